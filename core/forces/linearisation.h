// The symmetric matrix of a linearised step, A = M + weight_velocity D + weight_position K, K the symmetric
// part of -dp/dx. It is stored as one 3x3 block for every particle and one, B, for every spring between
// particles i and j: A = diag(node) + sum over springs of (e_i - e_j) B (e_i - e_j)^T,
// and to that a multiple of the constant matrix K of a material's bending and of J^T K J of its membrane
// (cloth/membrane.h). The asymmetric part of
// -df/dx (drag whose normal turns, a damper that turns) is not stored; Force::add_asymmetric_product
// multiplies with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/vector_kernels.h"

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
  /// The blocks from `first` on, to add to.
  BlockSums sums(std::size_t first);
  /// xx, xy, xz, yy, yz, zz of all blocks.
  const std::array<std::vector<double>, 6>& runs() const { return runs_; }

 private:
  std::array<std::vector<double>, 6> runs_;
};

struct Linearisation {
  SymmetricBlocks nodes;             ///< one of each particle
  SymmetricBlocks springs;           ///< run after run, in the order of ClothSystem::springs
  double bending = 0;                ///< s^2: what multiplies K of ClothSystem::bending
  double membrane = 0;               ///< s^2: what multiplies J^T K J of ClothSystem::membrane
  Vec3Field membrane_position;       ///< m, where J is; sized where there is a membrane
  std::vector<double> slider_slope;  ///< of ClothSystem::sliders, weighted; empty: none acts
  Vec3Field slider_normal;           ///< their unit normals
  bool has_compressed = false;  ///< some spring is shorter than its rest length, so that clamping changes A

  /// Adds `weight` J^T K J.
  void add_membrane(const Vec3Field& position, double weight);

  /// Visits the blocks of bending, its sliders and the membrane between two different particles and those
  /// that they add to each particle: off_diagonal(i, j, block), diagonal(i, block), blocks as 3x3 matrices,
  /// the one for i and j in the row of i. Pairs may repeat; their order depends on the system alone.
  template <class OffDiagonal, class Diagonal>
  void for_each_element_block(const ClothSystem& system, OffDiagonal off_diagonal, Diagonal diagonal) const;

  void add_slider_product(const ClothSystem& system, const Vec3Field& direction, Vec3Field& product) const;
  template <class OffDiagonal, class Diagonal>
  void for_each_slider_block(const ClothSystem& system, OffDiagonal off_diagonal, Diagonal diagonal) const;

  /// product = A direction; pinned particles get 0.
  void multiply(const ClothSystem& system, const Vec3Field& direction, Vec3Field& product) const;

  /// The same, but the products of pinned particles are undefined. Precondition: `direction` is 0 on them.
  void multiply_free(const ClothSystem& system, const Vec3Field& direction, Vec3Field& product) const;
};

/// -c_p c_q slope n n^T between two points, and its opposite on both.
template <class OffDiagonal, class Diagonal>
void Linearisation::for_each_slider_block(const ClothSystem& system, OffDiagonal off_diagonal,
                                          Diagonal diagonal) const {
  for (std::size_t k = 0; k < system.sliders.size(); ++k) {
    const BendingSlider& s = system.sliders[k];
    const bool acts = !slider_slope.empty();
    const Vec3 n = acts ? slider_normal[k] : Vec3(Vec3::Zero());
    const Eigen::Matrix3d along = (acts ? slider_slope[k] : 0.0) * n * n.transpose();
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      for (std::size_t q = p + 1; q < static_cast<std::size_t>(s.points); ++q) {
        const Eigen::Matrix3d block = s.coefficient[p] * s.coefficient[q] * along;
        diagonal(at(s.particle[p]), Eigen::Matrix3d(-block));
        diagonal(at(s.particle[q]), Eigen::Matrix3d(-block));
        off_diagonal(at(s.particle[p]), at(s.particle[q]), block);
      }
  }
}

/// visit(i, j) for every block off the diagonal that for_each_element_block() visits, in its order.
template <class Visit>
void for_each_element_pair(const ClothSystem& system, Visit visit) {
  for_each_bending_pair(system.bending_rows, system.bending,
                        [&](std::size_t i, std::size_t j, double) { visit(i, j); });
  for_each_slider_pair(system.sliders, [&](std::size_t i, std::size_t j, double) { visit(i, j); });
  for (const MembraneTriangle& t : system.membrane)
    for (std::size_t c = 0; c < 3; ++c) visit(at(t.corner[c]), at(t.corner[(c + 1) % 3]));
}

template <class OffDiagonal, class Diagonal>
void Linearisation::for_each_element_block(const ClothSystem& system, OffDiagonal off_diagonal,
                                           Diagonal diagonal) const {
  for_each_bending_pair(system.bending_rows, system.bending,
                        [&](std::size_t i, std::size_t j, double stiffness) {
                          const Eigen::Matrix3d block = bending * stiffness * Eigen::Matrix3d::Identity();
                          diagonal(i, block), diagonal(j, block);
                          off_diagonal(i, j, Eigen::Matrix3d(-block));
                        });
  for_each_slider_block(system, off_diagonal, diagonal);
  for (const MembraneTriangle& t : system.membrane) {
    std::array<Vec3, 3> d;
    for (std::size_t e = 0; e < 3; ++e) d[e] = edge_of(t, e, membrane_position);
    // Corner c is the beginning of edge c and the end of the edge before.
    const auto block = [&](std::size_t b, std::size_t c) -> Eigen::Matrix3d {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      const std::size_t before_b = (b + 2) % 3, before_c = (c + 2) % 3;
      for (const auto& [e, of_b] : {std::pair(b, -1.0), {before_b, 1.0}})
        for (const auto& [f, of_c] : {std::pair(c, -1.0), {before_c, 1.0}})
          sum += (4 * membrane * of_b * of_c * t.k[e][f]) * d[e] * d[f].transpose();
      return sum;
    };
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t next = (c + 1) % 3;
      diagonal(at(t.corner[c]), block(c, c));
      off_diagonal(at(t.corner[c]), at(t.corner[next]), block(c, next));
    }
  }
}

/// product = blocks direction, block by block, for the vectors [begin, end).
void multiply_blocks(const SymmetricBlocks& blocks, std::size_t begin, std::size_t end,
                     const Vec3Field& direction, Vec3Field& product);

}  // namespace cloth
