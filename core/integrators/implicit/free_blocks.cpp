#include "integrators/implicit/free_blocks.h"

#include <algorithm>

#include "geometry/at.h"

namespace cloth {
namespace {

/// block -> 3x3 numbers; adds scale * block
void add_block(double scale, const SymmetricBlock& block, double* to) {
  const double m[9] = {block.xx, block.xy, block.xz, block.xy, block.yy,
                       block.yz, block.xz, block.yz, block.zz};
  for (int k = 0; k < 9; ++k) to[k] += scale * m[k];
}

}  // namespace

FreeRows free_rows(const ClothSystem& system) {
  FreeRows rows;
  rows.row.assign(system.pinned.size(), -1);
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    if (system.pinned[i]) continue;
    rows.row[i] = static_cast<int>(rows.particle.size());
    rows.particle.push_back(static_cast<int>(i));
  }
  const auto add = [&](std::size_t i, std::size_t j) {
    if (rows.row[i] >= 0 && rows.row[j] >= 0) rows.couplings.emplace_back(rows.row[i], rows.row[j]);
  };
  for_each_spring(system.springs,
                  [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) { add(i, j); });
  for_each_element_pair(system, add);
  return rows;
}

void analyse_free_rows(const ClothSystem& system, const FreeRows& rows, BlockCholesky& factors) {
  std::vector<int> order = elimination_order(system);
  for (int& particle : order) particle = rows.row[at(particle)];
  factors.analyse(rows.couplings, order);
}

bool FreeBlocks::fits(const ClothSystem& system) const {
  if (pinned_ != system.pinned || bending_ != system.bending || membrane_ != system.membrane ||
      sliders_ != system.sliders || runs_.size() != system.springs.size())
    return false;
  return std::equal(system.springs.begin(), system.springs.end(), runs_.begin(),
                    [](const SpringRun& a, const SpringRun& b) {
                      return a.first == b.first && a.count == b.count && a.offset == b.offset;
                    });
}

bool FreeBlocks::analyse(const ClothSystem& system) {
  if (fits(system)) return false;
  pinned_ = system.pinned;
  runs_ = system.springs;
  bending_ = system.bending;
  membrane_ = system.membrane;
  sliders_ = system.sliders;
  rows_ = free_rows(system);
  diagonal_.resize(9 * rows_.particle.size());
  off_diagonal_.resize(9 * rows_.couplings.size());
  return true;
}

void FreeBlocks::gather(const ClothSystem& system, const Linearisation& linearisation) {
  std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
  std::fill(off_diagonal_.begin(), off_diagonal_.end(), 0.0);
  const auto add_to_diagonal = [&](std::size_t particle, const SymmetricBlock& block) {
    if (rows_.row[particle] >= 0) add_block(1, block, diagonal_.data() + 9 * rows_.row[particle]);
  };
  for (std::size_t i = 0; i < rows_.row.size(); ++i) add_to_diagonal(i, linearisation.nodes[i]);
  double* coupling = off_diagonal_.data();
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t spring, std::size_t i, std::size_t j) {
    const SymmetricBlock block = linearisation.springs[spring];
    add_to_diagonal(i, block);
    add_to_diagonal(j, block);
    if (rows_.row[i] < 0 || rows_.row[j] < 0) return;
    add_block(-1, block, coupling);
    coupling += 9;
  });
  linearisation.for_each_element_block(
      system,
      [&](std::size_t i, std::size_t j, const Eigen::Matrix3d& block) {
        if (rows_.row[i] < 0 || rows_.row[j] < 0) return;
        Eigen::Map<Eigen::Matrix3d>(coupling) += block;
        coupling += 9;
      },
      [&](std::size_t i, const Eigen::Matrix3d& block) {
        if (rows_.row[i] >= 0) Eigen::Map<Eigen::Matrix3d>(diagonal_.data() + 9 * rows_.row[i]) += block;
      });
}

void FreeBlocks::pack(const Vec3Field& field, std::vector<double>& numbers) const {
  numbers.resize(3 * rows_.particle.size());
  for (std::size_t row = 0; row < rows_.particle.size(); ++row)
    Eigen::Map<Vec3>(numbers.data() + 3 * row) = field[at(rows_.particle[row])];
}

void FreeBlocks::unpack(const std::vector<double>& numbers, Vec3Field& field) const {
  field.fill(0);
  for (std::size_t row = 0; row < rows_.particle.size(); ++row)
    field.set(at(rows_.particle[row]), Eigen::Map<const Vec3>(numbers.data() + 3 * row));
}

}  // namespace cloth
