#include "integrators/implicit/multigrid_solver.h"

#include <algorithm>
#include <cstdlib>

#include "geometry/at.h"

namespace cloth {
namespace {

std::array<const double*, 6> from(const SymmetricBlocks& blocks, std::size_t first) {
  const auto& runs = blocks.runs();
  return {runs[0].data() + first, runs[1].data() + first, runs[2].data() + first,
          runs[3].data() + first, runs[4].data() + first, runs[5].data() + first};
}

std::array<double, 6> numbers_of(const Eigen::Matrix3d& block) {
  return {block(0, 0), block(0, 1), block(0, 2), block(1, 1), block(1, 2), block(2, 2)};
}
std::array<const double*, 6> pointers_to(const std::array<double, 6>& n) {
  return {&n[0], &n[1], &n[2], &n[3], &n[4], &n[5]};
}

}  // namespace

bool MultigridSolver::suits(const ClothSystem& system) {
  return system.is_mesh() || (system.membrane.empty() && system.rows > 2 && system.columns > 2);
}

Stiffest stiffest_of(const ClothSystem& system) {
  Stiffest stiffest;
  for (const SpringRun& run : system.springs) stiffest.spring = std::max(stiffest.spring, run.stiffness);
  for (const BendingRun& run : system.bending)
    stiffest.bending = std::max(stiffest.bending, 2 * run.stiffness);
  for (const BendingSlider& s : system.sliders)
    stiffest.bending =
        std::max(stiffest.bending, 8 * s.stiffness * s.area * s.coefficient[0] * s.coefficient[0]);
  return stiffest;
}

Interpolation MultigridSolver::interpolation(const ClothSystem& system) {
  const Stiffest stiffest = stiffest_of(system);
  return stiffest.bending > stiffest.spring ? Interpolation::cubic_splines : Interpolation::linear;
}

bool MultigridSolver::prepare(const ClothSystem& system, const Linearisation& clamped,
                              const Vec3Field& position) {
  is_mesh_ = system.is_mesh();
  return is_mesh_ ? prepare_mesh(system, clamped, position) : prepare_grid(system, clamped);
}

void MultigridSolver::precondition(const Vec3Field& residual, Vec3Field& correction) {
  if (!is_mesh_) return grid_.solve(residual, correction);
  blocks_.pack(residual, numbers_);
  corrections_.resize(numbers_.size());
  aggregation_.solve(numbers_, corrections_);
  blocks_.unpack(corrections_, correction);
}

/// Springs unite neighbours, which every edge of a triangle has, also without stiffness: what a material's
/// bending couples reaches further, and is weaker.
bool MultigridSolver::prepare_mesh(const ClothSystem& system, const Linearisation& clamped,
                                   const Vec3Field& position) {
  if (blocks_.analyse(system)) {
    const FreeRows& rows = blocks_.rows();
    std::vector<Coupling> strong;
    for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
      if (rows.row[i] >= 0 && rows.row[j] >= 0) strong.emplace_back(rows.row[i], rows.row[j]);
    });
    aggregation_.analyse(static_cast<int>(rows.particle.size()), rows.couplings, strong);
  }
  blocks_.gather(system, clamped);
  blocks_.pack(position, numbers_);
  return aggregation_.prepare(blocks_.diagonal(), blocks_.off_diagonal(), numbers_);
}

bool MultigridSolver::prepare_grid(const ClothSystem& system, const Linearisation& clamped) {
  grid_.begin(system.rows, system.columns, interpolation(system));
  grid_.add_to_diagonal(0, clamped.nodes.size(), from(clamped.nodes, 0));
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    const auto first = at(run.first), count = at(run.count);
    const auto blocks = from(clamped.springs, spring);
    if (!grid_.add_couplings(first, count, run.offset, -1, blocks)) return false;
    grid_.add_to_diagonal(first, count, blocks);
    grid_.add_to_diagonal(first + at(run.offset), count, blocks);
    spring += count;
  }
  if (!add_bending(system, clamped.bending) || !add_sliders(system, clamped)) return false;
  for (std::size_t i = 0; i < system.pinned.size(); ++i)
    if (system.pinned[i]) grid_.fix(i);
  return grid_.prepare();
}

/// K of an element is k c c^T in every direction.
bool MultigridSolver::add_bending(const ClothSystem& system, double weight) {
  for (const BendingRun& run : system.bending)
    for (std::size_t p = 0; p < at(run.points); ++p) {
      const double of_point = weight * run.stiffness * run.coefficient[p];
      grid_.add_to_diagonal(at(run.first + run.offset[p]), at(run.count), of_point * run.coefficient[p]);
      for (std::size_t q = p + 1; q < at(run.points); ++q) {
        const auto [from, to] = std::minmax(run.offset[p], run.offset[q]);
        if (!grid_.add_couplings(at(run.first + from), at(run.count), to - from,
                                 of_point * run.coefficient[q]))
          return false;
      }
    }
  return true;
}

bool MultigridSolver::add_sliders(const ClothSystem& system, const Linearisation& matrix) {
  bool fits = true;
  matrix.for_each_slider_block(
      system,
      [&](std::size_t i, std::size_t j, const Eigen::Matrix3d& block) {
        const auto numbers = numbers_of(block);
        const auto [from, to] = std::minmax(i, j);
        fits &= grid_.add_couplings(from, 1, static_cast<int>(to - from), 1, pointers_to(numbers));
      },
      [&](std::size_t i, const Eigen::Matrix3d& block) {
        const auto numbers = numbers_of(block);
        grid_.add_to_diagonal(i, 1, pointers_to(numbers));
      });
  return fits;
}

}  // namespace cloth
