#include "forces/linearisation.h"

namespace cloth {

void Linearisation::multiply(const ClothSystem& system, const Vec3Field& direction,
                             Vec3Field& product) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) product.set(i, nodes[i] * direction[i]);
  std::size_t spring = 0;
  const double *x = direction.x(), *y = direction.y(), *z = direction.z();
  double *px = product.x(), *py = product.y(), *pz = product.z();
  for (const SpringRun& run : system.springs) {
    for (int s = 0; s < run.count; ++s, ++spring) {
      const auto i = static_cast<std::size_t>(run.first + s), j = i + static_cast<std::size_t>(run.offset);
      const SymmetricBlock& b = springs[spring];
      const double dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
      const double gx = b.xx * dx + b.xy * dy + b.xz * dz, gy = b.xy * dx + b.yy * dy + b.yz * dz,
                   gz = b.xz * dx + b.yz * dy + b.zz * dz;
      px[i] += gx, py[i] += gy, pz[i] += gz;
      px[j] -= gx, py[j] -= gy, pz[j] -= gz;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (system.pinned[i]) product.set(i, Vec3::Zero());
}

}  // namespace cloth
