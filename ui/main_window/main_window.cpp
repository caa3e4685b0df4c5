#include "main_window/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QMessageBox>
#include <utility>

#include "main_window/compare_window.h"
#include "main_window/lab_files.h"
#include "main_window/view_bar.h"
#include "scene/builtin_scenes.h"
#include "simulation/time_step.h"
#include "studies/studies_panel.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{1440, 900};
constexpr int parameters_width = 330, charts_width = 400;  // px
constexpr int studies_height = 400;                        // px

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : LabWindow(std::make_unique<LabDocument>(),
                {.document = tr("scene"),
                 .kind = scene_kind(),
                 .title = QStringLiteral("%1[*] – Clothlab"),
                 .unsaved = tr("\"%1\" was changed. Save the changes?"),
                 .play_tip = tr("Play or pause"),
                 .step_tip = tr("One step of the method"),
                 .record_tip = tr("Record energy, strain and times to CSV while it runs"),
                 .widest_time = "000.000 s",
                 .widest_rate = "000 000 steps/s, 0.00x real time"},
                pleasant_size, parent),
      document_(anyDocument().form()) {
  setObjectName("mainWindow");
  setDockNestingEnabled(true);
  view_ = new ClothView(this);
  charts_ = new ChartPanel(this);
  makeForm();
  studies_ = new StudiesPanel(document_, this);
  makeActions();
  makeLayout();
  makeMenus();
  connectDocument();
  connectView();
  connectSimulation();
}

void MainWindow::makeLayout() {
  addTransport();
  timeline_ = new Timeline(play_again_, this);
  view_bar_ = new ViewBar(*view_, save_picture_, this);
  view_->setMinimumSize(320, 160);

  setMiddle({view_bar_, view_, timeline_}, view_, Qt::TopEdge);
  QDockWidget* left = addDock(tr("Parameters"), "parametersDock", parameters_, Qt::LeftDockWidgetArea);
  QDockWidget* right = addDock(tr("Charts"), "chartsDock", charts_, Qt::RightDockWidgetArea);
  setWidths({left, right}, {parameters_width, charts_width});
  studies_dock_ = named("studiesDock", new QDockWidget(tr("Studies"), this));
  studies_dock_->setWidget(studies_);
  addDockWidget(Qt::BottomDockWidgetArea, studies_dock_);
  studies_dock_->hide();
  connect(studies_, &StudiesPanel::runOpened, this, &MainWindow::openRun);
  view_->setFocus();
}

void MainWindow::showStudies() {
  const bool was_hidden = studies_dock_->isHidden();
  studies_dock_->show();
  studies_dock_->raise();
  if (was_hidden) resizeDocks({studies_dock_}, {studies_height}, Qt::Vertical);
}

void MainWindow::openRun(const cloth::Scene& scene, const QString& note) {
  if (!mayLoseChanges()) return;
  document_.load(scene);
  say("run", NoticeBar::Level::info, note);
}

void MainWindow::connectDocument() {
  connect(&document_, &LabDocument::sceneChanged, this, &MainWindow::followChange);
  connect(&document_, &LabDocument::blocksChanged, this, &MainWindow::noteKeyframes);
  connect(&document_, &LabDocument::loaded, this, [this] {
    noteKeyframes();
    view_->resetCamera();
    startSimulation();
  });
}

void MainWindow::connectView() {
  connectHand(view_);
  view_->setObstaclesMovable(true);
  connect(view_, &ClothView::obstacleMoveStarted, this, &MainWindow::startObstacleMove);
  connect(view_, &ClothView::obstacleMoved, this, &MainWindow::moveObstacle);
  connect(view_, &ClothView::obstacleMoveEnded, this, &MainWindow::endObstacleMove);
  connect(view_, &ClothView::contactChosen, this,
          [this](const ContactChoice& choice) { link_.send(command::ShowContact{choice}); });
  connect(view_, &ClothView::openGlFailed, this, [this] {
    notice_->show("opengl", NoticeBar::Level::warning,
                  tr("The view needs OpenGL 3.3, which this machine does not give. Everything else works."));
  });
  connect(view_, &ClothView::frameDrawn, this, [this](double milliseconds) {
    if (shown_status_.playing && !shown_status_.playing_again)
      charts_->appendDrawTime(shown_status_.time, milliseconds);
  });
}

void MainWindow::connectSimulation() {
  connect(&link_, &SimulationLink::frameReady, view_, &ClothView::showFrame);
  connect(&link_, &SimulationLink::samplesReady, this,
          [this](const std::vector<ChartSample>& samples) { charts_->append(samples); });
  connect(&link_, &SimulationLink::statusChanged, this, &MainWindow::followStatus);
  connect(&timeline_->track(), &TimelineTrack::timeWanted, this, [this](double time) {
    paused_again_ = false;
    forgetDivergence();
    link_.send(command::GoTo{{.step = {}, .time = time}});
  });
  connect(play_again_, &QAction::triggered, this, [this] { link_.send(command::PlayAgain{}); });
}

void MainWindow::send(const RunCommand& command) {
  std::visit([this](const auto& each) { link_.send(each); }, command);
}

void MainWindow::load(const OpenedScene& opened) {
  if (!mayLoseChanges()) return;
  if (!opened.path.isEmpty()) recent_scenes.remember(opened.path);
  session_ = opened.session;
  transport_->suitDuration(opened.scene->duration);
  document_.load(*opened.scene, opened.session ? QString() : opened.path);
}

