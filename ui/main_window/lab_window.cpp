#include "main_window/lab_window.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDesktopServices>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QScreen>
#include <QToolBar>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "compare/builtin_comparisons.h"
#include "document/result_files.h"
#include "main_window/lab_files.h"
#include "params/mesh_button.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int title_bar_height = 32;  // px, at least what a desktop puts above a window

/// A click has switched the action already, but not its icon: the text tells which one it has. An action that
/// is told what it knows would have its bar laid out anew all the same.
void dress(QAction& action, bool on, const QString& text, const char* icon_name) {
  action.setChecked(on);
  if (action.text() == text) return;
  action.setText(text);
  action.setIcon(icon(icon_name));
}

}  // namespace

LabWindow::LabWindow(std::unique_ptr<Document> document, Wording wording, QSize pleasant_size,
                     QWidget* parent)
    : QMainWindow(parent), any_document_(std::move(document)), wording_(std::move(wording)) {
  setAcceptDrops(true);
  resize(pleasant_size.boundedTo(screen()->availableSize() - QSize(0, title_bar_height)));
  play_ = makeAction("play", tr("Play"), wording_.play_tip, Qt::Key_Space, "play");
  play_->setCheckable(true);
  step_ = makeAction("step", tr("Step"), wording_.step_tip, Qt::Key_Period, "step");
  reset_ = makeAction("reset", tr("Reset"), tr("Back to the start, paused"), QKeySequence("Ctrl+R"), "reset");
  record_ = makeAction("record", tr("Record"), wording_.record_tip, QKeySequence("Ctrl+Shift+R"), "record");
  record_->setCheckable(true);
  save_plots_ = makeAction("export-plot", tr("Save plots…"), tr("Save the charts as PNG, SVG or CSV"),
                           QKeySequence("Ctrl+Shift+P"), "savePlots");
  connect(play_, &QAction::triggered, this, &LabWindow::play);
  connect(step_, &QAction::triggered, this, [this] { send(command::SingleStep{}); });
  connect(reset_, &QAction::triggered, this, &LabWindow::restart);
  connect(record_, &QAction::triggered, this, [this](bool on) {
    if (on)
      startRecording(new_folder(results_folder(), {any_document_->title()}));
    else
      send(command::StopRecording{});
  });
  connect(any_document_.get(), &Document::titleChanged, this, &LabWindow::updateTitle);
  connect(any_document_.get(), &Document::modifiedChanged, this, [this](bool modified) {
    updateTitle();
    if (modified) notice_->withdraw("save " + wording_.document);  // no longer what lies there
  });
  updateTitle();
}

void LabWindow::makeForm() {
  parameters_ = new ParameterPanel(any_document_->form(), this);
  notice_ = new NoticeBar(this);
}

void LabWindow::deleteWidgets() {
  delete takeCentralWidget();
  qDeleteAll(findChildren<QDockWidget*>());
}

void LabWindow::play(bool on) {
  if (on)
    send(command::Play{});
  else
    send(command::Pause{});
}

void LabWindow::brush(const cloth::BrushGust& gust) {
  if (hasAir())
    send(command::Brush{gust});
  else
    offerAir(tr("The wind brush needs air, and this scene has none."));
}

QAction* LabWindow::makeAction(const char* icon_name, const QString& text, const QString& tip,
                               const QKeySequence& key, const char* name) {
  auto* action = named(name, new QAction(icon(icon_name), text, this));
  action->setShortcut(key);
  action->setToolTip(QStringLiteral("%1 (%2)").arg(tip, key.toString(QKeySequence::NativeText)));
  addAction(action);
  return action;
}

void LabWindow::setMiddle(const std::vector<QWidget*>& parts, QWidget* stretched, Qt::Edge messages) {
  auto* middle = new QWidget(this);
  auto* column = spaced(new QVBoxLayout(middle), 0);
  for (QWidget* part : parts) column->addWidget(part, part == stretched ? 1 : 0);
  setCentralWidget(middle);
  notice_->layOver(stretched, messages);
}

QDockWidget* LabWindow::addDock(const QString& title, const char* name, QWidget* content,
                                Qt::DockWidgetArea area) {
  auto* dock = named(name, new QDockWidget(title, this));
  dock->setTitleBarWidget(new QWidget(dock));  // the panels have heads of their own
  dock->setWidget(content);
  addDockWidget(area, dock);
  return dock;
}

