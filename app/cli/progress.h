// What a long command shows and hears while it works.
#pragma once

#include <chrono>
#include <string>

namespace clothlab::cli {

/// A bar with the remaining time on a terminal, nothing elsewhere: logs stay readable.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// At most some ten times a second does anything.
  void show(double fraction, const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  Clock::time_point start_, last_;
};

/// From now on Ctrl+C, SIGTERM and a closed terminal (SIGHUP) only ask for a stop.
void listen_for_stop();
bool stop_is_requested();

}  // namespace clothlab::cli
