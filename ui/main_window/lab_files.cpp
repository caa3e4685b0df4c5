#include "main_window/lab_files.h"

#include <QBuffer>
#include <QDir>
#include <QFileInfo>
#include <QObject>

#include "analysis/fit_report.h"
#include "cloth/cloth_obj.h"
#include "cloth/mesh_cloth.h"
#include "compare/builtin_comparisons.h"
#include "compare/comparison_json.h"
#include "contact/start_check.h"
#include "io/obj_writer.h"
#include "io/text_file.h"
#include "io/user_file.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "simulation/session_json.h"
#include "study/study_folder.h"

namespace clothlab {
namespace {

constexpr int most_recent = 8;

bool is_there(const QString& path) {
  return QFileInfo::exists(path);
}

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

OpenedComparison read_comparison_text(const std::string& text, const std::string& place,
                                      const QString& path) {
  cloth::ComparisonReading reading = cloth::read_comparison(text, place, {}, folder_of(path));
  return {std::move(reading.comparison), path, lines_of(reading.problems)};
}

QString text_of(const std::optional<cloth::IoError>& error) {
  return error ? QString::fromStdString(error->text()) : QString();
}

/// A format without its version, as it stands in a file.
bool says(const std::string& text, std::string format) {
  format.erase(format.rfind('/') + 1);
  return text.find('"' + format) != std::string::npos;
}

/// By custom a session's name tells; where it does not, its first key does.
bool is_session(const std::string& text, const QString& path) {
  return suffix_of(path) == ".session.json" || says(text, cloth::session_format);
}

OpenedScene read_session_text(const std::string& text, const std::string& place, const QString& path) {
  cloth::SessionReading reading = cloth::read_session(text, place, folder_of(path));
  OpenedScene opened{{}, std::move(reading.session), path, lines_of(reading.problems)};
  if (opened.session) opened.scene = opened.session->scene;
  return opened;
}

std::vector<cloth::Triangle> triangles_of(const ClothFrame& frame) {
  if (frame.mesh) return frame.mesh->surface.triangles;
  cloth::ClothSystem grid;
  grid.rows = frame.rows;
  grid.columns = frame.columns;
  return cloth::triangles_of(grid);
}

/// A missing file has the type that its name promises, so that the message names what was looked for.
FileType type_by_text(const QString& name) {
  if (!QFileInfo(name).isFile())
    return cloth::find_builtin_comparison(name.toStdString()) ? FileType::comparison : FileType::scene;
  std::string text;
  cloth::read_text_file(name.toStdString(), text);  // whoever opens it says what is wrong
  if (says(text, cloth::comparison_format)) return FileType::comparison;
  const bool is_study = says(text, cloth::study_format) || says(text, cloth::fit_format);
  return is_study ? FileType::study : FileType::scene;
}

}  // namespace

FileType type_of(const QString& name) {
  for (const char* index : {"study.json", "sweep.json", cloth::fit_index_name})
    if (QDir(name).exists(index)) return FileType::study;
  const QString suffix = suffix_of(name);
  if (suffix == ".obj") return FileType::mesh;
  if (comparison_kind().suffixes.front() == suffix) return FileType::comparison;
  if (scene_kind().suffixes.front() == suffix || session_kind().suffixes.front() == suffix)
    return FileType::scene;
  return type_by_text(name);
}

QString open_filter() {
  const FileKind mesh{QObject::tr("Meshes"), {".obj"}};
  FileKind all{QObject::tr("All that Clothlab opens"), {}};
  QStringList filters;
  for (const FileKind& kind : {scene_kind(), session_kind(), comparison_kind(), mesh}) {
    all.suffixes << kind.suffixes;
    filters << kind.filter();
  }
  all.suffixes.removeDuplicates();
  return QStringList{all.filter(), filters.join(";;"), QObject::tr("All files (*)")}.join(";;");
}

FileKind scene_kind() {
  return {QObject::tr("Clothlab scenes"), {".scene.json", ".json"}};
}

FileKind session_kind() {
  return {QObject::tr("Clothlab sessions"), {".session.json"}};
}

FileKind comparison_kind() {
  return {QObject::tr("Clothlab comparisons"), {".compare.json", ".json"}};
}

OpenedScene open_scene(const QString& name) {
  if (const QFileInfo file(name); file.isFile()) {
    std::string text;
    if (const auto error = cloth::read_text_file(name.toStdString(), text))
      return {{}, {}, name, QString::fromStdString(error->text())};
    const auto read = is_session(text, name) ? read_session_text : read_text;
    return read(text, file.fileName().toStdString(), file.absoluteFilePath());
  }
  if (const cloth::BuiltinScene* builtin = cloth::find_builtin_scene(name.toStdString()))
    return read_text(builtin->text, builtin->name, {});
  const QString why = QFileInfo(name).isDir()
                          ? QObject::tr(
                                "%1: is a folder without a study: there is no study.json, sweep.json or "
                                "identified.json in it")
                          : QObject::tr("%1: there is neither a file nor a built-in scene of this name");
  return {{}, {}, name, why.arg(name)};
}

QString save_scene_file(const cloth::Scene& scene, const QString& path) {
  return text_of(cloth::write_text_file(path.toStdString(),
                                        cloth::write_scene(moved_to_folder(scene, folder_of(path).path))));
}

const RecentPaths recent_scenes{"recentScenes", most_recent, is_there},
    recent_sessions{"recentSessions", most_recent, is_there},
    recent_comparisons{"recentComparisons", most_recent, is_there};

OpenedComparison open_comparison(const QString& name) {
  const QFileInfo file(name);
  if (file.isFile()) {
    std::string text;
    if (const auto error = cloth::read_text_file(name.toStdString(), text))
      return {std::nullopt, name, QString::fromStdString(error->text())};
    return read_comparison_text(text, file.fileName().toStdString(), file.absoluteFilePath());
  }
  if (const cloth::BuiltinComparison* builtin = cloth::find_builtin_comparison(name.toStdString()))
    return read_comparison_text(builtin->text, builtin->name, {});
  return {std::nullopt, name,
          QObject::tr("%1: there is neither a file nor a built-in comparison of this name").arg(name)};
}

QString save_comparison_file(const cloth::Comparison& comparison, const QString& path) {
  return text_of(cloth::write_text_file(
      path.toStdString(), cloth::write_comparison(moved_to_folder(comparison, folder_of(path).path))));
}

cloth::Comparison comparison_of_scene(const cloth::Scene& scene) {
  constexpr std::size_t panes = 3;
  std::vector<std::string> methods{scene.integrator.method};
  for (const char* method : {"verlet", "semi-implicit-euler", "rk4"})
    if (methods.size() < panes && methods.front() != method) methods.emplace_back(method);
  cloth::Comparison comparison{.title = {}, .scene = scene, .panes = cloth::panes_for(methods)};
  const auto& step = scene.integrator.time_step;
  for (cloth::Pane& pane : comparison.panes) {
    const std::string& method = std::get<std::string>(pane.own.front().value);
    const bool too_long = step && cloth::stable_step(method, scene).value_or(0) <= *step;
    if (too_long && method != scene.integrator.method)
      set_own(pane, "integrator.time_step", std::string("auto"));
  }
  return comparison;
}

QString save_cloth_file(const ClothFrame& frame, const QString& title, const QString& path) {
  const std::vector<cloth::Triangle> triangles = triangles_of(frame);
  cloth::ObjSurface<float> surface;
  surface.positions = frame.positions;
  surface.normals = frame.normals;
  surface.texture = cloth::grid_texture<float>(frame.rows, frame.columns);
  surface.triangles = triangles;
  const std::string text = cloth::obj_text(surface, cloth::title_at(title.toStdString(), frame.time));
  const auto error = cloth::write_user_file(path.toStdString(), text);
  return text_of(error);
}

QString save_picture_file(const QImage& picture, const QString& path) {
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  if (!picture.save(&buffer, suffix_of(path) == ".png" ? "PNG" : "JPG"))
    return QObject::tr("%1: the picture could not be encoded").arg(path);
  const QString problem = write_file(path, bytes);
  return problem.isEmpty() ? problem : QStringLiteral("%1: %2").arg(path, problem);
}

}  // namespace clothlab
