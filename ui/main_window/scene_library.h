// Where scenes and sessions come from: files, the built-in ones, and those that were open lately.
#pragma once

#include <QString>
#include <QStringList>
#include <optional>

#include "simulation/session.h"

namespace clothlab {

/// A scene, or why there is none, in words for a person.
struct OpenedScene {
  std::optional<cloth::Scene> scene;
  std::optional<cloth::Session> session;  ///< the file's, where it is a session; `scene` is its start then
  QString path;                           ///< of the file; empty for a built-in scene
  QString problems;                       ///< every problem, a line each
};

/// A scene, or a session (docs/sessions.md), which its text tells.
OpenedScene open_scene_file(const QString& path);

/// `name` is a file or a built-in scene, as on the command line.
OpenedScene open_scene(const QString& name);

/// Empty when done, else what went wrong.
QString save_scene_file(const cloth::Scene& scene, const QString& path);

/// The files opened or saved last, newest first, those that still exist.
QStringList recent_scenes();
void remember_scene(const QString& path);

}  // namespace clothlab
