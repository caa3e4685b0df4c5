#include "document/result_files.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>

#include "io/user_file.h"

namespace clothlab {
namespace {

QString plain(const QString& text) {
  QString name;
  for (const QChar c : text.toLower()) name += c.isLetterOrNumber() ? c : QChar('-');
  while (name.contains("--")) name.replace("--", "-");
  return name.left(40);
}

}  // namespace

QString results_folder() {
  return QDir(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation)).filePath("Clothlab");
}

QString new_folder(const QString& parent, const QStringList& words) {
  QString name = QDateTime::currentDateTime().toString("yyyy-MM-dd-HHmmss");
  for (const QString& word : words)
    if (!word.isEmpty()) name += "-" + plain(word);
  const QString base = QDir(parent).filePath(name);
  QString folder = base;
  for (int copy = 2; QFileInfo::exists(folder); ++copy) folder = base + "-" + QString::number(copy);
  return folder;
}

QStringList RecentPaths::list() const {
  QStringList paths = QSettings().value(key).toStringList();
  paths.removeIf([this](const QString& path) { return !holds(path); });
  return paths;
}

void RecentPaths::remember(const QString& path) const {
  const QString absolute = QFileInfo(path).absoluteFilePath();
  QStringList paths = list();
  paths.removeAll(absolute);
  paths.prepend(absolute);
  QSettings().setValue(key, QStringList(paths.mid(0, most)));
}

QString last_folder(const QString& kind) {
  const QString folder = QSettings().value("folders/" + kind).toString();
  return QFileInfo(folder).isDir() ? folder : QString();
}

void remember_folder(const QString& kind, const QString& path) {
  QSettings().setValue("folders/" + kind, QFileInfo(path).absolutePath());
}

QString write_file(const QString& path, const QByteArray& bytes) {
  const auto error = cloth::write_user_file(path.toStdString(), bytes.toStdString());
  return error ? QString::fromStdString(error->message) : QString();
}

}  // namespace clothlab