void MainWindow::load(const OpenedComparison& opened) {
  new_window<CompareWindow>()->load(opened);
}

void MainWindow::loadStudy(const QString& folder) {
  studies_->openFolder(folder);
  showStudies();
}

void MainWindow::startSimulation() {
  charts_->clear();
  notice_->withdraw("session");
  forgetDivergence();
  paused_again_ = false;
  if (session_) {
    link_.send(command::OpenSession{*std::exchange(session_, std::nullopt)});
    link_.send(command::PlayAgain{});
  } else {
    link_.send(command::Load{document_.scene()});
  }
  readStability();
}

void MainWindow::restart() {
  charts_->clear();
  forgetDivergence();
  paused_again_ = false;
  LabWindow::restart();
}

/// Goes on with what the pause ended; otherwise from here on something new begins.
void MainWindow::play(bool on) {
  if (on && std::exchange(paused_again_, false)) return link_.send(command::PlayAgain{});
  if (!on) paused_again_ = shown_status_.playing_again;
  LabWindow::play(on);
}

void MainWindow::followChange(const SceneChange& change) {
  if (change.effect == SceneChange::Effect::none) return readStability();
  if (document_.presentDrag() == 0) forgetPinch();
  paused_again_ = false;
  if (change.effect == SceneChange::Effect::live) {
    link_.send(command::Edit{document_.scene()});
    readStability();
    return;
  }
  const bool was_playing = shown_status_.playing;
  startSimulation();
  if (was_playing) link_.send(command::Play{});
}

void MainWindow::readStability() {
  const StabilityReading reading = read_stability(document_.scene());
  transport_->gauge().setReading(reading);
  const bool has_step = reading.time_step > 0;
  parameters_->setAutoValue("integrator.time_step",
                            has_step ? std::optional(reading.time_step) : std::nullopt);

  const auto& deformation = document_.scene().deformation;
  charts_->setDeformationRate(deformation && !deformation->springs.empty() ? std::optional(deformation->rate)
                                                                           : std::nullopt);
  if (divergence_)
    sayDivergence();
  else if (reading.level == StabilityReading::Level::unstable)
    notice_->showState("stability", NoticeBar::Level::warning,
                       tr("The time step is over the limit of this method: the run will diverge."),
                       {{tr("Use auto"), [this] { takeStableStep(); }}});
  else
    notice_->withdraw("stability");
}

void MainWindow::saveSession(const QString& path) {
  saving_session_ = path;
  link_.send(command::SaveSession{path.toStdString()});
}

void MainWindow::offerAir(const QString& text) {
  notice_->show("brush", NoticeBar::Level::info, text, tr("Add still air"), [this] { addStillAir(); });
}

void MainWindow::startObstacleMove(int obstacle) {
  const auto& obstacles = document_.scene().obstacles;
  if (static_cast<std::size_t>(obstacle) >= obstacles.size()) return;
  forgetPinch();
  dragged_ = obstacles[static_cast<std::size_t>(obstacle)];
  document_.beginDrag();
}

/// Only while the drag lasts that began: a scene that was opened meanwhile keeps its obstacles.
void MainWindow::moveObstacle(int obstacle, const cloth::Vec3& by) {
  if (document_.presentDrag() == 0 || !dragged_ || !by.allFinite()) return;
  document_.moveObstacle(obstacle, moved_by(*dragged_, by));
}

void MainWindow::endObstacleMove(int obstacle, bool kept) {
  if (!kept) moveObstacle(obstacle, cloth::Vec3::Zero());
  document_.endDrag();
  dragged_.reset();
}

/// Under the fields that keyframes leave without effect.
void MainWindow::noteKeyframes() {
  const auto& obstacles = document_.scene().obstacles;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const QString note = obstacles[k].keyframes.empty()
                             ? QString()
                             : tr("Has no effect: keyframes say where it is. Drag it in the view.");
    for (const char* key : {"center", "point", "translate", "velocity", "spin"})
      parameters_->setNote("obstacles." + std::to_string(k) + "." + key, note);
  }
}

void MainWindow::addStillAir() {
  document_.undoStack().beginMacro(tr("Add still air"));
  if (!document_.scene().air) {
    document_.addBlock("air");
    document_.setParameter("air.wind", cloth::Vec3(0, 0, 0));
  } else {
    document_.resetParameter("air.drag");
  }
  document_.undoStack().endMacro();
}

bool MainWindow::mayStopStudy() {
  if (!studies_->isRunning()) return true;
  comeForward();
  return QMessageBox::question(this, tr("A study is running"),
                               tr("A study is running. Stop it and close? What is finished is kept."),
                               QMessageBox::Close | QMessageBox::Cancel,
                               QMessageBox::Cancel) == QMessageBox::Close;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  LabWindow::closeEvent(event);
  if (event->isAccepted()) studies_->stop();
}

void open_first_window(const QString& name) {
  if (!name.isEmpty() && type_of(name) == FileType::comparison)
    if (const OpenedComparison opened = open_comparison(name); opened.comparison)
      return new_window<CompareWindow>()->load(opened);
  auto* window = new_window<MainWindow>();
  window->openScene(cloth::default_scene_name);
  if (!name.isEmpty()) window->open(name);
}

}  // namespace clothlab
