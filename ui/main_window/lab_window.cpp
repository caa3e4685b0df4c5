#include "main_window/lab_window.h"

#include <QApplication>
#include <QDockWidget>
#include <QScreen>
#include <QScrollArea>
#include <QToolBar>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "compare/scope_tabs.h"
#include "document/varied_ranges.h"
#include "main_window/autosave.h"
#include "main_window/view_bar.h"
#include "simulation/time_step.h"
#include "studies/studies_panel.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{1440, 900};
constexpr int title_bar_height = 32;  // px, at least what a desktop puts above a window
constexpr int ranking_height = 230;   // px

}  // namespace

LabWindow::LabWindow(QWidget* parent) : QMainWindow(parent) {
  setObjectName("labWindow");
  setAcceptDrops(true);
  setDockNestingEnabled(true);
  resize(pleasant_size.boundedTo(screen()->availableSize() - QSize(0, title_bar_height)));
  grid_ = new PaneGrid(this);
  notice_ = new NoticeBar(this);
  autosave_ = new Autosave(document_, this);
  makeActions();
  makeLayout();
  makeMenus();
  connectDocument();
  connectHand();
  connectPanes();
  connectRun();
  recall();
  showKind();
}

/// The widgets refer to the document and the link.
LabWindow::~LabWindow() {
  document_.undoStack().disconnect(this);
  studies_->choices().disconnect(this);  // the charts go before the studies
  delete autosave_;
  delete takeCentralWidget();
  qDeleteAll(findChildren<QDockWidget*>());
}

void LabWindow::makeLayout() {
  view_bar_ = new ViewBar(*grid_, save_picture_, this);
  timeline_ = new Timeline(play_again_, this);
  auto* middle = new QWidget(this);
  auto* column = spaced(new QVBoxLayout(middle), 0);
  column->addWidget(view_bar_);
  column->addWidget(grid_, 1);
  column->addWidget(timeline_);
  setCentralWidget(middle);
  notice_->layOver(grid_, Qt::TopEdge);

  transport_ = new TransportBar({play_, step_, reset_, record_}, this);
  auto* bottom = named("transportToolBar", new QToolBar(tr("Run"), this));
  bottom->setMovable(false);
  bottom->addWidget(transport_);
  addToolBar(Qt::BottomToolBarArea, bottom);
  makeDocks();
  view().setFocus();
}

void LabWindow::connectDocument() {
  document_.setMeshReader(
      [this](cloth::Scene& scene, const cloth::Scene& known) { return readMeshes(scene, known); });
  connect(&document_, &LabDocument::sceneChanged, this, &LabWindow::followEdit);
  connect(&document_, &LabDocument::blocksChanged, this, &LabWindow::noteKeyframes);
  connect(&document_, &LabDocument::scopeChanged, this, [this] {
    noteKeyframes();
    readStability();
  });
  connect(&document_, &LabDocument::loaded, this, [this] {
    showDocument();
    noteKeyframes();
    grid_->resetCamera();
    startRun();
  });
  connect(&document_, &LabDocument::titleChanged, this, &LabWindow::updateTitle);
  connect(&document_.undoStack(), &QUndoStack::indexChanged, this, [this] { notice_->withdraw("run"); });
  connect(autosave_, &Autosave::failed, this, [this](const QString& problem) {
    say("autosave", NoticeBar::Level::warning,
        tr("Unsaved changes could not be saved aside. %1").arg(problem));
  });
  connect(&document_, &LabDocument::modifiedChanged, this, [this](bool modified) {
    updateTitle();
    if (modified) notice_->withdraw("save " + what());  // no longer what lies there
  });
}

