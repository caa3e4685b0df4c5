#include "main_window/compare_window.h"

#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QMenuBar>
#include <QSignalBlocker>
#include <QTabBar>
#include <QToolBar>
#include <QVBoxLayout>

#include "compare/pane_style.h"
#include "main_window/lab_files.h"
#include "main_window/main_window.h"
#include "main_window/view_bar.h"
#include "params/wording.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_parameters.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize comparison_size{1600, 1000};
constexpr int form_width = 284, curves_width = 330, ranking_height = 170;  // px
constexpr int ranking_interval = 200;  // ms between two fillings of the table while it runs

}  // namespace

CompareWindow::CompareWindow(QWidget* parent)
    : LabWindow(std::make_unique<CompareDocument>(),
                {.document = tr("comparison"),
                 .kind = comparison_kind(),
                 .title = tr("%1[*] – Comparison – Clothlab"),
                 .unsaved = tr("The comparison \"%1\" was changed. Save it?"),
                 .play_tip = tr("Play or pause all panes"),
                 .step_tip = tr("To the next common time of all panes"),
                 .record_tip = tr("Record a CSV file of each pane and compare.csv while it runs"),
                 .widest_time = "000.000 of 00.00 s",
                 .widest_rate = "00.00x real time"},
                comparison_size, parent),
      document_(static_cast<CompareDocument&>(anyDocument())) {
  setObjectName("compareWindow");
  grid_ = new PaneGrid(this);
  charts_ = new CompareCharts(this);
  ranking_ = new RankingTable(this);
  makeForm();
  makeScopeTabs();
  makeViewBar();
  makeLayout();
  addTransport();
  transport_->gauge().hide();
  makeMenus();
  connectDocument();
  connectPanes();
  connectSimulation();
  ranking_clock_.start();
  grid_->setEnabled(false);  // until there is a comparison: its panes are empty
}

void CompareWindow::makeScopeTabs() {
  scopes_ = named("scopes", new QTabBar(this));
  scopes_->setAccessibleName(tr("Whose values the form shows"));
  scopes_->setExpanding(false);
  scopes_->setUsesScrollButtons(false);
  scopes_->setIconSize({12, 12});
  scopes_->setStyleSheet("QTabBar::tab { padding: 6px 6px; margin-right: 0; }");
  scope_hint_ = new QLabel(this);
  scope_hint_->setProperty("muted", true);
  scope_hint_->setWordWrap(true);
  scope_hint_->setContentsMargins(2 * spacing, spacing, spacing, 0);
  connect(scopes_, &QTabBar::currentChanged, this, [this](int tab) {
    document_.setScope(tab > 0 ? std::optional(static_cast<std::size_t>(tab - 1)) : std::nullopt);
  });
}

void CompareWindow::makeMenus() {
  QMenu* file = addFileMenu();
  addComparisons(*file);
  addSaveEntries(*file);
  file->addSeparator();
  file->addAction(save_plots_);
  connectCharts(charts_);
  addCloseEntries(*file);

  QMenu* edit = addEditMenu();
  edit->addSeparator();
  QAction* copy = edit->addAction(tr("Copy ranking"), this, [this] { ranking_->copy(); });
  copy->setObjectName("copyRanking");
  addRunMenu({play_, step_, reset_});
  addDockEntries(*menuBar()->addMenu(tr("&View")));
}

