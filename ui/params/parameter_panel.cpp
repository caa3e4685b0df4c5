#include "params/parameter_panel.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPainter>
#include <QScrollArea>
#include <QScrollBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "params/editors.h"
#include "params/material_row.h"
#include "params/mesh_button.h"
#include "params/parameter_section.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

/// Which part of which editor has the focus, to find it again in another editor of the same parameter.
struct FocusPlace {
  QString editor, part;
};

FocusPlace focus_place(const QWidget* root) {
  const QWidget* focus = root->focusWidget();
  if (!focus || !focus->hasFocus()) return {};
  for (const QWidget* up = focus; up && up != root; up = up->parentWidget())
    if (up->objectName().startsWith("param:")) return {up->objectName(), focus->objectName()};
  return {};
}

void restore_focus(const QWidget* root, const FocusPlace& place) {
  if (place.editor.isEmpty()) return;
  const auto* editor = root->findChild<QWidget*>(place.editor);
  auto* part = editor ? editor->findChild<QWidget*>(place.part) : nullptr;
  if (part && !part->hasFocus()) part->setFocus(Qt::OtherFocusReason);
}

}  // namespace

ParameterPanel::ParameterPanel(LabDocument& document, QWidget* parent)
    : QWidget(parent), document_(document) {
  setObjectName("parameterPanel");
  setAccessibleName(tr("Parameters"));
  auto* column = spaced(new QVBoxLayout(this), 0);
  makeHead();
  makeScrollArea();
  column->addWidget(scroll_, 1);
  if (document.isLoaded()) rebuild();

  connect(&document, &LabDocument::parameterChanged, this, &ParameterPanel::follow);
  connect(&document, &LabDocument::blocksChanged, this, &ParameterPanel::rebuild);
  connect(&document, &LabDocument::loaded, this, &ParameterPanel::rebuild);
  connect(&document, &LabDocument::scopeChanged, this, &ParameterPanel::rebuild);
}

/// The search field and, beside it, what can be added.
void ParameterPanel::makeHead() {
  auto* rows = new QVBoxLayout;
  rows->setContentsMargins(2 * spacing, spacing, spacing, spacing);
  auto* row = new QHBoxLayout;
  row->addWidget(makeSearch(), 1);
  row->addWidget(makeAdd());
  rows->addLayout(row);
  nothing_ = named("nothing", new QLabel(this));
  nothing_->setProperty("muted", true);
  nothing_->setTextFormat(Qt::PlainText);
  nothing_->setWordWrap(true);
  nothing_->hide();
  rows->addWidget(nothing_);
  static_cast<QVBoxLayout*>(layout())->addLayout(rows);
}

QWidget* ParameterPanel::makeSearch() {
  search_ = named("search", new QLineEdit(this));
  search_->setPlaceholderText(tr("Search (Ctrl+F)"));
  search_->setAccessibleName(tr("Search the parameters"));
  search_->setToolTip(tr("Words of a parameter's title, path or help text"));
  search_->setClearButtonEnabled(true);
  search_->installEventFilter(this);
  connect(search_, &QLineEdit::textChanged, this, &ParameterPanel::filter);
  return search_;
}

QWidget* ParameterPanel::makeAdd() {
  add_ = named("add", new QToolButton(this));
  add_->setText(tr("Add"));
  add_->setIcon(icon("add"));
  add_->setIconSize({16, 16});
  add_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  add_->setPopupMode(QToolButton::InstantPopup);
  add_->setFocusPolicy(Qt::TabFocus);
  add_->setToolTip(tr("Bring physics or an obstacle into the scene"));
  menu_ = named("addMenu", new QMenu(add_));
  menu_->setToolTipsVisible(true);
  add_->setMenu(menu_);
  return add_;
}

void ParameterPanel::startSearch() {
  search_->setFocus(Qt::ShortcutFocusReason);
  search_->selectAll();
}

/// Shows what has every word of the search field. Sections are open meanwhile, and afterwards as they were.
void ParameterPanel::filter() {
  const QStringList words = search_->text().split(' ', Qt::SkipEmptyParts);
  bool any = false;
  for (ParameterSection* section : sections_) {
    const QSignalBlocker quiet(section);
    any = section->showMatching(words) || any;
    section->setCollapsed(words.isEmpty() && collapsed_.count(section->path()) > 0);
  }
  nothing_->setText(tr("No parameter matches “%1”.").arg(search_->text().trimmed()));
  nothing_->setVisible(!any && !words.isEmpty());
}