/// What the user does in the views: pull, wind brush, pins, obstacles. It acts on all panes.
void LabWindow::connectHand() {
  connect(grid_, &PaneGrid::pullChanged, this,
          [this](const cloth::Pull& pull) { link_.send(command::Pull{pull}); });
  connect(grid_, &PaneGrid::pullEnded, this, [this] { link_.send(command::Pull{}); });
  connect(grid_, &PaneGrid::brushChanged, this, &LabWindow::brush);
  connect(grid_, &PaneGrid::brushEnded, this, [this] {
    if (document_.scene().air) link_.send(command::Brush{});
  });
  connect(grid_, &PaneGrid::pinToggled, this, [this](int particle) {
    const cloth::ParticlePlace place = place_of(document_.scene().cloth, particle);
    document_.togglePin(place.row, place.column);
  });
  connect(grid_, &PaneGrid::probeWanted, this, [this](const cloth::Probe& probe) {
    if (const QString rule = document_.addProbe(probe); !rule.isEmpty())
      say("probe", NoticeBar::Level::warning, tr("The probe was not added: it %1.").arg(rule));
  });
  connect(grid_, &PaneGrid::obstacleMoveStarted, this, &LabWindow::startObstacleMove);
  connect(grid_, &PaneGrid::obstacleMoved, this, &LabWindow::moveObstacle);
  connect(grid_, &PaneGrid::obstacleMoveEnded, this, &LabWindow::endObstacleMove);
}

/// What the user chooses in the heads of the panes, in the ranking, and about the drawing.
void LabWindow::connectPanes() {
  const auto set_own = [this](std::size_t pane, const std::string& path, const cloth::ParameterValue& value) {
    const QString rule = document_.setOwn(pane, path, value);
    if (path == "integrator.time_step") grid_->pane(pane).showStepRule(rule);
    if (rule.isEmpty()) grid_->showComparison(document_.comparison());
  };
  connect(grid_, &PaneGrid::methodChosen, this, [set_own](std::size_t pane, const std::string& method) {
    set_own(pane, "integrator.method", method);
  });
  connect(grid_, &PaneGrid::stepChosen, this, [set_own](std::size_t pane, const cloth::ParameterValue& step) {
    set_own(pane, "integrator.time_step", step);
  });
  connect(grid_, &PaneGrid::duplicateWanted, &document_, &LabDocument::duplicatePane);
  connect(grid_, &PaneGrid::removeWanted, &document_, &LabDocument::removePane);
  connect(grid_, &PaneGrid::referenceWanted, this, [this](std::size_t pane) {
    const std::string& name = document_.comparison().panes[pane].name;
    document_.setReference(document_.comparison().reference == name ? cloth::controlled_reference : name);
    showDocument();  // the menu's check mark, also where nothing changed
  });
  connect(grid_, &PaneGrid::remedyChosen, this, &LabWindow::restartWith);
  connect(ranking_, &RankingPanel::referenceChosen, &document_, &LabDocument::setReference);
  connect(grid_, &PaneGrid::contactChosen, this,
          [this](const ContactChoice& choice) { link_.send(command::ShowContact{choice}); });
  connect(grid_, &PaneGrid::modeChanged, this,
          [this](ViewMode, Colouring colouring) { link_.send(command::Colour{colouring}); });
  connect(grid_, &PaneGrid::openGlFailed, this, [this] {
    notice_->show("opengl", NoticeBar::Level::warning,
                  tr("The view needs OpenGL 3.3, which this machine does not give. Everything else works."));
  });
  connect(grid_, &PaneGrid::frameDrawn, this, [this](double milliseconds) {
    if (shown_status_.playing && !shown_status_.playing_again && !shown_status_.is_comparison())
      charts_->appendDrawTime(shown_status_.time, milliseconds);
  });
  for (ChartArea* charts : {static_cast<ChartArea*>(charts_), static_cast<ChartArea*>(pane_charts_)})
    connect(charts, &ChartArea::saveWanted, this, &LabWindow::saveCharts);
  connect(studies_, &StudiesPanel::runOpened, this, &LabWindow::openRun);
  connect(studies_, &StudiesPanel::pointOpened, this, &LabWindow::openPoint);
  connect(&document_.varied(), &VariedRanges::added, this, &LabWindow::showVaried);
  connect(charts_, &ChartPanel::tableDropped, this, &LabWindow::fitTo);
  connect(&studies_->choices(), &StudyChoices::changed, this, &LabWindow::showMeasured);
}

