// The default folder of results, recently used paths, and writing a file.
#pragma once

#include <QByteArray>
#include <QString>
#include <QStringList>

namespace clothlab {

/// The folder for results inside the user's documents folder.
QString results_folder();

/// The path of a folder in `parent` that does not exist yet, named after the present time and `words`.
/// Creates nothing.
QString new_folder(const QString& parent, const QStringList& words);

/// Recently opened or saved paths, stored in QSettings under `key`, at most `most`.
struct RecentPaths {
  const char* key;
  int most;
  bool (*holds)(const QString& path);  ///< whether `path` still exists and has the right kind of content

  QStringList list() const;  ///< newest first
  void remember(const QString& path) const;
};

/// The folder that a dialog for this kind of file was last used in, stored in QSettings; empty: none yet.
QString last_folder(const QString& kind);
/// Of a file that was chosen in the dialog.
void remember_folder(const QString& kind, const QString& path);

/// Writes a file atomically: after an error the old file is unchanged. Returns the error; empty on success.
QString write_file(const QString& path, const QByteArray& bytes);

}  // namespace clothlab
