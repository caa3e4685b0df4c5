#include "integrators/implicit/limited_memory.h"

#include <cmath>
#include <utility>

#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

double product_of(const Vec3Field& a, const Vec3Field& b) {
  return active_kernels<VectorKernels>().dot(a.flat().data(), b.flat().data(), a.flat().size());
}

void add_to(double scale, const Vec3Field& from, Vec3Field& to) {
  active_kernels<VectorKernels>().add_multiple(scale, from.flat().data(), to.flat().data(), to.flat().size());
}

}  // namespace

void LimitedMemory::add(Vec3Field change, Vec3Field growth) {
  constexpr double smallest_cosine = 1e-10;
  const double product = product_of(change, growth);
  const double lengths = std::sqrt(product_of(change, change) * product_of(growth, growth));
  if (!(product > smallest_cosine * lengths) || !std::isfinite(product)) return;
  if (pairs_.size() == most) pairs_.pop_front();
  pairs_.push_back({std::move(change), std::move(growth), product, 0});
}

void LimitedMemory::direction(const Vec3Field& residual, const LinearMap& preconditioner,
                              Vec3Field& direction) {
  rest_ = residual;
  for (std::size_t n = pairs_.size(); n-- > 0;) {
    Pair& pair = pairs_[n];
    pair.weight = product_of(pair.change, rest_) / pair.product;
    add_to(-pair.weight, pair.growth, rest_);
  }
  preconditioner(rest_, direction);
  for (const Pair& pair : pairs_)
    add_to(pair.weight - product_of(pair.growth, direction) / pair.product, pair.change, direction);
  for (double& value : direction.flat()) value = -value;
}

}  // namespace cloth
