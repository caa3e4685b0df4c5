// Turns signals that end the process (Ctrl+C, a closed terminal, kill, the end of the session) into a call
// from the event loop, so that the program can finish its recordings.
//
//     const StopSignals stop_signals([] { QCoreApplication::exit(130); });
#pragma once

#include <QSocketNotifier>
#include <functional>
#include <memory>

namespace clothlab {

class StopSignals {
 public:
  /// Until destruction, the first SIGINT, SIGTERM or SIGHUP calls `stop` from the event loop; a second one of
  /// its kind ends the process at once. SIGHUP stays ignored under nohup. One object at a time.
  explicit StopSignals(std::function<void()> stop);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  int read_end_ = -1;
  std::unique_ptr<QSocketNotifier> notifier_;
};

}  // namespace clothlab
