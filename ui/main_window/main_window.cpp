#include "main_window/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QMessageBox>
#include <QMimeData>
#include <QScreen>
#include <QToolBar>
#include <QUrl>
#include <QVBoxLayout>
#include <utility>

#include "document/document_actions.h"
#include "main_window/scene_library.h"
#include "main_window/view_bar.h"
#include "simulation/time_step.h"
#include "studies/studies_panel.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{1440, 900};
constexpr int parameters_width = 330, charts_width = 400;  // px
constexpr int studies_height = 400;                        // px
constexpr int title_bar_height = 32;                       // px, at least what a desktop puts above a window

}  // namespace

MainWindow::MainWindow(QWidget* parent) : QMainWindow(parent) {
  setObjectName("mainWindow");
  setAcceptDrops(true);
  const QSize room = screen()->availableSize() - QSize(0, title_bar_height);
  resize(pleasant_size.boundedTo(room));
  setDockNestingEnabled(true);
  view_ = new ClothView(this);
  charts_ = new ChartPanel(this);
  parameters_ = new ParameterPanel(document_, this);
  notice_ = new NoticeBar(this);
  studies_ = new StudiesPanel(document_, this);
  makeActions();
  makeLayout();
  makeMenus();
  connectDocument();
  connectView();
  connectSimulation();
  updateTitle();
}

MainWindow::~MainWindow() {
  // The widgets refer to the document and the link, which as members would go first.
  delete takeCentralWidget();
  qDeleteAll(findChildren<QDockWidget*>());
}

void MainWindow::makeLayout() {
  transport_ = new TransportBar({play_, step_, reset_, record_}, this);
  timeline_ = new Timeline(play_again_, this);
  view_bar_ = new ViewBar(*view_, save_picture_, this);
  view_->setMinimumSize(320, 240);

  auto* middle = new QWidget(this);
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(view_bar_);
  column->addWidget(notice_);
  column->addWidget(view_, 1);
  column->addWidget(timeline_);
  setCentralWidget(middle);

  auto* bottom = new QToolBar(tr("Run"), this);
  bottom->setObjectName("transportToolBar");
  bottom->setMovable(false);
  bottom->addWidget(transport_);
  addToolBar(Qt::BottomToolBarArea, bottom);

  const auto dock = [this](const QString& title, const char* name, QWidget* content,
                           Qt::DockWidgetArea area) {
    auto* widget = new QDockWidget(title, this);
    widget->setObjectName(name);
    widget->setTitleBarWidget(new QWidget(widget));  // the panels have heads of their own
    widget->setWidget(content);
    addDockWidget(area, widget);
    return widget;
  };
  QDockWidget* left = dock(tr("Parameters"), "parametersDock", parameters_, Qt::LeftDockWidgetArea);
  QDockWidget* right = dock(tr("Charts"), "chartsDock", charts_, Qt::RightDockWidgetArea);
  resizeDocks({left, right}, {parameters_width, charts_width}, Qt::Horizontal);
  studies_dock_ = new QDockWidget(tr("Studies"), this);
  studies_dock_->setObjectName("studiesDock");
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
  if (note.isEmpty())
    notice_->withdraw("run");
  else
    notice_->show("run", NoticeBar::Level::info, note);
}

void MainWindow::connectDocument() {
  connect(&document_, &LabDocument::sceneChanged, this, &MainWindow::followChange);
  connect(&document_, &LabDocument::blocksChanged, this, &MainWindow::noteKeyframes);
  connect(&document_, &LabDocument::loaded, this, [this] {
    noteKeyframes();
    view_->resetCamera();
    startSimulation();
  });
  connect(&document_, &LabDocument::titleChanged, this, &MainWindow::updateTitle);
  connect(&document_, &LabDocument::modifiedChanged, this, &MainWindow::updateTitle);
}

