#include "main_window/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDesktopServices>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QMessageBox>
#include <QMimeData>
#include <QScreen>
#include <QToolBar>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

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
  connect(&document_, &LabDocument::loaded, this, [this] {
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

void MainWindow::followStatus(const WorkerStatus& status) {
  play_->setChecked(status.playing);
  if (status.playing != shown_status_.playing) {  // an action tells everybody, whether its icon is new or not
    play_->setIcon(icon(status.playing ? "pause" : "play"));
    play_->setText(status.playing ? tr("Pause") : tr("Play"));
  }
  play_->setEnabled(status.refusal.empty());
  step_->setEnabled(status.refusal.empty());
  transport_->showStatus(status);
  timeline_->showStatus(status, link_.isUpToDate());
  play_again_->setEnabled(status.refusal.empty() && !status.playing &&
                          status.step < status.history.last_step);

  if (!status.refusal.empty())
    notice_->show("refusal", NoticeBar::Level::error, QString::fromStdString(status.refusal));
  else
    notice_->withdraw("refusal");
  if (status.notice != shown_status_.notice) {
    if (status.notice.empty())
      notice_->withdraw("unreachable");
    else
      notice_->show("unreachable", NoticeBar::Level::warning, QString::fromStdString(status.notice));
  }
  followDivergence(status);
  followRecording(status);
  followSession(status);
  followScene(status);
  shown_status_ = status;
}

/// The run is at a time when another scene was in force: the document becomes that scene, unless it has edits
/// of its own on the way.
void MainWindow::followScene(const WorkerStatus& status) {
  if (!status.scene || !link_.isUpToDate() || !status.refusal.empty()) return;
  timeline_->track().setStep(std::max(status.scene->record.interval, status.time_step));
  if (std::exchange(followed_, status.scene) != status.scene || status.jumps != shown_status_.jumps)
    document_.follow(*status.scene);
}

void MainWindow::followSession(const WorkerStatus& status) {
  if (!status.session_error.empty()) {
    if (status.session_error != shown_status_.session_error || !saving_session_.isEmpty())
      notice_->show("session", NoticeBar::Level::error,
                    tr("Session: %1").arg(QString::fromStdString(status.session_error)));
    if (link_.isUpToDate()) saving_session_.clear();
  } else if (!saving_session_.isEmpty() && link_.isUpToDate()) {
    notice_->show("session", NoticeBar::Level::info,
                  tr("Saved the session of %1 s in %2")
                      .arg(status.history.last_time, 0, 'f', 3)
                      .arg(std::exchange(saving_session_, QString())));
  }
  if (!status.session_agrees || status.session_agrees == shown_status_.session_agrees) return;
  if (*status.session_agrees)
    notice_->show("session", NoticeBar::Level::info, tr("The session came out the same, to the bit."));
  else
    notice_->show("session", NoticeBar::Level::warning,
                  tr("The session came out different from its file. Another version, compiler or processor "
                     "may round differently."));
}

void MainWindow::saveSession(const QString& path) {
  saving_session_ = path;
  link_.send(command::SaveSession{path.toStdString()});
}

void MainWindow::followDivergence(const WorkerStatus& status) {
  if (!status.divergence) {
    if (shown_status_.divergence) notice_->withdraw("divergence");
    return;
  }
  if (shown_status_.divergence) return;
  const QString text = tr("The run %1. The view shows the last good state.")
                           .arg(QString::fromStdString(cloth::describe(*status.divergence)));
  if (status.divergence->stable_step > 0 && std::isfinite(status.divergence->stable_step))
    notice_->show("divergence", NoticeBar::Level::error, text, tr("Use auto and restart"), [this] {
      takeStableStep();
      restart();
    });
  else
    notice_->show("divergence", NoticeBar::Level::error, text);
}

void MainWindow::followRecording(const WorkerStatus& status) {
  record_->setChecked(status.recording);
  if (status.recording != shown_status_.recording)
    record_->setIcon(icon(status.recording ? "stop-record" : "record"));
  if (status.recording_error != shown_status_.recording_error && !status.recording_error.empty()) {
    notice_->show("recording", NoticeBar::Level::error,
                  tr("Recording stopped: %1. What was written before is valid.")
                      .arg(QString::fromStdString(status.recording_error)));
  } else if (shown_status_.recording && !status.recording) {
    const QString folder = QString::fromStdString(status.recording_folder.string());
    notice_->show("recording", NoticeBar::Level::info,
                  tr("Recorded %1 rows in %2").arg(status.recorded_rows).arg(folder), tr("Open folder"),
                  [folder] { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); });
  }
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
  const auto answer = QMessageBox::question(
      this, tr("Unsaved changes"), tr("\"%1\" was changed. Save the changes?").arg(document_.title()),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save());
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
