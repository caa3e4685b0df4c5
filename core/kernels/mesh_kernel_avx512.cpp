// For x86-64 with AVX-512 (F, DQ, VL): registers of eight doubles. Compiled with flags of its own.
#if defined(__x86_64__)
#include <immintrin.h>

#include "kernels/mesh_kernel.h"

namespace cloth {
namespace {

using Lanes = __m512d;
constexpr int lanes = 8;

inline Lanes load_lanes(const double* from) {
  return _mm512_loadu_pd(from);
}
inline void store_lanes(double* to, Lanes a) {
  _mm512_storeu_pd(to, a);
}
/// 1/sqrt(a) to full precision for a in [least, most]: the processor's estimate r of 14 bits times the series
/// of 1/sqrt(1 - h), h = 1 - a r^2, to the third power; what is left out is below 2^-53. Seven operations in
/// place of a square root and a division, which keep the divider busy for longer than all the rest
/// takes.
inline Lanes reciprocal_root(Lanes a) {
  const Lanes r = _mm512_rsqrt14_pd(a);
  const Lanes h = _mm512_fnmadd_pd(r * a, r, _mm512_set1_pd(1));
  const Lanes series = _mm512_fmadd_pd(_mm512_fmadd_pd(h, _mm512_set1_pd(5.0 / 16), _mm512_set1_pd(3.0 / 8)),
                                       h, _mm512_set1_pd(0.5));
  return _mm512_fmadd_pd(series, r * h, r);
}

inline Lanes scale_of(Lanes dx, Lanes dy, Lanes dz, Lanes k, Lanes kL) {
  // Clamped to normal numbers: |d| = 0 gives a large scale that is multiplied with 0; NaN stays in d.
  const Lanes least = _mm512_set1_pd(__DBL_MIN__), most = _mm512_set1_pd(__DBL_MAX__);
  const Lanes squared = _mm512_fmadd_pd(dz, dz, _mm512_fmadd_pd(dy, dy, dx * dx));
  return _mm512_fnmadd_pd(kL, reciprocal_root(_mm512_min_pd(_mm512_max_pd(squared, least), most)), k);
}
inline Lanes where_positive(Lanes test, Lanes a) {
  return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(test, _mm512_setzero_pd(), _CMP_GT_OQ), a);
}

/// The 4-vectors [a | b] from two places in memory.
inline Lanes halves(const double* a, const double* b) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(a)), _mm256_load_pd(b), 1);
}

// Of [a0 a1 a2 a3 | a4 a5 a6 a7] and b: the lower, or the upper, pair of a's half and then of b's.
inline Lanes lower_pairs(Lanes a, Lanes b) {
  return _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), b);
}
inline Lanes upper_pairs(Lanes a, Lanes b) {
  return _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15), b);
}

template <class At>
inline void gather(const double* from, At at, Lanes& x, Lanes& y, Lanes& z) {
  const auto pair = [&](int lane) { return halves(from + at(lane), from + at(lane + 4)); };
  const Lanes a = pair(0), b = pair(1), c = pair(2), d = pair(3);
  const Lanes xz01 = _mm512_unpacklo_pd(a, b), xz23 = _mm512_unpacklo_pd(c, d);
  x = lower_pairs(xz01, xz23), z = upper_pairs(xz01, xz23);
  y = lower_pairs(_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
}

template <class At, class Visit>
inline void for_each_vector(At at, Lanes x, Lanes y, Lanes z, Visit visit) {
  const Lanes zero = _mm512_setzero_pd();
  const Lanes xy02 = _mm512_unpacklo_pd(x, y), xy13 = _mm512_unpackhi_pd(x, y);
  const Lanes z02 = _mm512_unpacklo_pd(z, zero), z13 = _mm512_unpackhi_pd(z, zero);
  const Lanes v04 = lower_pairs(xy02, z02), v26 = upper_pairs(xy02, z02);
  const Lanes v15 = lower_pairs(xy13, z13), v37 = upper_pairs(xy13, z13);
  visit(at(0), _mm512_castpd512_pd256(v04));
  visit(at(1), _mm512_castpd512_pd256(v15));
  visit(at(2), _mm512_castpd512_pd256(v26));
  visit(at(3), _mm512_castpd512_pd256(v37));
  visit(at(4), _mm512_extractf64x4_pd(v04, 1));
  visit(at(5), _mm512_extractf64x4_pd(v15, 1));
  visit(at(6), _mm512_extractf64x4_pd(v26, 1));
  visit(at(7), _mm512_extractf64x4_pd(v37, 1));
}

inline void put(double* to, __m256d a) {
  _mm256_store_pd(to, a);
}
inline void add_to(double* to, __m256d a) {
  _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), a));
}

#include "kernels/mesh_kernel.inl"

}  // namespace

const MeshKernel& avx512_mesh_kernel() {
  static constexpr MeshKernel kernel{"avx512", load, add_springs, store, sweep};
  return kernel;
}

}  // namespace cloth
#endif
