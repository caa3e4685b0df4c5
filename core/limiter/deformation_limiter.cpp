#include "limiter/deformation_limiter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cloth/grid.h"

namespace cloth {
namespace {

bool limits(const Deformation& deformation, SpringFamily family) {
  return std::find(deformation.springs.begin(), deformation.springs.end(), name_of(family)) !=
         deformation.springs.end();
}

/// Shortens one spring if it is too long. Returns its excess before that, relative to the rest length.
double shorten(const ClothSystem& system, double limit, double rest_length, std::size_t i, std::size_t j,
               Vec3Field& position) {
  double *x = position.x(), *y = position.y(), *z = position.z();
  const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
  const double squared = dx * dx + dy * dy + dz * dz;
  if (!(squared > limit * limit)) return 0;
  const bool free_i = !system.pinned[i], free_j = !system.pinned[j];
  const double length = std::sqrt(squared);
  const double excess = (length - limit) / rest_length;
  if (!free_i && !free_j) return 0;  // both pinned: not the limiter's to change
  const double share = (length - limit) / length / ((free_i ? 1 : 0) + (free_j ? 1 : 0));
  if (free_i) x[i] += share * dx, y[i] += share * dy, z[i] += share * dz;
  if (free_j) x[j] -= share * dx, y[j] -= share * dy, z[j] -= share * dz;
  return excess;
}

}  // namespace

DeformationLimiter::DeformationLimiter(const Deformation& deformation, const ClothSystem& system)
    : deformation_(deformation) {
  for (const SpringRun& run : system.springs)
    if (limits(deformation, run.family)) limited_.push_back(run);
}

bool DeformationLimiter::is_needed(const Deformation& deformation, const ClothSystem& system) {
  return std::any_of(system.springs.begin(), system.springs.end(),
                     [&](const SpringRun& run) { return limits(deformation, run.family); });
}

double DeformationLimiter::sweep(const ClothSystem& system, bool forward, Vec3Field& position) const {
  double largest = 0;
  const auto visit = [&](const SpringRun& run) {
    const double limit = (1 + deformation_.rate) * run.rest_length;
    for (int s = 0; s < run.count; ++s) {
      const int i = run.first + (forward ? s : run.count - 1 - s);
      largest = std::max(largest, shorten(system, limit, run.rest_length, static_cast<std::size_t>(i),
                                          static_cast<std::size_t>(i + run.offset), position));
    }
  };
  if (forward)
    std::for_each(limited_.begin(), limited_.end(), visit);
  else
    std::for_each(limited_.rbegin(), limited_.rend(), visit);
  return largest;
}

double DeformationLimiter::excess(const ClothSystem& system, const Vec3Field& position) const {
  double largest = 0;
  const double *x = position.x(), *y = position.y(), *z = position.z();
  for (const SpringRun& run : limited_) {
    const double limit = (1 + deformation_.rate) * run.rest_length;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
      const double squared = dx * dx + dy * dy + dz * dz;
      if (!(squared > limit * limit)) continue;
      if (system.pinned[static_cast<std::size_t>(i)] && system.pinned[static_cast<std::size_t>(j)]) continue;
      largest = std::max(largest, (std::sqrt(squared) - limit) / run.rest_length);
    }
  }
  return largest;
}

LimiterReport DeformationLimiter::apply(const ClothSystem& system, double time_step, ClothState& state) {
  LimiterReport report;
  before_ = state.position;
  while (report.sweeps < deformation_.max_sweeps) {
    // Sweeps go there and back: what one direction pushes ahead of itself the other takes up.
    const double found = sweep(system, report.sweeps % 2 == 0, state.position);
    ++report.sweeps;
    if (accepts(found)) break;
  }
  report.excess = excess(system, state.position);

  const auto x = state.position.flat();
  const auto x0 = before_.flat();
  const auto v = state.velocity.flat();
  for (std::size_t k = 0; k < v.size(); ++k) v[k] += (x[k] - x0[k]) / time_step;
  return report;
}

namespace {

/// The shortest chain of limited springs between two particles of a grid at rest: along rows and columns, and
/// along diagonals where shear springs are limited too.
double shortest_chain(const GridCell& cell, int rows, int columns, bool diagonals) {
  const double across = cell.across.norm(), down = cell.down.norm();
  if (!diagonals) return std::abs(rows) * down + std::abs(columns) * across;
  const bool same_sign = (rows > 0) == (columns > 0);
  const double diagonal = (same_sign ? Vec3(cell.across + cell.down) : Vec3(cell.across - cell.down)).norm();
  const int steps = std::min(std::abs(rows), std::abs(columns));
  return steps * std::min(diagonal, across + down) + (std::abs(rows) - steps) * down +
         (std::abs(columns) - steps) * across;
}

}  // namespace

std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position) {
  if (!scene.deformation || !scene.springs) return std::nullopt;
  const Deformation& deformation = *scene.deformation;
  if (!limits(deformation, SpringFamily::structural) || !(scene.springs->structural > 0)) return std::nullopt;
  const bool diagonals = limits(deformation, SpringFamily::shear) && scene.springs->shear > 0;
  const GridCell cell = cell_of(scene.cloth);
  const double slack = 1 + deformation.rate + deformation.tolerance;

  const std::vector<int> pins = pinned_particles(scene.cloth);
  std::optional<UnreachableRate> worst;
  for (std::size_t a = 0; a < pins.size(); ++a) {
    for (std::size_t b = a + 1; b < pins.size(); ++b) {
      const double distance =
          (position[static_cast<std::size_t>(pins[a])] - position[static_cast<std::size_t>(pins[b])]).norm();
      const double chain = shortest_chain(cell, pins[b] / system.columns - pins[a] / system.columns,
                                          pins[b] % system.columns - pins[a] % system.columns, diagonals);
      const double reach = (1 + deformation.rate) * chain;
      if (distance > slack * chain && (!worst || distance / reach > worst->distance / worst->reach))
        worst = UnreachableRate{pins[a], pins[b], distance, reach};
    }
  }
  return worst;
}

}  // namespace cloth
