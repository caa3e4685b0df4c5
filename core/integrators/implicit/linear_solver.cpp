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

/// block -> 3x3 numbers; adds scale * block
void add_block(double scale, const SymmetricBlock& block, double* to) {
  const double m[9] = {block.xx, block.xy, block.xz, block.xy, block.yy,
                       block.yz, block.xz, block.yz, block.zz};
  for (int k = 0; k < 9; ++k) to[k] += scale * m[k];
}

}  // namespace

FreeRows analyse_free_rows(const ClothSystem& system, BlockCholesky& factors) {
  FreeRows rows;
  rows.row.assign(system.pinned.size(), -1);
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    if (system.pinned[i]) continue;
    rows.row[i] = static_cast<int>(rows.particle.size());
    rows.particle.push_back(static_cast<int>(i));
  }
  std::vector<Coupling> couplings;
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    if (rows.row[i] >= 0 && rows.row[j] >= 0) couplings.emplace_back(rows.row[i], rows.row[j]);
  });
  for_each_element_pair(system, [&](std::size_t i, std::size_t j) {
    if (rows.row[i] >= 0 && rows.row[j] >= 0) couplings.emplace_back(rows.row[i], rows.row[j]);
  });
  std::vector<int> order = elimination_order(system);
  for (int& particle : order) particle = rows.row[static_cast<std::size_t>(particle)];
  factors.analyse(couplings, order);
  rows.couplings = couplings.size();
  return rows;
}

bool CholeskyFactors::fits(const ClothSystem& system) const {
  if (pinned_ != system.pinned || bending_ != system.bending || membrane_ != system.membrane ||
      sliders_ != system.sliders || runs_.size() != system.springs.size())
    return false;
  return std::equal(system.springs.begin(), system.springs.end(), runs_.begin(),
                    [](const SpringRun& a, const SpringRun& b) {
                      return a.first == b.first && a.count == b.count && a.offset == b.offset;
                    });
}

void CholeskyFactors::analyse(const ClothSystem& system) {
  pinned_ = system.pinned;
  runs_ = system.springs;
  bending_ = system.bending;
  membrane_ = system.membrane;
  sliders_ = system.sliders;
  rows_ = analyse_free_rows(system, factors_);
  diagonal_.resize(9 * rows_.particle.size());
  off_diagonal_.resize(9 * rows_.couplings);
  values_.resize(3 * rows_.particle.size());
}

bool CholeskyFactors::factorise(const ClothSystem& system, const Linearisation& linearisation) {
  if (!fits(system)) analyse(system);
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
  return factors_.factorise(diagonal_, off_diagonal_);
}

void CholeskyFactors::solve(const Vec3Field& right_hand_side, Vec3Field& solution) {
  for (std::size_t row = 0; row < rows_.particle.size(); ++row)
    Eigen::Map<Vec3>(values_.data() + 3 * row) = right_hand_side[at(rows_.particle[row])];
  factors_.solve(values_, 1);
  solution.fill(0);
  for (std::size_t row = 0; row < rows_.particle.size(); ++row)
    solution.set(at(rows_.particle[row]), Eigen::Map<const Vec3>(values_.data() + 3 * row));
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
