#include "forces/linearisation.h"

#include <algorithm>

#include "cloth/vectorised.h"

namespace cloth {
namespace {

/// The six numbers of blocks that lie one behind the other.
struct BlockRows {
  const double *xx, *xy, *xz, *yy, *yz, *zz;
};
BlockRows rows_of(const SymmetricBlocks& blocks, std::size_t begin) {
  const auto& r = blocks.runs();
  return {r[0].data() + begin, r[1].data() + begin, r[2].data() + begin,
          r[3].data() + begin, r[4].data() + begin, r[5].data() + begin};
}

struct VectorRows {
  double *x, *y, *z;
};
struct ConstVectorRows {
  const double *x, *y, *z;
};
VectorRows rows_of(Vec3Field& field, std::size_t begin) {
  return {field.x() + begin, field.y() + begin, field.z() + begin};
}
ConstVectorRows rows_of(const Vec3Field& field, std::size_t begin) {
  return {field.x() + begin, field.y() + begin, field.z() + begin};
}

CLOTH_VECTORISED void multiply_rows(BlockRows b, ConstVectorRows d, VectorRows p, std::size_t count) {
  double* __restrict px = p.x, * __restrict py = p.y, * __restrict pz = p.z;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = d.x[i], dy = d.y[i], dz = d.z[i];
    px[i] = b.xx[i] * dx + b.xy[i] * dy + b.xz[i] * dz;
    py[i] = b.xy[i] * dx + b.yy[i] * dy + b.yz[i] * dz;
    pz[i] = b.xz[i] * dx + b.yz[i] * dy + b.zz[i] * dz;
  }
}

/// Springs are taken in chunks, as for their forces: a run whose ends overlap vectorises as well.
constexpr int block_length = 128;

CLOTH_VECTORISED void add_springs(BlockRows b, ConstVectorRows d, VectorRows p, std::ptrdiff_t offset,
                                  int count) {
  alignas(64) double gx[block_length], gy[block_length], gz[block_length];
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

/// One spring of a mesh: the same as a chunk of one, without what a chunk costs.
inline void add_spring(const BlockRows& b, std::size_t s, const ConstVectorRows& d, const VectorRows& p,
                       int i, int j) {
  const double dx = d.x[i] - d.x[j], dy = d.y[i] - d.y[j], dz = d.z[i] - d.z[j];
  const double gx = b.xx[s] * dx + b.xy[s] * dy + b.xz[s] * dz;
  const double gy = b.xy[s] * dx + b.yy[s] * dy + b.yz[s] * dz;
  const double gz = b.xz[s] * dx + b.yz[s] * dy + b.zz[s] * dz;
  p.x[i] += gx, p.y[i] += gy, p.z[i] += gz;
  p.x[j] -= gx, p.y[j] -= gy, p.z[j] -= gz;
}

}  // namespace

void SymmetricBlocks::assign(std::size_t size, const SymmetricBlock& block) {
  const double numbers[6] = {block.xx, block.xy, block.xz, block.yy, block.yz, block.zz};
  for (std::size_t k = 0; k < 6; ++k) runs_[k].assign(size, numbers[k]);
}

void SymmetricBlocks::set(std::size_t i, const SymmetricBlock& block) {
  runs_[0][i] = block.xx, runs_[1][i] = block.xy, runs_[2][i] = block.xz;
  runs_[3][i] = block.yy, runs_[4][i] = block.yz, runs_[5][i] = block.zz;
}

void SymmetricBlocks::add(std::size_t i, const SymmetricBlock& block) {
  runs_[0][i] += block.xx, runs_[1][i] += block.xy, runs_[2][i] += block.xz;
  runs_[3][i] += block.yy, runs_[4][i] += block.yz, runs_[5][i] += block.zz;
}

void multiply_blocks(const SymmetricBlocks& blocks, std::size_t begin, std::size_t end,
                     const Vec3Field& direction, Vec3Field& product) {
  multiply_rows(rows_of(blocks, begin), rows_of(direction, begin), rows_of(product, begin), end - begin);
}

void Linearisation::multiply_free(const ClothSystem& system, const Vec3Field& direction,
                                  Vec3Field& product) const {
  multiply_blocks(nodes, 0, nodes.size(), direction, product);
  const BlockRows blocks = rows_of(springs, 0);
  const ConstVectorRows from = rows_of(direction, 0);
  const VectorRows to = rows_of(product, 0);
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    if (run.count == 1) {
      add_spring(blocks, spring++, from, to, run.first, run.first + run.offset);
      continue;
    }
    for (int begin = 0; begin < run.count; begin += block_length) {
      const int count = std::min(block_length, run.count - begin);
      const auto first = static_cast<std::size_t>(run.first + begin);
      add_springs(rows_of(springs, spring), rows_of(direction, first), rows_of(product, first), run.offset,
                  count);
      spring += static_cast<std::size_t>(count);
    }
  }
}

void Linearisation::multiply(const ClothSystem& system, const Vec3Field& direction,
                             Vec3Field& product) const {
  multiply_free(system, direction, product);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (system.pinned[i]) product.set(i, Vec3::Zero());
}

}  // namespace cloth
