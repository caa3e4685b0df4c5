// The window's actions and menus, and the dialogs behind them.
#include <QAction>
#include <QDockWidget>
#include <QMenuBar>
#include <QMessageBox>
#include <QToolBar>
#include <QToolButton>

#include "io/machine.h"
#include "main_window/compare_window.h"
#include "main_window/lab_files.h"
#include "main_window/main_window.h"
#include "main_window/view_bar.h"
#include "scene/builtin_scenes.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

void MainWindow::makeActions() {
  play_again_ =
      makeAction("play-again", tr("Play again"), tr("Play what the timeline has, from here to its end"),
                 QKeySequence("Shift+Space"), "playAgain");
  save_picture_ = makeAction("save-picture", tr("Save picture…"), tr("Save a picture of the view"),
                             QKeySequence("Ctrl+P"), "savePicture");
  save_cloth_ =
      makeAction("mesh", tr("Save cloth…"), tr("Save the cloth as the view shows it as an OBJ file"),
                 QKeySequence("Ctrl+Shift+O"), "saveCloth");
  connect(save_picture_, &QAction::triggered, this, &MainWindow::savePicture);
  connect(save_cloth_, &QAction::triggered, this, &MainWindow::saveCloth);
  connectCharts(charts_);
}

void MainWindow::makeMenus() {
  QMenu* file = addFileMenu();
  QMenu* builtin = file->addMenu(tr("Built-in scenes"));
  for (const cloth::BuiltinScene& scene : cloth::builtin_scenes()) {
    const QString name = QString::fromStdString(scene.name);
    QAction* entry = builtin->addAction(QString::fromStdString(cloth::builtin_scene(scene.name).title), this,
                                        [this, name] { openScene(name); });
    entry->setObjectName("scene:" + name);
  }
  recent_menu_ = file->addMenu(tr("Recent"));
  connect(recent_menu_, &QMenu::aboutToShow, this, &MainWindow::fillRecentMenu);
  addSaveEntries(*file);
  QAction* save_session =
      file->addAction(tr("Save session as…"), QKeySequence("Ctrl+Alt+S"), this, &MainWindow::saveSessionAs);
  save_session->setObjectName("saveSession");
  file->addSeparator();
  file->addActions({save_picture_, save_cloth_, save_plots_});
  addCloseEntries(*file);

  addEditMenu();
  QMenu* run = addRunMenu({play_, play_again_, step_, reset_});
  run->addSeparator();
  run->addAction(icon("chart"), tr("Studies…"), QKeySequence("Ctrl+T"), this, &MainWindow::showStudies)
      ->setObjectName("studies");

  QMenu* compare = menuBar()->addMenu(tr("&Compare"));
  QAction* methods =
      compare->addAction(tr("Compare methods"), QKeySequence("Ctrl+M"), this, &MainWindow::compareMethods);
  methods->setObjectName("compareMethods");
  methods->setToolTip(tr("This scene by its method and by two others, side by side"));
  compare->addAction(tr("Open comparison…"), this, &MainWindow::openWithDialog);
  addComparisons(*compare);

  QMenu* view = menuBar()->addMenu(tr("&View"));
  view_bar_->fillMenu(*view);
  view->addSeparator();
  addDockEntries(*view);

  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("About Clothlab"), this, &MainWindow::showAbout);
  makeToolBar(builtin);
}

void MainWindow::makeToolBar(QMenu* builtin) {
  QToolBar* bar = addToolBar(tr("File and edit"));
  bar->setObjectName("mainToolBar");
  bar->setMovable(false);
  bar->setIconSize({20, 20});
  auto* scenes = named("scenesButton", new QToolButton(bar));
  scenes->setIcon(icon("cloth"));
  scenes->setText(tr("Scenes"));
  scenes->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  scenes->setMenu(builtin);
  scenes->setPopupMode(QToolButton::InstantPopup);
  scenes->setToolTip(tr("Open a built-in scene"));
  bar->addWidget(scenes);
  bar->addActions({open_, save_});
  bar->addSeparator();
  bar->addActions({undo_, redo_});
  bar->addSeparator();
  bar->addAction(save_plots_);
}

void MainWindow::fillRecentMenu() {
  recent_menu_->clear();
  const QStringList recent = recent_scenes.list();
  for (const QString& path : recent) recent_menu_->addAction(path, this, [this, path] { open(path); });
  if (recent.isEmpty()) recent_menu_->addAction(tr("No scene was opened yet"))->setEnabled(false);
}

QString MainWindow::write(const QString& path) {
  const QString problem = save_scene_file(document_.scene(), path);
  if (problem.isEmpty()) recent_scenes.remember(path);
  return problem;
}

void MainWindow::saveSessionAs() {
  const QString path = ask_where_to_save(this, tr("Save the session"), {session_kind()});
  if (!path.isEmpty()) saveSession(path);
}

void MainWindow::compareMethods() {
  link_.send(command::Pause{});
  new_window<CompareWindow>()->compareScene(document_.scene());
}

void MainWindow::savePicture() {
  const QImage picture = view_->grabPicture();
  saveByDialog(tr("picture"), {{tr("Pictures"), {".png", ".jpg"}}},
               [&](const QString& path) { return save_picture_file(picture, path); });
}

/// The frame that is shown when the dialog opens, however long it stays.
void MainWindow::saveCloth() {
  const auto shown = view_->frame();
  if (!shown || !shown->has_cloth()) return;
  const ClothFrame frame = *shown;
  saveByDialog(tr("cloth"), {{tr("Meshes"), {".obj"}}},
               [&](const QString& path) { return save_cloth_file(frame, document_.title(), path); });
}

void MainWindow::showAbout() {
  QMessageBox::about(
      this, tr("About Clothlab"),
      tr("<h3>Clothlab %1</h3><p>A lab for cloth simulation after Provot (1995): mass and springs, "
         "deformation rate, integrators to compare.</p><p>Source under the MIT licence. This program uses "
         "Qt Charts, so as a distributed binary it is under the GPL, version 3.</p>")
          .arg(QString::fromStdString(cloth::version())));
}

}  // namespace clothlab
