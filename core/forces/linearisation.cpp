#include "forces/linearisation.h"

#include <algorithm>

#include "kernels/instruction_set.h"
#include "kernels/mesh_products.h"

namespace cloth {
namespace {

BlockRows rows_of(const SymmetricBlocks& blocks, std::size_t begin) {
  const auto& r = blocks.runs();
  return {r[0].data() + begin, r[1].data() + begin, r[2].data() + begin,
          r[3].data() + begin, r[4].data() + begin, r[5].data() + begin};
}

VectorRows rows_of(Vec3Field& field, std::size_t begin) {
  return {field.x() + begin, field.y() + begin, field.z() + begin};
}
ConstVectorRows rows_of(const Vec3Field& field, std::size_t begin) {
  return {field.x() + begin, field.y() + begin, field.z() + begin};
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

BlockSums SymmetricBlocks::sums(std::size_t first) {
  auto& r = runs_;
  return {r[0].data() + first, r[1].data() + first, r[2].data() + first,
          r[3].data() + first, r[4].data() + first, r[5].data() + first};
}

void multiply_blocks(const SymmetricBlocks& blocks, std::size_t begin, std::size_t end,
                     const Vec3Field& direction, Vec3Field& product) {
  active_kernels<VectorKernels>().multiply_blocks(rows_of(blocks, begin), rows_of(direction, begin),
                                                  rows_of(product, begin), end - begin);
}

void Linearisation::add_membrane(const Vec3Field& position, double weight) {
  membrane += weight;
  membrane_position = position;
}

void Linearisation::add_slider_product(const ClothSystem& system, const Vec3Field& direction,
                                       Vec3Field& product) const {
  for (std::size_t k = 0; k < system.sliders.size(); ++k) {
    if (slider_slope[k] == 0) continue;
    const BendingSlider& s = system.sliders[k];
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      sum += s.coefficient[p] * direction[at(s.particle[p])];
    const Vec3 push = slider_slope[k] * slider_normal[k].dot(sum) * slider_normal[k];
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      product.add(at(s.particle[p]), s.coefficient[p] * push);
  }
}

void Linearisation::multiply_free(const ClothSystem& system, const Vec3Field& direction,
                                  Vec3Field& product) const {
  multiply_blocks(nodes, 0, nodes.size(), direction, product);
  const VectorKernels& kernels = active_kernels<VectorKernels>();
  const BlockRows blocks = rows_of(springs, 0);
  const ConstVectorRows from = rows_of(direction, 0);
  const VectorRows to = rows_of(product, 0);
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    if (run.count == 1) {
      add_spring(blocks, spring++, from, to, run.first, run.first + run.offset);
      continue;
    }
    for (int begin = 0; begin < run.count; begin += VectorKernels::max_springs) {
      const int count = std::min(VectorKernels::max_springs, run.count - begin);
      const auto first = static_cast<std::size_t>(run.first + begin);
      kernels.add_springs(rows_of(springs, spring), rows_of(direction, first), rows_of(product, first),
                          run.offset, count);
      spring += static_cast<std::size_t>(count);
    }
  }
  if (bending > 0) add_bending_product(system, bending, direction, product);
  if (!slider_slope.empty()) add_slider_product(system, direction, product);
  if (membrane > 0) add_membrane_product(system.membrane, membrane, membrane_position, direction, product);
}

void Linearisation::multiply(const ClothSystem& system, const Vec3Field& direction,
                             Vec3Field& product) const {
  multiply_free(system, direction, product);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (system.pinned[i]) product.set(i, Vec3::Zero());
}

}  // namespace cloth
