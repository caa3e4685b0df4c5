#include "kernels/vector_kernels.h"

#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

void multiply_blocks(BlockRows b, ConstVectorRows d, VectorRows p, std::size_t count) {
  double* __restrict px = p.x, * __restrict py = p.y, * __restrict pz = p.z;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = d.x[i], dy = d.y[i], dz = d.z[i];
    px[i] = b.xx[i] * dx + b.xy[i] * dy + b.xz[i] * dz;
    py[i] = b.xy[i] * dx + b.yy[i] * dy + b.yz[i] * dz;
    pz[i] = b.xz[i] * dx + b.yz[i] * dy + b.zz[i] * dz;
  }
}

void add_springs(BlockRows b, ConstVectorRows d, VectorRows p, std::ptrdiff_t offset, int count) {
  alignas(64) double gx[VectorKernels::max_springs], gy[VectorKernels::max_springs],
      gz[VectorKernels::max_springs];
  for (int s = 0; s < count; ++s) {
    const double dx = d.x[s] - d.x[s + offset], dy = d.y[s] - d.y[s + offset], dz = d.z[s] - d.z[s + offset];
    gx[s] = b.xx[s] * dx + b.xy[s] * dy + b.xz[s] * dz;
    gy[s] = b.xy[s] * dx + b.yy[s] * dy + b.yz[s] * dz;
    gz[s] = b.xz[s] * dx + b.yz[s] * dy + b.zz[s] * dz;
  }
  for (int s = 0; s < count; ++s) p.x[s] += gx[s];
  for (int s = 0; s < count; ++s) p.y[s] += gy[s];
  for (int s = 0; s < count; ++s) p.z[s] += gz[s];
  double *qx = p.x + offset, *qy = p.y + offset, *qz = p.z + offset;
  for (int s = 0; s < count; ++s) qx[s] -= gx[s];
  for (int s = 0; s < count; ++s) qy[s] -= gy[s];
  for (int s = 0; s < count; ++s) qz[s] -= gz[s];
}

void add_multiple(double scale, const double* __restrict from, double* __restrict to, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) to[k] += scale * from[k];
}

void scale_and_add(double scale, const double* __restrict from, double* __restrict to, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) to[k] = scale * to[k] + from[k];
}

double dot(const double* a, const double* b, std::size_t count) {
  return kernels::dot_product(a, b, count);
}

constexpr VectorKernels table{multiply_blocks, add_springs, dot, add_multiple, scale_and_add};

}  // namespace

const VectorKernels& VectorKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
