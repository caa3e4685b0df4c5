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

/// One event that no other event was being handled for. On a machine that does other things as well, `wall`
/// is also what those took; `processor` is what the thread itself did.
struct EventTime {
  EventKind kind;
  double wall = 0, processor = 0;  ///< ms
};

class TimedApplication : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override {
    if (depth_ == 0) ++events_;
    if (!watching_) {
      ++depth_;
      const bool handled = QApplication::notify(receiver, event);
      --depth_;
      return handled;
    }
    const int type = event->type();
    const QObject* named = type == QEvent::Timer && receiver->parent() ? receiver->parent() : receiver;
    const char* const name = named->metaObject()->className();  // the receiver may not outlive the event
    QElapsedTimer timer;
    timer.start();
    const double before = processor_time();
    ++depth_;
    const bool handled = QApplication::notify(receiver, event);
    --depth_;
    const double wall = 1e-6 * static_cast<double>(timer.nsecsElapsed());
    const double processor = processor_time() - before;
    if (depth_ == 0 && wall > longest_.wall) longest_ = {{name, type}, wall, processor};
    if (depth_ == 0 && processor > busiest_.processor) busiest_ = {{name, type}, wall, processor};
    if (depth_ == 0 || type == QEvent::Paint) times_[{name, type}].push_back(processor);
    return handled;
  }

  void watch() {
    times_.clear();
    longest_ = busiest_ = {};
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
  const EventTime& longest() const { return longest_; }  ///< by the clock
  const EventTime& busiest() const { return busiest_; }  ///< by the thread's processor time

  /// Counts the events that no other event was being handled for: two things done under one number were done
  /// in one event.
  std::int64_t event_number() const { return events_; }

 private:
  static double processor_time() {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  bool watching_ = false;
  int depth_ = 0;
  std::int64_t events_ = 0;
  std::map<EventKind, std::vector<double>> times_;
  EventTime longest_, busiest_;
};
