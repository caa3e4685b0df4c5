// What one pass of a kernel over the rows of a grid works on. Plain data only: the kernels are compiled with
// flags of their own, and whatever they include must not hold inline functions, which the linker might use
// for files compiled without those flags.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth::kernels {

/// The six directions of springs, as bits. (row, column) is the particle at the spring's first end, except
/// for the antidiagonal, which joins (row, column + 1) to (row + 1, column).
enum SpringBit : unsigned {
  right_one = 1,
  right_two = 2,
  down_one = 4,
  down_two = 8,
  diagonal = 16,
  antidiagonal = 32,
};
inline constexpr int spring_kinds = 6;
inline constexpr unsigned structural_springs = right_one | down_one, shear_springs = diagonal | antidiagonal,
                          flexion_springs = right_two | down_two;

/// F_i = (k - k L / |d|) d, d = x_j - x_i; no part along d/|d| where |d| = 0.
struct SpringKind {
  double stiffness = 0;     ///< k, N/m
  double rest_tension = 0;  ///< k L, N
};

struct Grid {
  int rows = 0, columns = 0;
  unsigned springs = 0;             ///< the directions that exist; families are whole
  SpringKind kind[spring_kinds]{};  ///< in the order of the bits
};

/// Some rows of a field, one after the other; each component is a run of its own.
struct RowBlock {
  double *x = nullptr, *y = nullptr, *z = nullptr;
  int first = 0;  ///< the row that the pointers stand at
};

/// A field as a band of rows sees it: its own rows, and copies of the rows around them.
struct BandField {
  RowBlock own, above, below;
};

/// How many rows beyond its own a band reads on either side, at most.
inline constexpr int step_halo = 2, runge_kutta_halo = 8;

/// A row of scratch: room for whole vectors beyond the last column.
constexpr int pitch_of(int columns) {
  return (columns + 7) / 8 * 8 + 8;
}
/// Doubles of scratch that a pass needs, for each double of pitch.
inline constexpr int step_scratch_rows = 6, runge_kutta_scratch_rows = 3 * (2 * 4 + 3 * 3 * 2 + 7 * 2),
                     air_scratch_rows = 6;  ///< more, for each evaluation of the force

/// One pass over a band of rows [first, last) of the grid. Everything beyond those is only read.
struct Pass {
  Grid grid;
  int first = 0, last = 0;
  BandField position, velocity;
  BandField force;                                      ///< of Verlet, evaluate and damp
  const double* inverse_mass = nullptr;                 ///< 1/kg; 0 where pinned
  const double* load[3] = {nullptr, nullptr, nullptr};  ///< N, of every particle, in addition; may be null
  double weight[3] = {0, 0, 0};                         ///< N, of every particle
  double damping = 0;                                   ///< N s/m, viscous
  double spring_damping = 0;                            ///< N s/m, along every spring
  double air_drag = 0;                                  ///< N s/m, of every particle along its normal
  double wind[4][3] = {};                               ///< m/s, at every evaluation of the force in a step
  double mass_of_free = 1;                              ///< kg
  double step = 0;                                      ///< s
  bool drift_first = false;   ///< explicit Euler: the position follows the old velocity
  double* scratch = nullptr;  ///< 64-byte aligned
  /// Sums over each row, one array of `rows` after the other: |v|^2 before the step and after it, and what
  /// the dampers along the springs take before it and the air gives, in W; of Runge-Kutta |v|^2 at its four
  /// stages and after the step, and the powers at the stages.
  double* sums = nullptr;
};
enum StepSum { squares_before, squares_after, dampers_before, air_before, step_sums };
enum StageSum {
  stage_squares = 0,
  squares_of_result = 4,
  stage_dampers = 5,
  stage_air = 9,
  stage_sums = 13,
};

/// The passes of one instruction set.
struct GridKernels {
  /// v' = v + h a(x, v), x' = x + h v'; or x' = x + h v.
  void (*euler)(const Pass& pass);
  /// Velocity Verlet with centred damping: `force` holds p(x) before and p(x') after.
  void (*verlet)(const Pass& pass);
  /// The same in parts, for batches of steps whose states in between are not needed. From the state at t to
  /// v(t + h/2) and x(t + h); from those to v(t + 3h/2) and x(t + 2h), without `force`; and from those to
  /// v(t + h) and `force`.
  void (*verlet_open)(const Pass& pass);
  void (*verlet_between)(const Pass& pass);
  void (*verlet_close)(const Pass& pass);
  /// Kutta's method of order four.
  void (*runge_kutta)(const Pass& pass);
  /// force = springs + weight + load. `load` may be `force` itself. No sums.
  void (*evaluate)(const Pass& pass);
  /// force = D v of the dampers along the springs, and what they take.
  void (*damp)(const Pass& pass);
  /// The sums of |v|^2 as the steps make them, into the place after the step.
  void (*sum_squares)(const Pass& pass);
  /// What the springs make of the squares of their lengths: result[i] = k - k L / sqrt(s[i]), k where s[i] is
  /// zero; the two ways in which the kernels do it.
  void (*spring_scales[2])(const SpringKind& kind, const double* squares, double* result, int count);
  /// result[i] = 1 / sqrt(s[i]), 0 where s[i] is zero; the two ways as well.
  void (*inverse_roots[2])(const double* squares, double* result, int count);

  CLOTHLAB_KERNEL_TABLE(GridKernels)
};

}  // namespace cloth::kernels
