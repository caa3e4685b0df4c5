// LabWindow: actions, menus and bars, and what their entries show.
#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QMenuBar>
#include <QToolBar>
#include <QToolButton>

#include "document/result_files.h"
#include "help/help_window.h"
#include "main_window/lab_files.h"
#include "main_window/lab_window.h"
#include "main_window/undo_history.h"
#include "main_window/view_bar.h"
#include "scene/builtin_scenes.h"
#include "scenes/scene_chooser.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
/// An action of this window; its tooltip contains the shortcut.
QAction* LabWindow::makeAction(const char* icon_name, const QString& text, const QString& tip,
                               const QKeySequence& key, const char* name) {
  auto* action = named(name, new QAction(icon(icon_name), text, this));
  action->setShortcut(key);
  action->setToolTip(QStringLiteral("%1 (%2)").arg(tip, key.toString(QKeySequence::NativeText)));
  addAction(action);
  return action;
}

void LabWindow::makeActions() {
  play_ = makeAction("play", tr("Play"), tr("Play or pause"), Qt::Key_Space, "play");
  play_->setCheckable(true);
  step_ =
      makeAction("step", tr("Step"), tr("One step of the method; of a comparison, to the next common time"),
                 Qt::Key_Period, "step");
  reset_ = makeAction("reset", tr("Reset"), tr("Back to the start, paused"), QKeySequence("Ctrl+R"), "reset");
  record_ = makeAction("record", tr("Record"), tr("Record energy, strain and times to CSV while it runs"),
                       QKeySequence("Ctrl+Shift+R"), "record");
  record_->setCheckable(true);
  play_again_ =
      makeAction("play-again", tr("Play again"), tr("Play what the timeline has, from here to its end"),
                 QKeySequence("Shift+Space"), "playAgain");
  save_plots_ = makeAction("export-plot", tr("Save plots…"), tr("Save the charts as PNG, SVG or CSV"),
                           QKeySequence("Ctrl+Shift+P"), "savePlots");
  save_picture_ = makeAction("save-picture", tr("Save picture…"), tr("Save a picture of the view"),
                             QKeySequence("Ctrl+P"), "savePicture");
  save_cloth_ =
      makeAction("mesh", tr("Save cloth…"), tr("Save the cloth as the view shows it as an OBJ file"),
                 QKeySequence("Ctrl+Shift+O"), "saveCloth");
  save_session_ = makeAction("save", tr("Save session as…"), tr("Save the run so far with all its edits"),
                             QKeySequence("Ctrl+Alt+S"), "saveSession");
  duplicate_ = makeAction("add", tr("Compare with a copy"),
                          tr("Run a copy beside the scene, from its present state on, to change one of them"),
                          QKeySequence("Ctrl+D"), "duplicate");
  connect(record_, &QAction::triggered, this, [this](bool on) {
    if (on)
      startRecording(new_folder(results_folder(), {document_.title()}));
    else
      link_.send(command::StopRecording{});
  });
  connect(save_plots_, &QAction::triggered, this, &LabWindow::saveCharts);
  connect(save_picture_, &QAction::triggered, this, &LabWindow::savePicture);
  connect(save_cloth_, &QAction::triggered, this, &LabWindow::saveCloth);
  connect(save_session_, &QAction::triggered, this, &LabWindow::saveSessionAs);
  connect(duplicate_, &QAction::triggered, this, [this] { document_.duplicatePane(0); });
}

void LabWindow::makeMenus() {
  fillFileMenu(*menuBar()->addMenu(tr("&File")));
  makeEditMenu();

  QMenu* run = menuBar()->addMenu(tr("&Run"));
  run->addActions({play_, play_again_, step_, reset_});
  run->addSeparator();
  run->addAction(record_);
  run->addSeparator();
  run->addAction(icon("chart"), tr("Studies…"), QKeySequence("Ctrl+T"), this, &LabWindow::showStudies)
      ->setObjectName("studies");
  run->addAction(tr("Fit to measured values…"), this, &LabWindow::chooseMeasured)->setObjectName("fitTo");

  QMenu* compare = menuBar()->addMenu(tr("&Compare"));
  compare->addAction(duplicate_);
  QAction* methods =
      compare->addAction(tr("Compare methods"), QKeySequence("Ctrl+M"), this, &LabWindow::compareMethods);
  methods->setObjectName("compareMethods");
  methods->setToolTip(tr("This scene by its method and by two others, side by side, in a new window"));
  compare->addAction(tr("Built-in comparisons…"), this, [this] { chooseScene("report-methods"); })
      ->setObjectName("builtinComparisons");

  QMenu* view = menuBar()->addMenu(tr("&View"));
  view_bar_->fillMenu(*view);
  view->addSeparator();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view->addAction(dock->toggleViewAction());
  view->addSeparator();
  fillThemeMenu(*view->addMenu(tr("Theme")));

  fill_help_menu(*menuBar()->addMenu(tr("&Help")), *this);
  makeToolBar();
}