void LabWindow::connectRun() {
  connect(&link_, &RunLink::frameReady, grid_, &PaneGrid::showFrame);
  connect(&link_, &RunLink::samplesReady, this,
          [this](const std::vector<ChartSample>& samples) { charts_->append(samples); });
  connect(&link_, &RunLink::paneSamplesReady, pane_charts_, &CompareCharts::append);
  connect(&link_, &RunLink::statusChanged, this, &LabWindow::followStatus);
  connect(transport_, &TransportBar::speedChosen, this,
          [this](double factor) { link_.send(command::Speed{factor}); });
  connect(&timeline_->track(), &TimelineTrack::timeWanted, this, [this](double time) {
    paused_again_ = false;
    forgetDivergence();
    link_.send(command::GoTo{{.step = {}, .time = time}});
  });
  connect(play_, &QAction::triggered, this, &LabWindow::play);
  connect(play_again_, &QAction::triggered, this, [this] { link_.send(command::PlayAgain{}); });
  connect(step_, &QAction::triggered, this, [this] { link_.send(command::SingleStep{}); });
  connect(reset_, &QAction::triggered, this, &LabWindow::restart);
}

/// Goes on with what the pause ended; otherwise from here on something new begins. Where all panes have
/// stopped nothing moves: their messages tell why, also those that were closed.
void LabWindow::play(bool on) {
  if (on && std::exchange(paused_again_, false)) return link_.send(command::PlayAgain{});
  if (!on) paused_again_ = shown_status_.playing_again;
  if (on) grid_->sayStops();
  link_.send(on ? Command(command::Play{}) : Command(command::Pause{}));
}

void LabWindow::restart() {
  charts_->clear();
  forgetDivergence();
  paused_again_ = false;
  link_.send(command::Restart{});
}

/// What was shown and said of the run before is over.
void LabWindow::beginRun() {
  charts_->clear();
  for (const char* kind : {"session", "new-start", "quality", "reference", "rate"}) notice_->withdraw(kind);
  forgetDivergence();
  paused_again_ = false;
}

/// Of what the document contains, from the start.
void LabWindow::startRun() {
  beginRun();
  if (session_) {
    link_.send(command::OpenSession{*std::exchange(session_, std::nullopt)});
    link_.send(command::PlayAgain{});
  } else {
    link_.send(command::Load{document_.comparison()});
  }
  readStability();
}

void LabWindow::followEdit(const SceneChange& change) {
  const bool was_comparison = shows_comparison_;
  showDocument();
  if (change.effect == SceneChange::Effect::none) return readStability();
  if (document_.presentDrag() == 0) forgetPinch();
  paused_again_ = false;
  const bool was_playing = shown_status_.playing;
  const bool is_other_kind = was_comparison != document_.isComparison();
  if (is_other_kind) beginRun();
  if (is_other_kind || document_.isComparison() || change.effect == SceneChange::Effect::live) {
    link_.send(command::Edit{document_.comparison()});
    readStability();
    if (!is_other_kind) return;
  } else {
    startRun();
  }
  if (was_playing) link_.send(command::Play{});
}

/// What of the document the panes, their charts, tabs and ranking show.
void LabWindow::showDocument() {
  const cloth::Comparison& comparison = document_.comparison();
  const bool other_panes = comparison.panes.size() != grid_->paneCount();
  // A small window would grow to hold more panes before its docks give way.
  if (other_panes) setMinimumSize(size());
  grid_->showComparison(comparison);
  if (document_.isComparison()) {
    pane_charts_->setPanes(comparison);
    ranking_->showComparison(comparison);
  }
  scopes_->refresh();
  if (shows_comparison_ != document_.isComparison()) showKind();
  if (!other_panes) return;
  QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
  setMinimumSize(0, 0);  // as the layout says
  layout()->invalidate();
}

