// Where results go that were given no folder, and how a file is written.
#pragma once

#include <QByteArray>
#include <QString>
#include <QStringList>

namespace clothlab {

/// In the user's documents.
QString results_folder();

/// The path of a folder in `parent` that is not there yet, named by the time and `words`.
QString new_folder(const QString& parent, const QStringList& words);

/// Paths that were opened or saved lately, kept in the settings.
struct RecentPaths {
  const char* key;
  int most;
  bool (*holds)(const QString& path);  ///< whether there still is at `path` what was there

  QStringList list() const;  ///< newest first
  void remember(const QString& path) const;
};

/// Writes a file that is old or new, never half. What went wrong; empty if nothing did.
QString write_file(const QString& path, const QByteArray& bytes);

}  // namespace clothlab
