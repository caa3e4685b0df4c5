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
  return !system.is_mesh() && system.membrane.empty() && system.rows > 2 && system.columns > 2;
}

bool MultigridSolver::prepare(const ClothSystem& system, const Linearisation& clamped) {
  cycle_.begin(system.rows, system.columns);
  cycle_.add_to_diagonal(0, clamped.nodes.size(), from(clamped.nodes, 0));
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    const auto first = at(run.first), count = at(run.count);
    const auto blocks = from(clamped.springs, spring);
    if (!cycle_.add_couplings(first, count, run.offset, -1, blocks)) return false;
    cycle_.add_to_diagonal(first, count, blocks);
    cycle_.add_to_diagonal(first + at(run.offset), count, blocks);
    spring += count;
  }
  add_elements(system, clamped);
  for (std::size_t i = 0; i < system.pinned.size(); ++i)
    if (system.pinned[i]) cycle_.fix(i);
  return cycle_.prepare();
}

void MultigridSolver::add_elements(const ClothSystem& system, const Linearisation& matrix) {
  matrix.for_each_element_block(
      system,
      [&](std::size_t i, std::size_t j, const Eigen::Matrix3d& block) {
        const auto numbers = numbers_of(block);
        cycle_.add_couplings(std::min(i, j), 1, std::abs(static_cast<int>(j) - static_cast<int>(i)), 1,
                             pointers_to(numbers));
      },
      [&](std::size_t i, const Eigen::Matrix3d& block) {
        const auto numbers = numbers_of(block);
        cycle_.add_to_diagonal(i, 1, pointers_to(numbers));
      });
}

}  // namespace cloth
