// Eight lanes of AVX-512 (F, DQ, VL). What the functions do: lanes_portable.h.
#pragma once

#include <immintrin.h>

#include "kernels/grid_pass.h"

namespace cloth::kernels {
namespace {

struct Lanes {
  static constexpr int width = 8;
  static constexpr unsigned divided = 0;  ///< see lanes_avx2.h
  using V = __m512d;
  struct Spring {
    V stiffness, rest_tension, half, three_eighths, five_sixteenths;  ///< the last ones times k L
  };

  static V set(double a) { return _mm512_set1_pd(a); }
  static V zero() { return _mm512_setzero_pd(); }
  static V load(const double* p) { return _mm512_loadu_pd(p); }
  static __mmask8 first(int count) {
    return static_cast<__mmask8>(count >= width ? 0xff : count <= 0 ? 0 : (1 << count) - 1);
  }
  static V load(const double* p, int count, V otherwise) {
    return _mm512_mask_loadu_pd(otherwise, first(count), p);
  }
  static void store(double* p, V a) { _mm512_storeu_pd(p, a); }
  static void store(double* p, V a, int count) { _mm512_mask_storeu_pd(p, first(count), a); }
  static V add(V a, V b) { return _mm512_add_pd(a, b); }
  static V sub(V a, V b) { return _mm512_sub_pd(a, b); }
  static V mul(V a, V b) { return _mm512_mul_pd(a, b); }
  static V fma(V a, V b, V c) { return _mm512_fmadd_pd(a, b, c); }
  static V fnma(V a, V b, V c) { return _mm512_fnmadd_pd(a, b, c); }
  template <int lanes>
  static V shift(V before, V now) {
    return _mm512_castsi512_pd(
        _mm512_alignr_epi64(_mm512_castpd_si512(now), _mm512_castpd_si512(before), width - lanes));
  }
  static V shift_one(V before, V now) { return shift<1>(before, now); }
  static V shift_two(V before, V now) { return shift<2>(before, now); }
  static double sum(V a) { return _mm512_reduce_add_pd(a); }
  static Spring spring(double stiffness, double rest_tension) {
    return {set(stiffness), set(rest_tension), set(rest_tension / 2), set(rest_tension * 3 / 8),
            set(rest_tension * 5 / 16)};
  }

  /// k L / sqrt(s) from the 14-bit seed y: with e = 1 - s y^2,
  ///     1/sqrt(s) = y (1 - e)^(-1/2) = y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...),
  /// whose rest is below 2^-53. k L is folded into the coefficients. Where s is zero or infinite e is not a
  /// number and nothing is subtracted from k.
  template <bool Divide>
  static V spring_scale(V s, const Spring& spring) {
    if constexpr (Divide) {
      const __mmask8 has_length = _mm512_cmp_pd_mask(s, zero(), _CMP_NEQ_UQ);
      const V part = _mm512_div_pd(spring.rest_tension, _mm512_sqrt_pd(s));
      return _mm512_mask_sub_pd(spring.stiffness, has_length, spring.stiffness, part);
    }
    const V y = _mm512_rsqrt14_pd(s);
    const V e = fnma(mul(s, y), y, set(1));
    const __mmask8 has_direction = _mm512_cmp_pd_mask(e, e, _CMP_ORD_Q);
    const V series = fma(fma(fma(spring.five_sixteenths, e, spring.three_eighths), e, spring.half), e,
                         spring.rest_tension);
    return _mm512_mask3_fnmadd_pd(y, series, spring.stiffness, has_direction);
  }
};

}  // namespace
}  // namespace cloth::kernels
