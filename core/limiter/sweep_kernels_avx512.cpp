#include "limiter/sweep_kernels.h"

#if defined(__AVX512F__)

#include <immintrin.h>

#include "limiter/sweep_kernel_body.h"

namespace cloth {
namespace {

struct Lanes {
  static constexpr int width = 8;
  using Mask = __mmask8;
  __m512d value;
  static Lanes load(const double* p) { return {_mm512_loadu_pd(p)}; }
  static Lanes broadcast(double a) { return {_mm512_set1_pd(a)}; }
  void store(double* p) const { _mm512_storeu_pd(p, value); }
  Lanes swapped() const { return {_mm512_permute_pd(value, 0x55)}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {_mm512_add_pd(a.value, b.value)}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {_mm512_sub_pd(a.value, b.value)}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {_mm512_mul_pd(a.value, b.value)}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {_mm512_div_pd(a.value, b.value)}; }
  Lanes root() const { return {_mm512_sqrt_pd(value)}; }
  static Lanes larger_of(Lanes a, Lanes b) { return {_mm512_max_pd(a.value, b.value)}; }
  Mask over(Lanes limit) const { return _mm512_cmp_pd_mask(value, limit.value, _CMP_GT_OQ); }
  static bool any(Mask mask) { return mask != 0; }
  static Lanes chosen(Mask mask, Lanes a, Lanes b) { return {_mm512_mask_blend_pd(mask, b.value, a.value)}; }
};

}  // namespace

const SweepKernels* avx512_sweep_kernels() {
  static constexpr SweepKernels kernels = kernels_of<Lanes>("avx512");
  return &kernels;
}

}  // namespace cloth

#else

const cloth::SweepKernels* cloth::avx512_sweep_kernels() {
  return nullptr;
}

#endif