/// Tools, ways of drawing, camera, and the reference, above the panes.
void CompareWindow::makeViewBar() {
  QToolBar* bar = addToolBar(tr("View"));
  bar->setObjectName("compareViewBar");
  bar->setMovable(false);
  bar->setIconSize({20, 20});
  const std::vector<ViewChoice<Tool>> tools{
      {Tool::pull, "pull", tr("Pull"), tr("Drag a particle in all panes; beside the cloth: orbit"), "1",
       "toolPull"},
      {Tool::brush, "brush", tr("Wind brush"), tr("Drag to blow on all panes"), "2", "toolBrush"},
      {Tool::pin, "pin", tr("Pin"), tr("Click a particle to pin or free it in all panes"), "3", "toolPin"}};
  bar->addActions(make_choices(this, tools, [this](Tool tool) { grid_->setTool(tool); })->actions());
  bar->addSeparator();
  using Look = std::pair<ViewMode, Colouring>;
  const std::vector<ViewChoice<Look>> looks{
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
       tr("Colours for the strain, the same in all panes"),
       "S",
       "modeStrain"},
      {{ViewMode::strain, Colouring::difference},
       "view-difference",
       tr("Difference"),
       tr("Colours for each particle's distance from the reference, the same in all panes"),
       "D",
       "modeDifference"}};
  bar->addActions(make_choices(this, looks, [this](const Look& look) {
                    setColouring(look.first, look.second);
                  })->actions());
  bar->addSeparator();
  QAction* frame_all = bar->addAction(icon("frame-all"), tr("Frame all"), grid_, &PaneGrid::frameAll);
  frame_all->setShortcut(QStringLiteral("F"));
  frame_all->setToolTip(tr("Fit the cloth into all panes (F)"));
  bar->addWidget(make_camera_button(bar, [this](CameraPreset preset) { grid_->setPreset(preset); }));

  auto* gap = new QWidget(bar);
  gap->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  bar->addWidget(gap);
  auto* label = new QLabel(tr("Reference"), bar);
  label->setContentsMargins(0, 0, spacing, 0);
  bar->addWidget(label);
  reference_ = named("reference", new QComboBox(bar));
  reference_->setAccessibleName(tr("Reference"));
  reference_->setMinimumContentsLength(12);
  connect(reference_, &QComboBox::activated, this, &CompareWindow::chooseReference);
  bar->addWidget(reference_);
}

void CompareWindow::makeLayout() {
  setMiddle({grid_}, grid_, Qt::BottomEdge);
  auto* form = new QWidget(this);
  auto* rows = spaced(new QVBoxLayout(form), 0);
  rows->addWidget(scopes_);
  rows->addWidget(scope_hint_);
  rows->addWidget(parameters_, 1);

  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  QDockWidget* left = addDock(tr("Parameters"), "parametersDock", form, Qt::LeftDockWidgetArea);
  QDockWidget* right = addDock(tr("Charts"), "chartsDock", charts_, Qt::RightDockWidgetArea);
  QDockWidget* bottom = addDock(tr("Ranking"), "rankingDock", ranking_, Qt::BottomDockWidgetArea);
  setWidths({left, right}, {form_width, curves_width});
  resizeDocks({bottom}, {ranking_height}, Qt::Vertical);
}

void CompareWindow::connectDocument() {
  connect(&document_, &CompareDocument::loaded, this, [this] {
    if (!grid_->isEnabled()) {
      grid_->setEnabled(true);
      grid_->setFocus();
    }
    followDocument();
    grid_->resetCamera();
    notice_->withdraw("new-start");
    link_.send(command::Load{document_.comparison()});
  });
  connect(&document_, &CompareDocument::changed, this, [this] {
    followDocument();
    link_.send(command::Edit{document_.comparison()});
  });
  connect(&document_, &CompareDocument::scopeChanged, this, &CompareWindow::showScope);
  connect(parameters_, &ParameterPanel::noteButtonClicked, this, [this](const std::string& path) {
    if (document_.scope()) document_.useShared(*document_.scope(), path);
  });
}

