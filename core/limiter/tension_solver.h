// The deformation rate by tensions, a complementarity problem: every limited spring may have a tension t >= 0
// (N) that pulls its ends together, and t > 0 only at its limit, |d| = (1 + rate) L. Positions move by h^2 W
// J^T t, the effect of the tensions within one step h, where W holds the inverse masses and the rows of J the
// springs' directions at their two ends. Tensions are kept from step to step (warm start): a
// step begins with the held tensions as forces, and only their changes are solved for.
//
//     SpringTensions tension(solver.springs().size()), held = tension;
//     each step: solver.hold(tension, h, held);  add_force(held, position, force);  drift;
//                tension.copy(held);  solver.solve(system, h, tension, position);
//
// Each round is one sweep over the lines of springs, in which the tensions of a line are solved for together
// (Thomas' algorithm), then a Newton step for all tensions by conjugate gradients with the lines as
// preconditioner, projected to t >= 0. Where rounds do not converge, an interior point method provides a new
// start. Of a grid, springs that are over their limit or have a tension are solved for one by one while they
// are few, and with all springs of the grid side by side when they become many.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "limiter/grid_plan.h"
#include "limiter/nearest_shape.h"
#include "limiter/tension_kernels.h"
#include "limiter/tension_rounds.h"
#include "scene/scene.h"

namespace cloth {

struct TensionReport {
  int rounds = 0;
  int line_sweeps = 0;
  int cg_iterations = 0;
  int factorisations = 0;  ///< of the interior point method, where rounds did not converge
  double excess = 0;       ///< largest (|d| - (1 + rate) L)/L that is left; 0 if no spring exceeds its limit
  double slack = 0;        ///< largest ((1 + rate) L - |d|)/L of a spring that has a tension
  /// Excess and slack are within the tolerance. Where the pins make the rate unreachable, limits are replaced
  /// by stiff springs (soft constraints); their equations are solved then, and an excess remains.
  bool converged = false;
};

class TensionSolver {
 public:
  /// `unreachable`: the pins make the rate unreachable, so that springs are soft.
  TensionSolver(const Deformation& deformation, const ClothSystem& system, bool unreachable = false);
  /// In the order of the system's springs; tensions have the same order.
  const std::vector<TensionSpring>& springs() const { return springs_; }

  /// Moves positions and changes tensions (N; in: held, out: solved) until excess and slack are within the
  /// tolerance, and further to the smaller `target_residual` if that takes few rounds. Particles move by
  /// internal forces only, which conserves the momentum of a free cloth.
  TensionReport solve(const ClothSystem& system, double time_step, SpringTensions& tension,
                      Vec3Field& position, double target_residual = std::numeric_limits<double>::infinity());

  /// Of the particles that the last solve() moved, m: where they were before it.
  const SparseField& moved_from() const { return from_; }

  double shortest() const { return shortest_; }  ///< m, rest length

  /// The largest (|d| - (1 + rate) L)/L of a limited spring; 0 if none exceeds its limit.
  double excess(const Vec3Field& position) const { return largest_excess(springs_, position); }

  /// force += J^T tension, N: each tension pulls its ends together.
  void add_force(const SpringTensions& tension, const Vec3Field& position, SparseField& force) const;
  void add_force(const SpringTensions& tension, const Vec3Field& position, Vec3Field& force) const;

  /// `held` becomes the part of each tension that may act as a force over a step of h seconds: at most half
  /// of m (1 + rate) L/h^2, because a rotating spring would overshoot with more. Zero where the rate is
  /// unreachable.
  void hold(const SpringTensions& tension, double time_step, SpringTensions& held) const;

  bool unreachable() const { return unreachable_; }

 private:
  void find_over(const SpringTensions& tension, Vec3Field& position, std::size_t most);
  void find_over_of_row(const GridFamily& family, int row, const std::vector<double>& tension,
                        Vec3Field& position);
  TensionRounds& rounds_for(bool by_lines, const ClothSystem& system);
  void add_grid_force(const std::vector<double>& tension, const Vec3Field& position, Vec3Field& force) const;
  void run_rounds(const TensionTask& task, bool by_lines, const ClothSystem& system, SpringTensions& tension,
                  Vec3Field& position, TensionReport& report);
  void restart_from_nearest(const TensionTask& task, const ClothSystem& system, SpringTensions& tension,
                            Vec3Field& position, TensionReport& report);

  Deformation deformation_;
  const TensionKernels* kernels_;
  std::vector<TensionSpring> springs_;
  std::vector<double> hold_;  ///< N s^2, of each spring: h^2 times the largest held tension
  std::optional<GridPlan> grid_;
  // Each is made when it is first asked for.
  std::unique_ptr<TensionRounds> grid_rounds_, line_rounds_;
  std::optional<NearestShape> nearest_;

  // Of the present solve.
  SparseField from_;                 ///< m
  SpringTensions first_;             ///< N
  std::vector<std::uint32_t> over_;  ///< springs over their limit, unless many of a grid are taut
  double shortest_ = 0;
  bool unreachable_;
};

}  // namespace cloth
