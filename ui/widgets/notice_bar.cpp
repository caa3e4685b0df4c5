#include "widgets/notice_bar.h"

#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QToolButton>
#include <algorithm>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int widest_notice = 720;  // px

/// Broken at the space next to the middle.
QString in_two_lines(QString text) {
  const qsizetype half = text.size() / 2, before = text.lastIndexOf(' ', half),
                  after = text.indexOf(' ', half);
  const qsizetype at = before < 0 || (after >= 0 && after - half < half - before) ? after : before;
  if (at >= 0) text[at] = '\n';
  return text;
}

}  // namespace

/// One message: its symbol, its text with the buttons beside or below it, and the button that closes it.
class NoticeRow : public QFrame {
 public:
  explicit NoticeRow(const QString& kind);

  void say(NoticeBar::Level level, const QString& text, const QString& details);
  QPushButton* addButton(const QString& text);
  void clearButtons();
  /// Buttons below the text where the message is so narrow that they would leave it too little.
  void suitWidth(int width);

  QString text() const { return label_->text(); }
  QToolButton* closeButton() { return close_; }

 protected:
  void changeEvent(QEvent* event) override {
    if (event->type() == QEvent::PaletteChange) dress();
    QFrame::changeEvent(event);
  }

 private:
  void dress() { symbol_->setPixmap(icon(is_info_ ? "info" : "warning").pixmap(18, 18)); }

  bool is_info_ = true;
  QLabel* symbol_;
  QLabel* label_;
  QToolButton* close_;
  QGridLayout* cells_;
  QBoxLayout* buttons_;
};

NoticeRow::NoticeRow(const QString& kind)
    : symbol_(new QLabel(this)),
      label_(named("noticeText", new QLabel(this))),
      close_(named("noticeClose", new QToolButton(this))),
      cells_(spaced(new QGridLayout(this), spacing,
                    {spacing + spacing / 2, spacing / 2, spacing / 2, spacing / 2})),
      buttons_(spaced(new QBoxLayout(QBoxLayout::LeftToRight), spacing)) {
  setObjectName("notice:" + kind);
  label_->setWordWrap(true);
  label_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  close_->setIcon(icon("remove"));
  close_->setAutoRaise(true);
  close_->setFocusPolicy(Qt::TabFocus);  // a click leaves the focus where it was
  close_->setToolTip(NoticeBar::tr("Close this message"));
  close_->setAccessibleName(NoticeBar::tr("Close this message"));
  cells_->addWidget(symbol_, 0, 0, Qt::AlignTop);
  cells_->addWidget(label_, 0, 1);
  cells_->addWidget(close_, 0, 3, Qt::AlignTop);
  cells_->addLayout(buttons_, 0, 2);
  cells_->setColumnStretch(1, 1);
  symbol_->setMinimumHeight(close_->sizeHint().height());
}

void NoticeRow::say(NoticeBar::Level level, const QString& text, const QString& details) {
  is_info_ = level == NoticeBar::Level::info;
  setProperty("notice", is_info_ ? "info" : level == NoticeBar::Level::warning ? "warning" : "error");
  style()->polish(this);  // for the property
  label_->setText(text);
  label_->setToolTip(details);
  setAccessibleName(text);
  dress();
}

QPushButton* NoticeRow::addButton(const QString& text) {
  auto* button = named("noticeButton", new QPushButton(text, this));
  button->setFocusPolicy(Qt::TabFocus);
  buttons_->addWidget(button, 0, Qt::AlignLeft | Qt::AlignVCenter);
  button->show();
  return button;
}

void NoticeRow::clearButtons() {
  while (const QLayoutItem* item = buttons_->itemAt(0)) {
    QWidget* button = item->widget();
    buttons_->removeWidget(button);
    button->hide();
    button->setParent(nullptr);  // what looks for a button finds no old one
    button->deleteLater();
  }
}

