#include "limiter/deformation_limiter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cloth/grid.h"

namespace cloth {
namespace {

/// What the direct solver takes, in sweeps: factor * (springs it works on)^1.5 / (limited springs). The power
/// is that of a plane graph's factorisation. Measured on hung cloths of 33x33 to 129x129 particles.
constexpr double direct_cost_factor = 60;

/// Times `max_sweeps`: what "auto" may spend at most on the direct solver.
constexpr double direct_budget = 5;

/// Sweeps before the first guess of how many more are needed: the first ones are not yet typical.
constexpr int sweeps_before_guess = 4;

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

std::vector<SpringRun> limited_runs(const Deformation& deformation, const ClothSystem& system) {
  std::vector<SpringRun> limited;
  for (const SpringRun& run : system.springs)
    if (limits(deformation, run.family) && run.rest_length > 0) limited.push_back(run);
  return limited;
}

}  // namespace

DeformationLimiter::DeformationLimiter(const Deformation& deformation, const ClothSystem& system)
    : deformation_(deformation),
      limited_(limited_runs(deformation, system)),
      nearest_(system, limited_, deformation.rate) {}

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

/// False when the direct solver is to do it instead; otherwise the tolerance is reached or the sweeps are
/// used up.
bool DeformationLimiter::sweep_all(const ClothSystem& system, LimiterReport& report, Vec3Field& position) {
  const bool may_give_up = deformation_.solver == "auto" && !unreachable_;
  direct_cost_ = 0;
  double two_ago = 0, one_ago = 0;
  while (report.sweeps < deformation_.max_sweeps) {
    // Sweeps go there and back: what one direction pushes ahead of itself the other takes up.
    const double found = sweep(system, report.sweeps % 2 == 0, position);
    ++report.sweeps;
    if (accepts(found)) return true;
    if (may_give_up && report.sweeps >= sweeps_before_guess && report.sweeps % 2 == 0) {
      const double decay = std::log(two_ago / found) / 2;  // per sweep, there and back compared with itself
      const double remaining = decay > 0 ? std::log(found / deformation_.tolerance) / decay
                                         : std::numeric_limits<double>::infinity();
      if (direct_is_cheaper(remaining, report.sweeps)) return false;
    }
    two_ago = one_ago;
    one_ago = found;
  }
  return true;
}

/// Also true where the sweeps left would not do, and where as many have gone by as the direct solver costs;
/// never where that costs more than its budget.
bool DeformationLimiter::direct_is_cheaper(double remaining_sweeps, int sweeps) {
  if (direct_cost_ == 0) {
    double springs = 0;
    for (const SpringRun& run : limited_) springs += run.count;
    direct_cost_ =
        direct_cost_factor * std::pow(static_cast<double>(nearest_.working_count(before_)), 1.5) / springs;
  }
  const double most = static_cast<double>(deformation_.max_sweeps);
  if (direct_cost_ > direct_budget * most) return false;
  return sweeps + remaining_sweeps > most ||
         std::max(remaining_sweeps, static_cast<double>(sweeps)) > direct_cost_;
}

void DeformationLimiter::solve_directly(const ClothSystem& system, LimiterReport& report,
                                        Vec3Field& position) {
  report.direct_iterations =
      nearest_.find(system, deformation_.tolerance, position, !unreachable_).iterations;
}

LimiterReport DeformationLimiter::apply(const ClothSystem& system, double time_step, ClothState& state) {
  LimiterReport report;
  before_ = state.position;
  const bool swept = deformation_.solver != "direct" && sweep_all(system, report, state.position);
  if (!swept) {
    state.position = before_;
    solve_directly(system, report, state.position);
  }
  report.excess = excess(system, state.position);

  const auto x = state.position.flat();
  const auto x0 = before_.flat();
  const auto v = state.velocity.flat();
  for (std::size_t k = 0; k < v.size(); ++k) v[k] += (x[k] - x0[k]) / time_step;
  return report;
}

namespace {

/// Which springs of a grid make up chains.
struct Links {
  bool structural = false, shear = false;
};

/// The shortest chain of limited springs between two particles of a grid at rest; infinite if there is none.
/// Exact: of steps in several directions, each as long as its spring, those on both sides of the way are the
/// shortest, and their order can be chosen so that no step leaves the grid.
double shortest_chain(const GridCell& cell, const Links& links, int rows, int columns) {
  const double across = cell.across.norm(), down = cell.down.norm();
  const double falling = (cell.across + cell.down).norm(), rising = (cell.across - cell.down).norm();
  if (!links.shear) return std::abs(rows) * down + std::abs(columns) * across;
  if (!links.structural) {
    if ((rows + columns) % 2 != 0) return std::numeric_limits<double>::infinity();
    return std::abs(rows + columns) / 2 * falling + std::abs(columns - rows) / 2 * rising;
  }
  const double diagonal = (rows > 0) == (columns > 0) ? falling : rising;
  const int steps = std::min(std::abs(rows), std::abs(columns));
  return steps * diagonal + (std::abs(rows) - steps) * down + (std::abs(columns) - steps) * across;
}

}  // namespace

std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position) {
  if (!scene.deformation || !scene.springs) return std::nullopt;
  const Deformation& deformation = *scene.deformation;
  const Links links{limits(deformation, SpringFamily::structural) && scene.springs->structural > 0,
                    limits(deformation, SpringFamily::shear) && scene.springs->shear > 0};
  if (!links.structural && !links.shear) return std::nullopt;
  const GridCell cell = cell_of(scene.cloth);
  const double slack = 1 + deformation.rate + deformation.tolerance;

  const std::vector<int> pins = pinned_particles(scene.cloth);
  std::optional<UnreachableRate> worst;
  for (std::size_t a = 0; a < pins.size(); ++a) {
    for (std::size_t b = a + 1; b < pins.size(); ++b) {
      const double distance =
          (position[static_cast<std::size_t>(pins[a])] - position[static_cast<std::size_t>(pins[b])]).norm();
      const double chain = shortest_chain(cell, links, pins[b] / system.columns - pins[a] / system.columns,
                                          pins[b] % system.columns - pins[a] % system.columns);
      const double reach = (1 + deformation.rate) * chain;
      if (distance > slack * chain && (!worst || distance / reach > worst->distance / worst->reach))
        worst = UnreachableRate{pins[a], pins[b], distance, reach};
    }
  }
  return worst;
}

}  // namespace cloth
