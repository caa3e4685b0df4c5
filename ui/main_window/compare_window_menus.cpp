// The actions, menus and bars of a comparison's window, and the dialogs behind them.
#include <QComboBox>
#include <QLabel>
#include <QMenuBar>
#include <QToolBar>

#include "main_window/compare_window.h"
#include "main_window/view_bar.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

void CompareWindow::makeMenus() {
  QMenu* file = addFileMenu();
  addComparisons(*file, [this](const QString& name) { openComparison(name); });
  addSaveEntries(*file);
  file->addSeparator();
  file->addAction(save_plots_);
  connect(save_plots_, &QAction::triggered, charts_, &CompareCharts::saveAs);
  file->addSeparator();
  file->addAction(tr("Close"), QKeySequence::Close, this, &QWidget::close);

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

}  // namespace clothlab