void CompareWindow::connectPanes() {
  const auto tell = [this](std::size_t pane, const std::string& path, const cloth::ParameterValue& value) {
    const QString rule = document_.setOwn(pane, path, value);
    if (path == "integrator.time_step") grid_->pane(pane).showStepRule(rule);
    if (rule.isEmpty()) grid_->showComparison(document_.comparison());
  };
  connect(grid_, &PaneGrid::methodChosen, this,
          [tell](std::size_t pane, const std::string& method) { tell(pane, "integrator.method", method); });
  connect(grid_, &PaneGrid::stepChosen, this, [tell](std::size_t pane, const cloth::ParameterValue& step) {
    tell(pane, "integrator.time_step", step);
  });
  connect(grid_, &PaneGrid::duplicateWanted, &document_, &CompareDocument::duplicatePane);
  connect(grid_, &PaneGrid::removeWanted, &document_, &CompareDocument::removePane);
  connect(grid_, &PaneGrid::referenceWanted, this, [this](std::size_t pane) {
    const std::string& name = document_.comparison().panes[pane].name;
    document_.setReference(document_.comparison().reference == name ? cloth::controlled_reference : name);
    followDocument();  // the menu's check mark, also where nothing changed
  });
  connect(grid_, &PaneGrid::remedyChosen, this, [this](std::size_t pane, const Remedy& remedy) {
    restartWith(remedy, [this, pane](const std::string& path, const cloth::ParameterValue& value) {
      document_.setOwn(pane, path, value);
    });
  });
  connectHand(grid_);
}

void CompareWindow::connectSimulation() {
  connect(&link_, &CompareLink::frameReady, grid_, &PaneGrid::showFrame);
  connect(&link_, &CompareLink::samplesReady, charts_, &CompareCharts::append);
  connect(&link_, &CompareLink::statusChanged, this, &CompareWindow::followStatus);
}

void CompareWindow::load(const OpenedComparison& opened) {
  if (mayLoseChanges()) document_.load(*opened.comparison, opened.path);
}

void CompareWindow::load(const OpenedScene& opened) {
  new_window<MainWindow>()->load(opened);
}

/// Beside the scene that is open, or a built-in one.
void CompareWindow::loadStudy(const QString& folder) {
  auto* window = new_window<MainWindow>();
  window->openScene(cloth::default_scene_name);
  window->loadStudy(folder);
}

/// All panes share the cloth.
void CompareWindow::loadMesh(const QString& file) {
  document_.setScope(std::nullopt);
  LabWindow::loadMesh(file);
}

void CompareWindow::compareScene(const cloth::Scene& scene) {
  document_.load(comparison_of_scene(scene), {}, true);
}

void CompareWindow::followDocument() {
  const cloth::Comparison& comparison = document_.comparison();
  grid_->showComparison(comparison);
  charts_->setPanes(comparison);
  showReferences();
  showScope();
}

void CompareWindow::showScope() {
  const QSignalBlocker quiet(scopes_);
  const auto& panes = document_.comparison().panes;
  while (scopes_->count() > static_cast<int>(panes.size()) + 1) scopes_->removeTab(scopes_->count() - 1);
  while (scopes_->count() < static_cast<int>(panes.size()) + 1) scopes_->addTab({});
  scopes_->setTabText(0, tr("Shared"));
  for (std::size_t i = 0; i < panes.size(); ++i) {
    const int tab = static_cast<int>(i) + 1;
    scopes_->setTabText(tab, QString::fromStdString(panes[i].name));
    scopes_->setTabIcon(tab, pane_icon(style_of(panes[i])));
  }
  const auto scope = document_.scope();
  scopes_->setCurrentIndex(scope ? static_cast<int>(*scope) + 1 : 0);
  scope_hint_->setText(
      scope
          ? tr("What you change here becomes pane %1's own.").arg(QString::fromStdString(panes[*scope].name))
          : tr("What all panes share. A pane keeps the values that it has of its own."));
  parameters_->setBlocksEditable(!scope);
  showOwnership();
}

