#include "bridge/worker_pace.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cmath>

namespace clothlab {
namespace {

constexpr double longest_debt = 0.1;    // s
constexpr double meter_interval = 0.5;  // s

}  // namespace

void yield_to_the_window() {
  constexpr int niceness = 5;
  [[maybe_unused]] const int set = ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);
}

void WorkerPace::set_speed(double speed, double simulated, Clock::time_point now) {
  speed_ = speed;
  restart(simulated, now);
}

void WorkerPace::restart(double simulated, Clock::time_point now) {
  simulated_ = simulated;
  origin_ = now;
}

WorkerPace::Clock::time_point WorkerPace::due_time(double simulated) const {
  if (std::isinf(speed_)) return origin_;
  return origin_ + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>((simulated - simulated_) / speed_));
}

bool WorkerPace::is_due(double simulated, Clock::time_point now) {
  if (std::isinf(speed_)) return true;
  const Clock::time_point due = due_time(simulated);
  if (now < due) return false;
  if (seconds(now - due) > longest_debt) restart(simulated, now);
  return true;
}

void RateMeter::restart(double simulated, WorkerPace::Clock::time_point now) {
  since_ = now;
  simulated_ = simulated;
  steps_ = 0;
  steps_per_second_ = real_time_factor_ = 0;
}

void RateMeter::count(std::int64_t steps, double simulated, WorkerPace::Clock::time_point now) {
  steps_ += steps;
  const double elapsed = seconds(now - since_);
  if (elapsed < meter_interval) return;
  steps_per_second_ = static_cast<double>(steps_) / elapsed;
  real_time_factor_ = (simulated - simulated_) / elapsed;
  since_ = now;
  simulated_ = simulated;
  steps_ = 0;
}

}  // namespace clothlab
