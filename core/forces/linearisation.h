// The symmetric matrix of a linearised step, A = M + weight_velocity D + weight_position K, K the symmetric
// part of -dp/dx. It is stored as one 3x3 block for every particle and one, B, for every spring between
// particles i and j: A = diag(node) + sum over springs of (e_i - e_j) B (e_i - e_j)^T,
// and to that a multiple of the constant matrix K of a material's bending. The asymmetric part of
// -df/dx (drag whose normal turns, a damper that turns) is not stored; Force::add_asymmetric_product
// multiplies with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cloth/cloth_system.h"

namespace cloth {

/// A symmetric 3x3 block.
struct SymmetricBlock {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  Vec3 operator*(const Vec3& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
};

/// isotropic * I + along * n n^T
inline SymmetricBlock block_along(double isotropic, double along, const Vec3& n) {
  return {isotropic + along * n.x() * n.x(), along * n.x() * n.y(), along * n.x() * n.z(),
          isotropic + along * n.y() * n.y(), along * n.y() * n.z(), isotropic + along * n.z() * n.z()};
}

/// The weights of the parts of A, and the treatment of compressed springs.
struct LinearisationWeights {
  double position = 1;  ///< of K, s^2 in a step
  double velocity = 1;  ///< of D, s in a step
  /// Leaves the transverse stiffness k (1 - L/|d|) out where it is negative, so that A is positive definite
  /// (Choi and Ko 2002).
  bool clamped = false;
};

/// Many blocks as six contiguous runs (structure of arrays), so that products with them vectorise.
class SymmetricBlocks {
 public:
  void assign(std::size_t size, const SymmetricBlock& block);
  std::size_t size() const { return runs_[0].size(); }
  SymmetricBlock operator[](std::size_t i) const {
    return {runs_[0][i], runs_[1][i], runs_[2][i], runs_[3][i], runs_[4][i], runs_[5][i]};
  }
  void set(std::size_t i, const SymmetricBlock& block);
  void add(std::size_t i, const SymmetricBlock& block);
  /// xx, xy, xz, yy, yz, zz of all blocks.
  const std::array<std::vector<double>, 6>& runs() const { return runs_; }

 private:
  std::array<std::vector<double>, 6> runs_;
};

struct Linearisation {
  SymmetricBlocks nodes;        ///< one of each particle
  SymmetricBlocks springs;      ///< run after run, in the order of ClothSystem::springs
  double bending = 0;           ///< s^2: what multiplies K of ClothSystem::bending
  bool has_compressed = false;  ///< some spring is shorter than its rest length, so that clamping changes A

  /// product = A direction; pinned particles get 0.
  void multiply(const ClothSystem& system, const Vec3Field& direction, Vec3Field& product) const;

  /// The same, but the products of pinned particles are undefined. Precondition: `direction` is 0 on them.
  void multiply_free(const ClothSystem& system, const Vec3Field& direction, Vec3Field& product) const;
};

/// product = blocks direction, block by block, for the vectors [begin, end).
void multiply_blocks(const SymmetricBlocks& blocks, std::size_t begin, std::size_t end,
                     const Vec3Field& direction, Vec3Field& product);

}  // namespace cloth
