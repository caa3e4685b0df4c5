#include "limiter/unreachable_rate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>

#include "cloth/grid.h"
#include "limiter/tension_springs.h"

namespace cloth {
namespace {

/// The limited springs of a grid that chains consist of.
struct Links {
  bool structural = false, shear = false;
};

/// Length of the shortest chain of limited springs between two particles of a grid at rest; infinite if there
/// is none. Exact: the shortest chain uses only the two spring directions nearest to the straight line, and
/// their order can be chosen so that no step leaves the grid.
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

/// Of a mesh: the shortest path along limited springs from one particle to every other (Dijkstra 1959).
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

/// At the start no chain is shorter than the straight line, so that the rate is reachable.
bool are_where_they_started(const std::vector<int>& particles, const ClothSystem& system,
                            const Vec3Field& position) {
  return std::all_of(particles.begin(), particles.end(), [&](int i) {
    return position[static_cast<std::size_t>(i)] == system.start[static_cast<std::size_t>(i)];
  });
}

}  // namespace

std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position) {
  if (!scene.deformation) return std::nullopt;
  const Deformation& deformation = *scene.deformation;
  const auto links_by = [&](SpringFamily family) {
    return is_limited(deformation, family) && system.spring_count(family) > 0;
  };
  const Links links{links_by(SpringFamily::structural), links_by(SpringFamily::shear)};
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
