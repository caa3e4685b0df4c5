#include "document/recording_folder.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QStandardPaths>

namespace clothlab {

QString new_recording_folder(const QString& title) {
  QString name;
  for (const QChar c : title.toLower()) name += c.isLetterOrNumber() ? c : QChar('-');
  while (name.contains("--")) name.replace("--", "-");
  const QString stamp = QDateTime::currentDateTime().toString("yyyy-MM-dd-HHmmss");
  const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  const QString base = QDir(documents).filePath("Clothlab/" + stamp + "-" + name.left(40));
  QString folder = base;
  for (int copy = 2; QFileInfo::exists(folder); ++copy) folder = base + "-" + QString::number(copy);
  return folder;
}

}  // namespace clothlab
