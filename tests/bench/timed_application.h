// An application that times the events of the window's thread.
#pragma once

#include <time.h>

#include <QApplication>
#include <QElapsedTimer>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// The receiver's class (for a timer: its parent's) and the QEvent::Type.
using EventKind = std::pair<std::string, int>;

class TimedApplication : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override {
    if (!watching_) return QApplication::notify(receiver, event);
    const int type = event->type();
    const QObject* named = type == QEvent::Timer && receiver->parent() ? receiver->parent() : receiver;
    const char* const name = named->metaObject()->className();  // the receiver may not outlive the event
    QElapsedTimer timer;
    timer.start();
    const double before = processor_time();
    ++depth_;
    const bool handled = QApplication::notify(receiver, event);
    --depth_;
    const double taken = 1e-6 * static_cast<double>(timer.nsecsElapsed());
    if (depth_ == 0 && taken > longest_) longest_ = taken, longest_kind_ = {name, type};
    if (depth_ == 0 || type == QEvent::Paint) times_[{name, type}].push_back(processor_time() - before);
    return handled;
  }

  void watch() {
    times_.clear();
    longest_ = 0;
    longest_kind_ = {};
    watching_ = true;
  }
  void stop_watching() { watching_ = false; }

  /// ms of the thread's processor time for each event of a kind, in order: those that no other event was
  /// being handled for, and all paintings.
  const std::map<EventKind, std::vector<double>>& times() const { return times_; }
  std::vector<double> times(const EventKind& kind) const {
    const auto found = times_.find(kind);
    return found == times_.end() ? std::vector<double>() : found->second;
  }
  double longest() const { return longest_; }  ///< ms of the clock
  const EventKind& longest_kind() const { return longest_kind_; }

 private:
  static double processor_time() {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  bool watching_ = false;
  int depth_ = 0;
  std::map<EventKind, std::vector<double>> times_;
  double longest_ = 0;
  EventKind longest_kind_;
};
