// Linear systems of an implicit step: A x = b with A = M + h D + h^2 K on the free particles, and the exact
// Jacobian A + h^2 N where a force has an asymmetric part N.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstdint>
#include <functional>
#include <vector>

#include "forces/linearisation.h"

namespace cloth {

/// result = operator(direction). Both have one vector per particle, zero on pins.
using LinearMap = std::function<void(const Vec3Field& direction, Vec3Field& result)>;

/// Sparse Cholesky factors of A (Eigen's simplicial LLT, fill-reducing order AMD). The pattern is analysed
/// once and again only when springs or pins change.
class CholeskyFactors {
 public:
  /// False where A is not positive definite; nothing can then be solved.
  bool factorise(const ClothSystem& system, const Linearisation& linearisation);
  void solve(const Vec3Field& right_hand_side, Vec3Field& solution) const;

 private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  bool fits(const ClothSystem& system) const;
  void analyse(const ClothSystem& system);
  void add_block(int row, int column, const SymmetricBlock& block, double sign);

  std::vector<std::uint8_t> pinned_;  ///< that the pattern was made for
  std::vector<int> offsets_;          ///< of its spring runs
  std::vector<int> unknown_;          ///< of each particle; -1 where pinned
  Matrix matrix_;                     ///< its lower triangle
  Eigen::SimplicialLLT<Matrix, Eigen::Lower> factors_;
};

/// The inverses of A's 3x3 diagonal blocks: the preconditioner of iterative solves.
class BlockJacobi {
 public:
  void prepare(const ClothSystem& system, const Linearisation& linearisation);
  void solve(const Vec3Field& right_hand_side, Vec3Field& solution) const;

 private:
  std::vector<SymmetricBlock> inverse_;
};

struct KrylovReport {
  int iterations = 0;
  bool indefinite = false;  ///< a direction of negative curvature was met
  bool converged = false;
};

/// Preconditioned conjugate gradients from zero, to `tolerance` relative to the right-hand side in the
/// preconditioner's norm (Hestenes and Stiefel 1952).
KrylovReport conjugate_gradients(const LinearMap& matrix, const LinearMap& preconditioner,
                                 const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution);

/// Generalised minimal residuals with a preconditioner on the right, restarted (Saad and Schultz 1986).
/// Starts from zero; `tolerance` is relative to the right-hand side.
KrylovReport minimal_residuals(const LinearMap& matrix, const LinearMap& preconditioner,
                               const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution);

/// How A is solved. Factors cost the same for every stiffness; conjugate gradients cost more the further the
/// step reaches beyond the fastest oscillation. The rule is a fixed estimate of both from measured costs, so
/// that the same scene always takes the same way (docs/methods/implicit-euler.md has the measurements).
enum class LinearMethod { cholesky, conjugate_gradients };
LinearMethod choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights);

}  // namespace cloth