void LabWindow::setWidths(const QList<QDockWidget*>& docks, const QList<int>& widths) {
  for (qsizetype k = 0; k < docks.size(); ++k) {
    wanted_widths_[docks[k]] = widths[k];
    docks[k]->installEventFilter(this);
  }
  resizeDocks(docks, widths, Qt::Horizontal);
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

void LabWindow::addTransport() {
  transport_ =
      new TransportBar({play_, step_, reset_, record_}, wording_.widest_time, wording_.widest_rate, this);
  connect(transport_, &TransportBar::speedChosen, this,
          [this](double factor) { send(command::Speed{factor}); });
  auto* bottom = named("transportToolBar", new QToolBar(tr("Run"), this));
  bottom->setMovable(false);
  bottom->addWidget(transport_);
  addToolBar(Qt::BottomToolBarArea, bottom);
}

QMenu* LabWindow::addFileMenu() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  open_ = file->addAction(icon("open"), tr("Open…"), QKeySequence::Open, this, &LabWindow::openWithDialog);
  open_->setToolTip(tr("Open a scene, a session, a comparison, a mesh or a study (Ctrl+O)"));
  return file;
}

void LabWindow::addSaveEntries(QMenu& file) {
  file.addSeparator();
  save_ = file.addAction(icon("save"), tr("Save"), QKeySequence::Save, this, [this] { save(); });
  save_->setToolTip(tr("Save the %1 (Ctrl+S)").arg(wording_.document));
  file.addAction(tr("Save as…"), QKeySequence("Ctrl+Shift+S"), this, [this] { saveAs(); })
      ->setObjectName("saveAs");
}

void LabWindow::addCloseEntries(QMenu& file) {
  file.addSeparator();
  file.addAction(tr("Close"), QKeySequence::Close, this, &QWidget::close);
  file.addAction(tr("Quit"), QKeySequence("Ctrl+Q"), this, [] { quit(); })->setObjectName("quit");
}

void LabWindow::addComparisons(QMenu& menu) {
  QMenu* builtin = menu.addMenu(tr("Built-in comparisons"));
  for (const cloth::BuiltinComparison& comparison : cloth::builtin_comparisons()) {
    const QString name = QString::fromStdString(comparison.name);
    builtin->addAction(QString::fromStdString(cloth::builtin_comparison(comparison.name).title), this,
                       [this, name] { open(name); });
  }
}

QMenu* LabWindow::addEditMenu() {
  QUndoStack& stack = any_document_->undoStack();
  undo_ = stack.createUndoAction(this, tr("Undo"));
  undo_->setObjectName("undo");
  undo_->setIcon(icon("undo"));
  undo_->setShortcut(QKeySequence::Undo);
  redo_ = stack.createRedoAction(this, tr("Redo"));
  redo_->setObjectName("redo");
  redo_->setIcon(icon("redo"));
  redo_->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  edit->addActions({undo_, redo_});
  return edit;
}

QMenu* LabWindow::addRunMenu(const QList<QAction*>& actions) {
  QMenu* run = menuBar()->addMenu(tr("&Run"));
  run->addActions(actions);
  run->addSeparator();
  run->addAction(record_);
  return run;
}

void LabWindow::addDockEntries(QMenu& view) {
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view.addAction(dock->toggleViewAction());
}

void LabWindow::say(const QString& kind, NoticeBar::Level level, const QString& text) {
  if (text.isEmpty())
    notice_->withdraw(kind);
  else
    notice_->show(kind, level, text);
}

void LabWindow::followRun(const RunStatus& now) {
  dress(*play_, now.playing, now.playing ? tr("Pause") : tr("Play"), now.playing ? "pause" : "play");
  play_->setEnabled(now.refusal.empty());
  step_->setEnabled(now.refusal.empty());
  notice_->showState("refusal", NoticeBar::Level::error, QString::fromStdString(now.refusal));
}

void LabWindow::followRecording(const RunStatus& before, const RunStatus& now) {
  dress(*record_, now.recording, now.recording ? tr("Stop recording") : tr("Record"),
        now.recording ? "stop-record" : "record");
  if (now.recording_error != before.recording_error && !now.recording_error.empty()) {
    notice_->show("recording", NoticeBar::Level::error,
                  tr("Recording stopped: %1. What was written before is valid.")
                      .arg(QString::fromStdString(now.recording_error)));
  } else if (before.recording && !now.recording) {
    const QString folder = QString::fromStdString(now.recording_folder.string());
    notice_->show("recording", NoticeBar::Level::info,
                  tr("Recorded %1 rows in %2").arg(now.recorded_rows).arg(folder), tr("Open folder"),
                  [folder] { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); });
  }
}

void LabWindow::restartWith(
    const Remedy& remedy,
    const std::function<void(const std::string& path, const cloth::ParameterValue& value)>& set) {
  if (!remedy.edits.empty()) {
    any_document_->undoStack().beginMacro(remedy.text);
    for (const auto& [path, value] : remedy.edits) set(path, value);
    any_document_->undoStack().endMacro();
  }
  restart();
}