void ParameterPanel::focusFirstMatch() {
  for (const ParameterSection* section : sections_)
    for (const ParameterEditor* one : section->editors())
      if (one->isVisible()) return void(reveal(one->path()));
}

/// Escape in the search field clears it, Enter and Down go to the first match.
bool ParameterPanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched != search_ || event->type() != QEvent::KeyPress) return QWidget::eventFilter(watched, event);
  switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_Escape:
      search_->clear();
      return true;
    case Qt::Key_Return:
    case Qt::Key_Enter:
    case Qt::Key_Down:
      focusFirstMatch();
      return true;
    default:
      return QWidget::eventFilter(watched, event);
  }
}

void ParameterPanel::makeScrollArea() {
  scroll_ = named("scroll", new QScrollArea(this));
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setFocusPolicy(Qt::NoFocus);
  content_ = new QWidget;
  column_ = spaced(new QVBoxLayout(content_), 0);
  column_->addStretch(1);
  scroll_->setWidget(content_);
}

void ParameterPanel::fillAddMenu() {
  menu_->clear();
  auto group = cloth::BlockOffer::Group::block;
  for (const cloth::BlockOffer& offer : offers_for(document_.scene())) {
    if (offer.group != std::exchange(group, offer.group) && !menu_->isEmpty()) menu_->addSeparator();
    QAction* action = menu_->addAction(QString::fromStdString(offer.title));
    action->setObjectName("offer:" + QString::fromStdString(offer.path));
    action->setToolTip(QString::fromStdString(offer.doc));
    connect(action, &QAction::triggered, this, [this, path = offer.path] { add(path); });
  }
  add_->setEnabled(!menu_->isEmpty());
}

void ParameterPanel::add(const std::string& offer_path) {
  std::set<std::string> before;
  for (const ParameterSection* section : sections_) before.insert(section->path());
  search_->clear();
  if (!document_.addBlock(offer_path)) return;
  for (ParameterSection* section : sections_) {
    if (before.count(section->path())) continue;
    section->setCollapsed(false);
    QCoreApplication::sendPostedEvents(content_, QEvent::LayoutRequest);
    scroll_->ensureWidgetVisible(section, 0, 0);
  }
}

ParameterSection* ParameterPanel::makeSection(const cloth::Block& block) {
  auto* section = new ParameterSection(document_, block, content_);
  section->setCollapsed(collapsed_.count(block.path) > 0);
  connect(section, &ParameterSection::collapsedChanged, this, [this, path = block.path](bool collapsed) {
    if (collapsed)
      collapsed_.insert(path);
    else
      collapsed_.erase(path);
  });
  connect(section, &ParameterSection::removeRequested, this,
          [this, path = block.path] { document_.removeBlock(path); });
  connect(section, &ParameterSection::meshChosen, this, [this, path = block.path] { showMesh(path); });
  connect(section, &ParameterSection::materialSaid, this,
          [this, section] { showRow(section->findChild<MaterialRow*>()); });
  section->setRemovable(blocks_editable_);
  for (const cloth::Parameter& parameter : block.parameters) {
    ParameterEditor* made = section->editor(parameter.path);
    applyNotes(*made);
    connect(made, &ParameterEditor::tabStopsChanged, this, &ParameterPanel::orderTabs);
    connect(made, &ParameterEditor::noteButtonClicked, this,
            [this, path = parameter.path] { Q_EMIT noteButtonClicked(path); });
  }
  return section;
}

/// The name of a block's mesh with what is said about it, in sight.
void ParameterPanel::showMesh(const std::string& block_path) {
  QCoreApplication::sendPostedEvents(content_, QEvent::LayoutRequest);
  for (ParameterSection* section : sections_) {
    if (section->path() != block_path) continue;
    QWidget* row = section->findChild<ClothShapeRow*>();
    for (ParameterEditor* editor : section->editors())
      if (auto* mesh = qobject_cast<MeshEditor*>(editor)) row = mesh;
    showRow(row);
  }
}

