#include "integrators/implicit/limited_memory.h"

#include <algorithm>
#include <cmath>

#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

/// Calls visit(begin, count) for stretches of a field's numbers that stay in the first cache.
template <class Visit>
void for_each_stretch(std::size_t size, Visit&& visit) {
  constexpr std::size_t stretch = 1024;
  for (std::size_t begin = 0; begin < size; begin += stretch) visit(begin, std::min(stretch, size - begin));
}

const double* at(const Vec3Field& field, std::size_t begin) {
  return field.flat().data() + begin;
}
double* at(Vec3Field& field, std::size_t begin) {
  return field.flat().data() + begin;
}

}  // namespace

/// The projections of a residual.
void LimitedMemory::project(const Vec3Field& residual) {
  const auto& kernels = active_kernels<VectorKernels>();
  Products sums{};
  for_each_stretch(residual.flat().size(), [&](std::size_t begin, std::size_t count) {
    for (std::size_t n = 0; n < count_; ++n)
      sums[n] += kernels.dot(at(pairs_[n].change, begin), at(residual, begin), count);
  });
  projections_ = sums;
}

/// A change's product with the new pair's growth is the difference of its projections.
void LimitedMemory::add_pair(const Vec3Field& residual, double length, const Vec3Field& direction) {
  constexpr double smallest_cosine = 1e-10;
  const auto& kernels = active_kernels<VectorKernels>();
  Pair& pair = pairs_[count_];
  if (pair.change.size() != residual.size()) pair.change = pair.growth = Vec3Field(residual.size());
  double product = 0, of_changes = 0, of_growths = 0, projection = 0;
  for_each_stretch(residual.flat().size(), [&](std::size_t begin, std::size_t count) {
    double *change = at(pair.change, begin), *growth = at(pair.growth, begin);
    const double *along = at(direction, begin), *now = at(residual, begin), *before = at(last_, begin);
    for (std::size_t k = 0; k < count; ++k) change[k] = length * along[k], growth[k] = now[k] - before[k];
    product += kernels.dot(change, growth, count);
    of_changes += kernels.dot(change, change, count);
    of_growths += kernels.dot(growth, growth, count);
    projection += kernels.dot(change, now, count);
  });
  const Products before = projections_;
  project(residual);
  if (!(product > smallest_cosine * std::sqrt(of_changes * of_growths)) || !std::isfinite(product)) return;
  pair.product = product;
  for (std::size_t n = 0; n < count_; ++n) pair.of_older[n] = projections_[n] - before[n];
  projections_[count_++] = projection;
  if (count_ <= most) return;
  std::rotate(pairs_.begin(), pairs_.begin() + 1, pairs_.end());
  for (std::size_t n = 0; n < most; ++n)
    std::rotate(pairs_[n].of_older.begin(), pairs_[n].of_older.begin() + 1, pairs_[n].of_older.end());
  std::rotate(projections_.begin(), projections_.begin() + 1, projections_.end());
  count_ = most;
}

void LimitedMemory::next(const Vec3Field& residual, double length, const LinearMap& preconditioner,
                         Vec3Field& direction) {
  const auto& kernels = active_kernels<VectorKernels>();
  const std::size_t size = residual.flat().size();
  length != 0 ? add_pair(residual, length, direction) : project(residual);
  last_ = rest_ = residual;

  Products weight{};
  for (std::size_t i = count_; i-- > 0;) {
    double projection = projections_[i];
    for (std::size_t j = i + 1; j < count_; ++j) projection -= weight[j] * pairs_[j].of_older[i];
    weight[i] = projection / pairs_[i].product;
  }
  for_each_stretch(size, [&](std::size_t begin, std::size_t count) {
    for (std::size_t n = count_; n-- > 0;)
      kernels.add_multiple(-weight[n], at(pairs_[n].growth, begin), at(rest_, begin), count);
  });

  preconditioner(rest_, direction);

  Products along{};
  for_each_stretch(size, [&](std::size_t begin, std::size_t count) {
    for (std::size_t n = 0; n < count_; ++n)
      along[n] += kernels.dot(at(pairs_[n].growth, begin), at(direction, begin), count);
  });
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < i; ++j) along[i] += weight[j] * pairs_[i].of_older[j];
    weight[i] -= along[i] / pairs_[i].product;
  }
  for_each_stretch(size, [&](std::size_t begin, std::size_t count) {
    for (std::size_t n = 0; n < count_; ++n)
      kernels.add_multiple(weight[n], at(pairs_[n].change, begin), at(direction, begin), count);
    std::for_each_n(at(direction, begin), count, [](double& value) { value = -value; });
  });
}

}  // namespace cloth
