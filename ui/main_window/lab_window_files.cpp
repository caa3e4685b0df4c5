// LabWindow: opens, saves and closes, and asks before something is lost.
#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QLocale>
#include <QMessageBox>
#include <QMimeData>
#include <utility>

#include "main_window/autosave.h"
#include "main_window/lab_files.h"
#include "main_window/lab_window.h"
#include "params/mesh_button.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_mesh.h"
#include "studies/studies_panel.h"
#include "widgets/beside.h"

namespace clothlab {

bool LabWindow::open(const QString& name) {
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
  return false;
}

/// What `read` gives, beside the window; a scene may have large meshes. Before the first one is shown there
/// is nothing to go on with.
template <class Opened>
Opened LabWindow::readBeside(const QString& name, Opened (*read)(const QString& name)) {
  if (!document_.isLoaded()) return read(name);
  const auto opened = std::make_shared<Opened>();
  const BesideResult result =
      beside_the_window(this, tr("Reading %1").arg(QFileInfo(name).fileName()),
                        [opened, name, read](const std::stop_token&) { *opened = read(name); });
  if (!result.stopped && result.failure.isEmpty()) return std::move(*opened);
  Opened none;
  none.problems = result.stopped ? tr("Reading it was stopped.") : result.failure;
  return none;
}

bool LabWindow::openScene(const QString& name) {
  const OpenedScene opened = readBeside(name, open_scene);
  return isSound(tr("scene"), opened.problems) && load(opened);
}

bool LabWindow::openComparison(const QString& name) {
  const OpenedComparison opened = readBeside(name, open_comparison);
  return isSound(tr("comparison"), opened.problems) && load(opened);
}

/// For work beside the window, which its message says and offers to stop.
bool LabWindow::isWaiting() const {
  return findChild<QDialog*>("beside", Qt::FindDirectChildrenOnly);
}

/// As cloth::load_meshes() does, beside the window.
std::vector<cloth::Problem> LabWindow::readMeshes(cloth::Scene& scene, const cloth::Scene& known) {
  if (!document_.isLoaded()) return load_meshes(scene, &known);
  struct Meshes {
    cloth::Scene scene, known;
    std::vector<cloth::Problem> problems;
  };
  const auto reading = std::make_shared<Meshes>(Meshes{scene, known, {}});
  const BesideResult result =
      beside_the_window(this, tr("Reading a mesh"), [reading](const std::stop_token&) {
        reading->problems = load_meshes(reading->scene, &reading->known);
      });
  if (result.stopped) return {{{}, {}, tr("was not read: it was stopped").toStdString()}};
  if (!result.failure.isEmpty()) return {{{}, {}, "cannot be read: " + result.failure.toStdString()}};
  scene = std::move(reading->scene);
  return std::move(reading->problems);
}

/// Whether what was read has no problems; says them.
bool LabWindow::isSound(const QString& what, const QString& problems) {
  say("open", NoticeBar::Level::error,
      problems.isEmpty() ? QString() : tr("The %1 was not opened.\n%2").arg(what, problems));
  return problems.isEmpty();
}

bool LabWindow::load(const OpenedScene& opened) {
  if (!mayLoseChanges()) return false;
  if (!opened.path.isEmpty()) (opened.session ? recent_sessions : recent_scenes).remember(opened.path);
  session_ = opened.session;
  transport_->suitDuration(opened.scene->duration);
  document_.load(*opened.scene, opened.session ? QString() : opened.path);
  return true;
}

bool LabWindow::load(const OpenedComparison& opened) {
  if (!mayLoseChanges()) return false;
  if (!opened.path.isEmpty()) recent_comparisons.remember(opened.path);
  transport_->suitDuration(opened.comparison->scene.duration);
  document_.load(*opened.comparison, opened.path);
  return true;
}

/// Replaces the cloth, which all panes share, by the mesh, as an undoable edit.
bool LabWindow::loadMesh(const QString& file) {
  const QString rule = document_.setClothMesh(file_as_seen_from(document_.scene().folder, file));
  if (rule.isEmpty())
    say("open", NoticeBar::Level::info, tr("The cloth is now made of the mesh %1.").arg(file));
  else
    say("open", NoticeBar::Level::error, tr("The mesh was not opened.\n%1 %2").arg(file, rule));
  return rule.isEmpty();
}

bool LabWindow::loadStudy(const QString& folder) {
  studies_->openFolder(folder);
  showStudies();
  return true;
}

void LabWindow::openRun(const cloth::Scene& scene, const QString& note) {
  if (!mayLoseChanges()) return;
  document_.load(scene);
  say("run", NoticeBar::Level::info, note);
}

void LabWindow::offerUnsaved() {
  for (const LeftFile& file : Autosave::found()) {
    const QFileInfo left(file.path);
    const QString kind = "unsaved " + left.fileName();
    const QString when = QLocale().toString(left.lastModified(), QLocale::ShortFormat);
    notice_->show(kind, NoticeBar::Level::warning,
                  tr("Clothlab ended without saving. Changes of %1 were kept.").arg(when),
                  {{tr("Restore"), [this, file] { restore(file.path); }},
                   {tr("Discard"), [file] { QFile::remove(file.path); }}});
  }
}

void LabWindow::restore(const QString& file) {
  const bool is_comparison = type_of(file) == FileType::comparison;
  const OpenedScene scene = is_comparison ? OpenedScene() : open_scene(file);
  const OpenedComparison comparison = is_comparison ? open_comparison(file) : OpenedComparison();
  if (!isSound(tr("document"), scene.problems + comparison.problems) || !mayLoseChanges()) return;
  if (is_comparison)
    document_.load(*comparison.comparison, {}, true);
  else
    document_.load(*scene.scene, {}, true);
  autosave_->save();  // from here on this window keeps it
  QFile::remove(file);
}

void LabWindow::openWithDialog() {
  const QString start = document_.path().isEmpty() ? last_folder("open") : document_.path();
  const QString path = QFileDialog::getOpenFileName(this, tr("Open"), start, open_filter());
  if (path.isEmpty()) return;
  remember_folder("open", path);
  open(path);
}

void LabWindow::dragEnterEvent(QDragEnterEvent* event) {
  const auto urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void LabWindow::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  open(event->mimeData()->urls().front().toLocalFile());
}

bool LabWindow::saveAs() {
  const FileKind kind = document_.isComparison() ? comparison_kind() : scene_kind();
  const QString path = ask_where_to_save(this, tr("Save the %1").arg(what()), {kind}, document_.path());
  return !path.isEmpty() && saveTo(path);
}

bool LabWindow::saveTo(const QString& path) {
  const QString problem = document_.isComparison() ? save_comparison_file(document_.comparison(), path)
                                                   : save_scene_file(document_.scene(), path);
  if (problem.isEmpty()) (document_.isComparison() ? recent_comparisons : recent_scenes).remember(path);
  const bool saved = saySaved(what(), path, problem);
  if (saved) document_.markSaved(path);
  return saved;
}

void LabWindow::saveSessionAs() {
  const QString path = ask_where_to_save(this, tr("Save the session"), {session_kind()});
  if (!path.isEmpty()) saveSession(path);
}

void LabWindow::saveSession(const QString& path) {
  saving_session_ = path;
  link_.send(command::SaveSession{path.toStdString()});
}

void LabWindow::saveCharts() {
  ChartArea* shown = shows_comparison_ ? static_cast<ChartArea*>(pane_charts_) : charts_;
  saveByDialog(tr("charts"), ChartArea::kinds(), [this, shown](const QString& path) {
    return suffix_of(path) == ".csv" ? writePoints(shown->csvWriter(path)) : shown->save(path);
  });
}

/// There may be a million of them. Empty, or what went wrong.
QString LabWindow::writePoints(std::function<QString(const std::stop_token&)> write) {
  const auto problem = std::make_shared<QString>();
  const BesideResult result = beside_the_window(
      this, tr("Writing the points of the charts"),
      [problem, write = std::move(write)](const std::stop_token& stop) { *problem = write(stop); });
  return result.stopped ? tr("It was stopped.") : result.failure.isEmpty() ? *problem : result.failure;
}

/// Asks for a path, calls `write` and shows where it wrote, or the error that it returned. `what`: "picture".
bool LabWindow::saveByDialog(const QString& what, const std::vector<FileKind>& kinds,
                             const std::function<QString(const QString& path)>& write) {
  const QString path = ask_where_to_save(this, tr("Save the %1").arg(what), kinds);
  return !path.isEmpty() && saySaved(what, path, write(path));
}

/// Shows that `what` was saved, or the problem; true if there is none.
bool LabWindow::saySaved(const QString& what, const QString& path, const QString& problem) {
  if (problem.isEmpty())
    say("save " + what, NoticeBar::Level::info, saved_in(what, path));
  else
    say("save " + what, NoticeBar::Level::error, tr("The %1 was not saved. %2").arg(what, problem));
  return problem.isEmpty();
}

/// Shows a message, or withdraws the one of this kind if the text is empty.
void LabWindow::say(const QString& kind, NoticeBar::Level level, const QString& text) {
  if (text.isEmpty())
    notice_->withdraw(kind);
  else
    notice_->show(kind, level, text);
}

void LabWindow::updateTitle() {
  const QString pattern =
      document_.isComparison() ? tr("%1[*] – Comparison – Clothlab") : QStringLiteral("%1[*] – Clothlab");
  setWindowTitle(pattern.arg(document_.title()));
  setWindowModified(document_.isModified());
}

/// Asks to save, discard or cancel. Returns false if the user cancelled or saving failed.
bool LabWindow::mayLoseChanges() {
  if (!asks_to_save_ || !document_.isModified()) return true;
  comeForward();
  const auto answer = QMessageBox::question(
      this, tr("Unsaved changes"), tr("The %1 \"%2\" was changed. Save it?").arg(what(), document_.title()),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save());
}

bool LabWindow::mayStopStudy() {
  if (!studies_->isRunning()) return true;
  comeForward();
  return QMessageBox::question(this, tr("A study is running"),
                               tr("A study is running. Stop it and close? What is finished is kept."),
                               QMessageBox::Close | QMessageBox::Cancel,
                               QMessageBox::Cancel) == QMessageBox::Close;
}

/// Brings the window to the front, so that its question is visible.
void LabWindow::comeForward() {
  if (isMinimized()) showNormal();
  raise();
  activateWindow();
}

void LabWindow::closeEvent(QCloseEvent* event) {
  if (!std::exchange(may_close_, false) && !mayClose()) return event->ignore();
  link_.send(command::Pause{});
  link_.send(command::StopRecording{});
  studies_->stop();
  autosave_->forget();
  remember();
  event->accept();
}

std::vector<LabWindow*> LabWindow::all() {
  std::vector<LabWindow*> windows;
  for (QWidget* top : QApplication::topLevelWidgets())
    if (auto* window = qobject_cast<LabWindow*>(top)) windows.push_back(window);
  return windows;
}

LabWindow* LabWindow::showNew() {
  auto* window = new LabWindow;
  window->setAttribute(Qt::WA_DeleteOnClose);
  window->show();
  return window;
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

void open_first_window(const QString& name) {
  LabWindow* window = LabWindow::showNew();
  window->offerUnsaved();
  const bool replaces = type_of(name) == FileType::scene || type_of(name) == FileType::comparison;
  if (!name.isEmpty() && replaces && window->open(name)) return;
  window->document().load(*open_scene(cloth::default_scene_name).scene);
  if (!name.isEmpty() && !replaces) window->open(name);
}

}  // namespace clothlab
