#include "integrators/implicit/linear_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/implicit/multigrid_solver.h"

namespace cloth {

const char* name_of(LinearMethod method) {
  switch (method) {
    case LinearMethod::cholesky:
      return "factors";
    case LinearMethod::conjugate_gradients:
      return "conjugate gradients";
    case LinearMethod::multigrid:
      return "multigrid";
  }
  return "";
}

namespace {

/// Of a solve, s: costs that were measured once, on grids and on meshes.
struct SolveCosts {
  double factors = 0;
  double preconditioner = 0, iteration = 0;  ///< of conjugate gradients with the diagonal's blocks
  double multigrid = 0;
};

/// Dissected factors of a grid grow as its size times its shorter side, an iteration is linear. Cycles are
/// those of smooth states, which are most, 3 to 5, with splines 4 to 5 and on narrow strips up to 20:
/// conjugate gradients need more iterations as well where cloth buckles.
SolveCosts grid_costs(const ClothSystem& system) {
  const double size = system.size(), side = std::min(system.rows, system.columns);
  const double cycles = MultigridSolver::interpolation(system) == Interpolation::cubic_splines ? 12 : 4;
  return {.factors = 130e-9 * size * side,
          .preconditioner = 60e-9 * size,
          .iteration = 25e-9 * size,
          .multigrid = 60e-6 + (400e-9 + 75e-9 * cycles) * size};
}

/// The matrix's blocks in the rows of free particles, about: with springs 12 to 13 each, where a material
/// bends 13 on a grid that was cut and some 37 on a mesh.
double blocks_of_mesh(const ClothSystem& system, double free) {
  const double size = system.size();
  double springs = 0;
  for (const SpringRun& run : system.springs) springs += run.count;
  const bool is_cut = !system.bending.empty() && system.bending_rows.column.empty();
  const double bending = is_cut ? 12 * size : static_cast<double>(system.bending_rows.column.size());
  return free * (1 + std::max(2 * springs, bending) / size);
}

/// All of it grows with the blocks. Cycles are those of smooth states: 4 to 5, of a material 5 to 12.
SolveCosts mesh_costs(const ClothSystem& system) {
  const auto free = static_cast<double>(std::count(system.pinned.begin(), system.pinned.end(), 0));
  const double blocks = blocks_of_mesh(system, free), side = std::sqrt(free);
  const double cycles = system.bending.empty() ? 4 : 8;
  return {.factors = 7e-9 * blocks * std::max(side - 8, 0.25 * side),
          .preconditioner = 60e-9 * free,
          .iteration = 12e-9 * free + 2e-9 * blocks,
          .multigrid = 200e-6 + (80e-9 + 8e-9 * cycles) * blocks};
}

}  // namespace

LinearChoice choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights) {
  // Of Newton's method: with conjugate gradients a step is neither relaxed, nor is its last iteration spared.
  constexpr double more_iterations = 1.5;
  // Measured with the forcing of ImplicitStage: as the root of the condition, but a grid has no worse one
  // than its size gives it; and what factors save in iterations of Newton's method where springs are stiffer
  // still.
  constexpr double iterations_per_root = 2, stiff = 1e6, growth = 0.25;
  const double iterations_per_edge = system.bending.empty() ? 1.7 : 4;  // a material's stiffnesses lie apart
  const Stiffest of_system = stiffest_of(system);
  const double stiffest = std::max({of_system.spring, of_system.bending, stiffest_edge(system.membrane)});
  double lightest = std::numeric_limits<double>::infinity();
  for (const double mass : system.mass) lightest = std::min(lightest, mass);
  const double condition = 1 + 12 * weights.position * stiffest / lightest;
  const double size = system.size();

  LinearChoice choice;
  choice.iterations =
      std::min(iterations_per_edge * std::sqrt(size), iterations_per_root * std::sqrt(condition)) *
      std::pow(std::max(1.0, condition / stiff), growth);
  const SolveCosts costs = system.is_mesh() ? mesh_costs(system) : grid_costs(system);
  choice.factors = costs.factors;
  choice.gradients = more_iterations * (costs.preconditioner + costs.iteration * choice.iterations);
  if (choice.gradients < choice.factors) choice.method = LinearMethod::conjugate_gradients;
  // Single precision ends where the springs' part of A is some 1e7 times the masses' on a grid; on meshes no
  // end was met at 5e10.
  const double stiffest_ratio = system.is_mesh() ? 1e9 : 2e6;
  if (MultigridSolver::suits(system) && weights.position * stiffest / lightest <= stiffest_ratio) {
    choice.multigrid = costs.multigrid;
    if (*choice.multigrid < std::min(choice.factors, choice.gradients))
      choice.method = LinearMethod::multigrid;
  }
  return choice;
}

}  // namespace cloth