/// Arranges the widgets for a scene or for a comparison.
void LabWindow::showKind() {
  const bool studies = studies_dock_->isVisible();
  const int studies_height = studies_dock_->height();
  shows_comparison_ = document_.isComparison();
  charts_->setVisible(!shows_comparison_);
  pane_charts_area_->setVisible(shows_comparison_);
  placeCorners(!studies_dock_->isHidden());
  setWidths();
  ranking_dock_->setVisible(shows_comparison_);
  ranking_dock_->toggleViewAction()->setVisible(shows_comparison_);
  // A study whose runs are opened keeps its diagram.
  if (studies) studies_dock_->raise();
  if (studies)
    resizeDocks({studies_dock_}, {studies_height}, Qt::Vertical);
  else if (shows_comparison_)
    resizeDocks({ranking_dock_}, {ranking_height}, Qt::Vertical);
  transport_->gauge().setVisible(!shows_comparison_);
  view_bar_->showComparison(shows_comparison_);
  save_session_->setEnabled(!shows_comparison_);
  duplicate_->setVisible(!shows_comparison_);
  notice_->layOver(grid_, shows_comparison_ ? Qt::BottomEdge : Qt::TopEdge);
  updateTitle();
}

void LabWindow::readStability() {
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
  else if (reading.level == StabilityReading::Level::unstable && !document_.isComparison())
    notice_->showState(
        "stability", NoticeBar::Level::warning,
        tr("The time step is over the limit of this method: the run will diverge."),
        {{tr("Use auto"), [this] { document_.setParameter("integrator.time_step", std::string("auto")); }}});
  else
    notice_->withdraw("stability");
}

/// Under the fields that keyframes leave without effect.
void LabWindow::noteKeyframes() {
  const auto& obstacles = document_.scene().obstacles;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (document_.isComparison() && obstacles[k].keyframes.empty())
      continue;  // notes may be there on own values
    const QString note = obstacles[k].keyframes.empty()
                             ? QString()
                             : tr("Has no effect: keyframes say where it is. Drag it in the view.");
    for (const char* key : {"center", "point", "translate", "velocity", "spin"})
      parameters_->setNote("obstacles." + std::to_string(k) + "." + key, note);
  }
}

void LabWindow::brush(const cloth::BrushGust& gust) {
  const auto& air = document_.scene().air;
  if (air && air->drag > 0) return link_.send(command::Brush{gust});
  notice_->show("brush", NoticeBar::Level::info, tr("The wind brush needs air, and this scene has none."),
                tr("Add still air"), [this] { addStillAir(); });
}

void LabWindow::addStillAir() {
  document_.setScope(std::nullopt);
  document_.undoStack().beginMacro(tr("Add still air"));
  if (!document_.scene().air) {
    document_.addBlock("air");
    document_.setParameter("air.wind", cloth::Vec3(0, 0, 0));
  } else {
    document_.resetParameter("air.drag");
  }
  document_.undoStack().endMacro();
}

void LabWindow::startObstacleMove(int obstacle) {
  const auto& obstacles = document_.comparison().scene.obstacles;
  if (static_cast<std::size_t>(obstacle) >= obstacles.size()) return;
  forgetPinch();
  dragged_ = obstacles[static_cast<std::size_t>(obstacle)];
  document_.beginDrag();
}

/// Only while the drag lasts that began: a scene that was opened meanwhile keeps its obstacles.
void LabWindow::moveObstacle(int obstacle, const cloth::Vec3& by) {
  if (document_.presentDrag() == 0 || !dragged_ || !by.allFinite()) return;
  document_.moveObstacle(obstacle, moved_by(*dragged_, by));
}

void LabWindow::endObstacleMove(int obstacle, bool kept) {
  if (!kept) moveObstacle(obstacle, cloth::Vec3::Zero());
  document_.endDrag();
  dragged_.reset();
}

}  // namespace clothlab
