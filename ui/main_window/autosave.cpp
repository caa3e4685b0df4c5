#include "main_window/autosave.h"

#include <QCoreApplication>
#include <QDir>
#include <QStandardPaths>
#include <utility>

#include "document/lab_document.h"
#include "main_window/lab_files.h"

namespace clothlab {
namespace {

constexpr int interval = 30'000;  // ms

/// "/folder/123-1.scene.json" -> "/folder/123-1.lock"
QString lock_of(const QString& file) {
  return file.left(file.size() - suffix_of(file).size()) + ".lock";
}

}  // namespace

Autosave::Autosave(LabDocument& document, QObject* parent) : QObject(parent), document_(document) {
  timer_.setSingleShot(true);
  timer_.setInterval(interval);
  connect(&timer_, &QTimer::timeout, this, &Autosave::save);
  connect(&document_, &LabDocument::sceneChanged, this, [this] {
    if (!timer_.isActive()) timer_.start();
  });
  connect(&document_, &LabDocument::modifiedChanged, this, [this](bool modified) {
    if (!modified) forget();
  });
  connect(&document_, &LabDocument::loaded, this, [this] {
    forget();
    if (document_.isModified()) timer_.start();
  });
}

QString Autosave::folder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/unsaved";
}

std::vector<LeftFile> Autosave::found() {
  std::vector<LeftFile> files;
  const QDir folder(Autosave::folder(), "*.json", QDir::Time | QDir::Reversed, QDir::Files);
  for (const QString& name : folder.entryList()) {
    const QString path = folder.filePath(name);
    auto lock = std::make_shared<QLockFile>(lock_of(path));
    lock->setStaleLockTime(0);  // however old: only whether its process lives counts
    // Between listing and locking, another program may have restored or discarded the file.
    if (lock->tryLock(0) && QFile::exists(path)) files.push_back({path, lock});
  }
  return files;
}

void Autosave::save() {
  if (!document_.isModified()) return forget();
  QDir().mkpath(folder());
  static int windows = 0;
  const QString suffix = document_.isComparison() ? ".compare.json" : ".scene.json";
  if (!file_.endsWith(suffix)) {
    forget();
    const QString process = QStringLiteral("%1/%2-").arg(folder()).arg(QCoreApplication::applicationPid());
    do file_ = process + QString::number(++windows) + suffix;
    while (QFile::exists(file_));  // left by an earlier process of the same number
    lock_ = std::make_unique<QLockFile>(lock_of(file_));
    lock_->setStaleLockTime(0);
    lock_->tryLock(0);
  }
  const QString problem = document_.isComparison() ? save_comparison_file(document_.comparison(), file_)
                                                   : save_scene_file(document_.scene(), file_);
  const bool had_failed = std::exchange(has_failed_, !problem.isEmpty());
  if (has_failed_ && !had_failed) Q_EMIT failed(problem);
}

void Autosave::forget() {
  timer_.stop();
  if (!file_.isEmpty()) QFile::remove(std::exchange(file_, {}));
  lock_.reset();
}

}  // namespace clothlab
