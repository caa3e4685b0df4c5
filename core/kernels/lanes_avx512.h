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
  static V div(V a, V b) { return _mm512_div_pd(a, b); }
  static V min(V a, V b) { return _mm512_min_pd(a, b); }
  static V max(V a, V b) { return _mm512_max_pd(a, b); }
  static bool any_positive(V a) { return _mm512_cmp_pd_mask(a, zero(), _CMP_GT_OQ) != 0; }
  static void pairs_one(V a, V b, V& first, V& second) {
    first = _mm512_unpacklo_pd(a, b), second = _mm512_unpackhi_pd(a, b);
  }
  static void unpair_one(V first, V second, V& a, V& b) { pairs_one(first, second, a, b); }
  static void pairs_two(V a, V b, V& first, V& second) {
    first = _mm512_shuffle_f64x2(a, b, 0x88), second = _mm512_shuffle_f64x2(a, b, 0xdd);
  }
  static void unpair_two(V first, V second, V& a, V& b) {
    a = _mm512_permutex2var_pd(first, _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), second);
    b = _mm512_permutex2var_pd(first, _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15), second);
  }
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

  template <bool Divide>
  static V inverse_root(V s) {
    const V y = _mm512_rsqrt14_pd(s);
    const V e = fnma(mul(s, y), y, set(1));
    const V root = fma(mul(y, e), fma(fma(set(5.0 / 16), e, set(3.0 / 8)), e, set(0.5)), y);
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(e, e, _CMP_ORD_Q), root);
  }

  static V scale_at(V inverse_root, const Spring& spring) {
    return fnma(spring.rest_tension, inverse_root, spring.stiffness);
  }

  // Only for general meshes.

  static V where_positive(V k, V value) {
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(k, zero(), _CMP_GT_OQ), value);
  }
  static V scale(V s, V stiffness, V tension) {
    const V y = _mm512_rsqrt14_pd(s);
    const V e = fnma(mul(s, y), y, set(1));
    const V series = fma(fma(set(5.0 / 16), e, set(3.0 / 8)), e, set(0.5));
    return fnma(tension, fma(series, mul(y, e), y), stiffness);
  }
  static V exact_scale(V s, V stiffness, V tension) {
    return spring_scale<true>(s, {stiffness, tension, zero(), zero(), zero()});
  }
  static bool is_in_doubt(V force) { return _mm512_cmp_pd_mask(force, force, _CMP_UNORD_Q) != 0; }
  using Table = V;
  using Kinds = __m512i;
  static Table table(const double* eight) { return load(eight); }
  static Kinds kinds(const unsigned char* p) {
    return _mm512_cvtepu8_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
  }
  static V pick(Table table, Kinds kinds) { return _mm512_permutexvar_pd(kinds, table); }

  /// The 4-vectors [a | b] from two places in memory.
  static V halves(const double* a, const double* b) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(a)), _mm256_load_pd(b), 1);
  }
  // Of [a0 a1 a2 a3 | a4 a5 a6 a7] and b: the lower, or the upper, pair of a's half and then of b's.
  static V lower_pairs(V a, V b) {
    return _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), b);
  }
  static V upper_pairs(V a, V b) {
    return _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15), b);
  }
  static void gather(const double* vectors, const int* at, V& x, V& y, V& z) {
    const auto pair = [&](int lane) { return halves(vectors + at[lane], vectors + at[lane + 4]); };
    const V a = pair(0), b = pair(1), c = pair(2), d = pair(3);
    const V xz01 = _mm512_unpacklo_pd(a, b), xz23 = _mm512_unpacklo_pd(c, d);
    x = lower_pairs(xz01, xz23), z = upper_pairs(xz01, xz23);
    y = lower_pairs(_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
  }
  static void put(double* to, V x, V y, V z) {
    const V xy02 = _mm512_unpacklo_pd(x, y), xy13 = _mm512_unpackhi_pd(x, y);
    const V z02 = _mm512_unpacklo_pd(z, zero()), z13 = _mm512_unpackhi_pd(z, zero());
    const V v04 = lower_pairs(xy02, z02), v26 = upper_pairs(xy02, z02);
    const V v15 = lower_pairs(xy13, z13), v37 = upper_pairs(xy13, z13);
    const auto put_two = [to](int k, V a, V b) {
      _mm512_storeu_pd(to + 4 * k, _mm512_insertf64x4(a, _mm512_castpd512_pd256(b), 1));
      _mm512_storeu_pd(to + 4 * k + 16, _mm512_insertf64x4(b, _mm512_extractf64x4_pd(a, 1), 0));
    };
    put_two(0, v04, v15), put_two(2, v26, v37);
  }
};

}  // namespace
}  // namespace cloth::kernels
