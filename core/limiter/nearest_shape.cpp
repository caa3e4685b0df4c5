#include "limiter/nearest_shape.h"

#include <algorithm>
#include <cmath>

#include "limiter/interior_point.h"

namespace cloth {
namespace {

/// The working set of a round: springs over the limit, and those below it by less than this many times the
/// largest excess at the start.
constexpr double nearness = 2;

}  // namespace

NearestShape::NearestShape(const Deformation& deformation, const ClothSystem& system)
    : springs_(tension_springs(deformation, system)) {
  std::erase_if(springs_, [&](const TensionSpring& spring) {
    return system.pinned[spring.first] && system.pinned[spring.second];
  });
}

NearestShapeReport NearestShape::find(const ClothSystem& system, double tolerance, Vec3Field& position,
                                      bool reachable) {
  NearestShapeReport report;
  multipliers_.assign(springs_.size(), 0.0);
  const double before = largest_excess(springs_, position);
  if (!(before > 0) || !std::isfinite(before)) return report = {0, before, before <= 0};

  const Vec3Field start = position;
  Vec3Field found = position;
  std::vector<std::uint8_t> working(springs_.size(), 0);
  report.excess = before;
  for (int round = 0; round < max_rounds; ++round) {
    std::vector<TensionSpring> chosen;
    std::vector<std::size_t> which;
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      // The last round takes every spring.
      if (round + 1 == max_rounds || springs_[s].excess(found) > -nearness * before) working[s] = 1;
      if (!working[s]) continue;
      chosen.push_back(springs_[s]);
      which.push_back(s);
    }
    InteriorPoint problem(system, std::move(chosen), start);
    const NearestShapeReport part = problem.solve(tolerance, reachable);
    found = start;
    problem.displace(found);
    const double excess = largest_excess(springs_, found);
    report.iterations += part.iterations;
    report.converged = part.converged && excess <= std::max(tolerance, part.excess);
    if (report.converged || excess <= report.excess) {
      position = found;
      report.excess = excess;
      for (std::size_t k = 0; k < which.size(); ++k) multipliers_[which[k]] = problem.multiplier(k);
    }
    if (report.converged || !part.converged) break;
  }
  return report;
}

}  // namespace cloth
