#include "simulation/memory_estimate.h"

#include <fmt/format.h>

#include "integrators/registry.h"
#include "io/process.h"

namespace cloth {
namespace {

/// Bytes for a particle, measured as the growth of a run's largest memory from 256 x 256 to 512 x 512 particles
/// of a grid with all spring families, rounded down.
double bytes_per_particle(MethodSettings settings, bool has_springs_to_solve) {
  constexpr double explicit_method = 120, error_control = 500, implicit = 900, local_and_global = 1400,
                   substeps = 300;
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
  }
  return explicit_method;
}

std::string megabytes(double bytes) {
  return fmt::format("{:.0f} MB", bytes / 1e6);
}

}  // namespace

double least_memory(const Scene& scene) {
  MethodSettings settings = MethodSettings::none;
  for (const MethodFacts& facts : integrator_facts())
    if (facts.name == scene.integrator.method) settings = facts.settings;
  const double particles = static_cast<double>(scene.cloth.rows) * scene.cloth.columns;
  return particles * bytes_per_particle(settings, scene.springs.has_value());
}

std::optional<std::string> memory_problem(const Scene& scene) {
  const double needed = least_memory(scene);
  const auto available = available_memory();
  if (!available || needed <= *available) return std::nullopt;
  const std::int64_t particles = std::int64_t{scene.cloth.rows} * scene.cloth.columns;
  return fmt::format("there is not enough memory: a run of {} particles with {} takes {} at least, and {} are to be had",
                     particles, scene.integrator.method, megabytes(needed), megabytes(*available));
}

}  // namespace cloth
