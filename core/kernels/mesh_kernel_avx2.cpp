// For x86-64 with AVX2: registers of four doubles. Compiled with flags of its own.
#if defined(__x86_64__)
#include <immintrin.h>

#include "kernels/mesh_kernel.h"

namespace cloth {
namespace {

using Lanes = __m256d;
constexpr int lanes = 4;

inline Lanes load_lanes(const double* from) {
  return _mm256_loadu_pd(from);
}
inline void store_lanes(double* to, Lanes a) {
  _mm256_storeu_pd(to, a);
}
inline Lanes scale_of(Lanes dx, Lanes dy, Lanes dz, Lanes k, Lanes kL) {
  const Lanes length = _mm256_sqrt_pd(dx * dx + dy * dy + dz * dz);
  return _mm256_and_pd(k - kL / length, _mm256_cmp_pd(length, _mm256_setzero_pd(), _CMP_GT_OQ));
}
inline Lanes where_positive(Lanes test, Lanes a) {
  return _mm256_and_pd(a, _mm256_cmp_pd(test, _mm256_setzero_pd(), _CMP_GT_OQ));
}

/// The halves [a | b] from two places in memory.
inline Lanes halves(const double* a, const double* b) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(a)), _mm_load_pd(b), 1);
}

template <class At>
inline void gather(const double* from, At at, Lanes& x, Lanes& y, Lanes& z) {
  const double *a = from + at(0), *b = from + at(1), *c = from + at(2), *d = from + at(3);
  const Lanes xy02 = halves(a, c), xy13 = halves(b, d);
  x = _mm256_unpacklo_pd(xy02, xy13), y = _mm256_unpackhi_pd(xy02, xy13);
  z = _mm256_unpacklo_pd(halves(a + 2, c + 2), halves(b + 2, d + 2));
}

template <class At, class Visit>
inline void for_each_vector(At at, Lanes x, Lanes y, Lanes z, Visit visit) {
  const Lanes zero = _mm256_setzero_pd();
  const Lanes xy02 = _mm256_unpacklo_pd(x, y), xy13 = _mm256_unpackhi_pd(x, y);
  const Lanes z02 = _mm256_unpacklo_pd(z, zero), z13 = _mm256_unpackhi_pd(z, zero);
  visit(at(0), _mm256_permute2f128_pd(xy02, z02, 0x20));
  visit(at(1), _mm256_permute2f128_pd(xy13, z13, 0x20));
  visit(at(2), _mm256_permute2f128_pd(xy02, z02, 0x31));
  visit(at(3), _mm256_permute2f128_pd(xy13, z13, 0x31));
}

inline void put(double* to, __m256d a) {
  _mm256_store_pd(to, a);
}
inline void add_to(double* to, __m256d a) {
  _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), a));
}

#include "kernels/mesh_kernel.inl"

}  // namespace

const MeshKernel& avx2_mesh_kernel() {
  static constexpr MeshKernel kernel{"avx2", load, add_springs, store, sweep};
  return kernel;
}

}  // namespace cloth
#endif
