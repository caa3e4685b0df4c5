#include "cloth/bending.h"

#include <algorithm>

#include "cloth/sums.h"

namespace cloth {
namespace {

/// Elements are taken in chunks: their sums side by side, then added to one point after the other.
constexpr int chunk_length = 128;
using Chunk = std::array<double, chunk_length>;

/// sum_p c_p x_p of `count` elements from particle `first`, of one component.
void sum_points(const BendingRun& run, int first, int count, const double* x, Chunk& sum) {
  const double c = run.coefficient[0];
  const double* at = x + first + run.offset[0];
  for (int e = 0; e < count; ++e) sum[e] = c * at[e];
  for (int p = 1; p < run.points; ++p) {
    const double next = run.coefficient[p];
    at = x + first + run.offset[p];
    for (int e = 0; e < count; ++e) sum[e] += next * at[e];
  }
}

bool has_single_elements(const BendingRuns& runs) {
  return std::all_of(runs.begin(), runs.end(), [](const BendingRun& run) { return run.count == 1; });
}

/// Of a single element.
Vec3 weighted_sum(const BendingRun& run, const Vec3Field& field) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p)
    sum += run.coefficient[p] * field[static_cast<std::size_t>(run.first + run.offset[p])];
  return sum;
}

template <class Visit>  // visit(run, first, count)
void for_each_chunk(const BendingRuns& runs, Visit visit) {
  for (const BendingRun& run : runs)
    for (int begin = 0; begin < run.count; begin += chunk_length)
      visit(run, run.first + begin, std::min(chunk_length, run.count - begin));
}

}  // namespace

double bending_square(const BendingRuns& runs, const Vec3Field& field) {
  double total = 0;
  if (has_single_elements(runs)) {
    for (const BendingRun& run : runs) total += run.stiffness * weighted_sum(run, field).squaredNorm();
    return total;
  }
  Chunk sum;
  for_each_chunk(runs, [&](const BendingRun& run, int first, int count) {
    for (const double* x : {field.x(), field.y(), field.z()}) {
      sum_points(run, first, count, x, sum);
      total += run.stiffness *
               ordered_sum(static_cast<std::size_t>(count), [&](std::size_t e) { return sum[e] * sum[e]; });
    }
  });
  return total;
}

double bending_energy(const BendingRuns& runs, const Vec3Field& position) {
  return 0.5 * bending_square(runs, position);
}

void add_bending_product(const BendingRuns& runs, double scale, const Vec3Field& field, Vec3Field& result) {
  const std::array<const double*, 3> from{field.x(), field.y(), field.z()};
  const std::array<double*, 3> to{result.x(), result.y(), result.z()};
  Chunk sum;
  for_each_chunk(runs, [&](const BendingRun& run, int first, int count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum_points(run, first, count, from[axis], sum);
      for (int p = 0; p < run.points; ++p) {
        const double factor = scale * run.stiffness * run.coefficient[p];
        double* at = to[axis] + first + run.offset[p];
        for (int e = 0; e < count; ++e) at[e] += factor * sum[e];
      }
    }
  });
}

}  // namespace cloth