void ParameterPanel::showRow(QWidget* row) {
  QCoreApplication::sendPostedEvents(content_, QEvent::LayoutRequest);
  if (row) scroll_->ensureWidgetVisible(row, 0, 3 * spacing);
}

void ParameterPanel::retire(ParameterSection* section) {
  // It may be the sender of the signal that led here, and what is typed in it must not reach another block.
  section->abandonEdits();
  section->hide();
  section->setParent(nullptr);
  section->deleteLater();
}

void ParameterPanel::follow(const std::string& path) {
  if (ParameterEditor* changed = editor(path)) changed->refresh();
  if (path.rfind("cloth.", 0) != 0) return;
  for (const ParameterSection* section : sections_)
    for (ParameterEditor* other : section->editors()) other->refreshDefault();
}

void ParameterPanel::rebuild() {
  const int place = scroll_->verticalScrollBar()->value();
  const FocusPlace focus = focus_place(this);
  content_->setUpdatesEnabled(false);
  std::vector<ParameterSection*> old = std::exchange(sections_, {});
  for (const cloth::Block& block : blocks_of(document_.scene())) {
    const auto same =
        std::find_if(old.begin(), old.end(), [&](const ParameterSection* s) { return s->shows(block); });
    if (same == old.end()) {
      sections_.push_back(makeSection(block));
    } else {
      (*same)->refresh();
      sections_.push_back(*same);
      old.erase(same);
    }
  }
  for (ParameterSection* section : old) retire(section);
  for (std::size_t i = 0; i < sections_.size(); ++i) column_->insertWidget(static_cast<int>(i), sections_[i]);
  filter();
  fillAddMenu();
  orderTabs();
  content_->setUpdatesEnabled(true);
  QCoreApplication::sendPostedEvents(content_, QEvent::LayoutRequest);
  restore_focus(this, focus);
  scroll_->verticalScrollBar()->setValue(place);
}

void ParameterPanel::orderTabs() {
  QWidget::setTabOrder(add_, search_);
  QWidget* last = search_;
  for (const ParameterSection* section : sections_)
    for (QWidget* stop : section->tabStops()) {
      QWidget::setTabOrder(last, stop);
      last = stop;
    }
}

ParameterEditor* ParameterPanel::editor(const std::string& path) const {
  for (const ParameterSection* section : sections_)
    if (ParameterEditor* found = section->editor(path)) return found;
  return nullptr;
}

void ParameterPanel::applyNotes(ParameterEditor& which) {
  if (const auto note = notes_.find(which.path()); note != notes_.end())
    which.setNote(note->second.text, note->second.button);
  const auto value = auto_values_.find(which.path());
  auto* number = qobject_cast<NumberEditor*>(&which);
  if (number && value != auto_values_.end()) number->setAutoValue(value->second);
}

void ParameterPanel::setNote(const std::string& path, const QString& note, const QString& button) {
  if (notes_[path] == Note{note, button}) return;
  notes_[path] = {note, button};
  if (ParameterEditor* found = editor(path)) found->setNote(note, button);
}

void ParameterPanel::clearNotes() {
  for (auto& [path, note] : std::exchange(notes_, {}))
    if (ParameterEditor* found = editor(path)) found->setNote({});
}

void ParameterPanel::setBlocksEditable(bool editable) {
  blocks_editable_ = editable;
  add_->setVisible(editable);
  for (ParameterSection* section : sections_) section->setRemovable(editable);
}

void ParameterPanel::setAutoValue(const std::string& path, std::optional<double> value) {
  if (value)
    auto_values_[path] = *value;
  else
    auto_values_.erase(path);
  if (auto* number = qobject_cast<NumberEditor*>(editor(path))) number->setAutoValue(value);
}

bool ParameterPanel::reveal(const std::string& path) {
  for (ParameterSection* section : sections_)
    if (ParameterEditor* found = section->editor(path)) {
      if (found->isHidden() || section->isHidden()) search_->clear();
      section->setCollapsed(false);
      QCoreApplication::sendPostedEvents(content_, QEvent::LayoutRequest);
      scroll_->ensureWidgetVisible(found, 0, 2 * spacing);
      found->tabStops().first()->setFocus(Qt::OtherFocusReason);
      return true;
    }
  return false;
}

void ParameterPanel::paintEvent(QPaintEvent*) {
  QPainter(this).fillRect(rect(), theme().panel);
}

}  // namespace clothlab
