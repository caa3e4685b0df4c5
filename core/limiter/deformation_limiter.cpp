#include "limiter/deformation_limiter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>

#include "cloth/grid.h"
#include "cloth/sums.h"
#include "limiter/tension_springs.h"

namespace cloth {
namespace {

/// What the direct solver takes, in sweeps: factor * (springs it works on)^1.5 / (limited springs). The power
/// is that of a plane graph's factorisation. Measured on hung cloths of 33x33 and 65x65 particles, against
/// sweeps in which nearly every spring is over its limit.
constexpr double direct_cost_factor = 400;

/// Times `max_sweeps`: what "auto" may spend at most on the direct solver.
constexpr double direct_budget = 15;

/// With over-relaxation the excess falls in waves: how many more sweeps are needed is told from this many.
constexpr int sweeps_per_guess = 10;

/// Shortens springs of which one end is pinned; otherwise as SweepKernels::shorten.
double shorten_pinned(const SpringBatch& batch, double relaxation, Points p) {
  double longest = 0;
  for (int s = 0; s < batch.row.count; ++s) {
    int still = batch.row.first + s * batch.row.stride, free = still + batch.row.offset;
    if (batch.ends == FreeEnds::first) std::swap(still, free);
    const double dx = p.x[still] - p.x[free], dy = p.y[still] - p.y[free], dz = p.z[still] - p.z[free];
    const double squared = dx * dx + dy * dy + dz * dz;
    if (!(squared > batch.limit * batch.limit)) continue;
    longest = std::max(longest, squared);
    const double length = std::sqrt(squared);
    const double share = relaxation * ((length - batch.limit) / length);
    p.x[free] += share * dx, p.y[free] += share * dy, p.z[free] += share * dz;
  }
  return longest;
}

double excess_of(const SpringBatch& batch, double squared_length) {
  return (std::sqrt(squared_length) - batch.limit) / batch.rest_length;
}

}  // namespace

DeformationLimiter::DeformationLimiter(const Deformation& deformation, const ClothSystem& system,
                                       const SweepKernels& kernels)
    : deformation_(deformation),
      kernels_(&kernels),
      pieces_(row_by_row(pieces_of(system, limited_runs(deformation, system), deformation.rate))),
      batches_(
          batches_of(pieces_of(system, limited_runs(deformation, system), deformation.rate), system.columns)),
      elastic_(pieces_of(system, system.springs, deformation.rate)) {}

bool DeformationLimiter::is_needed(const Deformation& deformation, const ClothSystem& system) {
  return std::any_of(system.springs.begin(), system.springs.end(),
                     [&](const SpringRun& run) { return is_limited(deformation, run.family); });
}

void DeformationLimiter::begin_sweeps(int rows) {
  moves_ = 0;
  last_move_.assign(static_cast<std::size_t>(rows), 0);
  found_still_.assign(batches_.size(), -1);
}

bool DeformationLimiter::has_changed(const SpringBatch& batch, std::int64_t since) const {
  for (int row = batch.low; row <= batch.high; ++row)
    if (last_move_[static_cast<std::size_t>(row)] > since) return true;
  return since < 0;
}

double DeformationLimiter::shorten(const SpringBatch& batch, double relaxation, Vec3Field& position) const {
  const Points points{position.x(), position.y(), position.z()};
  return batch.ends == FreeEnds::both ? kernels_->shorten(batch.row, batch.limit, relaxation, points)
                                      : shorten_pinned(batch, relaxation, points);
}

/// Returns the largest excess that it found. Batches that were within their limits and whose particles have
/// not moved since would find nothing: they are passed over.
double DeformationLimiter::sweep(double relaxation, Vec3Field& position) {
  double largest = 0;
  for (std::size_t k = 0; k < batches_.size(); ++k) {
    const SpringBatch& batch = batches_[k];
    if (!has_changed(batch, found_still_[k])) continue;
    const double squared = shorten(batch, relaxation, position);
    if (squared > 0) {
      largest = std::max(largest, excess_of(batch, squared));
      std::fill(last_move_.begin() + batch.low, last_move_.begin() + batch.high + 1, ++moves_);
    } else {
      found_still_[k] = moves_;
    }
  }
  return largest;
}

double DeformationLimiter::excess(const Vec3Field& position) const {
  const ConstPoints points{position.x(), position.y(), position.z()};
  double largest = 0;
  for (const SpringBatch& piece : pieces_) {
    const double squared = kernels_->longest(piece.row, piece.limit, points);
    if (squared > 0) largest = std::max(largest, excess_of(piece, squared));
  }
  return largest;
}

/// False when the direct solver is to do it instead; otherwise the tolerance is reached or the sweeps are
/// used up.
bool DeformationLimiter::sweep_all(const ClothSystem& system, LimiterReport& report, Vec3Field& position) {
  const bool may_give_up = deformation_.solver == "auto" && !unreachable_;
  direct_cost_ = 0;
  double at_last_guess = 0;
  while (report.sweeps < deformation_.max_sweeps) {
    const double found = sweep(report.sweeps == 0 ? 1 : over_relaxation, position);
    ++report.sweeps;
    // What it found it has changed, and with it the neighbours.
    if (accepts(found) && accepts(report.excess = excess(position))) return true;
    if (report.sweeps % sweeps_per_guess != 0) continue;
    if (may_give_up && at_last_guess > 0) {
      const double decay = std::log(at_last_guess / found) / sweeps_per_guess;
      const double remaining = decay > 0 ? std::log(found / deformation_.tolerance) / decay
                                         : std::numeric_limits<double>::infinity();
      if (direct_is_cheaper(system, remaining, report.sweeps)) return false;
    }
    at_last_guess = found;
  }
  report.excess = excess(position);
  return true;
}

/// Most cloths never ask for it, and its list of springs is as large as all else that the limiter holds.
NearestShape& DeformationLimiter::nearest(const ClothSystem& system) {
  if (!nearest_) nearest_.emplace(system, limited_runs(deformation_, system), deformation_.rate);
  return *nearest_;
}

/// Also true where the sweeps left would not do, and where as many have gone by as the direct solver costs;
/// never where that costs more than its budget.
bool DeformationLimiter::direct_is_cheaper(const ClothSystem& system, double remaining_sweeps, int sweeps) {
  if (direct_cost_ == 0) {
    double springs = 0;
    for (const SpringBatch& piece : pieces_) springs += piece.row.count;
    direct_cost_ = direct_cost_factor *
                   std::pow(static_cast<double>(nearest(system).working_count(before_)), 1.5) / springs;
  }
  const double most = static_cast<double>(deformation_.max_sweeps);
  if (direct_cost_ > direct_budget * most) return false;
  return sweeps + remaining_sweeps > most ||
         std::max(remaining_sweeps, static_cast<double>(sweeps)) > direct_cost_;
}

void DeformationLimiter::solve_directly(const ClothSystem& system, LimiterReport& report,
                                        Vec3Field& position) {
  report.direct_iterations =
      nearest(system).find(system, deformation_.tolerance, position, !unreachable_).iterations;
}

LimiterReport DeformationLimiter::apply(const ClothSystem& system, double time_step, ClothState& state) {
  LimiterReport report;
  before_ = state.position;
  begin_sweeps(system.rows);
  swept_ = deformation_.solver != "direct" && sweep_all(system, report, state.position);
  if (!swept_) {
    state.position = before_;
    solve_directly(system, report, state.position);
    report.excess = excess(state.position);
  }
  change_velocity(system, time_step, state);
  return report;
}

void DeformationLimiter::change_velocity(const ClothSystem& system, double time_step,
                                         ClothState& state) const {
  const double per_step = 1 / time_step;
  const auto columns = static_cast<std::size_t>(system.columns);
  const auto change = [&](const double* x, const double* x0, double* v) {
    for (int row = 0; row < system.rows; ++row) {
      if (!has_moved(row)) continue;
      const std::size_t first = static_cast<std::size_t>(row) * columns;
      for (std::size_t k = first; k < first + columns; ++k) v[k] += (x[k] - x0[k]) * per_step;
    }
  };
  change(state.position.x(), before_.x(), state.velocity.x());
  change(state.position.y(), before_.y(), state.velocity.y());
  change(state.position.z(), before_.z(), state.velocity.z());
}

double DeformationLimiter::work(const ClothSystem& system, const Vec3& gravity, double time_step,
                                const ClothState& state) const {
  const double per_step = 1 / time_step;
  const double* x[] = {state.position.x(), state.position.y(), state.position.z()};
  const double* x0[] = {before_.x(), before_.y(), before_.z()};
  const double* v[] = {state.velocity.x(), state.velocity.y(), state.velocity.z()};
  double work = 0;
  for (int row = 0; row < system.rows; ++row) {
    if (!has_moved(row)) continue;
    const auto first = static_cast<std::size_t>(system.index(row, 0));
    for (int axis = 0; axis < 3; ++axis)
      work += ordered_sum(static_cast<std::size_t>(system.columns),
                          [=, m = system.mass.data() + first, to = x[axis] + first, from = x0[axis] + first,
                           speed = v[axis] + first, g = gravity[axis]](std::size_t k) {
                            const double moved = to[k] - from[k], change = moved * per_step;
                            return m[k] * (change * (speed[k] - 0.5 * change) - g * moved);
                          });
  }
  const ConstPoints before{x0[0], x0[1], x0[2]}, after{x[0], x[1], x[2]};
  for (const SpringBatch& piece : elastic_) {
    bool moved = false;
    for (int row = piece.low; row <= piece.high; ++row) moved = moved || has_moved(row);
    if (moved)
      work += 0.5 * piece.stiffness * kernels_->stretching(piece.row, piece.rest_length, before, after);
  }
  return work;
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

/// Of a mesh: the way along limited springs from one particle to every other (Dijkstra 1959).
std::vector<double> chains_from(int from, const std::vector<SpringRun>& limited, std::size_t particles) {
  std::vector<std::vector<std::pair<int, double>>> joined(particles);
  for (const SpringRun& run : limited)
    for (int i = run.first; i < run.first + run.count; ++i) {
      joined[static_cast<std::size_t>(i)].emplace_back(i + run.offset, run.rest_length);
      joined[static_cast<std::size_t>(i + run.offset)].emplace_back(i, run.rest_length);
    }
  std::vector<double> chain(particles, std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  chain[static_cast<std::size_t>(from)] = 0;
  next.emplace(0, from);
  while (!next.empty()) {
    const auto [length, i] = next.top();
    next.pop();
    if (length > chain[static_cast<std::size_t>(i)]) continue;
    for (const auto& [j, rest_length] : joined[static_cast<std::size_t>(i)]) {
      double& known = chain[static_cast<std::size_t>(j)];
      if (length + rest_length < known) next.emplace(known = length + rest_length, j);
    }
  }
  return chain;
}

/// At the start no chain is shorter than the straight way.
bool are_where_they_started(const std::vector<int>& particles, const ClothSystem& system,
                            const Vec3Field& position) {
  return std::all_of(particles.begin(), particles.end(), [&](int i) {
    return position[static_cast<std::size_t>(i)] == system.start[static_cast<std::size_t>(i)];
  });
}

}  // namespace

std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position) {
  if (!scene.deformation || !scene.springs) return std::nullopt;
  const Deformation& deformation = *scene.deformation;
  const Links links{is_limited(deformation, SpringFamily::structural) && scene.springs->structural > 0,
                    is_limited(deformation, SpringFamily::shear) && scene.springs->shear > 0};
  if (!links.structural && !links.shear) return std::nullopt;
  const bool is_mesh = system.is_mesh();
  const GridCell cell = is_mesh ? GridCell{} : cell_of(scene.cloth);
  const double slack = 1 + deformation.rate + deformation.tolerance;

  const std::vector<int> pins = pinned_particles(scene.cloth);
  std::optional<UnreachableRate> worst;
  if (is_mesh && are_where_they_started(pins, system, position)) return worst;
  for (std::size_t a = 0; a < pins.size(); ++a) {
    std::vector<double> chains;
    if (is_mesh && a + 1 < pins.size())
      chains = chains_from(pins[a], limited_runs(deformation, system), position.size());
    for (std::size_t b = a + 1; b < pins.size(); ++b) {
      const double distance =
          (position[static_cast<std::size_t>(pins[a])] - position[static_cast<std::size_t>(pins[b])]).norm();
      const double chain =
          is_mesh ? chains[static_cast<std::size_t>(pins[b])]
                  : shortest_chain(cell, links, pins[b] / system.columns - pins[a] / system.columns,
                                   pins[b] % system.columns - pins[a] % system.columns);
      const double reach = (1 + deformation.rate) * chain;
      if (distance > slack * chain && (!worst || distance / reach > worst->distance / worst->reach))
        worst = UnreachableRate{pins[a], pins[b], distance, reach};
    }
  }
  return worst;
}

}  // namespace cloth
