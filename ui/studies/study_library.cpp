#include "studies/study_library.h"

#include <QDir>
#include <QFileInfo>

namespace clothlab {

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

const RecentPaths recent_studies{"recentStudies", 12, [](const QString& folder) {
                                   return QFileInfo::exists(QDir(folder).filePath("study.json")) ||
                                          QFileInfo::exists(QDir(folder).filePath("sweep.json")) ||
                                          QFileInfo::exists(QDir(folder).filePath("identified.json"));
                                 }};

}  // namespace clothlab
