// LabWindow: the docks, their places and their widths.
#include <QApplication>
#include <QDockWidget>
#include <QResizeEvent>
#include <QScrollArea>
#include <QVBoxLayout>
#include <algorithm>
#include <array>

#include "compare/scope_tabs.h"
#include "main_window/lab_window.h"
#include "studies/studies_panel.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

/// px, of form and charts; the panes of a comparison need more room than one.
constexpr std::array widths_of_scene{330, 400}, widths_of_comparison{284, 330};
constexpr int studies_height = 400;  // px

}  // namespace

/// Every part is made where it will be: a widget that gets another parent is styled anew with all that is in
/// it.
void LabWindow::makeDocks() {
  parameters_dock_ = addDock(tr("Parameters"), "parametersDock", Qt::LeftDockWidgetArea);
  auto* form = new QWidget(parameters_dock_);
  parameters_dock_->setWidget(form);
  auto* rows = spaced(new QVBoxLayout(form), 0);
  parameters_ = new ParameterPanel(document_, form);
  scopes_ = new ScopeTabs(document_, *parameters_, form);
  rows->addWidget(scopes_);
  rows->addWidget(parameters_, 1);

  charts_dock_ = addDock(tr("Charts"), "chartsDock", Qt::RightDockWidgetArea);
  auto* charts = new QWidget(charts_dock_);
  charts_dock_->setWidget(charts);
  auto* one_of_two = spaced(new QVBoxLayout(charts), 0);
  one_of_two->addWidget(charts_ = new ChartPanel(charts));
  pane_charts_area_ = new QScrollArea(charts);  // probes may give more charts than there is height for
  pane_charts_area_->setWidget(pane_charts_ = new CompareCharts(pane_charts_area_));
  pane_charts_area_->setWidgetResizable(true);
  pane_charts_area_->setFrameShape(QFrame::NoFrame);
  pane_charts_area_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  pane_charts_area_->setMinimumSize(CompareCharts::least_size());
  one_of_two->addWidget(pane_charts_area_);

  parameters_dock_->installEventFilter(this);
  charts_dock_->installEventFilter(this);
  ranking_dock_ = addDock(tr("Ranking"), "rankingDock", Qt::BottomDockWidgetArea);
  ranking_dock_->setWidget(ranking_ = new RankingPanel(ranking_dock_));
  ranking_dock_->hide();
  studies_dock_ = addDock(tr("Studies"), "studiesDock", Qt::BottomDockWidgetArea);
  studies_dock_->setWidget(studies_ = new StudiesPanel(document_, studies_dock_));
  tabifyDockWidget(ranking_dock_, studies_dock_);
  studies_dock_->hide();
  connect(studies_dock_, &QDockWidget::visibilityChanged, this,
          [this] { placeCorners(!studies_dock_->isHidden()); });
  QAction* entry = studies_dock_->toggleViewAction();
  entry->disconnect(studies_dock_);  // its place is made before it is shown
  connect(entry, &QAction::triggered, this,
          [this](bool on) { on ? showStudies() : static_cast<void>(studies_dock_->close()); });
}

/// Studies take the whole width, and in a low window the height of the panes; the ranking leaves form and
/// charts of a comparison their height.
void LabWindow::placeCorners(bool studies) {
  const bool whole = !shows_comparison_ || studies;
  grid_->setLow(studies);
  setCorner(Qt::BottomLeftCorner, whole ? Qt::BottomDockWidgetArea : Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, whole ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea);
}

QDockWidget* LabWindow::addDock(const QString& title, const char* name, Qt::DockWidgetArea area) {
  auto* dock = named(name, new QDockWidget(title, this));
  addDockWidget(area, dock);
  return dock;
}

/// Docks at the sides get the widths of a scene or of a comparison, but for those that the user made wider or
/// narrower. They get them back when the window was narrower meanwhile.
void LabWindow::setWidths() {
  const auto& now = shows_comparison_ ? widths_of_comparison : widths_of_scene;
  const auto& before = shows_comparison_ ? widths_of_scene : widths_of_comparison;
  const QList<QDockWidget*> docks{parameters_dock_, charts_dock_};
  for (std::size_t k = 0; k < now.size(); ++k) {
    int& wanted = wanted_widths_[docks[static_cast<qsizetype>(k)]];
    if (wanted == 0 || wanted == before[k]) wanted = now[k];
  }
  resizeDocks(docks, {wanted_widths_[parameters_dock_], wanted_widths_[charts_dock_]}, Qt::Horizontal);
}

/// A dock whose edge a hand drags is wanted as wide as it becomes.
bool LabWindow::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && QApplication::mouseButtons() != Qt::NoButton)
    if (auto* dock = qobject_cast<QDockWidget*>(watched); dock && wanted_widths_.contains(dock))
      wanted_widths_[dock] = dock->width();
  return QMainWindow::eventFilter(watched, event);
}

/// Docks that a narrower window has squeezed get their widths back, as far as the middle can spare it.
void LabWindow::resizeEvent(QResizeEvent* event) {
  QMainWindow::resizeEvent(event);
  if (!centralWidget()) return;
  int spare = centralWidget()->width() - centralWidget()->minimumSizeHint().width();
  QList<QDockWidget*> docks;
  QList<int> widths;
  for (auto [dock, wanted] : wanted_widths_.asKeyValueRange()) {
    if (!dock->isVisible() || dock->isFloating() || dock->width() >= wanted || spare <= 0) continue;
    const int more = std::min(wanted - dock->width(), spare);
    docks << dock;
    widths << dock->width() + more;
    spare -= more;
  }
  if (!docks.isEmpty()) resizeDocks(docks, widths, Qt::Horizontal);
}

void LabWindow::showStudies() {
  const bool was_hidden = studies_dock_->isHidden();
  placeCorners(true);  // before the dock needs its place
  studies_dock_->show();
  studies_dock_->raise();
  // The upper half of a low window keeps the larger part.
  if (was_hidden) resizeDocks({studies_dock_}, {std::min(studies_height, height() * 9 / 20)}, Qt::Vertical);
}

}  // namespace clothlab
