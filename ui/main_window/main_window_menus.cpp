// The window's actions and menus, and the dialogs behind them.
#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QToolBar>
#include <QToolButton>

#include "compare/builtin_comparisons.h"
#include "compare/compare_window.h"
#include "document/document_actions.h"
#include "document/result_files.h"
#include "io/machine.h"
#include "main_window/cloth_file.h"
#include "main_window/main_window.h"
#include "main_window/scene_library.h"
#include "main_window/view_bar.h"
#include "scene/builtin_scenes.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

const char* const scene_filter =
    "Clothlab scenes and sessions (*.scene.json *.session.json *.json);;All files (*)";

QString with_ending(const QString& path, const QString& ending) {
  return path.isEmpty() || QFileInfo(path).fileName().contains('.') ? path : path + ending;
}

/// A window of its own that outlives this one and goes when it is closed.
CompareWindow* new_compare_window() {
  auto* window = new CompareWindow;
  window->setAttribute(Qt::WA_DeleteOnClose);
  window->show();
  return window;
}

}  // namespace

void MainWindow::makeActions() {
  const auto action = [this](const char* icon_name, const QString& text, const QString& tip,
                             const QKeySequence& key, const char* name) {
    auto* made = new QAction(icon(icon_name), text, this);
    made->setObjectName(name);
    made->setShortcut(key);
    const QString shortcut = key.toString(QKeySequence::NativeText);
    made->setToolTip(shortcut.isEmpty() ? tip : QStringLiteral("%1 (%2)").arg(tip, shortcut));
    addAction(made);
    return made;
  };
  play_ = action("play", tr("Play"), tr("Play or pause"), Qt::Key_Space, "play");
  play_->setCheckable(true);
  play_again_ = action("play-again", tr("Play again"), tr("Play what the timeline has, from here to its end"),
                       QKeySequence("Shift+Space"), "playAgain");
  step_ = action("step", tr("Step"), tr("One step of the method"), Qt::Key_Period, "step");
  reset_ = action("reset", tr("Reset"), tr("Back to the start, paused"), QKeySequence("Ctrl+R"), "reset");
  record_ = action("record", tr("Record"), tr("Record energy, strain and times to CSV while it runs"),
                   QKeySequence("Ctrl+Shift+R"), "record");
  record_->setCheckable(true);
  save_picture_ = action("save-picture", tr("Save picture…"), tr("Save a picture of the view"),
                         QKeySequence("Ctrl+P"), "savePicture");
  save_cloth_ = action("mesh", tr("Save cloth…"), tr("Save the cloth as the view shows it as an OBJ file"),
                       QKeySequence("Ctrl+Shift+O"), "saveCloth");
  save_plots_ = action("export-plot", tr("Save plots…"), tr("Save the charts as PNG, SVG or CSV"),
                       QKeySequence("Ctrl+Shift+P"), "savePlots");
  connect(save_picture_, &QAction::triggered, this, &MainWindow::savePicture);
  connect(save_cloth_, &QAction::triggered, this, &MainWindow::saveCloth);
  connect(save_plots_, &QAction::triggered, this, [this] { charts_->saveAs(); });
}

void MainWindow::makeMenus() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  QAction* open =
      file->addAction(icon("open"), tr("Open…"), QKeySequence::Open, this, &MainWindow::openWithDialog);
  open->setToolTip(tr("Open a scene or a session (Ctrl+O)"));
  QMenu* builtin = file->addMenu(tr("Built-in scenes"));
  for (const cloth::BuiltinScene& scene : cloth::builtin_scenes()) {
    const QString name = QString::fromStdString(scene.name);
    QAction* entry = builtin->addAction(QString::fromStdString(cloth::builtin_scene(scene.name).title), this,
                                        [this, name] { openScene(name); });
    entry->setObjectName("scene:" + name);
  }
  recent_menu_ = file->addMenu(tr("Recent"));
  connect(recent_menu_, &QMenu::aboutToShow, this, &MainWindow::fillRecentMenu);
  file->addSeparator();
  QAction* save_action =
      file->addAction(icon("save"), tr("Save"), QKeySequence::Save, this, [this] { save(); });
  save_action->setToolTip(tr("Save the scene (Ctrl+S)"));
  file->addAction(tr("Save as…"), QKeySequence("Ctrl+Shift+S"), this, [this] { saveAs(); });
  QAction* save_session =
      file->addAction(tr("Save session as…"), QKeySequence("Ctrl+Alt+S"), this, &MainWindow::saveSessionAs);
  save_session->setObjectName("saveSession");
  file->addSeparator();
  file->addActions({save_picture_, save_cloth_, save_plots_});
  file->addSeparator();
  file->addAction(tr("Quit"), QKeySequence::Quit, this, &QWidget::close);

  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  const auto [undo, redo] = make_undo_actions(document_.undoStack(), this);
  edit->addActions({undo, redo});

  QMenu* run = menuBar()->addMenu(tr("&Run"));
  run->addActions({play_, play_again_, step_, reset_});
  run->addSeparator();
  run->addAction(record_);
  run->addSeparator();
  run->addAction(icon("chart"), tr("Studies…"), QKeySequence("Ctrl+T"), this, &MainWindow::showStudies)
      ->setObjectName("studies");

  QMenu* compare = menuBar()->addMenu(tr("&Compare"));
  QAction* methods =
      compare->addAction(tr("Compare methods"), QKeySequence("Ctrl+M"), this, &MainWindow::compareMethods);
  methods->setObjectName("compareMethods");
  methods->setToolTip(tr("This scene by its method and by two others, side by side"));
  compare->addAction(tr("Open comparison…"), this, &MainWindow::openComparison);
  QMenu* comparisons = compare->addMenu(tr("Built-in comparisons"));
  for (const cloth::BuiltinComparison& comparison : cloth::builtin_comparisons()) {
    const QString name = QString::fromStdString(comparison.name);
    comparisons->addAction(QString::fromStdString(cloth::builtin_comparison(comparison.name).title), this,
                           [name] { new_compare_window()->openComparison(name); });
  }

  QMenu* view = menuBar()->addMenu(tr("&View"));
  view_bar_->fillMenu(*view);
  view->addSeparator();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view->addAction(dock->toggleViewAction());

  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("About Clothlab"), this, &MainWindow::showAbout);

  QToolBar* bar = addToolBar(tr("File and edit"));
  bar->setObjectName("mainToolBar");
  bar->setMovable(false);
  bar->setIconSize({20, 20});
  auto* scenes = new QToolButton(bar);
  scenes->setObjectName("scenesButton");
  scenes->setIcon(icon("cloth"));
  scenes->setText(tr("Scenes"));
  scenes->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  scenes->setMenu(builtin);
  scenes->setPopupMode(QToolButton::InstantPopup);
  scenes->setToolTip(tr("Open a built-in scene"));
  bar->addWidget(scenes);
  bar->addActions({open, save_action});
  bar->addSeparator();
  bar->addActions({undo, redo});
  bar->addSeparator();
  bar->addAction(save_plots_);
}