void LabWindow::updateTitle() {
  setWindowTitle(wording_.title.arg(any_document_->title()));
  setWindowModified(any_document_->isModified());
}

/// Asks to save, discard or cancel. Returns false if the user cancelled or saving failed.
bool LabWindow::mayLoseChanges() {
  if (!asks_to_save_ || !any_document_->isModified()) return true;
  comeForward();
  const auto answer = QMessageBox::question(
      this, tr("Unsaved changes"), wording_.unsaved.arg(any_document_->title()),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save());
}

void LabWindow::comeForward() {
  if (isMinimized()) showNormal();
  raise();
  activateWindow();
}

void LabWindow::closeEvent(QCloseEvent* event) {
  if (!std::exchange(may_close_, false) && !mayClose()) return event->ignore();
  send(command::Pause{});
  send(command::StopRecording{});
  event->accept();
}

std::vector<LabWindow*> LabWindow::all() {
  std::vector<LabWindow*> windows;
  for (QWidget* top : QApplication::topLevelWidgets())
    if (auto* window = qobject_cast<LabWindow*>(top)) windows.push_back(window);
  return windows;
}

void LabWindow::quit() {
  std::vector<LabWindow*> windows = all();
  std::erase_if(windows, [](const LabWindow* window) { return !window->isVisible(); });
  for (LabWindow* window : windows)
    if (!window->mayClose()) return;
  for (LabWindow* window : windows) {
    window->may_close_ = true;
    window->close();
  }
}

void LabWindow::dragEnterEvent(QDragEnterEvent* event) {
  const auto urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void LabWindow::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  open(event->mimeData()->urls().front().toLocalFile());
}

void LabWindow::openWithDialog() {
  const QString path = QFileDialog::getOpenFileName(this, tr("Open"), any_document_->path(), open_filter());
  if (!path.isEmpty()) open(path);
}

void LabWindow::open(const QString& name) {
  switch (type_of(name)) {
    case FileType::scene:
      return openScene(name);
    case FileType::comparison:
      return openComparison(name);
    case FileType::mesh:
      return loadMesh(name);
    case FileType::study:
      return loadStudy(QFileInfo(name).isDir() ? name : QFileInfo(name).absolutePath());
  }
}

void LabWindow::openScene(const QString& name) {
  if (const OpenedScene opened = open_scene(name); isSound(tr("scene"), opened.problems)) load(opened);
}

void LabWindow::openComparison(const QString& name) {
  if (const OpenedComparison opened = open_comparison(name); isSound(tr("comparison"), opened.problems))
    load(opened);
}

/// Whether what was read has no problems; says them.
bool LabWindow::isSound(const QString& what, const QString& problems) {
  say("open", NoticeBar::Level::error,
      problems.isEmpty() ? QString() : tr("The %1 was not opened.\n%2").arg(what, problems));
  return problems.isEmpty();
}

void LabWindow::loadMesh(const QString& file) {
  LabDocument& form = any_document_->form();
  const QString rule = form.setClothMesh(file_as_seen_from(form.scene().folder, file));
  if (rule.isEmpty())
    say("open", NoticeBar::Level::info, tr("The cloth is now made of the mesh %1.").arg(file));
  else
    say("open", NoticeBar::Level::error, tr("The mesh was not opened.\n%1 %2").arg(file, rule));
}

bool LabWindow::saveAs() {
  const QString path = ask_where_to_save(this, tr("Save the %1").arg(wording_.document), {wording_.kind},
                                         any_document_->path());
  return !path.isEmpty() && saveTo(path);
}

bool LabWindow::saveTo(const QString& path) {
  const bool saved = saySaved(wording_.document, path, write(path));
  if (saved) any_document_->markSaved(path);
  return saved;
}

bool LabWindow::saveByDialog(const QString& what, const std::vector<FileKind>& kinds,
                             const std::function<QString(const QString& path)>& write) {
  const QString path = ask_where_to_save(this, tr("Save the %1").arg(what), kinds);
  return !path.isEmpty() && saySaved(what, path, write(path));
}

bool LabWindow::saySaved(const QString& what, const QString& path, const QString& problem) {
  if (problem.isEmpty())
    say("save " + what, NoticeBar::Level::info, saved_in(what, path));
  else
    say("save " + what, NoticeBar::Level::error, tr("The %1 was not saved. %2").arg(what, problem));
  return problem.isEmpty();
}

void LabWindow::connectCharts(ChartArea* charts) {
  const auto save = [this, charts] {
    saveByDialog(tr("charts"), ChartArea::kinds(),
                 [charts](const QString& path) { return charts->save(path); });
  };
  connect(save_plots_, &QAction::triggered, this, save);
  connect(charts, &ChartArea::saveWanted, this, save);
}

}  // namespace clothlab
