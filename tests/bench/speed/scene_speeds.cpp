#include "bench/speed/scene_speeds.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "bench/speed/interleaved_timing.h"
#include "bench/speed/speed_scenes.h"
#include "bench/speed/step_costs.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth::speed {
namespace {

double seconds_of(int threads) {
  timespec now{};
  clock_gettime(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Advances a simulation in turns of about a moment.
class Turns {
 public:
  Turns(Simulation& simulation, double moment, int threads)
      : simulation_(simulation), moment_(moment), threads_(threads) {}

  /// Takes a turn of at most `most` steps. Returns what it took in s.
  double take(std::int64_t most) {
    const std::int64_t steps = std::clamp<std::int64_t>(steps_, 1, most);
    const double begin = seconds_of(threads_);
    divergence = simulation_.advance(steps);
    const double taken = std::max(seconds_of(threads_) - begin, 1e-9);
    const double wanted = static_cast<double>(steps) * moment_ / taken;
    steps_ = static_cast<std::int64_t>(std::clamp(wanted, 0.5 * double(steps_), 2.0 * double(steps_)));
    steps_ = std::max<std::int64_t>(steps_, 1);
    taken_steps = steps;
    return taken;
  }

  std::int64_t taken_steps = 0;
  std::optional<Divergence> divergence;

 private:
  Simulation& simulation_;
  double moment_;
  int threads_;
  std::int64_t steps_ = 1;
};

/// As many rows and columns as the scene has, or of a mesh a square of as many particles.
Scene bare_scene(const Scene& scene, int particles) {
  Scene bare = hanging_cloth(4, "verlet", bare_feature());
  ClothSheet& cloth = bare.cloth;
  const int side = std::max(4, static_cast<int>(std::lround(std::sqrt(particles))));
  cloth.rows = scene.cloth.is_mesh() ? side : std::max(4, scene.cloth.rows);
  cloth.columns = scene.cloth.is_mesh() ? side : std::max(4, scene.cloth.columns);
  cloth.height = cloth.width * (cloth.rows - 1) / (cloth.columns - 1);
  return bare;
}

int refined_count(int particles, int longer, int size) {
  constexpr int fewest = 3;
  return std::max(fewest, static_cast<int>(std::lround((particles - 1.0) * (size - 1) / (longer - 1))) + 1);
}

}  // namespace

std::optional<Scene> refined(const Scene& scene, int size, std::string& why) {
  if (scene.cloth.is_mesh()) {
    why = "its cloth is a mesh and cannot be refined";
    return std::nullopt;
  }
  Scene finer = scene;
  const int longer = std::max(scene.cloth.rows, scene.cloth.columns);
  finer.cloth.rows = refined_count(scene.cloth.rows, longer, size);
  finer.cloth.columns = refined_count(scene.cloth.columns, longer, size);
  const auto limit = guaranteed_step(finer.integrator.method, finer);
  if (finer.integrator.time_step && limit && *finer.integrator.time_step > *limit)
    finer.integrator.time_step.reset();
  if (const std::vector<Problem> problems = find_problems(finer); !problems.empty()) {
    why = "refined, it breaks a rule: " + problems.front().text();
    return std::nullopt;
  }
  return finer;
}

SceneSpeed measure_scene(const std::string& name, const Scene& scene, double longest, int threads) {
  constexpr double moment = 0.004, bare_moment = 0.001;  // s
  Simulation simulation(scene);
  const int particles = simulation.system().size();
  Simulation bare(bare_scene(scene, particles));
  use_threads(simulation, threads), use_threads(bare, threads);
  SceneSpeed result{.name = name,
                    .method = scene.integrator.method,
                    .rows = scene.cloth.is_mesh() ? 0 : scene.cloth.rows,
                    .columns = scene.cloth.is_mesh() ? 0 : scene.cloth.columns,
                    .particles = particles,
                    .time_step = simulation.time_step(),
                    .duration = scene.duration,
                    .remark = {}};
  Turns turns(simulation, moment, threads), bare_turns(bare, bare_moment, threads);
  bare_turns.take(8);
  // The first step also takes what is taken once: memory, patterns and orders of equations.
  if (simulation.time_step() < scene.duration) turns.take(1);
  const std::int64_t first_step = simulation.count().steps;
  const double first_time = simulation.time();
  std::vector<double> bare_times;
  while (simulation.time() < scene.duration && result.seconds < longest) {
    const double left = std::ceil((scene.duration - simulation.time()) / simulation.time_step());
    result.seconds += turns.take(static_cast<std::int64_t>(std::max(1.0, left)));
    if (turns.divergence) {
      result.remark = describe(*turns.divergence);
      break;
    }
    const double taken = bare_turns.take(1 << 20);
    bare_times.push_back(1e9 * taken / double(bare_turns.taken_steps) / bare.system().size());
  }
  result.simulated = simulation.time() - first_time;
  const double steps = static_cast<double>(simulation.count().steps - first_step);
  if (steps > 0) result.nanoseconds = 1e9 * result.seconds / steps / result.particles;
  result.bare = spread_of(bare_times).median;
  return result;
}

std::vector<SceneGrowth> fit_scene_growth(const std::vector<SceneSpeed>& rows) {
  std::vector<SceneGrowth> found;
  std::vector<std::vector<OrderPoint>> points;  // of ln y against ln x, whatever they are
  for (const SceneSpeed& row : rows) {
    if (!(row.nanoseconds > 0)) continue;
    auto at =
        std::find_if(found.begin(), found.end(), [&](const auto& other) { return other.name == row.name; });
    if (at == found.end()) {
      found.push_back({.name = row.name, .smallest = row.particles, .largest = row.particles});
      points.emplace_back();
      at = found.end() - 1;
    }
    at->smallest = std::min(at->smallest, row.particles), at->largest = std::max(at->largest, row.particles);
    points[static_cast<std::size_t>(at - found.begin())].push_back(
        {double(row.particles), row.particles * row.nanoseconds});
  }
  for (std::size_t k = 0; k < found.size(); ++k) found[k].exponent = fit_slope(points[k]);
  std::erase_if(found, [](const SceneGrowth& row) { return row.smallest == row.largest; });
  return found;
}

}  // namespace cloth::speed
