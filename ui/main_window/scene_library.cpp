#include "main_window/scene_library.h"

#include <QFileInfo>
#include <QSettings>

#include "contact/start_check.h"
#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "simulation/session_json.h"

namespace clothlab {
namespace {

constexpr int most_recent = 8;
const char* const recent_key = "recentScenes";

QString lines_of(const std::vector<cloth::Problem>& problems) {
  QStringList lines;
  for (const cloth::Problem& problem : problems) lines << QString::fromStdString(problem.text());
  return lines.join('\n');
}

/// Where the meshes of a scene at `path` are found; a built-in scene has no path.
cloth::SceneFolder folder_of(const QString& path) {
  if (path.isEmpty()) return {.path = "", .built_in = true};
  return {QFileInfo(path).absolutePath().toStdString()};
}

OpenedScene read_text(const std::string& text, const std::string& place, const QString& path) {
  cloth::SceneReading reading = cloth::read_runnable_scene(text, place, {}, {folder_of(path)});
  return {std::move(reading.scene), {}, path, lines_of(reading.problems)};
}

/// By custom a session's name tells; where it does not, its first key does.
bool is_session(const std::string& text, const QString& path) {
  return path.endsWith(".session.json") || text.find("\"clothlab/session/") != std::string::npos;
}

OpenedScene read_session_text(const std::string& text, const std::string& place, const QString& path) {
  cloth::SessionReading reading = cloth::read_session(text, place, folder_of(path));
  OpenedScene opened{{}, std::move(reading.session), path, lines_of(reading.problems)};
  if (opened.session) opened.scene = opened.session->scene;
  return opened;
}

}  // namespace

OpenedScene open_scene_file(const QString& path) {
  std::string text;
  if (const auto error = cloth::read_text_file(path.toStdString(), text))
    return {{}, {}, path, QString::fromStdString(error->text())};
  const QFileInfo file(path);
  const auto read = is_session(text, path) ? read_session_text : read_text;
  return read(text, file.fileName().toStdString(), file.absoluteFilePath());
}

OpenedScene open_scene(const QString& name) {
  if (QFileInfo::exists(name)) return open_scene_file(name);
  if (const cloth::BuiltinScene* builtin = cloth::find_builtin_scene(name.toStdString()))
    return read_text(builtin->text, builtin->name, {});
  return {
      {}, {}, name, QObject::tr("%1: there is neither a file nor a built-in scene of this name").arg(name)};
}

QString save_scene_file(const cloth::Scene& scene, const QString& path) {
  const auto error = cloth::write_text_file(path.toStdString(),
                                            cloth::write_scene(moved_to_folder(scene, folder_of(path).path)));
  return error ? QString::fromStdString(error->text()) : QString();
}

QStringList recent_scenes() {
  QStringList existing;
  for (const QString& path : QSettings().value(recent_key).toStringList())
    if (QFileInfo::exists(path)) existing << path;
  return existing;
}

void remember_scene(const QString& path) {
  QStringList recent = recent_scenes();
  const QString absolute = QFileInfo(path).absoluteFilePath();
  recent.removeAll(absolute);
  recent.prepend(absolute);
  QSettings().setValue(recent_key, QStringList(recent.mid(0, most_recent)));
}

}  // namespace clothlab
