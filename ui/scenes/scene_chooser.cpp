#include "scenes/scene_chooser.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPainter>
#include <QPainterPath>
#include <QScrollBar>
#include <QStyledItemDelegate>
#include <QVBoxLayout>

#include "scenes/scene_gallery.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{900, 600};
constexpr QSize picture_size{144, 90};  // px
constexpr int least_card_width = 380;   // px

enum Role { name_role = Qt::UserRole, shows_role, found_role };

bool is_card(const QModelIndex& index) {
  return index.flags().testFlag(Qt::ItemIsSelectable);
}

/// Paints purposes as headings over the whole width, and cards below them in as many columns as have room.
class CardPainter : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const int width = static_cast<const QListWidget*>(option.widget)->viewport()->width();
    const int line = option.fontMetrics.height();
    if (!is_card(index)) return {width, line + 3 * spacing};
    const int columns = std::max(1, width / least_card_width);
    return {(width - 1) / columns,  // a row is full one pixel before the end
            std::max(picture_size.height(), 5 * line) + 2 * spacing};
  }

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const int edge = spacing;
    const QRect inside = option.rect.adjusted(edge, edge, -edge, -edge);
    painter->save();
    if (is_card(index)) {
      QStyleOptionViewItem frame = option;
      initStyleOption(&frame, index);
      frame.text.clear();
      frame.widget->style()->drawControl(QStyle::CE_ItemViewItem, &frame, painter, frame.widget);
      paintPicture(painter, visual(option, inside, {{0, 0}, picture_size}), index);
      const int left = picture_size.width() + spacing + spacing / 2;
      paintTexts(painter, option, visual(option, inside, {left, 0, inside.width() - left, inside.height()}),
                 index);
    } else {
      painter->setFont(bold(option.font));
      painter->setPen(theme().text);
      painter->drawText(inside, leading(option) | Qt::AlignBottom, index.data().toString());
    }
    painter->restore();
  }

 private:
  /// `part` of `whole`, from its top left; mirrored where text runs from the right.
  static QRect visual(const QStyleOptionViewItem& option, const QRect& whole, const QRect& part) {
    return QStyle::visualRect(option.direction, whole, part.translated(whole.topLeft()));
  }
  static Qt::Alignment leading(const QStyleOptionViewItem& option) {
    return QStyle::visualAlignment(option.direction, Qt::AlignLeft) | Qt::AlignAbsolute;
  }
  static QFont bold(QFont font) {
    font.setWeight(QFont::DemiBold);
    return font;
  }

  /// The picture is read when it is first seen, and kept in Qt's cache.
  static void paintPicture(QPainter* painter, const QRect& place, const QModelIndex& index) {
    painter->setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    QPainterPath outline;
    outline.addRoundedRect(QRectF(place).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    painter->save();
    painter->setClipPath(outline);
    painter->drawPixmap(place, QPixmap(gallery_picture(index.data(name_role).toString(), theme().dark)));
    painter->restore();
    painter->setPen(theme().border);
    painter->drawPath(outline);
  }

  static void paintTexts(QPainter* painter, const QStyleOptionViewItem& option, QRect place,
                         const QModelIndex& index) {
    const int flags = (leading(option) | Qt::AlignTop).toInt() | Qt::TextWordWrap;
    QRect used;
    painter->setFont(bold(option.font));
    painter->setPen(theme().text);
    painter->drawText(place, flags, index.data().toString(), &used);
    place.setTop(used.bottom() + spacing / 2);
    painter->setFont(option.font);
    painter->setPen(theme().muted_text);
    painter->drawText(place, flags, index.data(shows_role).toString());
  }
};

}  // namespace

