// Where scenes, sessions and comparisons come from: files, the built-in ones, and those that were open
// lately.
#pragma once

#include <QString>
#include <optional>

#include "bridge/frame.h"
#include "compare/comparison.h"
#include "document/result_files.h"
#include "simulation/session.h"

namespace clothlab {

/// A scene, or why there is none, in words for a person.
struct OpenedScene {
  std::optional<cloth::Scene> scene;
  std::optional<cloth::Session> session;  ///< the file's, where it is a session; `scene` is its start then
  QString path;                           ///< of the file; empty for a built-in scene
  QString problems;                       ///< every problem, a line each
};

/// `name` is a file, of a scene or a session (docs/sessions.md), or a built-in scene, as on the command line.
OpenedScene open_scene(const QString& name);

/// Empty when done, else what went wrong.
QString save_scene_file(const cloth::Scene& scene, const QString& path);

extern const RecentPaths recent_scenes;  ///< files

/// A comparison, or why there is none, in words for a person.
struct OpenedComparison {
  std::optional<cloth::Comparison> comparison;
  QString path;      ///< of the file; empty for a built-in one
  QString problems;  ///< every problem, a line each
};

/// `name` is a file or a built-in comparison, as on the command line.
OpenedComparison open_comparison(const QString& name);

/// Empty when done, else what went wrong.
QString save_comparison_file(const cloth::Comparison& comparison, const QString& path);

/// Whether a file of this name is taken for a comparison rather than for a scene.
bool is_comparison_name(const QString& name);

/// The scene as it is, beside the same with two other methods; these choose their step themselves where the
/// scene's is beyond their limit.
cloth::Comparison comparison_of_scene(const cloth::Scene& scene);

/// Writes a frame's cloth as an OBJ file: vertices in m, single precision as the view has them, normals,
/// triangles, and texture coordinates of a grid. Empty when done, else what went wrong.
QString save_cloth_file(const ClothFrame& frame, const QString& title, const QString& path);

}  // namespace clothlab
