#include "limiter/sweep_kernels.h"

#if defined(__AVX2__)

#include <immintrin.h>

#include "limiter/sweep_kernel_body.h"

namespace cloth {
namespace {

struct Lanes {
  static constexpr int width = 4;
  using Mask = __m256d;
  __m256d value;
  static Lanes load(const double* p) { return {_mm256_loadu_pd(p)}; }
  static Lanes broadcast(double a) { return {_mm256_set1_pd(a)}; }
  void store(double* p) const { _mm256_storeu_pd(p, value); }
  Lanes swapped() const { return {_mm256_permute_pd(value, 0x5)}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {_mm256_add_pd(a.value, b.value)}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {_mm256_sub_pd(a.value, b.value)}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {_mm256_mul_pd(a.value, b.value)}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {_mm256_div_pd(a.value, b.value)}; }
  Lanes root() const { return {_mm256_sqrt_pd(value)}; }
  static Lanes larger_of(Lanes a, Lanes b) { return {_mm256_max_pd(a.value, b.value)}; }
  Mask over(Lanes limit) const { return _mm256_cmp_pd(value, limit.value, _CMP_GT_OQ); }
  static bool any(Mask mask) { return _mm256_movemask_pd(mask) != 0; }
  static Lanes chosen(Mask mask, Lanes a, Lanes b) { return {_mm256_blendv_pd(b.value, a.value, mask)}; }
};

}  // namespace

const SweepKernels* avx2_sweep_kernels() {
  static constexpr SweepKernels kernels = kernels_of<Lanes>("avx2");
  return &kernels;
}

}  // namespace cloth

#else

const cloth::SweepKernels* cloth::avx2_sweep_kernels() {
  return nullptr;
}

#endif
