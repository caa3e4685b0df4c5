// How simulated time follows the clock: a speed, or as fast as it goes.
#pragma once

#include <chrono>
#include <cstdint>

namespace clothlab {

/// Between two frames that a worker offers: a little more often than a 60 Hz screen asks.
inline constexpr std::chrono::milliseconds frame_interval{14};
/// Between two writings of a recording that grows.
inline constexpr std::chrono::milliseconds flush_interval{500};

inline double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Where cores are few, the window draws first and the calling thread takes the rest, and so do the threads
/// that it starts. On Linux a thread has a niceness of its own; where it cannot be set, nothing is lost.
void yield_to_the_window();

class WorkerPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `speed` in simulated seconds per second; infinity: as fast as it goes.
  void set_speed(double speed, double simulated, Clock::time_point now);
  double speed() const { return speed_; }

  /// From now on simulated time runs from `simulated`.
  void restart(double simulated, Clock::time_point now);

  /// True if a step that ends at `simulated` is due. A simulation that cannot keep up is not chased for more
  /// than a moment: the debt is dropped.
  bool is_due(double simulated, Clock::time_point now);

  /// When that step will be due.
  Clock::time_point due_time(double simulated) const;

 private:
  double speed_ = 1;
  double simulated_ = 0;
  Clock::time_point origin_ = Clock::now();
};

/// Steps per second and simulated seconds per second over the last moments.
class RateMeter {
 public:
  void restart(double simulated, WorkerPace::Clock::time_point now);
  /// After `steps` more.
  void count(std::int64_t steps, double simulated, WorkerPace::Clock::time_point now);
  double steps_per_second() const { return steps_per_second_; }
  double real_time_factor() const { return real_time_factor_; }

 private:
  WorkerPace::Clock::time_point since_ = WorkerPace::Clock::now();
  double simulated_ = 0;
  std::int64_t steps_ = 0;
  double steps_per_second_ = 0, real_time_factor_ = 0;
};

}  // namespace clothlab
