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

LinearChoice choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights) {
  // s, measured: dissected factors of a grid grow as its size times its shorter side, an iteration of
  // conjugate gradients is linear.
  constexpr double factor_cost = 130e-9, preconditioner_cost = 60e-9, iteration_cost = 25e-9;
  // Of smooth states, which are most: conjugate gradients need more iterations as well where cloth buckles.
  constexpr double start_cost = 200e-6, setup_cost = 600e-9, cycle_cost = 140e-9;
  // Of Newton's method: with conjugate gradients a step is neither relaxed, nor is its last iteration spared.
  constexpr double more_iterations = 1.5;
  // Measured with the forcing of ImplicitStage: as the root of the condition, but a grid has no worse one
  // than its size gives it; and what factors save in iterations of Newton's method where springs are stiffer
  // still.
  constexpr double iterations_per_root = 2, stiff = 1e6, growth = 0.25;
  const double iterations_per_edge = system.bending.empty() ? 1.7 : 4;  // a material's stiffnesses lie apart
  const Stiffest of_system = stiffest_of(system);
  double stiffest = std::max(of_system.spring, of_system.bending);
  double lightest = std::numeric_limits<double>::infinity();
  for (const MembraneTriangle& t : system.membrane)
    for (const double bound : edge_bounds(t)) stiffest = std::max(stiffest, bound);
  for (const double mass : system.mass) lightest = std::min(lightest, mass);
  const double condition = 1 + 12 * weights.position * stiffest / lightest;
  const double size = system.size();

  LinearChoice choice;
  choice.iterations =
      std::min(iterations_per_edge * std::sqrt(size), iterations_per_root * std::sqrt(condition)) *
      std::pow(std::max(1.0, condition / stiff), growth);
  const double side = system.is_mesh() ? std::sqrt(size) : std::min(system.rows, system.columns);
  choice.factors = factor_cost * size * side;
  choice.gradients = more_iterations * (preconditioner_cost + iteration_cost * choice.iterations) * size;
  if (choice.gradients < choice.factors) choice.method = LinearMethod::conjugate_gradients;
  // Single precision ends where the springs' part of A is some 1e6 times the masses'.
  constexpr double stiffest_ratio = 3e5;
  if (MultigridSolver::suits(system) && weights.position * stiffest / lightest <= stiffest_ratio) {
    // With splines 4 to 5 cycles, which take longer; else 3 to 5.
    const double cycles = MultigridSolver::interpolation(system) == Interpolation::cubic_splines ? 6 : 4;
    choice.multigrid = start_cost + (setup_cost + cycle_cost * cycles) * size;
    if (*choice.multigrid < std::min(choice.factors, choice.gradients))
      choice.method = LinearMethod::multigrid;
  }
  return choice;
}

}  // namespace cloth