void NoticeRow::suitWidth(int width) {
  constexpr int least_text = 240, narrow = 260;  // px
  const bool is_narrow = width < narrow;
  symbol_->setVisible(!is_narrow);
  int beside = spacing;
  for (int i = 0; i < buttons_->count(); ++i) {
    auto* button = static_cast<QPushButton*>(buttons_->itemAt(i)->widget());
    const QString text = button->text().replace('\n', ' ');
    button->setText(is_narrow ? in_two_lines(text) : text);
    beside += button->sizeHint().width() + spacing;
  }
  const int room = width - symbol_->sizeHint().width() - close_->sizeHint().width() - 4 * spacing;
  cells_->removeItem(buttons_);
  if (room - beside >= least_text)
    cells_->addLayout(buttons_, 0, 2);
  else
    cells_->addLayout(buttons_, 1, is_narrow ? 0 : 1, 1, is_narrow ? 4 : 3, Qt::AlignLeft);
  buttons_->setDirection(room >= beside ? QBoxLayout::LeftToRight : QBoxLayout::TopToBottom);
}

NoticeBar::NoticeBar(QWidget* parent)
    : QScrollArea(parent), column_(spaced(new QBoxLayout(QBoxLayout::TopToBottom), spacing / 2)) {
  setObjectName("notices");
  setFrameShape(NoFrame);
  setFocusPolicy(Qt::NoFocus);
  setWidgetResizable(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* content = new QWidget(this);
  content->setLayout(column_);
  setWidget(content);
  content->installEventFilter(this);
  hide();
}

void NoticeBar::layOver(QWidget* view, Qt::Edge edge) {
  view_ = view;
  edge_ = edge;
  column_->setDirection(edge == Qt::TopEdge ? QBoxLayout::TopToBottom : QBoxLayout::BottomToTop);
  setParent(view->parentWidget());
  view->installEventFilter(this);
  place();
}

void NoticeBar::show(const QString& kind, Level level, const QString& text, std::vector<NoticeAction> actions,
                     const QString& details) {
  closed_.erase(kind);
  NoticeRow*& row = rows_[kind];
  if (!row) {
    row = new NoticeRow(kind);
    column_->addWidget(row);
    row->show();
    connect(row->closeButton(), &QToolButton::clicked, this, [this, kind] { close(kind); });
  }
  row->say(level, text, details);
  row->clearButtons();
  for (NoticeAction& action : actions)
    connect(row->addButton(action.text), &QPushButton::clicked, this,
            [this, kind, act = std::move(action.act)] {
              withdraw(kind);
              act();
            });
  place();
}

void NoticeBar::showState(const QString& kind, Level level, const QString& text,
                          std::vector<NoticeAction> actions) {
  if (text.isEmpty()) return withdraw(kind);
  const auto closed = closed_.find(kind);
  const QString told = closed != closed_.end() ? closed->second : this->text(kind);
  if (told != text) show(kind, level, text, std::move(actions));
}

void NoticeBar::close(const QString& kind) {
  const QString told = text(kind);
  withdraw(kind);
  closed_[kind] = told;
}

void NoticeBar::withdraw(const QString& kind) {
  closed_.erase(kind);
  const auto found = rows_.find(kind);
  if (found == rows_.end()) return;
  NoticeRow* row = found->second;
  rows_.erase(found);
  column_->removeWidget(row);
  row->hide();
  row->setParent(nullptr);
  row->deleteLater();  // it may be the sender of the signal that led here
  place();
}

QString NoticeBar::text(const QString& kind) const {
  QStringList texts;
  for (const auto& [of, row] : rows_)
    if (kind.isEmpty() || kind == of) texts << row->text();
  return texts.join('\n');
}

QString NoticeBar::cause() const {
  const QLayoutItem* newest = column_->itemAt(column_->count() - 1);
  for (const auto& [kind, row] : rows_)
    if (newest && newest->widget() == row) return kind;
  return {};
}

bool NoticeBar::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (watched == view_ && (type == QEvent::Resize || type == QEvent::Move)) place();
  if (watched == widget() && type == QEvent::LayoutRequest) place();
  return QScrollArea::eventFilter(watched, event);
}

/// As high as the messages need, and no higher than the view.
void NoticeBar::place() {
  if (!view_) return;
  setVisible(!rows_.empty());
  if (rows_.empty()) return;
  const QRect room = view_->geometry().adjusted(spacing, spacing, -spacing, -spacing);
  const int width = std::min(room.width(), widest_notice);
  for (const auto& [kind, row] : rows_) row->suitWidth(width);
  column_->activate();
  const int height = std::min(column_->totalHeightForWidth(width), room.height());
  const int top = edge_ == Qt::TopEdge ? room.top() : room.bottom() + 1 - height;
  setGeometry(room.left() + (room.width() - width) / 2, top, width, height);
  raise();
}

}  // namespace clothlab
