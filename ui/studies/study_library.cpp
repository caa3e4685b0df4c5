#include "studies/study_library.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>

namespace clothlab {
namespace {

constexpr int most_recent = 12;
const char* const recent_key = "recentStudies";

QString plain(const QString& text) {
  QString name;
  for (const QChar c : text.toLower()) name += c.isLetterOrNumber() ? c : QChar('-');
  while (name.contains("--")) name.replace("--", "-");
  return name.left(40);
}

}  // namespace

QString studies_folder() {
  return QDir(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation))
      .filePath("Clothlab/studies");
}

QString new_study_folder(const QString& kind, const QString& title) {
  const QString stamp = QDateTime::currentDateTime().toString("yyyy-MM-dd-HHmmss");
  const QString base = QDir(studies_folder()).filePath(stamp + "-" + plain(kind) + "-" + plain(title));
  QString folder = base;
  for (int copy = 2; QFileInfo::exists(folder); ++copy) folder = base + "-" + QString::number(copy);
  return folder;
}

QString shown_path(const QString& path) {
  const QString home = QDir::homePath();
  const bool within = path == home || path.startsWith(home + '/');
  return QDir::toNativeSeparators(within ? "~" + path.mid(home.size()) : path);
}

QString path_from(const QString& shown) {
  return shown == "~" || shown.startsWith("~/") ? QDir::homePath() + shown.mid(1) : shown;
}

QStringList recent_studies() {
  QStringList existing;
  for (const QString& folder : QSettings().value(recent_key).toStringList())
    if (QFileInfo::exists(QDir(folder).filePath("study.json"))) existing << folder;
  return existing;
}

void remember_study(const QString& folder) {
  const QString absolute = QFileInfo(folder).absoluteFilePath();
  QStringList recent = recent_studies();
  recent.removeAll(absolute);
  recent.prepend(absolute);
  QSettings().setValue(recent_key, QStringList(recent.mid(0, most_recent)));
}

}  // namespace clothlab
