// The Save dialog of all windows, for every type of file.
#pragma once

#include <QString>
#include <QStringList>
#include <vector>

class QWidget;

namespace clothlab {

/// An entry of a dialog's list of file types: "Clothlab scenes" with the suffixes ".scene.json" and ".json".
/// The first suffix is appended to a name without one.
struct FileKind {
  QString name;
  QStringList suffixes;

  QString filter() const;  ///< "Clothlab scenes (*.scene.json *.json)"
};

/// The suffix of a file's name in lower case, as ".png" or ".scene.json"; empty for "wind 0.5".
QString suffix_of(const QString& path);

/// Asks for a path; empty: the user cancelled. A suffix that is not in `kinds` is refused with a message that
/// names those that are; a file that has the final name already is replaced only after a question. After a
/// refusal or a No the dialog is shown again.
QString ask_where_to_save(QWidget* parent, const QString& title, const std::vector<FileKind>& kinds,
                          const QString& suggestion = {});

/// The message after saving: "Saved the scene in /home/anna/flag.scene.json".
QString saved_in(const QString& what, const QString& path);

}  // namespace clothlab
