#include "main_window/view_bar.h"

#include <QAction>
#include <QActionGroup>
#include <QHBoxLayout>
#include <QMenu>
#include <QSpinBox>
#include <QToolButton>
#include <algorithm>

#include "theme/theme.h"
#include "widgets/action_button.h"

namespace clothlab {
namespace {

QString with_shortcut(const QString& tip, const QString& shortcut) {
  return QStringLiteral("%1 (%2)").arg(tip, shortcut);
}

}  // namespace

ViewBar::ViewBar(ClothView& view, QAction* save_picture, QWidget* parent)
    : QFrame(parent),
      view_(view),
      tools_(new QActionGroup(this)),
      modes_(new QActionGroup(this)),
      frame_all_(nullptr) {
  setObjectName("viewBar");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(spacing, spacing / 2, spacing, spacing / 2);
  row->setSpacing(spacing / 2);
  addTools(*row);
  row->addSpacing(2 * spacing);
  addModes(*row);
  row->addSpacing(2 * spacing);
  addContact(*row);
  row->addStretch(1);
  addCamera();
  keepLast(make_action_button(save_picture, this));
}

QAction* ViewBar::addChoice(QActionGroup* group, const char* icon_name, const QString& text,
                            const QString& tip, const QString& shortcut, const QString& name) {
  auto* action = new QAction(icon(icon_name), text, group);
  action->setCheckable(true);
  action->setShortcut(shortcut);
  action->setToolTip(with_shortcut(tip, shortcut));
  action->setObjectName(name);
  return action;
}

void ViewBar::addTools(QHBoxLayout& row) {
  const struct {
    Tool tool;
    const char* icon;
    QString text, tip, shortcut, name;
  } tools[] = {
      {Tool::pull, "pull", tr("Pull"), tr("Drag the cloth to pull a particle; drag beside it to orbit"), "1",
       "toolPull"},
      {Tool::brush, "brush", tr("Wind brush"),
       tr("Drag to blow where the cursor is; also with Shift held. Wheel while blowing: radius"), "2",
       "toolBrush"},
      {Tool::pin, "pin", tr("Pin"), tr("Click a particle to pin or free it"), "3", "toolPin"},
  };
  for (const auto& entry : tools) {
    QAction* action = addChoice(tools_, entry.icon, entry.text, entry.tip, entry.shortcut, entry.name);
    action->setChecked(entry.tool == view_.tool());
    connect(action, &QAction::triggered, this, [this, tool = entry.tool] { view_.setTool(tool); });
    connect(&view_, &ClothView::toolChanged, action,
            [action, tool = entry.tool](Tool chosen) { action->setChecked(tool == chosen); });
    row.addWidget(make_action_button(action, this));
  }
}

void ViewBar::addModes(QHBoxLayout& row) {
  const struct {
    ViewMode mode;
    const char* icon;
    QString text, tip, shortcut, name;
  } modes[] = {
      {ViewMode::textured, "view-textured", tr("Textured"), tr("Woven cloth with light"), "T",
       "modeTextured"},
      {ViewMode::wireframe, "view-wireframe", tr("Wireframe"), tr("The grid of structural springs"), "W",
       "modeWireframe"},
      {ViewMode::strain, "view-strain", tr("Strain"),
       tr("Colours for the strain of structural and shear springs"), "S", "modeStrain"},
  };
  for (const auto& entry : modes) {
    QAction* action = addChoice(modes_, entry.icon, entry.text, entry.tip, entry.shortcut, entry.name);
    action->setChecked(entry.mode == view_.mode());
    connect(action, &QAction::triggered, this, [this, mode = entry.mode] { view_.setMode(mode); });
    connect(&view_, &ClothView::modeChanged, action,
            [action, mode = entry.mode](ViewMode chosen) { action->setChecked(mode == chosen); });
    row.addWidget(make_action_button(action, this));
  }
}

/// The spin box is there only where a scene has a hierarchy of boxes.
void ViewBar::addContact(QHBoxLayout& row) {
  contact_ = new QAction(icon("contact"), tr("Contact"), this);
  contact_->setObjectName("showContact");
  contact_->setCheckable(true);
  contact_->setShortcut(QStringLiteral("C"));
  contact_->setToolTip(with_shortcut(tr("Where the cloth touches something, and the way it is pushed"), "C"));
  row.addWidget(make_action_button(contact_, this));

  box_level_ = new QSpinBox(this);
  box_level_->setObjectName("boxLevel");
  box_level_->setAccessibleName(tr("Boxes of the hierarchy"));
  box_level_->setToolTip(tr("Boxes that contact is looked for in, so many levels below the one around all"));
  box_level_->setMinimum(-1);
  box_level_->setSpecialValueText(tr("No boxes"));
  box_level_->setPrefix(tr("Boxes: level "));
  box_level_->setValue(-1);
  box_level_->hide();
  row.addWidget(box_level_);

  const auto choose = [this] {
    const bool shown = contact_->isChecked();
    box_level_->setEnabled(shown);
    view_.setContact({.marks = shown, .box_level = shown ? box_level_->value() : -1});
  };
  box_level_->setEnabled(false);
  connect(contact_, &QAction::toggled, this, choose);
  connect(box_level_, &QSpinBox::valueChanged, this, choose);
  connect(&view_, &ClothView::hierarchyDepthChanged, this, [this](int depth) {
    box_level_->setMaximum(depth);
    box_level_->setVisible(depth > 0);
    suitWidth();
  });
}

void ViewBar::addCamera() {
  const struct {
    CameraPreset preset;
    QString text, shortcut;
  } presets[] = {
      {CameraPreset::front, tr("Front"), "F1"}, {CameraPreset::back, tr("Back"), "F2"},
      {CameraPreset::left, tr("Left"), "F3"},   {CameraPreset::right, tr("Right"), "F4"},
      {CameraPreset::top, tr("Top"), "F5"},     {CameraPreset::isometric, tr("Isometric"), "F6"},
  };
  auto* menu = new QMenu(this);
  for (const auto& entry : presets) {
    auto* action = menu->addAction(entry.text);
    action->setShortcut(entry.shortcut);
    connect(action, &QAction::triggered, this, [this, preset = entry.preset] { view_.setPreset(preset); });
    camera_.append(action);
  }
  auto* button = new QToolButton(this);
  button->setObjectName("cameraButton");
  button->setIcon(icon("camera-iso"));
  button->setIconSize({20, 20});
  button->setAutoRaise(true);
  button->setMenu(menu);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setToolTip(tr("Look from the front, back, left, right, top or a corner"));
  button->setAccessibleName(tr("Camera"));
  keepLast(button);

  frame_all_ = new QAction(icon("frame-all"), tr("Frame all"), this);
  frame_all_->setObjectName("frameAll");
  frame_all_->setShortcut(QStringLiteral("F"));
  frame_all_->setToolTip(with_shortcut(tr("Fit the cloth and the obstacles into the view"), "F"));
  connect(frame_all_, &QAction::triggered, &view_, &ClothView::frameAll);
  keepLast(make_action_button(frame_all_, this));
}

void ViewBar::keepLast(QWidget* button) {
  layout()->addWidget(button);
  last_ << button;
}

int ViewBar::roomOf(const QWidget& part) const {
  return part.sizeHint().width() + layout()->spacing();
}

/// Without the last buttons.
int ViewBar::leastWidth() const {
  int least = layout()->minimumSize().width();
  for (const QWidget* button : last_)
    if (!button->isHidden()) least -= roomOf(*button);
  return least;
}

/// Only the field for boxes may cost the last buttons their place.
QSize ViewBar::minimumSizeHint() const {
  int all_but_boxes = leastWidth() - (box_level_->isHidden() ? 0 : roomOf(*box_level_));
  for (const QWidget* button : last_) all_but_boxes += roomOf(*button);
  return {std::max(leastWidth(), all_but_boxes), layout()->minimumSize().height()};
}

void ViewBar::suitWidth() {
  int needed = leastWidth();
  for (QWidget* button : last_) {
    needed += roomOf(*button);
    button->setVisible(needed <= width());
  }
}

void ViewBar::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  suitWidth();
}

void ViewBar::fillMenu(QMenu& menu) const {
  menu.addActions(tools_->actions());
  menu.addSeparator();
  menu.addActions(modes_->actions());
  menu.addSeparator();
  menu.addAction(contact_);
  menu.addSeparator();
  menu.addActions(camera_);
  menu.addAction(frame_all_);
}

}  // namespace clothlab