void MainWindow::fillRecentMenu() {
  recent_menu_->clear();
  const QStringList recent = recent_scenes();
  for (const QString& path : recent) recent_menu_->addAction(path, this, [this, path] { openScene(path); });
  if (recent.isEmpty()) recent_menu_->addAction(tr("No scene was opened yet"))->setEnabled(false);
}

void MainWindow::openWithDialog() {
  const QString path =
      QFileDialog::getOpenFileName(this, tr("Open a scene or a session"), document_.path(), tr(scene_filter));
  if (!path.isEmpty()) openScene(path);
}

bool MainWindow::save() {
  if (document_.path().isEmpty()) return saveAs();
  const QString problem = save_scene_file(document_.scene(), document_.path());
  if (!problem.isEmpty()) {
    notice_->show("save", NoticeBar::Level::error, tr("The scene was not saved. %1").arg(problem));
    return false;
  }
  document_.markSaved(document_.path());
  remember_scene(document_.path());
  return true;
}

bool MainWindow::saveAs() {
  const QString path = with_ending(
      QFileDialog::getSaveFileName(this, tr("Save the scene"), document_.path(), tr(scene_filter)),
      ".scene.json");
  if (path.isEmpty()) return false;
  const QString problem = save_scene_file(document_.scene(), path);
  if (!problem.isEmpty()) {
    notice_->show("save", NoticeBar::Level::error, tr("The scene was not saved. %1").arg(problem));
    return false;
  }
  document_.markSaved(path);
  remember_scene(path);
  return true;
}

void MainWindow::saveSessionAs() {
  const QString path = with_ending(QFileDialog::getSaveFileName(this, tr("Save the session"), {},
                                                                tr("Clothlab sessions (*.session.json)")),
                                   ".session.json");
  if (!path.isEmpty()) saveSession(path);
}

void MainWindow::compareMethods() {
  link_.send(command::Pause{});
  new_compare_window()->compareScene(document_.scene());
}

void MainWindow::openComparison() {
  const QString path = QFileDialog::getOpenFileName(this, tr("Open a comparison"), {},
                                                    tr("Clothlab comparisons (*.compare.json)"));
  if (!path.isEmpty()) new_compare_window()->openComparison(path);
}

void MainWindow::savePicture() {
  const QImage picture = view_->grabPicture();
  const QString path = with_ending(
      QFileDialog::getSaveFileName(this, tr("Save a picture of the view"), {}, tr("Pictures (*.png *.jpg)")),
      ".png");
  if (path.isEmpty()) return;
  if (!picture.save(path))
    notice_->show("picture", NoticeBar::Level::error, tr("%1: the picture could not be written.").arg(path));
}

/// The frame that is shown when the dialog opens, however long it stays.
void MainWindow::saveCloth() {
  const auto shown = view_->frame();
  if (!shown || !shown->has_cloth()) return;
  const ClothFrame frame = *shown;
  const QString path =
      with_ending(QFileDialog::getSaveFileName(this, tr("Save the cloth"), {}, tr("Meshes (*.obj)")), ".obj");
  if (path.isEmpty()) return;
  const QString problem = save_cloth_file(frame, document_.title(), path);
  if (problem.isEmpty())
    notice_->withdraw("cloth");
  else
    notice_->show("cloth", NoticeBar::Level::error, tr("The cloth was not saved. %1").arg(problem));
}

void MainWindow::toggleRecording(bool on) {
  if (on)
    startRecording(new_folder(results_folder(), {document_.title()}));
  else
    link_.send(command::StopRecording{});
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
