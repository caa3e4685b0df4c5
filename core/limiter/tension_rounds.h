// The iterations of TensionSolver: line sweeps and conjugate gradients on the active springs, which are those
// that are over their limit or have a tension.
//
// Legend: x positions, d = x_second - x_first of a spring, a = d/|d|, C = |d| - limit, w inverse masses (0
// where pinned), h time step, J the rows (.. -a .. +a ..) of the springs. A tension t (N) pulls the two ends
// together for one step: it moves them by h^2 w t a, toward each other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/sparse_field.h"
#include "limiter/grid_plan.h"
#include "limiter/spring_tensions.h"
#include "limiter/tension_springs.h"

namespace cloth {

/// Violation of the complementarity conditions, in rest lengths.
struct TensionResidual {
  double excess = 0;  ///< largest C of all springs, 0 if none is over
  double slack = 0;   ///< largest -C of springs that have a tension
  bool within(double tolerance) const { return excess <= tolerance && slack <= tolerance; }
};

/// Of a solve.
struct TensionTask {
  double time_step = 0;  ///< s
  double tolerance = 0;  ///< of the residual
  /// Compliance of the limit: C = h^2 softness (w_first + w_second) t where there is a tension, and the
  /// residual is that of this equation. With a softness above 0 it has a solution wherever the pins are.
  double softness = 0;
};

/// What a solve reads and changes. Positions and tensions have their new values after TensionRounds::end().
struct TensionProblem {
  const std::vector<double>& inverse_mass;
  SpringTensions& tension;
  Vec3Field& position;
  SparseField& from;                    ///< gets the first positions of particles that are moved
  std::span<const std::uint32_t> over;  ///< the springs over their limit, those between two pins aside
};

// Constants of both implementations.

/// Share of the diagonal of J W J^T that is added to it, because redundant springs make that matrix singular.
inline constexpr double least_ridge = 3e-6;     ///< along a line, above what floats round
inline constexpr double together_ridge = 1e-3;  ///< all tensions at once; less only makes iterations more
inline double ridge_of(const TensionTask& task) {
  return std::max(together_ridge, task.softness);
}

/// Conjugate gradients end at this share of the first residual, or of the tolerance.
inline constexpr double enough_of_residual = 0.5, enough_of_tolerance = 0.3;
inline constexpr int max_cg_iterations = 6;

/// Where the clipped step does not reduce C, this share of C over the diagonal is taken.
inline constexpr double steepest_share = 0.25;

class TensionRounds {
 public:
  virtual ~TensionRounds() = default;

  virtual void begin(const TensionTask& task, const TensionProblem& problem) = 0;
  virtual TensionResidual evaluate() = 0;
  /// For one line after the other: solves for its tensions together, clips those below 0 and moves its
  /// particles.
  virtual void sweep_lines(bool backwards) = 0;
  /// One Newton step for all tensions at the last evaluated positions, by conjugate gradients with the lines
  /// as preconditioner. Returns the iterations.
  virtual int solve_together() = 0;
  /// Whether more springs have come to be looked at than such rounds are for.
  virtual bool have_outgrown() const { return false; }
  /// `changed`: anything was swept or solved.
  virtual void end(bool changed) = 0;
};

/// For all springs of a grid: families of lines side by side. It does not ask for TensionProblem::over.
std::unique_ptr<TensionRounds> make_grid_rounds(const GridPlan& plan);
/// For any springs, and the only ones of a mesh: line by line, as long as springs that are over their limit
/// or have a tension, and their neighbours, take. The two agree to the tolerance.
std::unique_ptr<TensionRounds> make_line_rounds(std::span<const TensionSpring> springs,
                                                const ClothSystem& system);

}  // namespace cloth
