// The actions, menus and bars of a comparison's window, and the dialogs behind them.
#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenuBar>
#include <QToolBar>
#include <QToolButton>
#include <limits>

#include "compare/builtin_comparisons.h"
#include "compare/compare_window.h"
#include "compare/comparison_files.h"
#include "document/document_actions.h"
#include "document/result_files.h"
#include "theme/theme.h"
#include "widgets/action_button.h"

namespace clothlab {
namespace {

const char* const filter = "Clothlab comparisons (*.compare.json);;All files (*)";

}  // namespace

void CompareWindow::makeActions() {
  const auto action = [this](const char* icon_name, const QString& text, const QString& tip,
                             const QKeySequence& key, const char* name) {
    auto* made = new QAction(icon(icon_name), text, this);
    made->setObjectName(name);
    made->setShortcut(key);
    made->setToolTip(QStringLiteral("%1 (%2)").arg(tip, key.toString(QKeySequence::NativeText)));
    addAction(made);
    return made;
  };
  play_ = action("play", tr("Play"), tr("Play or pause all panes"), Qt::Key_Space, "play");
  play_->setCheckable(true);
  step_ = action("step", tr("Step"), tr("To the next common time of all panes"), Qt::Key_Period, "step");
  reset_ = action("reset", tr("Reset"), tr("Back to the start, paused"), QKeySequence("Ctrl+R"), "reset");
  record_ = action("record", tr("Record"), tr("Record a CSV file of each pane and compare.csv while it runs"),
                   QKeySequence("Ctrl+Shift+R"), "record");
  record_->setCheckable(true);
  connect(play_, &QAction::triggered, this, [this](bool play) {
    play ? link_.send(command::Play{}) : link_.send(command::Pause{});
  });
  connect(step_, &QAction::triggered, this, [this] { link_.send(command::SingleStep{}); });
  connect(reset_, &QAction::triggered, this, [this] { link_.send(command::Restart{}); });
  connect(record_, &QAction::triggered, this, &CompareWindow::toggleRecording);
}

void CompareWindow::makeMenus() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  file->addAction(icon("open"), tr("Open…"), QKeySequence::Open, this, &CompareWindow::openWithDialog);
  QMenu* builtin = file->addMenu(tr("Built-in comparisons"));
  for (const cloth::BuiltinComparison& comparison : cloth::builtin_comparisons()) {
    const QString name = QString::fromStdString(comparison.name);
    builtin->addAction(QString::fromStdString(cloth::builtin_comparison(comparison.name).title), this,
                       [this, name] { openComparison(name); });
  }
  file->addSeparator();
  file->addAction(icon("save"), tr("Save"), QKeySequence::Save, this, [this] { save(); });
  file->addAction(tr("Save as…"), QKeySequence("Ctrl+Shift+S"), this, [this] { saveAs(); });
  file->addSeparator();
  QAction* save_plots = file->addAction(icon("export-plot"), tr("Save plots…"), QKeySequence("Ctrl+Shift+P"),
                                        charts_, &CompareCharts::saveAs);
  save_plots->setObjectName("savePlots");
  save_plots->setToolTip(tr("Save the charts as PNG, SVG or CSV"));
  file->addSeparator();
  file->addAction(tr("Close"), QKeySequence::Close, this, &QWidget::close);

  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  const auto [undo, redo] = make_undo_actions(document_.undoStack(), this);
  edit->addActions({undo, redo});
  edit->addSeparator();
  QAction* copy = edit->addAction(tr("Copy ranking"), this, [this] { ranking_->copy(); });
  copy->setObjectName("copyRanking");

  QMenu* run = menuBar()->addMenu(tr("&Run"));
  run->addActions({play_, step_, reset_});
  run->addSeparator();
  run->addAction(record_);

  QMenu* view = menuBar()->addMenu(tr("&View"));
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view->addAction(dock->toggleViewAction());
}

