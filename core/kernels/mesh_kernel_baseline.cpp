// For every processor: registers of two doubles, as the compiler's vector types.
#include "kernels/mesh_kernel.h"

namespace cloth {
namespace {

using Lanes = double __attribute__((vector_size(16)));
constexpr int lanes = 2;

struct Vector {
  Lanes xy, z0;
};

inline Lanes load_lanes(const double* from) {
  return Lanes{from[0], from[1]};
}
inline void store_lanes(double* to, Lanes a) {
  to[0] = a[0], to[1] = a[1];
}
inline Lanes scale_of(Lanes dx, Lanes dy, Lanes dz, Lanes k, Lanes kL) {
  const Lanes squared = dx * dx + dy * dy + dz * dz;
  const Lanes length{__builtin_sqrt(squared[0]), __builtin_sqrt(squared[1])};
  return length > 0 ? k - kL / length : Lanes{};
}

template <class At>
inline void gather(const double* from, At at, Lanes& x, Lanes& y, Lanes& z) {
  const double *a = from + at(0), *b = from + at(1);
  x = Lanes{a[0], b[0]}, y = Lanes{a[1], b[1]}, z = Lanes{a[2], b[2]};
}

template <class At, class Visit>
inline void for_each_vector(At at, Lanes x, Lanes y, Lanes z, Visit visit) {
  for (int lane = 0; lane < lanes; ++lane)
    visit(at(lane), Vector{Lanes{x[lane], y[lane]}, Lanes{z[lane], 0}});
}

inline void put(double* to, Vector a) {
  store_lanes(to, a.xy);
  store_lanes(to + 2, a.z0);
}
inline void add_to(double* to, Vector a) {
  store_lanes(to, load_lanes(to) + a.xy);
  to[2] += a.z0[0];
}

#include "kernels/mesh_kernel.inl"

}  // namespace

const MeshKernel& baseline_mesh_kernel() {
  static constexpr MeshKernel kernel{"baseline", load, add_springs, store, sweep};
  return kernel;
}

}  // namespace cloth
