#include "study/step_objective.h"

#include <utility>

#include "geometry/at.h"

namespace cloth {
namespace {

/// Both ends of a step and how they differ.
struct TwoEnds {
  const Vec3Field &end, &other, &apart;  ///< m; apart = end - other
};

long double spring_differences(const SpringRuns& springs, const TwoEnds& ends) {
  long double sum = 0;
  for_each_spring(springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    const Vec3 d = ends.end[j] - ends.end[i], e = ends.other[j] - ends.other[i];
    const double l = d.norm(), m = e.norm();
    if (!(run.stiffness > 0) || l + m == 0) return;
    const double longer = (ends.apart[j] - ends.apart[i]).dot(d + e) / (l + m);
    sum += 0.5 * run.stiffness * longer * (l + m - 2 * run.rest_length);
  });
  return sum;
}

long double bending_differences(const BendingRuns& bending, const TwoEnds& ends) {
  long double sum = 0;
  for (const BendingRun& run : bending)
    for (int e = run.first; e < run.first + run.count; ++e) {
      Vec3 apart = Vec3::Zero(), both = Vec3::Zero();
      for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p) {
        const std::size_t i = at(e + run.offset[p]);
        apart += run.coefficient[p] * ends.apart[i];
        both += run.coefficient[p] * (ends.end[i] + ends.other[i]);
      }
      sum += 0.5 * run.stiffness * apart.dot(both);
    }
  return sum;
}

long double membrane_differences(const Membrane& membrane, const TwoEnds& ends) {
  long double sum = 0;
  for (const MembraneTriangle& t : membrane) {
    const std::array<double, 3> q = square_changes(t, ends.end), r = square_changes(t, ends.other);
    std::array<double, 3> apart{}, both{};
    for (std::size_t e = 0; e < 3; ++e) {
      apart[e] = edge_of(t, e, ends.apart).dot(edge_of(t, e, ends.end) + edge_of(t, e, ends.other));
      both[e] = q[e] + r[e];
    }
    const std::array<double, 3> k = times_k(t, both);
    for (std::size_t e = 0; e < 3; ++e) sum += 0.5 * apart[e] * k[e];
  }
  return sum;
}

}  // namespace

StepObjective::StepObjective(const ClothSystem& system, double step, std::vector<double> inertia,
                             Vec3Field start, Vec3Field predicted)
    : system_(&system),
      step_(step),
      inertia_(std::move(inertia)),
      start_(std::move(start)),
      predicted_(std::move(predicted)) {}

Vec3Field StepObjective::end_of(const Vec3Field& velocity) const {
  Vec3Field end = start_;
  for (std::size_t i = 0; i < end.size(); ++i) end.add(i, step_ * velocity[i]);
  return end;
}

double StepObjective::difference(const Vec3Field& velocity, const Vec3Field& other) const {
  Vec3Field apart(velocity.size());
  long double sum = 0;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const Vec3 faster = velocity[i] - other[i];
    apart.set(i, step_ * faster);
    if (system_->pinned[i]) continue;
    sum += 0.5 * inertia_[i] * faster.dot((velocity[i] - predicted_[i]) + (other[i] - predicted_[i]));
  }
  const Vec3Field end = end_of(velocity), other_end = end_of(other);
  const TwoEnds ends{end, other_end, apart};
  sum += spring_differences(system_->springs, ends) + bending_differences(system_->bending, ends) +
         membrane_differences(system_->membrane, ends);
  return static_cast<double>(sum);
}

}  // namespace cloth
