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

NearestShape::NearestShape(const ClothSystem& system, const std::vector<SpringRun>& limited, double rate) {
  std::size_t count = 0;
  for (const SpringRun& run : limited) count += static_cast<std::size_t>(run.count);
  springs_.reserve(count);
  for (const SpringRun& run : limited) {
    if (!(run.rest_length > 0)) continue;  // nothing to take a fraction of
    for (int s = run.first; s < run.first + run.count; ++s) {
      const auto i = static_cast<std::size_t>(s), j = static_cast<std::size_t>(s + run.offset);
      if (system.pinned[i] && system.pinned[j]) continue;
      springs_.push_back({i, j, (1 + rate) * run.rest_length, run.rest_length});
    }
  }
}

double NearestShape::excess_of(const LimitedSpring& spring, const Vec3Field& position) const {
  return ((position[spring.j] - position[spring.i]).norm() - spring.limit) / spring.rest_length;
}

double NearestShape::largest_excess(const Vec3Field& position) const {
  double largest = 0;
  for (const LimitedSpring& spring : springs_) largest = std::max(largest, excess_of(spring, position));
  return largest;
}

NearestShapeReport NearestShape::find(const ClothSystem& system, double tolerance, Vec3Field& position,
                                      bool reachable) {
  NearestShapeReport report;
  multipliers_.assign(springs_.size(), 0.0);
  const double before = largest_excess(position);
  if (!(before > 0) || !std::isfinite(before)) return report = {0, before, before <= 0};

  const Vec3Field start = position;
  Vec3Field found = position;
  std::vector<std::uint8_t> working(springs_.size(), 0);
  report.excess = before;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<LimitedSpring> chosen;
    std::vector<std::size_t> which;
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      // The last round takes every spring.
      if (round + 1 == most_rounds || excess_of(springs_[s], found) > -nearness * before) working[s] = 1;
      if (!working[s]) continue;
      chosen.push_back(springs_[s]);
      which.push_back(s);
    }
    InteriorPoint problem(system, std::move(chosen), start);
    const NearestShapeReport part = problem.solve(tolerance, reachable);
    found = start;
    problem.displace(found);
    const double excess = largest_excess(found);
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
