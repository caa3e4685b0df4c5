#include "integrators/implicit/linear_solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "geometry/at.h"

namespace cloth {
namespace {

constexpr double smallest_pivot = 1e-12;  // of a 3x3 block, relative to its largest

/// Of a block whose eigenvalues may lie so far apart that the smallest is rounding: that one is then bounded.
SymmetricBlock bounded_inverse(const SymmetricBlock& block) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block.matrix());
  const double floor = smallest_pivot * solver.eigenvalues().cwiseAbs().maxCoeff();
  const Vec3 inverse = solver.eigenvalues().cwiseMax(floor).cwiseInverse();
  const Eigen::Matrix3d m = solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
}

/// By L D L^T of the block.
SymmetricBlock inverse_of(const SymmetricBlock& a) {
  const double floor = smallest_pivot * std::max({a.xx, a.yy, a.zz});
  const double l10 = a.xy / a.xx, l20 = a.xz / a.xx;
  const double d1 = a.yy - l10 * a.xy;
  const double l21 = (a.yz - l20 * a.xy) / d1;
  const double d2 = a.zz - l20 * a.xz - l21 * l21 * d1;
  if (!(a.xx > floor && d1 > floor && d2 > floor)) return bounded_inverse(a);
  const double i0 = 1 / a.xx, i1 = 1 / d1, zz = 1 / d2;
  const double m20 = l10 * l21 - l20;  // of L^-1, whose other entries are -l10 and -l21
  const double yz = -l21 * zz, xz = m20 * zz;
  return {i0 + l10 * l10 * i1 + m20 * xz, -l10 * i1 + m20 * yz, xz, i1 - l21 * yz, yz, zz};
}

}  // namespace

bool CholeskyFactors::factorise(const ClothSystem& system, const Linearisation& linearisation) {
  if (blocks_.analyse(system)) analyse_free_rows(system, blocks_.rows(), factors_);
  blocks_.gather(system, linearisation);
  return factors_.factorise(blocks_.diagonal(), blocks_.off_diagonal());
}

void CholeskyFactors::solve(const Vec3Field& right_hand_side, Vec3Field& solution) {
  blocks_.pack(right_hand_side, values_);
  factors_.solve(values_, 1);
  blocks_.unpack(values_, solution);
}

void BlockJacobi::prepare(const ClothSystem& system, const Linearisation& linearisation) {
  inverse_ = linearisation.nodes;
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t spring, std::size_t i, std::size_t j) {
    const SymmetricBlock block = linearisation.springs[spring];
    inverse_.add(i, block);
    inverse_.add(j, block);
  });
  linearisation.for_each_element_block(
      system, [](std::size_t, std::size_t, const Eigen::Matrix3d&) {},
      [&](std::size_t i, const Eigen::Matrix3d& m) {
        inverse_.add(i, {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)});
      });
  for (std::size_t i = 0; i < inverse_.size(); ++i)
    inverse_.set(i, system.pinned[i] ? SymmetricBlock{} : inverse_of(inverse_[i]));
}

void BlockJacobi::solve(const Vec3Field& right_hand_side, Vec3Field& solution) const {
  multiply_blocks(inverse_, 0, inverse_.size(), right_hand_side, solution);
}

}  // namespace cloth
