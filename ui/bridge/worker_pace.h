// Relates simulated time to the clock: at a chosen speed, or as fast as possible. Used by the worker's thread
// only.
#pragma once

#include <chrono>
#include <cstdint>

namespace clothlab {

/// Interval between two frames: slightly shorter than that of a 60 Hz screen.
inline constexpr std::chrono::milliseconds frame_interval{14};
/// Interval between two flushes of a growing recording.
inline constexpr std::chrono::milliseconds flush_interval{500};

inline double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Lowers the priority of the calling thread and of the threads that it starts later, so that the window's
/// thread is scheduled first. On Linux each thread has its own niceness; a failure to set it is ignored.
void yield_to_the_window();

class WorkerPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `speed` in simulated seconds per second; infinity: as fast as possible. `simulated`: present simulated
  /// time, s.
  void set_speed(double speed, double simulated, Clock::time_point now);
  double speed() const { return speed_; }

  /// Begins to count from the simulated time `simulated` (s).
  void restart(double simulated, Clock::time_point now);

  /// True if a step that ends at `simulated` (s) is due. A simulation that cannot keep up falls behind by at
  /// most 0.1 s; the rest of the delay is dropped.
  bool is_due(double simulated, Clock::time_point now);

  /// The time at which a step that ends at `simulated` is due.
  Clock::time_point due_time(double simulated) const;

 private:
  double speed_ = 1;
  double simulated_ = 0;
  Clock::time_point origin_ = Clock::now();
};

/// Measures steps per second and simulated seconds per second over the last half second.
class RateMeter {
 public:
  void restart(double simulated, WorkerPace::Clock::time_point now);
  /// Counts `steps` further steps that ended at `simulated` (s).
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
