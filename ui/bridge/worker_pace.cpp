#include "bridge/worker_pace.h"

#include <cmath>

namespace clothlab {
namespace {

constexpr double longest_debt = 0.1;    // s
constexpr double meter_interval = 0.5;  // s

double seconds(WorkerPace::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

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

void RateMeter::count(double simulated, WorkerPace::Clock::time_point now) {
  ++steps_;
  const double elapsed = seconds(now - since_);
  if (elapsed < meter_interval) return;
  steps_per_second_ = static_cast<double>(steps_) / elapsed;
  real_time_factor_ = (simulated - simulated_) / elapsed;
  since_ = now;
  simulated_ = simulated;
  steps_ = 0;
}

}  // namespace clothlab