void LabWindow::fillFileMenu(QMenu& file) {
  file.addAction(tr("New window"), QKeySequence::New, this,
                 [] { showNew()->open(cloth::default_scene_name); })
      ->setObjectName("newWindow");
  open_ = file.addAction(icon("open"), tr("Open…"), QKeySequence::Open, this, &LabWindow::openWithDialog);
  open_->setToolTip(tr("Open a scene, a session, a comparison, a mesh or a study (Ctrl+O)"));
  scenes_ = named("scenes", file.addAction(icon("cloth"), tr("Scenes…"), QKeySequence("Ctrl+B"), this,
                                           [this] { chooseScene({}); }));
  scenes_->setIconText(tr("Scenes"));
  scenes_->setToolTip(tr("Choose a built-in scene or comparison (Ctrl+B)"));
  recent_menu_ = file.addMenu(tr("Recent"));
  connect(recent_menu_, &QMenu::aboutToShow, this, &LabWindow::fillRecentMenu);
  file.addSeparator();
  save_ = file.addAction(icon("save"), tr("Save"), QKeySequence::Save, this, [this] { save(); });
  save_->setToolTip(tr("Save the scene or the comparison (Ctrl+S)"));
  file.addAction(tr("Save as…"), QKeySequence("Ctrl+Shift+S"), this, [this] { saveAs(); })
      ->setObjectName("saveAs");
  file.addAction(save_session_);
  file.addSeparator();
  file.addActions({save_picture_, save_cloth_, save_plots_});
  file.addSeparator();
  file.addAction(tr("Close"), QKeySequence::Close, this, &QWidget::close);
  file.addAction(tr("Quit"), QKeySequence("Ctrl+Q"), this, [] { quit(); })->setObjectName("quit");
}

void LabWindow::makeEditMenu() {
  QUndoStack& stack = document_.undoStack();
  undo_ = named("undo", stack.createUndoAction(this, tr("Undo")));
  undo_->setIcon(icon("undo"));
  undo_->setShortcut(QKeySequence::Undo);
  redo_ = named("redo", stack.createRedoAction(this, tr("Redo")));
  redo_->setIcon(icon("redo"));
  redo_->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  edit->addActions({undo_, redo_});
  edit->addAction(tr("Undo history"), this, [this] { show_undo_history(document_.undoStack(), *this); })
      ->setObjectName("undoHistory");
  edit->addSeparator();
  edit->addAction(tr("Find parameter"), QKeySequence::Find, this, [this] {
    parameters_dock_->show();
    parameters_->startSearch();
  });
  edit->addAction(tr("Copy ranking"), this, [this] { ranking().copy(); })->setObjectName("copyRanking");
}

void LabWindow::makeToolBar() {
  QToolBar* bar = addToolBar(tr("File and edit"));
  bar->setObjectName("mainToolBar");
  bar->setMovable(false);
  bar->setIconSize({20, 20});
  QToolButton* scenes = make_action_button(scenes_, bar);
  scenes->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  bar->addWidget(scenes);
  bar->addActions({open_, save_});
  bar->addSeparator();
  bar->addActions({undo_, redo_});
  bar->addSeparator();
  bar->addAction(save_plots_);
}

void LabWindow::chooseScene(const QString& selected) {
  auto* chooser = new SceneChooser(selected, this);
  connect(chooser, &SceneChooser::chosen, this, [this](const QString& name) {
    if (cloth::find_builtin_scene(name.toStdString()))
      openScene(name);
    else
      openComparison(name);
  });
  chooser->open();
}

void LabWindow::fillRecentMenu() {
  recent_menu_->clear();
  const std::pair<QString, const RecentPaths&> kinds[] = {{tr("Scenes"), recent_scenes},
                                                          {tr("Sessions"), recent_sessions},
                                                          {tr("Comparisons"), recent_comparisons}};
  for (const auto& [title, paths] : kinds) {
    const QStringList recent = paths.list();
    if (!recent.isEmpty()) recent_menu_->addSection(title);
    for (const QString& path : recent) recent_menu_->addAction(path, this, [this, path] { open(path); });
  }
  if (recent_menu_->isEmpty()) recent_menu_->addAction(tr("No file was opened yet"))->setEnabled(false);
}

void LabWindow::fillThemeMenu(QMenu& menu) {
  const std::pair<const char*, QString> choices[] = {
      {"", tr("As the desktop")}, {"light", tr("Light")}, {"dark", tr("Dark")}};
  auto* group = new QActionGroup(&menu);
  for (const auto& [name, text] : choices) {
    QAction* action = menu.addAction(text, this, [name] { choose_theme(*qApp, QLatin1String(name)); });
    action->setObjectName(QStringLiteral("theme:") + name);
    action->setCheckable(true);
    group->addAction(action);
  }
  connect(&menu, &QMenu::aboutToShow, group, [group] {
    for (QAction* action : group->actions())
      action->setChecked(action->objectName() == "theme:" + chosen_theme());
  });
}

void LabWindow::compareMethods() {
  link_.send(command::Pause{});
  showNew()->document_.load(comparison_of_scene(document_.scene()), {}, true);
}

void LabWindow::savePicture() {
  const QImage picture = grid_->grabPicture();
  saveByDialog(tr("picture"), {{tr("Pictures"), {".png", ".jpg"}}},
               [&](const QString& path) { return save_picture_file(picture, path); });
}

/// The frame that is shown when the dialog opens, however long it stays; of a comparison that of the pane
/// whose values the form shows, or of the first one.
void LabWindow::saveCloth() {
  const auto shown = grid_->pane(document_.scope().value_or(0)).view().frame();
  if (!shown || !shown->has_cloth()) return;
  const ClothFrame frame = *shown;
  saveByDialog(tr("cloth"), {{tr("Meshes"), {".obj"}}},
               [&](const QString& path) { return save_cloth_file(frame, document_.title(), path); });
}

}  // namespace clothlab
