#include "compare/compare_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QScreen>
#include <QSignalBlocker>
#include <QTabBar>
#include <QVBoxLayout>
#include <algorithm>

#include "compare/comparison_files.h"
#include "compare/pane_style.h"
#include "document/document_actions.h"
#include "params/wording.h"
#include "scene/scene_parameters.h"
#include "theme/theme.h"
#include "widgets/run_actions.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{1600, 1000};
constexpr int parameters_width = 284, charts_width = 330, ranking_height = 170;  // px
constexpr int title_bar_height = 32;
constexpr int ranking_interval = 200;  // ms between two fillings of the table while it runs

}  // namespace

CompareWindow::CompareWindow(QWidget* parent) : QMainWindow(parent) {
  setObjectName("compareWindow");
  resize(pleasant_size.boundedTo(screen()->availableSize() - QSize(0, title_bar_height)));
  grid_ = new PaneGrid(this);
  charts_ = new CompareCharts(this);
  ranking_ = new RankingTable(this);
  parameters_ = new ParameterPanel(document_.form(), this);
  notice_ = new NoticeBar(this);
  makeScopeTabs();
  makeActions();
  makeViewBar();
  makeLayout();
  makeTransport();
  makeMenus();
  connectDocument();
  connectPanes();
  connectSimulation();
  ranking_clock_.start();
  grid_->setFocus();
  updateTitle();
}

CompareWindow::~CompareWindow() {
  // The widgets refer to the document and the link, which as members would go first.
  delete takeCentralWidget();
  qDeleteAll(findChildren<QDockWidget*>());
}

