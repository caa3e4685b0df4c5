#include "simulation/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/process.h"
#include "scene/method_facts.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

/// Bytes for a particle, measured as the growth of a run's largest memory from 256 x 256 to 512 x 512
/// particles of a grid with all spring families, rounded down.
double bytes_per_particle(MethodSettings settings, bool has_springs_to_solve) {
  constexpr double explicit_method = 120, error_control = 500, implicit = 900, local_and_global = 500,
                   substeps = 300, particles_alone = 900;
  switch (settings) {
    case MethodSettings::none:
      return explicit_method;
    case MethodSettings::error_control:
      return error_control;
    case MethodSettings::newton:
      return has_springs_to_solve ? implicit : explicit_method;
    case MethodSettings::projective:
      return has_springs_to_solve ? local_and_global : explicit_method;
    case MethodSettings::xpbd:
      return substeps;
    case MethodSettings::vbd:
      return particles_alone;
  }
  return explicit_method;
}

std::string megabytes(double bytes) {
  return fmt::format("{:.0f} MB", bytes / 1e6);
}

/// What a run of the scene takes at least, in bytes: its particles and their springs in its method's arrays.
/// What depends on the motion, such as contact's lists, comes on top.
double least_memory(const Scene& scene) {
  MethodSettings settings = MethodSettings::none;
  for (const MethodFacts& facts : integrator_facts())
    if (facts.name == scene.integrator.method) settings = facts.settings;
  const double particles = static_cast<double>(scene.cloth.rows) * scene.cloth.columns;
  return particles * bytes_per_particle(settings, has_stiffness(scene));
}

}  // namespace

std::optional<std::string> memory_problem(const Scene& scene) {
  return memory_problem(std::vector<Scene>{scene});
}

std::optional<std::string> memory_problem(const std::vector<Scene>& scenes) {
  double needed = 0;
  for (const Scene& scene : scenes) needed += least_memory(scene);
  const auto available = available_memory();
  if (scenes.empty() || !available || needed <= *available) return std::nullopt;
  const Scene& first = scenes.front();
  const std::int64_t particles = std::int64_t{first.cloth.rows} * first.cloth.columns;
  const std::string what =
      scenes.size() == 1 ? fmt::format("a run of {} particles with {}", particles, first.integrator.method)
                         : fmt::format("{} runs of {} particles at once", scenes.size(), particles);
  return fmt::format("there is not enough memory: {} {} {} at least, and {} are to be had", what,
                     scenes.size() == 1 ? "takes" : "take", megabytes(needed), megabytes(*available));
}

int runs_that_fit(const std::vector<Scene>& scenes, int most) {
  double largest = 0;
  for (const Scene& scene : scenes) largest = std::max(largest, least_memory(scene));
  const auto available = available_memory();
  if (!available || largest * most <= *available) return most;
  return std::max(1, static_cast<int>(*available / largest));
}

}  // namespace cloth
