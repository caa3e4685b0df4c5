// The deformation rate by tensions: every limited spring may carry a tension t >= 0 (N) that pulls its ends
// together, and carries one only at its limit, |d| = (1 + rate) L. Positions move by h^2 W J^T t, what the
// tensions do within one step of h. They are kept from step to step: a step begins with the tensions that it
// is told to hold, as forces, and only their changes are left to find.
//
//     std::vector<double> tension(solver.springs().size(), 0.0);
//     each step: held = solver.held(tension, h);  add_force(held, position, force);  drift;
//                tension = held;  solver.solve(system, h, tension, position);
//
// Solved by rounds: one sweep over the lines of springs, in each of which the tensions are found together
// (Thomas' algorithm), then a Newton step for all of them by conjugate gradients with the lines as
// preconditioner, projected to t >= 0. What rounds do not end, an interior point method starts anew.
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
  int factorisations = 0;  ///< of the interior point method, where rounds did not end
  double excess = 0;       ///< largest (|d| - (1 + rate) L)/L that is left, 0 if none is over
  double slack = 0;        ///< largest ((1 + rate) L - |d|)/L of a spring that has a tension
  /// Excess and slack are within the tolerance; where the rate is known to be unreachable, those of soft
  /// springs are, and an excess is left.
  bool converged = false;
};

class TensionSolver {
 public:
  TensionSolver(const Deformation& deformation, const ClothSystem& system);
  ~TensionSolver();
  TensionSolver(TensionSolver&&) noexcept;
  TensionSolver& operator=(TensionSolver&&) noexcept;

  /// True if this deformation limits any spring of this system.
  static bool is_needed(const Deformation& deformation, const ClothSystem& system);

  /// In the order of the system's springs. So are tensions.
  const std::vector<TensionSpring>& springs() const { return springs_; }

  /// Moves positions and changes tensions (N, from what is held to what they are) until excess and slack are
  /// within the tolerance, and on to `aim`, which is less, as far as that takes few rounds. Particles move by
  /// internal forces alone: the momentum of a free cloth stays.
  TensionReport solve(const ClothSystem& system, double time_step, std::vector<double>& tension,
                      Vec3Field& position, double aim = std::numeric_limits<double>::infinity());

  double shortest() const { return shortest_; }  ///< m, rest length

  /// The largest (|d| - (1 + rate) L)/L of a limited spring, 0 if none is over.
  double excess(const Vec3Field& position) const;

  /// force += J^T tension, N: each tension pulls its ends together.
  void add_force(const std::vector<double>& tension, const Vec3Field& position, Vec3Field& force) const;

  /// What of a tension may be held over a step of h seconds: at most half of m (1 + rate) L/h^2. More makes a
  /// spring that turns overshoot. None where the rate is unreachable.
  std::vector<double> held(const std::vector<double>& tension, double time_step) const;

  /// Whether the pins are known to make the rate unreachable: springs are then soft.
  void set_unreachable(bool unreachable) { unreachable_ = unreachable; }
  bool unreachable() const { return unreachable_; }

 private:
  bool is_loose(const std::vector<double>& tension, Vec3Field& position) const;
  void add_grid_force(const std::vector<double>& tension, const Vec3Field& position, Vec3Field& force) const;
  void go_on(const TensionTask& task, const ClothSystem& system, std::vector<double>& tension,
             Vec3Field& position, TensionReport& report);
  void find_nearest(const TensionTask& task, const ClothSystem& system, std::vector<double>& tension,
                    Vec3Field& position, TensionReport& report);

  Deformation deformation_;
  const TensionKernels* kernels_;
  std::vector<TensionSpring> springs_;
  std::vector<double> hold_;  ///< N s^2, of each spring: h^2 times the most that is held
  std::optional<GridPlan> grid_;
  std::unique_ptr<TensionRounds> rounds_;
  std::optional<NearestShape> nearest_;  ///< made when it is first asked for
  double shortest_ = 0;
  bool unreachable_ = false;
};

}  // namespace cloth
