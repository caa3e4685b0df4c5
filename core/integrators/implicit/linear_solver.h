// Linear systems of an implicit step: A x = b with A = M + h D + h^2 K on the free particles, and the exact
// Jacobian A + h^2 N where a force has an asymmetric part N.
#pragma once

#include <functional>
#include <vector>

#include "integrators/implicit/free_blocks.h"
#include "sparse/block_cholesky.h"

namespace cloth {

/// result = operator(direction). Both have one vector per particle, zero on pins.
using LinearMap = std::function<void(const Vec3Field& direction, Vec3Field& result)>;

/// Sparse Cholesky factors of A in 3x3 blocks. The pattern is analysed once and again only when springs or
/// pins change.
class CholeskyFactors {
 public:
  /// False where A is not positive definite; nothing can then be solved.
  bool factorise(const ClothSystem& system, const Linearisation& linearisation);
  void solve(const Vec3Field& right_hand_side, Vec3Field& solution);

 private:
  FreeBlocks blocks_;
  BlockCholesky factors_{3};
  std::vector<double> values_;  ///< scratch
};

/// The inverses of A's 3x3 diagonal blocks: the preconditioner of iterative solves. Zero on pins.
class BlockJacobi {
 public:
  void prepare(const ClothSystem& system, const Linearisation& linearisation);
  void solve(const Vec3Field& right_hand_side, Vec3Field& solution) const;
  const SymmetricBlocks& inverse() const { return inverse_; }

 private:
  SymmetricBlocks inverse_;
};

struct KrylovReport {
  int iterations = 0;
  bool indefinite = false;  ///< a direction of negative curvature was met
  double reach = 0;         ///< how far along it the step would be if it curved as much upwards
  bool converged = false;
};

/// Preconditioned conjugate gradients from zero, to `tolerance` relative to the right-hand side in the
/// preconditioner's norm (Hestenes and Stiefel 1952). Keeps its vectors from one solve to the next.
class ConjugateGradients {
 public:
  KrylovReport solve(const ClothSystem& system, const Linearisation& matrix,
                     const BlockJacobi& preconditioner, const Vec3Field& right_hand_side, double tolerance,
                     Vec3Field& solution);

  /// The same with any symmetric, positive definite preconditioner, which may differ a little from one
  /// iteration to the next (flexible: Notay 2000, Eq. 2.3).
  KrylovReport solve(const ClothSystem& system, const Linearisation& matrix, const LinearMap& preconditioner,
                     const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution);

  /// The last direction: that of negative curvature where the solve ended with one.
  const Vec3Field& direction() const { return direction_; }

 private:
  double advance(double length, const BlockJacobi& preconditioner, Vec3Field& solution);

  Vec3Field residual_, conditioned_, direction_, image_;
};

/// Generalised minimal residuals with a preconditioner on the right, restarted (Saad and Schultz 1986). Keeps
/// its vectors from one solve to the next.
class MinimalResiduals {
 public:
  /// Starts from `solution`; `tolerance` is relative to the right-hand side.
  KrylovReport solve(const LinearMap& matrix, const LinearMap& preconditioner,
                     const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution);

 private:
  int run_cycle(const LinearMap& matrix, const LinearMap& preconditioner, double goal, Vec3Field& solution);
  Vec3Field& take_basis(std::size_t number);
  bool extend();
  void add_correction(const LinearMap& preconditioner, Vec3Field& solution);

  std::vector<Vec3Field> basis_;
  std::vector<std::vector<double>> columns_;  ///< of the triangular matrix
  std::vector<double> cosines_, sines_, rotated_;
  Vec3Field residual_, image_, conditioned_, combined_;
};

}  // namespace cloth
