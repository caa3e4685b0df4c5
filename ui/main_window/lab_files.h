// Opens and saves scenes, sessions, comparisons and pictures: files, built-in ones and recent ones.
#pragma once

#include <QImage>
#include <QString>
#include <optional>

#include "bridge/frame.h"
#include "compare/comparison.h"
#include "document/result_files.h"
#include "document/save_dialog.h"
#include "simulation/session.h"

namespace clothlab {

/// The types of files that the program opens. A session opens as a scene.
enum class FileType { scene, comparison, mesh, study };

/// The type of a file, of a study's folder, or of a built-in scene or comparison with this name. The suffix
/// decides; where it does not, as for `comparison.json` in a results folder, the content does.
FileType type_of(const QString& name);

/// The name filters of the Open dialog.
QString open_filter();

FileKind scene_kind();
FileKind session_kind();
FileKind comparison_kind();

/// A scene, or the errors that prevented opening it.
struct OpenedScene {
  std::optional<cloth::Scene> scene;
  std::optional<cloth::Session> session;  ///< set if the file is a session; `scene` is then its first scene
  QString path;                           ///< of the file; empty for a built-in scene
  QString problems;                       ///< every problem, a line each
};

/// `name` is a file, of a scene or a session (docs/sessions.md), or a built-in scene, as on the command line.
OpenedScene open_scene(const QString& name);

/// Empty when done, else what went wrong.
QString save_scene_file(const cloth::Scene& scene, const QString& path);

extern const RecentPaths recent_scenes, recent_sessions, recent_comparisons;  ///< files

/// A comparison, or the errors that prevented opening it.
struct OpenedComparison {
  std::optional<cloth::Comparison> comparison;
  QString path;      ///< of the file; empty for a built-in one
  QString problems;  ///< every problem, a line each
};

/// `name` is a file or a built-in comparison, as on the command line.
OpenedComparison open_comparison(const QString& name);

/// Empty when done, else what went wrong.
QString save_comparison_file(const cloth::Comparison& comparison, const QString& path);

/// A comparison of the scene with two copies that use other methods. A copy uses the time step `auto` if the
/// scene's step is not stable for its method.
cloth::Comparison comparison_of_scene(const cloth::Scene& scene);

/// Writes a frame's cloth as an OBJ file: vertices in m, single precision as the view has them, normals,
/// triangles, and texture coordinates of a grid. Empty when done, else what went wrong.
QString save_cloth_file(const ClothFrame& frame, const QString& title, const QString& path);

/// Saves as PNG or JPEG, by the path's suffix. Empty when done, else what went wrong.
QString save_picture_file(const QImage& picture, const QString& path);

}  // namespace clothlab