/// Tools, ways of drawing, camera, and the reference, above the panes.
void CompareWindow::makeViewBar() {
  QToolBar* bar = addToolBar(tr("View"));
  bar->setObjectName("compareViewBar");
  bar->setMovable(false);
  bar->setIconSize({20, 20});
  const auto choice = [this, bar](QActionGroup* group, const char* icon_name, const QString& text,
                                  const QString& tip, const QString& key, const char* name, bool checked) {
    auto* action = new QAction(icon(icon_name), text, group);
    action->setObjectName(name);
    action->setCheckable(true);
    action->setChecked(checked);
    action->setShortcut(key);
    action->setToolTip(QStringLiteral("%1 (%2)").arg(tip, key));
    bar->addAction(action);
    return action;
  };
  auto* tools = new QActionGroup(this);
  const auto tool = [&](Tool which, QAction* action) {
    connect(action, &QAction::triggered, this, [this, which] { grid_->setTool(which); });
  };
  tool(Tool::pull,
       choice(tools, "pull", tr("Pull"), tr("Drag a particle in all panes; beside the cloth: orbit"), "1",
              "toolPull", true));
  tool(Tool::brush,
       choice(tools, "brush", tr("Wind brush"), tr("Drag to blow on all panes"), "2", "toolBrush", false));
  tool(Tool::pin, choice(tools, "pin", tr("Pin"), tr("Click a particle to pin or free it in all panes"), "3",
                         "toolPin", false));
  bar->addSeparator();
  auto* modes = new QActionGroup(this);
  const auto mode = [&](ViewMode which, Colouring colouring, QAction* action) {
    connect(action, &QAction::triggered, this, [this, which, colouring] { setColouring(which, colouring); });
  };
  mode(ViewMode::textured, Colouring::strain,
       choice(modes, "view-textured", tr("Textured"), tr("Woven cloth with light"), "T", "modeTextured",
              true));
  mode(ViewMode::wireframe, Colouring::strain,
       choice(modes, "view-wireframe", tr("Wireframe"), tr("The grid of structural springs"), "W",
              "modeWireframe", false));
  mode(ViewMode::strain, Colouring::strain,
       choice(modes, "view-strain", tr("Strain"), tr("Colours for the strain, the same in all panes"), "S",
              "modeStrain", false));
  mode(ViewMode::strain, Colouring::difference,
       choice(modes, "view-difference", tr("Difference"),
              tr("Colours for each particle's distance from the reference, the same in all panes"), "D",
              "modeDifference", false));
  bar->addSeparator();
  QAction* frame_all = bar->addAction(icon("frame-all"), tr("Frame all"), grid_, &PaneGrid::frameAll);
  frame_all->setShortcut(QStringLiteral("F"));
  frame_all->setToolTip(tr("Fit the cloth into all panes (F)"));
  auto* camera = new QMenu(bar);
  const std::pair<CameraPreset, QString> presets[] = {
      {CameraPreset::front, tr("Front")}, {CameraPreset::back, tr("Back")},
      {CameraPreset::left, tr("Left")},   {CameraPreset::right, tr("Right")},
      {CameraPreset::top, tr("Top")},     {CameraPreset::isometric, tr("Isometric")}};
  int key = 0;
  for (const auto& [preset, name] : presets) {
    QAction* action = camera->addAction(name, this, [this, which = preset] { grid_->setPreset(which); });
    action->setShortcut(QStringLiteral("F%1").arg(++key));
  }
  auto* look = new QToolButton(bar);
  look->setIcon(icon("camera-iso"));
  look->setMenu(camera);
  look->setPopupMode(QToolButton::InstantPopup);
  look->setToolTip(tr("Look from the front, back, left, right, top or a corner"));
  look->setAccessibleName(tr("Camera"));
  bar->addWidget(look);

  auto* gap = new QWidget(bar);
  gap->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  bar->addWidget(gap);
  auto* label = new QLabel(tr("Reference"), bar);
  label->setContentsMargins(0, 0, spacing, 0);
  bar->addWidget(label);
  reference_ = new QComboBox(bar);
  reference_->setObjectName("reference");
  reference_->setAccessibleName(tr("Reference"));
  reference_->setMinimumContentsLength(12);
  connect(reference_, &QComboBox::activated, this, &CompareWindow::chooseReference);
  bar->addWidget(reference_);
}

void CompareWindow::makeTransport() {
  auto* frame = new QWidget(this);
  auto* row = new QHBoxLayout(frame);
  row->setContentsMargins(spacing, spacing / 2, spacing, spacing / 2);
  row->setSpacing(spacing / 2);
  QToolButton* play = make_action_button(play_, frame);
  play->setIconSize({24, 24});
  row->addWidget(play);
  for (QAction* action : {step_, reset_, record_}) row->addWidget(make_action_button(action, frame));
  row->addSpacing(spacing);
  speed_ = new QComboBox(frame);
  speed_->setObjectName("speed");
  speed_->setToolTip(tr("Speed: simulated seconds per second"));
  speed_->setAccessibleName(tr("Speed"));
  for (const double factor : {0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0})
    speed_->addItem(tr("%1x").arg(factor), factor);
  speed_->addItem(tr("Fastest"), std::numeric_limits<double>::infinity());
  speed_->setCurrentIndex(3);
  connect(speed_, &QComboBox::currentIndexChanged, this,
          [this](int index) { link_.send(command::Speed{speed_->itemData(index).toDouble()}); });
  row->addWidget(speed_);
  row->addSpacing(spacing);
  time_ = new Reading("000.000 of 00.00 s", Reading::Look::bold, frame);
  time_->setObjectName("timeLabel");
  row->addWidget(time_);
  rate_ = new Reading("00.00x real time", Reading::Look::muted, frame);
  rate_->setObjectName("rateLabel");
  row->addWidget(rate_, 1);

  auto* bottom = new QToolBar(tr("Run"), this);
  bottom->setObjectName("transportToolBar");
  bottom->setMovable(false);
  bottom->addWidget(frame);
  addToolBar(Qt::BottomToolBarArea, bottom);
}

void CompareWindow::openWithDialog() {
  const QString path =
      QFileDialog::getOpenFileName(this, tr("Open a comparison"), document_.path(), tr(filter));
  if (!path.isEmpty()) openComparison(path);
}

bool CompareWindow::save() {
  return document_.path().isEmpty() ? saveAs() : saveTo(document_.path());
}

bool CompareWindow::saveAs() {
  QString path = QFileDialog::getSaveFileName(this, tr("Save the comparison"), document_.path(), tr(filter));
  if (path.isEmpty()) return false;
  if (!QFileInfo(path).fileName().contains('.')) path += ".compare.json";
  return saveTo(path);
}

bool CompareWindow::saveTo(const QString& path) {
  const QString problem = save_comparison_file(document_.comparison(), path);
  if (!problem.isEmpty()) {
    notice_->show("save", NoticeBar::Level::error, tr("The comparison was not saved. %1").arg(problem));
    return false;
  }
  document_.markSaved(path);
  return true;
}

void CompareWindow::toggleRecording(bool on) {
  if (on)
    startRecording(new_folder(results_folder(), {document_.title()}));
  else
    link_.send(command::StopRecording{});
}

}  // namespace clothlab