void MainWindow::connectView() {
  connect(view_, &ClothView::pullChanged, this,
          [this](const cloth::Pull& pull) { link_.send(command::Pull{pull}); });
  connect(view_, &ClothView::pullEnded, this, [this] { link_.send(command::Pull{}); });
  connect(view_, &ClothView::brushChanged, this, &MainWindow::brush);
  connect(view_, &ClothView::brushEnded, this, [this] {
    if (hasAir()) link_.send(command::Brush{});
  });
  connect(view_, &ClothView::pinToggled, this, [this](int particle) {
    const int columns = document_.scene().cloth.columns;
    document_.togglePin(particle / columns, particle % columns);
  });
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
  connect(transport_, &TransportBar::speedChosen, this,
          [this](double factor) { link_.send(command::Speed{factor}); });
  connect(&timeline_->track(), &TimelineTrack::timeWanted, this, [this](double time) {
    paused_again_ = false;
    link_.send(command::GoTo{{.step = {}, .time = time}});
  });
  connect(play_, &QAction::triggered, this, &MainWindow::play);
  connect(play_again_, &QAction::triggered, this, [this] { link_.send(command::PlayAgain{}); });
  connect(step_, &QAction::triggered, this, [this] { link_.send(command::SingleStep{}); });
  connect(reset_, &QAction::triggered, this, &MainWindow::restart);
  connect(record_, &QAction::triggered, this, &MainWindow::toggleRecording);
}

void MainWindow::openScene(const QString& name) {
  if (mayLoseChanges()) takeScene(open_scene(name));
}

void MainWindow::takeScene(const OpenedScene& opened) {
  if (!opened.scene) {
    notice_->show("open", NoticeBar::Level::error, tr("The scene was not opened.\n%1").arg(opened.problems));
    return;
  }
  notice_->withdraw("open");
  if (!opened.path.isEmpty()) remember_scene(opened.path);
  session_ = opened.session;
  transport_->suitDuration(opened.scene->duration);
  document_.load(*opened.scene, opened.session ? QString() : opened.path);
}

void MainWindow::startSimulation() {
  charts_->clear();
  notice_->withdraw("session");
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
  paused_again_ = false;
  link_.send(command::Restart{});
}

/// Goes on with what the pause ended; otherwise from here on something new begins.
void MainWindow::play(bool on) {
  if (!on) {
    paused_again_ = shown_status_.playing_again;
    link_.send(command::Pause{});
  } else if (std::exchange(paused_again_, false)) {
    link_.send(command::PlayAgain{});
  } else {
    link_.send(command::Play{});
  }
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
  if (reading.level == StabilityReading::Level::unstable)
    notice_->show("stability", NoticeBar::Level::warning,
                  tr("The time step is over the limit of this method: the run will diverge."), tr("Use auto"),
                  [this] { takeStableStep(); });
  else
    notice_->withdraw("stability");
}

void MainWindow::takeStableStep() {
  document_.setParameter("integrator.time_step", std::string("auto"));
}

void MainWindow::saveSession(const QString& path) {
  saving_session_ = path;
  link_.send(command::SaveSession{path.toStdString()});
}

bool MainWindow::hasAir() const {
  const auto& air = document_.scene().air;
  return air && air->drag > 0;
}

void MainWindow::brush(const cloth::BrushGust& gust) {
  if (!hasAir()) {
    notice_->show("brush", NoticeBar::Level::info, tr("The wind brush needs air, and this scene has none."),
                  tr("Add still air"), [this] { addStillAir(); });
    return;
  }
  link_.send(command::Brush{gust});
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

void MainWindow::startRecording(const QString& folder) {
  link_.send(command::StartRecording{folder.toStdString()});
}

void MainWindow::updateTitle() {
  setWindowTitle(QStringLiteral("%1[*] – Clothlab").arg(document_.title()));
  setWindowModified(document_.isModified());
}

bool MainWindow::mayLoseChanges() {
  if (!asks_to_save_ || !document_.isModified()) return true;
  return ask_to_save(this, tr("\"%1\" was changed. Save the changes?").arg(document_.title()),
                     [this] { return save(); });
}

bool MainWindow::mayStopStudy() {
  if (!studies_->isRunning()) return true;
  return QMessageBox::question(this, tr("A study is running"),
                               tr("A study is running. Stop it and close? What is finished is kept."),
                               QMessageBox::Close | QMessageBox::Cancel,
                               QMessageBox::Cancel) == QMessageBox::Close;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayStopStudy() || !mayLoseChanges()) {
    event->ignore();
    return;
  }
  studies_->stop();
  link_.send(command::Pause{});
  link_.send(command::StopRecording{});
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const auto urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  openScene(event->mimeData()->urls().front().toLocalFile());
}

}  // namespace clothlab