SceneChooser::SceneChooser(const QString& selected, QWidget* parent)
    : QDialog(parent),
      words_(named("sceneWords", new QLineEdit(this))),
      list_(named("sceneList", new QListWidget(this))) {
  setObjectName("sceneChooser");
  setWindowTitle(tr("Scenes"));
  setAttribute(Qt::WA_DeleteOnClose);
  resize(pleasant_size.boundedTo(parent->size()));
  words_->setPlaceholderText(tr("Find: ball, wind, stiffness…"));
  words_->setAccessibleName(tr("Find a scene"));
  words_->setClearButtonEnabled(true);
  list_->setAccessibleName(windowTitle());
  list_->setItemDelegate(new CardPainter(list_));
  list_->setFlow(QListView::LeftToRight);
  list_->setWrapping(true);
  list_->setResizeMode(QListView::Adjust);
  list_->setVerticalScrollMode(QListView::ScrollPerPixel);
  list_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setMouseTracking(true);
  auto* column = spaced(new QVBoxLayout(this), spacing, {spacing, spacing, spacing, spacing});
  column->addWidget(words_);
  column->addWidget(list_, 1);
  addEntries();
  select(selected);
  list_->setFocus();
  for (QWidget* each : {static_cast<QWidget*>(words_), static_cast<QWidget*>(list_)})
    each->installEventFilter(this);
  const auto choose = [this](const QListWidgetItem* item) {
    if (!item || !item->flags().testFlag(Qt::ItemIsSelectable)) return;
    const QString name = item->data(name_role).toString();
    accept();
    Q_EMIT chosen(name);
  };
  connect(list_, &QListWidget::itemClicked, this, choose);
  connect(words_, &QLineEdit::returnPressed, this, [this, choose] { choose(list_->currentItem()); });
  connect(words_, &QLineEdit::textChanged, this, &SceneChooser::find);
}

void SceneChooser::addEntries() {
  for (const GalleryGroup& group : scene_gallery()) {
    (new QListWidgetItem(group.purpose, list_))->setFlags(Qt::NoItemFlags);
    for (const GalleryEntry& entry : group.entries) {
      auto* card = new QListWidgetItem(gallery_title(entry.name), list_);
      card->setData(name_role, QString(entry.name));
      card->setData(shows_role, entry.shows);
      card->setData(Qt::AccessibleDescriptionRole, entry.shows);
      card->setData(found_role, QStringList{group.purpose, card->text(), entry.shows, entry.name}.join(' '));
    }
  }
  auto* nothing = new QListWidgetItem(tr("No scene has these words"), list_);
  nothing->setFlags(Qt::NoItemFlags);
  nothing->setHidden(true);
}

/// The first card that can be seen where there is none of that name.
void SceneChooser::select(const QString& name) {
  QListWidgetItem* selected = nullptr;
  for (int row = list_->count() - 1; row >= 0; --row) {
    QListWidgetItem* item = list_->item(row);
    const bool named = selected && selected->data(name_role) == name;
    if (!item->isHidden() && item->flags().testFlag(Qt::ItemIsSelectable) && !named) selected = item;
  }
  list_->setCurrentItem(selected);
}

/// A heading stays where a card below it does.
void SceneChooser::find(const QString& words) {
  bool group_shown = false, any_shown = false;
  for (int row = list_->count() - 2; row >= 0; --row) {
    QListWidgetItem* item = list_->item(row);
    bool shown = group_shown;
    if (item->flags().testFlag(Qt::ItemIsSelectable)) {
      shown = true;
      for (const QString& word : words.split(' ', Qt::SkipEmptyParts))
        shown = shown && item->data(found_role).toString().contains(word, Qt::CaseInsensitive);
      group_shown = group_shown || shown;
    } else {
      group_shown = false;
    }
    item->setHidden(!shown);
    any_shown = any_shown || shown;
  }
  list_->item(list_->count() - 1)->setHidden(any_shown);
  select({});
  list_->scrollToTop();
}

/// Keys that move go to the list, keys that write to the field, whichever has the focus.
bool SceneChooser::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress) return QDialog::eventFilter(watched, event);
  const auto& key = static_cast<const QKeyEvent&>(*event);
  const bool moves = key.key() == Qt::Key_Up || key.key() == Qt::Key_Down || key.key() == Qt::Key_PageUp ||
                     key.key() == Qt::Key_PageDown;
  const bool turns = key.key() == Qt::Key_Left || key.key() == Qt::Key_Right;
  if (watched == words_ && (moves || (turns && words_->text().isEmpty()))) {
    QCoreApplication::sendEvent(list_, event);
    return true;
  }
  const bool enters = key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
  const bool writes = key.key() == Qt::Key_Backspace || (!key.text().isEmpty() && key.text()[0].isPrint());
  if (watched == list_ && (enters || writes)) {
    if (writes) words_->setFocus();
    QCoreApplication::sendEvent(words_, event);
    return true;
  }
  return QDialog::eventFilter(watched, event);
}

}  // namespace clothlab
