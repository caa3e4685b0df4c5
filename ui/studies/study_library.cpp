#include "studies/study_library.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>

#include "document/result_files.h"

namespace clothlab {
namespace {

constexpr int most_recent = 12;
const char* const recent_key = "recentStudies";

}  // namespace

QString new_study_folder(const QString& kind, const QString& title) {
  return new_folder(studies_folder(), {kind, title});
}

QString studies_folder() {
  return QDir(results_folder()).filePath("studies");
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
