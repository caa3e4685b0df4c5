#include "integrators/implicit/linear_solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/sums.h"

namespace cloth {
namespace {

/// Where the block of two unknowns stands in the lower triangle, and whether it must be transposed for it.
struct Place {
  int row, column;
};
Place lower_place(int i, int j) {
  return i > j ? Place{i, j} : Place{j, i};
}

/// Of a block whose eigenvalues may lie so far apart that the smallest is rounding: that one is then bounded.
Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& block) {
  constexpr double smallest = 1e-12;  // relative to the largest
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block);
  const double floor = smallest * solver.eigenvalues().cwiseAbs().maxCoeff();
  const Vec3 inverse = solver.eigenvalues().cwiseMax(floor).cwiseInverse();
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

bool CholeskyFactors::fits(const ClothSystem& system) const {
  if (pinned_ != system.pinned || offsets_.size() != system.springs.size() * 3) return false;
  for (std::size_t k = 0; k < system.springs.size(); ++k) {
    const SpringRun& run = system.springs[k];
    if (offsets_[3 * k] != run.first || offsets_[3 * k + 1] != run.count || offsets_[3 * k + 2] != run.offset)
      return false;
  }
  return true;
}

void CholeskyFactors::analyse(const ClothSystem& system) {
  pinned_ = system.pinned;
  offsets_.clear();
  for (const SpringRun& run : system.springs)
    offsets_.insert(offsets_.end(), {run.first, run.count, run.offset});
  unknown_.assign(system.pinned.size(), -1);
  int unknowns = 0;
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    if (!system.pinned[i]) unknown_[i] = unknowns++;

  std::vector<Eigen::Triplet<double, int>> entries;
  const auto add = [&](int row, int column) {
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a)
        if (row != column || a >= b) entries.emplace_back(3 * row + a, 3 * column + b, 0.0);
  };
  for (int k = 0; k < unknowns; ++k) add(k, k);
  for (const SpringRun& run : system.springs) {
    for (int s = 0; s < run.count; ++s) {
      const int i = unknown_[static_cast<std::size_t>(run.first + s)];
      const int j = unknown_[static_cast<std::size_t>(run.first + s + run.offset)];
      if (i < 0 || j < 0) continue;
      const Place place = lower_place(i, j);
      add(place.row, place.column);
    }
  }
  matrix_.resize(3 * unknowns, 3 * unknowns);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  factors_.analyzePattern(matrix_);
}

void CholeskyFactors::add_block(int row, int column, const SymmetricBlock& block, double sign) {
  const double columns[3][3] = {
      {block.xx, block.xy, block.xz}, {block.xy, block.yy, block.yz}, {block.xz, block.yz, block.zz}};
  for (int b = 0; b < 3; ++b) {
    const int first = row == column ? b : 0;  // of the diagonal's block only the lower half is kept
    const int begin = matrix_.outerIndexPtr()[3 * column + b],
              end = matrix_.outerIndexPtr()[3 * column + b + 1];
    const int* rows = matrix_.innerIndexPtr();
    const auto at = std::lower_bound(rows + begin, rows + end, 3 * row + first) - rows;
    for (int a = first; a < 3; ++a) matrix_.valuePtr()[at + a - first] += sign * columns[b][a];
  }
}

bool CholeskyFactors::factorise(const ClothSystem& system, const Linearisation& linearisation) {
  if (!fits(system)) analyse(system);
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    if (unknown_[i] >= 0) add_block(unknown_[i], unknown_[i], linearisation.nodes[i], 1);
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    for (int s = 0; s < run.count; ++s, ++spring) {
      const int i = unknown_[static_cast<std::size_t>(run.first + s)];
      const int j = unknown_[static_cast<std::size_t>(run.first + s + run.offset)];
      const SymmetricBlock& block = linearisation.springs[spring];
      if (i >= 0) add_block(i, i, block, 1);
      if (j >= 0) add_block(j, j, block, 1);
      if (i < 0 || j < 0) continue;
      const Place place = lower_place(i, j);
      add_block(place.row, place.column, block, -1);
    }
  }
  if (matrix_.rows() == 0) return true;
  factors_.factorize(matrix_);
  return factors_.info() == Eigen::Success;
}

void CholeskyFactors::solve(const Vec3Field& right_hand_side, Vec3Field& solution) const {
  solution.fill(0);
  if (matrix_.rows() == 0) return;
  Eigen::VectorXd b(matrix_.rows());
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    if (unknown_[i] >= 0) b.segment<3>(3 * unknown_[i]) = right_hand_side[i];
  const Eigen::VectorXd x = factors_.solve(b);
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    if (unknown_[i] >= 0) solution.set(i, x.segment<3>(3 * unknown_[i]));
}

void BlockJacobi::prepare(const ClothSystem& system, const Linearisation& linearisation) {
  inverse_ = linearisation.nodes;
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    for (int s = 0; s < run.count; ++s, ++spring) {
      const auto i = static_cast<std::size_t>(run.first + s), j = i + static_cast<std::size_t>(run.offset);
      inverse_[i] += linearisation.springs[spring];
      inverse_[j] += linearisation.springs[spring];
    }
  }
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    if (system.pinned[i]) {
      inverse_[i] = {};
      continue;
    }
    const Eigen::Matrix3d m = inverse_of(inverse_[i].matrix());
    inverse_[i] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
  }
}

void BlockJacobi::solve(const Vec3Field& right_hand_side, Vec3Field& solution) const {
  for (std::size_t i = 0; i < inverse_.size(); ++i) solution.set(i, inverse_[i] * right_hand_side[i]);
}

LinearMethod choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights) {
  // ns, measured: factors grow as size^1.75 on a grid; an iteration of conjugate gradients is linear in it.
  constexpr double factor_cost = 65, factor_growth = 1.75, iteration_cost = 32;
  // Measured to linear_tolerance of ImplicitStage: as the root of the condition, but however stiff the
  // springs, a grid has no worse condition than its size gives it.
  constexpr double iterations_per_root = 1.3, iterations_per_edge = 10;
  double stiffest = 0, lightest = std::numeric_limits<double>::infinity();
  for (const SpringRun& run : system.springs) stiffest = std::max(stiffest, run.stiffness);
  for (const double mass : system.mass) lightest = std::min(lightest, mass);
  const double condition = 1 + 12 * weights.position * stiffest / lightest;
  const double size = system.size();
  const double iterations =
      std::min(iterations_per_edge * std::sqrt(size), iterations_per_root * std::sqrt(condition));
  const double by_factors = factor_cost * std::pow(size, factor_growth);
  return iterations * iteration_cost * size < by_factors ? LinearMethod::conjugate_gradients
                                                         : LinearMethod::cholesky;
}

}  // namespace cloth
