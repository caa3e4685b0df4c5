#include "bridge/sweep_estimate.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "simulation/recorder.h"
#include "simulation/time_step.h"
#include "sweep/sweep_points.h"

namespace clothlab {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double longest_run = 0.25;  // s
constexpr std::int64_t most_looks = 16;
constexpr int estimate_priority = 5;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Look {
  cloth::Scene scene;
  double steps = 0;
};

/// Points evenly picked, with the steps that each takes.
std::vector<Look> looks_at(const cloth::SweepPoints& points, const std::stop_token& stop) {
  std::vector<Look> looks;
  const std::int64_t count = std::min(points.count(), most_looks);
  for (std::int64_t k = 0; k < count && !stop.stop_requested(); ++k) {
    cloth::SceneReading reading = points.scene(count > 1 ? k * (points.count() - 1) / (count - 1) : 0);
    if (!reading.problems.empty() || !reading.scene) continue;
    const auto step = resolved_time_step(*reading.scene);
    if (!step) continue;
    const double steps = reading.scene->duration / *step;
    looks.push_back({std::move(*reading.scene), steps});
  }
  return looks;
}

/// s of a step with all that is measured on the way.
double timed_step(const cloth::Scene& scene, const std::stop_token& stop) {
  cloth::RunOptions options;
  const auto start = Clock::now();
  options.progress = [&](double) { return !stop.stop_requested() && since(start) < longest_run; };
  const cloth::RunResult result = run_scene(scene, options);
  const double steps = static_cast<double>(std::max<std::int64_t>(1, result.summary.count.steps));
  return since(start) / steps;
}

}  // namespace

std::optional<SweepEstimate> estimate_sweep(const cloth::SweepPlan& plan, int jobs,
                                            const std::stop_token& stop) {
  const cloth::SweepPoints points(plan);
  const std::vector<Look> looks = looks_at(points, stop);
  if (stop.stop_requested()) return std::nullopt;
  SweepEstimate estimate{.points = points.count()};
  estimate.looked_at = std::min(points.count(), most_looks);
  estimate.refused = estimate.looked_at - std::ssize(looks);
  if (looks.empty()) return estimate;
  double steps = 0;
  for (const Look& look : looks) steps += look.steps;
  const double step = timed_step(looks[looks.size() / 2].scene, stop);
  if (stop.stop_requested()) return std::nullopt;
  estimate.point = step * steps / static_cast<double>(estimate.looked_at);
  const std::int64_t at_once = std::clamp<std::int64_t>(jobs, 1, points.count());
  estimate.whole = estimate.point * static_cast<double>((points.count() + at_once - 1) / at_once);
  return estimate;
}

void SweepEstimator::ask(cloth::SweepPlan plan, int jobs) {
  last_ = std::make_shared<Question>();
  thread_.start([question = last_, plan = std::move(plan), jobs](const std::stop_token& stop) {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), estimate_priority);
    std::optional<SweepEstimate> answer;
    try {
      answer = estimate_sweep(plan, jobs, stop);
    } catch (const std::exception&) {
      return;  // a scene too large for the memory: there is no estimate
    }
    const std::lock_guard lock(question->mutex);
    question->answer = answer;
  });
}

void SweepEstimator::forget() {
  thread_.stop();
  last_.reset();
}

std::optional<SweepEstimate> SweepEstimator::take() {
  if (!last_) return std::nullopt;
  const std::lock_guard lock(last_->mutex);
  return std::exchange(last_->answer, std::nullopt);
}

}  // namespace clothlab
