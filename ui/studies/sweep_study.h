// The sweep that the Studies dock shows: it runs here, goes on, or is followed while something else fills its
// folder.
#pragma once

#include <QFileSystemWatcher>
#include <QObject>

#include "bridge/sweep_runner.h"
#include "bridge/sweep_watch.h"

namespace clothlab {

class SweepStudy : public QObject {
  Q_OBJECT

 public:
  SweepStudy();

  /// Whether a folder holds a sweep.
  static bool isSweep(const QString& folder);

  /// Runs it over all cores and follows it.
  void start(SweepOrder order);
  /// Makes here what the folder that is shown does not have.
  void goOn();
  /// Follows a folder; what runs here must be at an end.
  void open(const QString& folder);
  /// Another study is shown instead. Precondition: it does not run.
  void leave();
  void cancel() { runner_.cancel(); }
  /// Cancels, and waits for the present points and the writing of what is finished.
  void stop();

  bool isShown() const { return !folder_.isEmpty(); }
  bool isRunning() const { return runner_.is_running(); }
  SweepStatus status() const { return runner_.status(); }
  const QString& folder() const { return folder_; }
  /// The newest results; null until the folder was read.
  const std::shared_ptr<const SweepView>& view() const { return view_; }
  /// Why it cannot be followed or run; empty: no error.
  QString problem() const;
  /// Whether there may be other results than those shown before long.
  bool isFollowed() const;
  /// Takes what has come; true where the results are others.
  bool poll();

  QString title() const;
  QString summary() const;
  /// What is being done, with how much and how long.
  QString progress() const;

 private:
  void follow(const QString& folder);
  void watchFiles();

  SweepRunner runner_;
  SweepWatch watch_;
  QFileSystemWatcher files_;
  QString folder_;
  std::shared_ptr<const SweepView> view_;
  bool was_running_ = false;
  std::int64_t done_ = 0;  ///< points, at the last poll
};

}  // namespace clothlab
