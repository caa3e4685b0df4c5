// Four lanes of AVX2 with fused multiply-add. What the functions do: lanes_portable.h.
#pragma once

#include <immintrin.h>

#include "kernels/grid_pass.h"

namespace cloth::kernels {
namespace {

struct Lanes {
  static constexpr int width = 4;
  /// Directions whose roots are computed by division; the others are refined from an estimate, so that the
  /// divider and the multipliers are busy at the same time.
  static constexpr unsigned divided = right_one | down_one | diagonal;
  using V = __m256d;
  struct Spring {
    V stiffness, rest_tension;
  };

  static V set(double a) { return _mm256_set1_pd(a); }
  static V zero() { return _mm256_setzero_pd(); }
  static V load(const double* p) { return _mm256_loadu_pd(p); }
  static __m256i first(int count) {
    return _mm256_cmpgt_epi64(_mm256_set1_epi64x(count), _mm256_setr_epi64x(0, 1, 2, 3));
  }
  static V load(const double* p, int count, V otherwise) {
    const __m256i mask = first(count);
    return _mm256_blendv_pd(otherwise, _mm256_maskload_pd(p, mask), _mm256_castsi256_pd(mask));
  }
  static void store(double* p, V a) { _mm256_storeu_pd(p, a); }
  static void store(double* p, V a, int count) { _mm256_maskstore_pd(p, first(count), a); }
  static V add(V a, V b) { return _mm256_add_pd(a, b); }
  static V sub(V a, V b) { return _mm256_sub_pd(a, b); }
  static V mul(V a, V b) { return _mm256_mul_pd(a, b); }
  static V fma(V a, V b, V c) { return _mm256_fmadd_pd(a, b, c); }
  static V fnma(V a, V b, V c) { return _mm256_fnmadd_pd(a, b, c); }
  static V div(V a, V b) { return _mm256_div_pd(a, b); }
  static V min(V a, V b) { return _mm256_min_pd(a, b); }
  static V max(V a, V b) { return _mm256_max_pd(a, b); }
  static bool any_positive(V a) { return _mm256_movemask_pd(_mm256_cmp_pd(a, zero(), _CMP_GT_OQ)) != 0; }
  static void pairs_one(V a, V b, V& first, V& second) {
    first = _mm256_unpacklo_pd(a, b), second = _mm256_unpackhi_pd(a, b);
  }
  static void unpair_one(V first, V second, V& a, V& b) { pairs_one(first, second, a, b); }
  static void pairs_two(V a, V b, V& first, V& second) {
    first = _mm256_permute2f128_pd(a, b, 0x20), second = _mm256_permute2f128_pd(a, b, 0x31);
  }
  static void unpair_two(V first, V second, V& a, V& b) { pairs_two(first, second, a, b); }
  static V shift_two(V before, V now) { return _mm256_permute2f128_pd(before, now, 0x21); }
  static V shift_one(V before, V now) { return _mm256_shuffle_pd(shift_two(before, now), now, 0b0101); }
  static double sum(V a) {
    const __m128d half = _mm_add_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
    return _mm_cvtsd_f64(half) + _mm_cvtsd_f64(_mm_unpackhi_pd(half, half));
  }
  static Spring spring(double stiffness, double rest_tension) { return {set(stiffness), set(rest_tension)}; }

  static V divided_root(V s) {
    const V inverse = _mm256_div_pd(set(1), _mm256_sqrt_pd(s));
    return _mm256_andnot_pd(_mm256_cmp_pd(s, zero(), _CMP_EQ_OQ), inverse);
  }
  [[gnu::noinline]] static V rarely_divided_root(V s) { return divided_root(s); }
  /// 1/sqrt(s) from the 12-bit seed y of single precision: with e = 1 - s y^2,
  ///     1/sqrt(s) = y (1 - e)^(-1/2) = y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + 35/128 e^4 + ...),
  /// whose rest is below 2^-53. Numbers beyond the range of single precision have no seed; e^2 then is not
  /// finite or too large, and they are computed by division.
  static V refined_root(V s) {
    const V y = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(s)));
    const V e = fnma(mul(s, y), y, set(1));
    const V square = mul(e, e);
    const V in_range = _mm256_cmp_pd(square, set(0x1p-19), _CMP_LT_OQ);
    if (_mm256_movemask_pd(in_range) != 0b1111) [[unlikely]]
      return rarely_divided_root(s);
    const V high = fma(fma(set(35.0 / 128), e, set(5.0 / 16)), e, set(3.0 / 8));
    return fma(mul(y, e), fma(high, e, set(0.5)), y);
  }
  template <bool Divide>
  static V inverse_root(V s) {
    return Divide ? divided_root(s) : refined_root(s);
  }
  static V scale_at(V inverse_root, const Spring& spring) {
    return fnma(spring.rest_tension, inverse_root, spring.stiffness);
  }
  template <bool Divide>
  static V spring_scale(V s, const Spring& spring) {
    return scale_at(inverse_root<Divide>(s), spring);
  }

  // Only for general meshes. Tables are read from memory: no register holds eight doubles.

  static V where_positive(V k, V value) { return _mm256_and_pd(_mm256_cmp_pd(k, zero(), _CMP_GT_OQ), value); }
  static V scale(V s, V stiffness, V tension) {
    return fnma(tension, _mm256_div_pd(set(1), _mm256_sqrt_pd(s)), stiffness);
  }
  static V exact_scale(V s, V stiffness, V tension) { return spring_scale<true>(s, {stiffness, tension}); }
  static bool is_in_doubt(V force) {
    return _mm256_movemask_pd(_mm256_cmp_pd(force, force, _CMP_UNORD_Q)) != 0;
  }
  using Table = const double*;
  using Kinds = const unsigned char*;
  static Table table(const double* eight) { return eight; }
  static Kinds kinds(const unsigned char* p) { return p; }
  static V pick(Table table, Kinds k) {
    return _mm256_setr_pd(table[k[0]], table[k[1]], table[k[2]], table[k[3]]);
  }

  /// The pairs [a | b] from two places in memory.
  static V halves(const double* a, const double* b) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(a)), _mm_load_pd(b), 1);
  }
  static void gather(const double* vectors, const int* at, V& x, V& y, V& z) {
    const double *a = vectors + at[0], *b = vectors + at[1], *c = vectors + at[2], *d = vectors + at[3];
    const V xy02 = halves(a, c), xy13 = halves(b, d);
    x = _mm256_unpacklo_pd(xy02, xy13), y = _mm256_unpackhi_pd(xy02, xy13);
    z = _mm256_unpacklo_pd(halves(a + 2, c + 2), halves(b + 2, d + 2));
  }
  static void put(double* to, V x, V y, V z) {
    const V xy02 = _mm256_unpacklo_pd(x, y), xy13 = _mm256_unpackhi_pd(x, y);
    const V z02 = _mm256_unpacklo_pd(z, zero()), z13 = _mm256_unpackhi_pd(z, zero());
    store(to, _mm256_permute2f128_pd(xy02, z02, 0x20));
    store(to + 4, _mm256_permute2f128_pd(xy13, z13, 0x20));
    store(to + 8, _mm256_permute2f128_pd(xy02, z02, 0x31));
    store(to + 12, _mm256_permute2f128_pd(xy13, z13, 0x31));
  }
};

}  // namespace
}  // namespace cloth::kernels
