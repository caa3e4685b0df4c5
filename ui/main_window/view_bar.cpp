#include "main_window/view_bar.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QMenu>
#include <QSpinBox>
#include <QToolButton>
#include <algorithm>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

QAction* make_view_action(const char* icon_name, const QString& text, const QString& tip,
                          const QString& shortcut, const char* name, QObject* parent) {
  auto* action = named(name, new QAction(icon(icon_name), text, parent));
  action->setShortcut(shortcut);
  action->setToolTip(QStringLiteral("%1 (%2)").arg(tip, shortcut));
  return action;
}

ViewBar::ViewBar(PaneGrid& panes, QAction* save_picture, QWidget* parent) : QFrame(parent), panes_(panes) {
  setObjectName("viewBar");
  auto* row = spaced(new QHBoxLayout(this), spacing / 2, {spacing, spacing / 2, spacing, spacing / 2});
  addTools();
  addModes();
  for (const QActionGroup* group : {tools_, modes_}) {
    for (QAction* action : group->actions()) row->addWidget(make_action_button(action, this));
    if (group == tools_) addProbes(*row);
    row->addSpacing(2 * spacing);
  }
  difference_ = findChild<QWidget*>("modeDifferenceButton");
  addContact(*row);
  row->addStretch(1);
  addCamera();
  keepLast(make_action_button(save_picture, this));
  showComparison(false);  // before the window says how small it can be
}

void ViewBar::addTools() {
  const std::vector<ViewChoice<Tool>> tools{
      {Tool::pull, "pull", tr("Pull"), tr("Drag the cloth to pull a particle; drag beside it to orbit"), "1",
       "toolPull"},
      {Tool::brush, "brush", tr("Wind brush"),
       tr("Drag to blow where the cursor is; also with Shift held. Wheel while blowing: radius"), "2",
       "toolBrush"},
      {Tool::pin, "pin", tr("Pin"), tr("Click a particle to pin or free it"), "3", "toolPin"},
      {Tool::probe, "probe", tr("Probe"), tr("Click particles to measure them: charted and recorded"), "4",
       "toolProbe"}};
  tools_ = make_choices(this, tools, [this](Tool tool) { panes_.setTool(tool); });
  connect(&panes_, &PaneGrid::toolChanged, this, [this](Tool tool) {
    tools_->actions()[static_cast<int>(tool)]->setChecked(true);
    probe_measure_->setVisible(tool == Tool::probe);
    suitWidth();
  });
}

/// What the probe tool measures, beside the tools.
void ViewBar::addProbes(QHBoxLayout& row) {
  probe_measure_ = named("probeMeasure", new QComboBox(this));
  probe_measure_->setAccessibleName(tr("What the probe measures"));
  probe_measure_->setToolTip(
      tr("What to measure, by clicks on one, two or three particles, or both ends of a line"));
  for (const cloth::ProbeFacts& facts : cloth::probe_facts())
    if (facts.is_of_particles()) {
      probe_measure_->addItem(QString::fromLatin1(facts.title), static_cast<int>(facts.measure));
      probe_measure_->setItemData(probe_measure_->count() - 1, QString::fromLatin1(facts.doc),
                                  Qt::ToolTipRole);
    }
  probe_measure_->hide();
  row.addWidget(probe_measure_);
  connect(probe_measure_, &QComboBox::currentIndexChanged, this, [this] {
    panes_.setProbeMeasure(static_cast<cloth::ProbeMeasure>(probe_measure_->currentData().toInt()));
  });
}

void ViewBar::addModes() {
  using Mode = std::pair<ViewMode, Colouring>;
  const std::vector<ViewChoice<Mode>> modes{
      {{ViewMode::textured, Colouring::strain},
       "view-textured",
       tr("Textured"),
       tr("Woven cloth with light"),
       "T",
       "modeTextured"},
      {{ViewMode::wireframe, Colouring::strain},
       "view-wireframe",
       tr("Wireframe"),
       tr("The grid of structural springs"),
       "W",
       "modeWireframe"},
      {{ViewMode::strain, Colouring::strain},
       "view-strain",
       tr("Strain"),
       tr("Colours for the strain of structural and shear springs"),
       "S",
       "modeStrain"},
      {{ViewMode::strain, Colouring::difference},
       "view-difference",
       tr("Difference"),
       tr("Colours for each particle's distance from the reference, the same in all panes"),
       "D",
       "modeDifference"}};
  modes_ = make_choices(this, modes, [this](const Mode& mode) { panes_.setMode(mode.first, mode.second); });
  connect(&panes_, &PaneGrid::modeChanged, this, [this](ViewMode mode, Colouring colouring) {
    const bool difference = mode == ViewMode::strain && colouring == Colouring::difference;
    modes_->actions()[difference ? 3 : static_cast<int>(mode)]->setChecked(true);
  });
}

