// Two lanes of SSE2, part of every x86-64 processor. What the functions do: lanes_portable.h.
#pragma once

#include <emmintrin.h>

namespace cloth::kernels {
namespace {

struct Lanes {
  static constexpr int width = 2;
  static constexpr unsigned divided =
      63;  ///< bits of the directions whose roots are computed by division: all
  using V = __m128d;
  struct Spring {
    V stiffness, rest_tension;
  };

  static V set(double a) { return _mm_set1_pd(a); }
  static V zero() { return _mm_setzero_pd(); }
  static V load(const double* p) { return _mm_loadu_pd(p); }
  static V load(const double* p, int count, V otherwise) {
    if (count >= 2) return load(p);
    return count == 1 ? _mm_loadl_pd(otherwise, p) : otherwise;
  }
  static void store(double* p, V a) { _mm_storeu_pd(p, a); }
  static void store(double* p, V a, int count) {
    if (count >= 2)
      store(p, a);
    else if (count == 1)
      _mm_store_sd(p, a);
  }
  static V add(V a, V b) { return _mm_add_pd(a, b); }
  static V sub(V a, V b) { return _mm_sub_pd(a, b); }
  static V mul(V a, V b) { return _mm_mul_pd(a, b); }
  static V fma(V a, V b, V c) { return _mm_add_pd(_mm_mul_pd(a, b), c); }
  static V fnma(V a, V b, V c) { return _mm_sub_pd(c, _mm_mul_pd(a, b)); }
  static V div(V a, V b) { return _mm_div_pd(a, b); }
  static V min(V a, V b) { return _mm_min_pd(a, b); }
  static V max(V a, V b) { return _mm_max_pd(a, b); }
  static bool any_positive(V a) { return _mm_movemask_pd(_mm_cmpgt_pd(a, zero())) != 0; }
  static void pairs_one(V a, V b, V& first, V& second) {
    first = _mm_unpacklo_pd(a, b), second = _mm_unpackhi_pd(a, b);
  }
  static void unpair_one(V first, V second, V& a, V& b) { pairs_one(first, second, a, b); }
  static void pairs_two(V a, V b, V& first, V& second) { first = a, second = b; }
  static void unpair_two(V first, V second, V& a, V& b) { a = first, b = second; }
  static V shift_one(V before, V now) { return _mm_shuffle_pd(before, now, 0b01); }
  static V shift_two(V before, V) { return before; }
  static double sum(V a) { return _mm_cvtsd_f64(a) + _mm_cvtsd_f64(_mm_unpackhi_pd(a, a)); }
  static Spring spring(double stiffness, double rest_tension) { return {set(stiffness), set(rest_tension)}; }
  template <bool Divide>
  static V spring_scale(V s, const Spring& spring) {
    const V part = _mm_div_pd(spring.rest_tension, _mm_sqrt_pd(s));
    return _mm_sub_pd(spring.stiffness, _mm_andnot_pd(_mm_cmpeq_pd(s, zero()), part));
  }

  template <bool Divide>
  static V inverse_root(V s) {
    return _mm_andnot_pd(_mm_cmpeq_pd(s, zero()), _mm_div_pd(set(1), _mm_sqrt_pd(s)));
  }
  static V scale_at(V inverse_root, const Spring& spring) {
    return fnma(spring.rest_tension, inverse_root, spring.stiffness);
  }

  // Only for general meshes.

  static V where_positive(V k, V value) { return _mm_and_pd(_mm_cmpgt_pd(k, zero()), value); }
  static V scale(V s, V stiffness, V tension) {
    return _mm_sub_pd(stiffness, _mm_div_pd(tension, _mm_sqrt_pd(s)));
  }
  static V exact_scale(V s, V stiffness, V tension) { return spring_scale<true>(s, {stiffness, tension}); }
  static bool is_in_doubt(V force) { return _mm_movemask_pd(_mm_cmpunord_pd(force, force)) != 0; }
  using Table = const double*;
  using Kinds = const unsigned char*;
  static Table table(const double* eight) { return eight; }
  static Kinds kinds(const unsigned char* p) { return p; }
  static V pick(Table table, Kinds k) { return _mm_setr_pd(table[k[0]], table[k[1]]); }
  static void gather(const double* vectors, const int* at, V& x, V& y, V& z) {
    const double *a = vectors + at[0], *b = vectors + at[1];
    const V xy0 = _mm_load_pd(a), xy1 = _mm_load_pd(b);
    x = _mm_unpacklo_pd(xy0, xy1), y = _mm_unpackhi_pd(xy0, xy1);
    z = _mm_loadh_pd(_mm_load_sd(a + 2), b + 2);
  }
  static void put(double* to, V x, V y, V z) {
    store(to, _mm_unpacklo_pd(x, y)), store(to + 2, _mm_unpacklo_pd(z, zero()));
    store(to + 4, _mm_unpackhi_pd(x, y)), store(to + 6, _mm_unpackhi_pd(z, zero()));
  }
};

}  // namespace
}  // namespace cloth::kernels