void CompareWindow::makeScopeTabs() {
  scopes_ = new QTabBar(this);
  scopes_->setObjectName("scopes");
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

void CompareWindow::makeLayout() {
  auto* middle = new QWidget(this);
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(notice_);
  column->addWidget(grid_, 1);
  setCentralWidget(middle);

  auto* form = new QWidget(this);
  auto* rows = new QVBoxLayout(form);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(0);
  rows->addWidget(scopes_);
  rows->addWidget(scope_hint_);
  rows->addWidget(parameters_, 1);

  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  const auto dock = [this](const QString& title, const char* name, QWidget* content,
                           Qt::DockWidgetArea area) {
    auto* widget = new QDockWidget(title, this);
    widget->setObjectName(name);
    widget->setTitleBarWidget(new QWidget(widget));
    widget->setWidget(content);
    addDockWidget(area, widget);
    return widget;
  };
  QDockWidget* left = dock(tr("Parameters"), "parametersDock", form, Qt::LeftDockWidgetArea);
  QDockWidget* right = dock(tr("Charts"), "chartsDock", charts_, Qt::RightDockWidgetArea);
  QDockWidget* bottom = dock(tr("Ranking"), "rankingDock", ranking_, Qt::BottomDockWidgetArea);
  resizeDocks({left, right}, {parameters_width, charts_width}, Qt::Horizontal);
  resizeDocks({bottom}, {ranking_height}, Qt::Vertical);
}

void CompareWindow::connectDocument() {
  connect(&document_, &CompareDocument::loaded, this, [this] {
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
  connect(&document_, &CompareDocument::titleChanged, this, &CompareWindow::updateTitle);
  connect(&document_, &CompareDocument::modifiedChanged, this, &CompareWindow::updateTitle);
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
  connect(grid_, &PaneGrid::pullChanged, this,
          [this](const cloth::Pull& pull) { link_.send(command::Pull{pull}); });
  connect(grid_, &PaneGrid::pullEnded, this, [this] { link_.send(command::Pull{}); });
  connect(grid_, &PaneGrid::brushChanged, this, &CompareWindow::brush);
  connect(grid_, &PaneGrid::brushEnded, this, [this] { link_.send(command::Brush{}); });
  connect(grid_, &PaneGrid::pinToggled, this, [this](int particle) {
    const int columns = document_.comparison().scene.cloth.columns;
    document_.togglePin(particle / columns, particle % columns);
  });
}

void CompareWindow::connectSimulation() {
  connect(&link_, &CompareLink::frameReady, grid_, &PaneGrid::showFrame);
  connect(&link_, &CompareLink::samplesReady, charts_, &CompareCharts::append);
  connect(&link_, &CompareLink::statusChanged, this, &CompareWindow::followStatus);
}

void CompareWindow::openComparison(const QString& name) {
  if (!mayLoseChanges()) return;
  OpenedComparison opened = open_comparison(name);
  if (!opened.comparison) {
    notice_->show("open", NoticeBar::Level::error,
                  tr("The comparison was not opened.\n%1").arg(opened.problems));
    return;
  }
  notice_->withdraw("open");
  takeComparison(std::move(*opened.comparison), opened.path, false);
}

void CompareWindow::compareScene(const cloth::Scene& scene) {
  takeComparison(comparison_of_scene(scene), {}, true);
}

void CompareWindow::takeComparison(cloth::Comparison comparison, const QString& path, bool unsaved) {
  document_.load(std::move(comparison), path, unsaved);
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

void CompareWindow::brush(const cloth::BrushGust& gust) {
  const auto& air = document_.comparison().scene.air;
  if (air && air->drag > 0) {
    link_.send(command::Brush{gust});
    return;
  }
  notice_->show("brush", NoticeBar::Level::info,
                tr("The wind brush needs air, and this scene has none. Add it to what the panes share."));
}

void CompareWindow::followStatus(const CompareStatus& status) {
  follow_playing(*play_, status.playing);
  play_->setEnabled(status.refusal.empty());
  step_->setEnabled(status.refusal.empty());
  if (status.time > status.duration)  // played on beyond its end
    time_->setText(tr("%1 s").arg(status.time, 0, 'f', 3));
  else
    time_->setText(tr("%1 of %2 s").arg(status.time, 0, 'f', 3).arg(status.duration, 0, 'g', 4));
  if (status.playing)
    rate_->setText(tr("%1x real time").arg(status.real_time_factor, 0, 'f', 2));
  else
    rate_->setText(status.time > 0 && status.time >= status.duration ? tr("Finished") : tr("Paused"));

  grid_->showResults(status);
  const bool news = status.time != shown_status_.time || status.panes.size() != shown_status_.panes.size();
  if (!status.playing || (news && ranking_clock_.elapsed() > ranking_interval)) {
    ranking_->showResults(status.panes);
    ranking_clock_.restart();
  }
  if (!status.refusal.empty())
    notice_->show("refusal", NoticeBar::Level::error, QString::fromStdString(status.refusal));
  else
    notice_->withdraw("refusal");
  if (!status.reference_failure.empty())
    notice_->show("reference", NoticeBar::Level::warning,
                  tr("The reference stopped: it %1").arg(QString::fromStdString(status.reference_failure)));
  else
    notice_->withdraw("reference");
  QStringList breaches;
  for (const cloth::PaneResult& pane : status.panes)
    if (auto breach = pane.rate_breach) {
      breach->steps = 1;  // a notice that does not change with every step
      breaches << tr("Pane %1: %2")
                      .arg(QString::fromStdString(pane.name),
                           QString::fromStdString(cloth::describe(*breach)));
    }
  if (breaches.isEmpty())
    notice_->withdraw("rate");
  else
    notice_->show("rate", NoticeBar::Level::warning, breaches.join('\n'));
  reference_->setToolTip(tr("Differences are from: %1").arg(QString::fromStdString(status.reference)));
  if (status.new_starts != shown_status_.new_starts)
    notice_->show("new-start", NoticeBar::Level::info,
                  tr("Started anew from 0 s: this change cannot be put in force in the middle of a run."));
  follow_recording(*record_, *notice_, shown_status_, status);
  shown_status_ = status;
}

void CompareWindow::startRecording(const QString& folder) {
  link_.send(command::StartRecording{folder.toStdString()});
}

void CompareWindow::updateTitle() {
  setWindowTitle(tr("%1[*] – Comparison – Clothlab").arg(document_.title()));
  setWindowModified(document_.isModified());
}

bool CompareWindow::mayLoseChanges() {
  if (!asks_to_save_ || !document_.isModified()) return true;
  return ask_to_save(this, tr("The comparison \"%1\" was changed. Save it?").arg(document_.title()),
                     [this] { return save(); });
}

void CompareWindow::closeEvent(QCloseEvent* event) {
  if (!mayLoseChanges()) {
    event->ignore();
    return;
  }
  link_.send(command::Pause{});
  link_.send(command::StopRecording{});
  event->accept();
}

}  // namespace clothlab
