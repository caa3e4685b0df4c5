#include "limiter/sweep_kernels.h"

#if defined(__SSE2__) && defined(__x86_64__)

#include <immintrin.h>

#include "limiter/sweep_kernel_body.h"

namespace cloth {
namespace {

struct Lanes {
  static constexpr int width = 2;
  using Mask = __m128d;
  __m128d value;
  static Lanes load(const double* p) { return {_mm_loadu_pd(p)}; }
  static Lanes broadcast(double a) { return {_mm_set1_pd(a)}; }
  void store(double* p) const { _mm_storeu_pd(p, value); }
  Lanes swapped() const { return {_mm_shuffle_pd(value, value, 1)}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_pd(a.value, b.value)}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {_mm_sub_pd(a.value, b.value)}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {_mm_mul_pd(a.value, b.value)}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {_mm_div_pd(a.value, b.value)}; }
  Lanes root() const { return {_mm_sqrt_pd(value)}; }
  static Lanes larger_of(Lanes a, Lanes b) { return {_mm_max_pd(a.value, b.value)}; }
  Mask over(Lanes limit) const { return _mm_cmpgt_pd(value, limit.value); }
  static bool any(Mask mask) { return _mm_movemask_pd(mask) != 0; }
  static Lanes chosen(Mask mask, Lanes a, Lanes b) {
    return {_mm_or_pd(_mm_and_pd(mask, a.value), _mm_andnot_pd(mask, b.value))};
  }
};

}  // namespace

const SweepKernels* sse2_sweep_kernels() {
  static constexpr SweepKernels kernels = kernels_of<Lanes>("sse2");
  return &kernels;
}

}  // namespace cloth

#else

const cloth::SweepKernels* cloth::sse2_sweep_kernels() {
  return nullptr;
}

#endif