void ViewBar::showComparison(bool on) {
  modes_->actions().constLast()->setVisible(on);
  difference_->setVisible(on);
  suitWidth();
}

/// The spin box is there only where a scene has a hierarchy of boxes.
void ViewBar::addContact(QHBoxLayout& row) {
  contact_ = make_view_action("contact", tr("Contact"),
                              tr("Where the cloth touches something, and the way it is pushed"), "C",
                              "showContact", this);
  contact_->setCheckable(true);
  row.addWidget(make_action_button(contact_, this));

  box_level_ = named("boxLevel", new QSpinBox(this));
  box_level_->setAccessibleName(tr("Boxes of the hierarchy"));
  box_level_->setToolTip(tr("Boxes that contact is looked for in, so many levels below the one around all"));
  box_level_->setMinimum(-1);
  box_level_->setSpecialValueText(tr("No boxes"));
  box_level_->setPrefix(tr("Boxes: "));
  box_level_->setValue(-1);
  box_level_->hide();
  row.addWidget(box_level_);

  const auto choose = [this] {
    const bool shown = contact_->isChecked();
    box_level_->setEnabled(shown);
    panes_.setContact({.marks = shown, .box_level = shown ? box_level_->value() : -1});
  };
  box_level_->setEnabled(false);
  connect(contact_, &QAction::toggled, this, choose);
  connect(box_level_, &QSpinBox::valueChanged, this, choose);
  connect(&panes_, &PaneGrid::hierarchyDepthChanged, this, [this](int depth) {
    box_level_->setMaximum(depth);
    box_level_->setVisible(depth > 0);
    suitWidth();
  });
}

/// A button with a menu of the camera presets.
QToolButton* ViewBar::makeCameraButton() {
  const std::pair<CameraPreset, QString> presets[] = {
      {CameraPreset::front, tr("Front")}, {CameraPreset::back, tr("Back")},
      {CameraPreset::left, tr("Left")},   {CameraPreset::right, tr("Right")},
      {CameraPreset::top, tr("Top")},     {CameraPreset::isometric, tr("Isometric")}};
  auto* menu = new QMenu(this);
  int key = 0;
  for (const auto& [preset, name] : presets) {
    QAction* action = menu->addAction(name, this, [this, which = preset] { panes_.setPreset(which); });
    action->setShortcut(QStringLiteral("Ctrl+%1").arg(++key));
  }
  camera_ = menu->actions();
  auto* button = named("cameraButton", new QToolButton(this));
  button->setIcon(icon("camera-iso"));
  button->setIconSize({20, 20});
  button->setAutoRaise(true);
  button->setMenu(menu);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setToolTip(tr("Look from the front, back, left, right, top or a corner"));
  button->setAccessibleName(tr("Camera"));
  return button;
}

void ViewBar::addCamera() {
  keepLast(makeCameraButton());
  frame_all_ = make_view_action("frame-all", tr("Frame all"),
                                tr("Fit the cloth and the obstacles into the view"), "F", "frameAll", this);
  connect(frame_all_, &QAction::triggered, &panes_, &PaneGrid::frameAll);
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

/// The fields for boxes and probes may cost the last buttons their place, and a narrow window the last one.
QSize ViewBar::minimumSizeHint() const {
  int without_fields = leastWidth();
  for (const QWidget* field : {static_cast<QWidget*>(box_level_), static_cast<QWidget*>(probe_measure_)})
    if (!field->isHidden()) without_fields -= roomOf(*field);
  for (const QWidget* button : last_)
    if (button != last_.constLast()) without_fields += roomOf(*button);
  return {std::max(leastWidth(), without_fields), layout()->minimumSize().height()};
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
