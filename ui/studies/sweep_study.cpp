#include "studies/sweep_study.h"

#include <QDir>
#include <QFileInfo>
#include <utility>

#include "simulation/step_batches.h"
#include "studies/study_library.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr std::chrono::milliseconds look_interval{500};
constexpr int most_watched = 64;  // files, of which the system has not many to give

QString remaining(double seconds) {
  const int whole = static_cast<int>(std::ceil(seconds));
  return whole < 60 ? QObject::tr("%1 s").arg(whole)
                    : QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60, 2, 10, QChar('0'));
}

}  // namespace

SweepStudy::SweepStudy() {
  connect(&files_, &QFileSystemWatcher::fileChanged, this, [this] { watch_.look(); });
  connect(&files_, &QFileSystemWatcher::directoryChanged, this, [this] {
    watchFiles();
    watch_.look();
  });
}

bool SweepStudy::isSweep(const QString& folder) {
  return QFileInfo::exists(QDir(folder).filePath(cloth::sweep_index_name));
}

void SweepStudy::start(SweepOrder order) {
  const QString folder = QString::fromStdString(order.folder.string());
  view_.reset();
  runner_.start(std::move(order), cloth::machine_threads());
  was_running_ = true;
  follow(folder);
}

void SweepStudy::goOn() {
  if (!isShown() || isRunning()) return;
  runner_.start({.folder = folder_.toStdString()}, cloth::machine_threads());
  was_running_ = true;
  follow(folder_);
}

void SweepStudy::open(const QString& folder) {
  if (folder != folder_) view_.reset();
  was_running_ = false;
  follow(folder);
}

void SweepStudy::follow(const QString& folder) {
  folder_ = folder;
  if (const QStringList before = files_.files() + files_.directories(); !before.isEmpty())
    files_.removePaths(before);
  watchFiles();
  watch_.follow(folder.toStdString(), look_interval);
}

/// Files that come to be are found by the watch's own looks, too.
void SweepStudy::watchFiles() {
  const QString shards = QDir(folder_).filePath(cloth::shard_folder_name);
  if (!QFileInfo::exists(shards)) return;
  QStringList wanted{shards};
  for (const QFileInfo& file : QDir(shards).entryInfoList(QDir::Files, QDir::Time).mid(0, most_watched))
    wanted << file.filePath();
  const QStringList watched = files_.files() + files_.directories();
  wanted.removeIf([&](const QString& path) { return watched.contains(path); });
  if (!wanted.isEmpty()) files_.addPaths(wanted);
}

void SweepStudy::leave() {
  watch_.stop();
  if (const QStringList before = files_.files() + files_.directories(); !before.isEmpty())
    files_.removePaths(before);
  folder_.clear();
  view_.reset();
}

void SweepStudy::stop() {
  runner_.cancel();
  runner_.wait();
}

QString SweepStudy::problem() const {
  const SweepStatus now = status();
  if (was_running_ && !now.running && !now.problem.empty()) return sentence_text(now.problem);
  // While it begins here there may be no folder yet.
  return now.running && !view_ ? QString() : sentence_text(watch_.problem());
}

bool SweepStudy::isFollowed() const {
  return isShown() && (isRunning() || !view_ || view_->results.missing() > 0);
}

bool SweepStudy::poll() {
  if (const auto done = status().done; isRunning() && std::exchange(done_, done) != done) watch_.look();
  auto newest = watch_.take();
  if (!newest) return false;
  view_ = std::move(newest);
  if (files_.files().isEmpty()) watchFiles();
  return true;
}

QString SweepStudy::title() const {
  if (!view_) return QObject::tr("Sweep");
  const cloth::SweepPlan& plan = view_->folder.plan;
  return QObject::tr("Sweep: %1")
      .arg(QString::fromStdString(plan.title.empty() ? plan.scene.title : plan.title));
}

QString SweepStudy::summary() const {
  if (!view_) return QObject::tr("The folder is being read");
  const cloth::SweepResults& results = view_->results;
  const auto finished = results.counts[static_cast<std::size_t>(cloth::PointStatus::finished)];
  const std::int64_t failed = std::ssize(results.rows) - finished;
  QString text = results.missing() > 0
                     ? QObject::tr("%1 of %2 points").arg(results.rows.size()).arg(results.points)
                     : QObject::tr("%1 points").arg(results.points);
  if (failed > 0) text += QObject::tr(", %1 failed").arg(failed);
  if (!results.disagreements.empty())
    text += QObject::tr(". Two attempts disagree: %1")
                .arg(QString::fromStdString(results.disagreements.front().text));
  text += QObject::tr(", in %1").arg(shown_path(folder_));
  if (results.missing() > 0) text += QObject::tr(". New rows are shown as they come");
  return text;
}

QString SweepStudy::progress() const {
  const SweepStatus now = status();
  if (now.stopping) return QObject::tr("stopping");
  if (now.writing) return QObject::tr("writing tables and pictures");
  if (now.points == 0) return QObject::tr("laying out the points");
  QString text = QObject::tr("%1 of %2 points").arg(now.done).arg(now.points);
  if (now.left) text += QObject::tr(", about %1 left").arg(remaining(*now.left));
  return text;
}

}  // namespace clothlab