/// Below each parameter: in which panes it is own, or that it is this pane's own and what the others share.
void CompareWindow::showOwnership() {
  const cloth::Comparison& comparison = document_.comparison();
  parameters_->clearNotes();
  const auto scope = document_.scope();
  for (const std::string& path : own_paths(comparison)) {
    const auto shared = cloth::find_parameter(comparison.scene, path);
    const auto words = [&](const cloth::Parameter& p, const cloth::Scene& scene) {
      return value_in_words(p.info, p.get(scene));
    };
    if (scope && own_value(comparison.panes[*scope], path)) {
      const QString others = shared ? words(*shared, comparison.scene) : tr("not there");
      parameters_->setNote(path, tr("Own value. Shared: %1").arg(others), tr("Use shared"));
    } else if (!scope) {
      QStringList own;
      for (std::size_t i = 0; i < comparison.panes.size(); ++i)
        if (own_value(comparison.panes[i], path))
          if (const auto parameter = cloth::find_parameter(scene_of(comparison, i), path))
            own << QStringLiteral("%1 %2").arg(QString::fromStdString(comparison.panes[i].name),
                                               words(*parameter, scene_of(comparison, i)));
      parameters_->setNote(path, tr("Own: %1").arg(own.join(", ")));
    }
  }
}

void CompareWindow::showReferences() {
  const cloth::Comparison& comparison = document_.comparison();
  const QSignalBlocker quiet(reference_);
  reference_->clear();
  reference_->addItem(tr("Error control"), QString::fromLatin1(cloth::controlled_reference));
  for (const cloth::Pane& pane : comparison.panes)
    reference_->addItem(pane_icon(style_of(pane)), tr("Pane %1").arg(QString::fromStdString(pane.name)),
                        QString::fromStdString(pane.name));
  reference_->addItem(tr("None"), QString::fromLatin1(cloth::no_reference));
  reference_->setCurrentIndex(reference_->findData(QString::fromStdString(comparison.reference)));
}

void CompareWindow::chooseReference(int index) {
  document_.setReference(reference_->itemData(index).toString().toStdString());
}

void CompareWindow::setColouring(ViewMode mode, Colouring colouring) {
  link_.send(command::Colour{colouring});
  grid_->setMode(mode);
}

void CompareWindow::offerAir(const QString& text) {
  say("brush", NoticeBar::Level::info, text + ' ' + tr("Add it to what the panes share."));
}

void CompareWindow::followStatus(const CompareStatus& status) {
  transport_->showStatus(status);
  grid_->showResults(status);
  const bool news = status.time != shown_status_.time || status.panes.size() != shown_status_.panes.size();
  if (!status.playing || (news && ranking_clock_.elapsed() > ranking_interval)) {
    ranking_->showResults(status.panes);
    ranking_clock_.restart();
  }
  followRun(status);
  notice_->showState(
      "reference", NoticeBar::Level::warning,
      status.reference_failure.empty()
          ? QString()
          : tr("The reference stopped: it %1").arg(QString::fromStdString(status.reference_failure)));
  QStringList breaches;
  for (const cloth::PaneResult& pane : status.panes)
    if (auto breach = pane.rate_breach) {
      breach->steps = 1;  // a notice that does not change with every step
      breaches << tr("Pane %1: %2")
                      .arg(QString::fromStdString(pane.name),
                           QString::fromStdString(cloth::describe(*breach)));
    }
  notice_->showState("rate", NoticeBar::Level::warning, breaches.join('\n'));
  reference_->setToolTip(tr("Differences are from: %1").arg(QString::fromStdString(status.reference)));
  if (status.new_starts != shown_status_.new_starts)
    notice_->show("new-start", NoticeBar::Level::info,
                  tr("Started anew from 0 s: this change cannot be put in force in the middle of a run."));
  followRecording(shown_status_, status);
  shown_status_ = status;
}

/// Where all panes have stopped nothing moves: their messages tell why, also those that were closed.
void CompareWindow::play(bool on) {
  if (on) grid_->sayStops();
  LabWindow::play(on);
}

void CompareWindow::send(const RunCommand& command) {
  std::visit([this](const auto& each) { link_.send(each); }, command);
}

QString CompareWindow::write(const QString& path) {
  return save_comparison_file(document_.comparison(), path);
}

}  // namespace clothlab
