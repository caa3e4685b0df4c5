// The interface of the kernels for grids: the input and output of one pass over rows of a grid. Plain data
// only: kernels are compiled for a given instruction set, and what they include must not contain inline
// functions, which the linker might use for files compiled for another one.
#pragma once

#include "kernels/descent_fields.h"
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
  unsigned springs = 0;             ///< SpringBits of the directions that exist, each with all its springs
  SpringKind kind[spring_kinds]{};  ///< in the order of the bits
};

/// What a grid assembled cell by cell has in addition (cloth/material_grid.h): particles, springs along rows
/// and springs along columns at its borders count half, and there are bending elements (cloth/bending.h).
/// Absent: `part` is null.
struct CellShares {
  const double* part =
      nullptr;  ///< 1/2 for the first and the last column, 1 for others; padded to whole registers
  /// N/m: the stiffness of the bending element whose first point is this particle, along the row, along the
  /// column and of the cell's twist; 0: none. Null: the cloth does not bend.
  const double *across = nullptr, *down = nullptr, *twist = nullptr;
};

/// The sliders of hysteresis (cloth/bending_sliders.h) along rows or along columns of a grid, each at the
/// place of its middle particle, where others have c = 0.
struct SliderLine {
  const double* curvature = nullptr;  ///< c in kappa = c n . (x_- - 2 x + x_+), 1/m^2. Null: no sliders
  const double* slip = nullptr;       ///< 1/m
  double* next_slip = nullptr;        ///< 1/m, output of `end_sliders`
  double push = 0;  ///< N m: times kappa - slip and the share, the force of a slider on its ends
  double most = 0;  ///< 1/m, of |kappa - slip| where it yields
  double curvature_of_whole = 0;  ///< 1/m^2, the least c
};
struct SliderPass {
  SliderLine across, down;
  const double* normal[3] = {nullptr, nullptr, nullptr};  ///< unit vectors, of every particle
  double* next_normal[3] = {nullptr, nullptr, nullptr};   ///< output of `end_sliders` and `slider_normals`
};

/// Consecutive rows of a field; each component is a contiguous array.
struct RowBlock {
  double *x = nullptr, *y = nullptr, *z = nullptr;
  int first = 0;  ///< the row to which the pointers point
};

/// A field as a band of rows (one thread's part of the grid) reads it: its own rows, and copies of the rows
/// above and below them.
struct BandField {
  RowBlock own, above, below;
};

/// The largest number of rows beyond its own that a band reads on either side.
inline constexpr int step_halo = 2, runge_kutta_halo = 8;

/// Doubles in a row of scratch memory, with padding for whole registers beyond the last column.
constexpr int pitch_of(int columns) {
  return (columns + 7) / 8 * 8 + 8;
}
/// Rows of scratch memory, of pitch_of(columns) doubles each, that a pass needs.
inline constexpr int step_scratch_rows = 6, runge_kutta_scratch_rows = 3 * (2 * 4 + 3 * 3 * 2 + 7 * 2),
                     air_scratch_rows = 6,
                     slider_scratch_rows = 6;  ///< in addition, for each evaluation of the force
inline constexpr int slider_end_scratch_rows = 6 + 3 * 5;

/// One pass over a band of rows [first, last) of the grid. Other rows are only read.
struct Pass {
  Grid grid;
  int first = 0, last = 0;
  BandField position, velocity;
  BandField force;                                      ///< of Verlet, predicted Verlet, evaluate and damp
  const double* inverse_mass = nullptr;                 ///< 1/kg; 0 where pinned
  const double* load[3] = {nullptr, nullptr, nullptr};  ///< N, additional force on each particle; may be null
  double weight[3] = {0, 0, 0};                         ///< N, of every particle; with shares, of a whole one
  CellShares shares;
  SliderPass sliders;
  double damping = 0;                     ///< N s/m, viscous
  bool has_dampers = false;               ///< along springs, or of bending
  double spring_damping[spring_kinds]{};  ///< N s/m, dampers along springs
  double bending_time = 0;                ///< s, damper over stiffness of bending elements
  bool has_air = false;
  double air_drag = 0, air_friction = 0;  ///< N s/m per particle, along the normal and across it
  double wind[4][3] = {};                 ///< m/s, for each evaluation of the force in a step
  double mass_of_free = 1;                ///< kg
  double step = 0;                        ///< s
  bool drift_first = false;               ///< explicit Euler: the position follows the old velocity
  double gain = 1, held = 1;              ///< predicted Verlet: of VelocityUpdate
  double* scratch = nullptr;              ///< 64-byte aligned
  /// Output: sums over each row, in consecutive arrays of grid.rows numbers, indexed by StepSum or, of
  /// Runge-Kutta, StageSum (+ stage): |v|^2 in (m/s)^2, with CellShares times the particle's share, the power
  /// dissipated by dampers along springs and the power given by the air, in W.
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

/// In J: what the sliders of a row store, or what they have lost.
enum SliderSum { energy_of_sliders, slider_sums };

/// One visit of every spring by XPBD, see grid_projection.h: moves the velocities alone.
struct Projection {
  Grid grid;
  RowBlock position;                        ///< m, at the start of the step; all rows
  RowBlock velocity;                        ///< m/s, in place
  const double* mobility = nullptr;         ///< 1/kg; 0 where pinned
  const unsigned char* is_alike = nullptr;  ///< of each row: whether every particle has `common_mobility`
  double common_mobility = 0;               ///< 1/kg
  double spring_damping = 0;                ///< N s/m, of every spring
  double step = 0;                          ///< s
  double largest_change = 0;                ///< output: squared, of a particle's velocity by a visit, (m/s)^2
};

/// One visit of every particle by VBD, see grid_visits.h. Fields are in the order that grid_descent.h says.
struct Descent : DescentFields {
  Grid grid;
  double rest_length[spring_kinds]{};  ///< m
  int row_stride = 0, residue_stride = 0,
      first = 0;                  ///< doubles: from row to row, from run to run, before row 0
  const double* there = nullptr;  ///< 1 where a row has a column, 0 in its padding

  CLOTHLAB_INLINE long place(int row, int residue, int at) const {
    return first + static_cast<long>(row) * row_stride + residue * residue_stride + at;
  }
};

/// The passes of one instruction set.
struct GridKernels {
  /// v' = v + h a(x, v), x' = x + h v'; or x' = x + h v.
  void (*euler)(const Pass& pass);
  /// Velocity Verlet with centred damping: `force` holds p(x) before and p(x') after.
  void (*verlet)(const Pass& pass);
  /// The same in parts, for batches of steps of which only the last state is needed. `open` computes
  /// v(t + h/2) and x(t + h) from the state at t. `between` advances both by h: to v(t + 3h/2) and x(t + 2h);
  /// it does not use `force`. `close` completes the last step from v(t + h/2) and x(t + h): v(t + h) and
  /// `force` at x(t + h).
  void (*verlet_open)(const Pass& pass);
  void (*verlet_between)(const Pass& pass);
  void (*verlet_close)(const Pass& pass);
  /// Velocity Verlet with every force at a velocity that is not solved for: `force` holds f before and after.
  /// In parts: `predicted_open` drifts and leaves v + (1 + held) h/2 f/m in `velocity`; `predicted_close`
  /// computes f' there and adds h/2 (gain f' - held f)/m; with a step of 0 it only computes f'.
  void (*predicted)(const Pass& pass);
  void (*predicted_open)(const Pass& pass);
  void (*predicted_close)(const Pass& pass);
  /// Kutta's method of order four.
  void (*runge_kutta)(const Pass& pass);
  /// force = springs + weight + load. `load` may be `force` itself. No sums.
  void (*evaluate)(const Pass& pass);
  /// force = D v of the dampers (SweepLoads), and the power that they dissipate.
  void (*damp)(const Pass& pass);
  /// The end of a step with sliders: next slips and normals at `position`, and what they have lost. Where
  /// `force` is given, it becomes what it would be with those.
  void (*end_sliders)(const Pass& pass);
  /// Next normals at `position` alone; no sums.
  void (*slider_normals)(const Pass& pass);
  /// The energy that the sliders store at `position`.
  void (*slider_energies)(const Pass& pass);
  /// The sums of |v|^2, added in the same order as in a step, into `squares_after`.
  void (*sum_squares)(const Pass& pass);
  /// Every spring of finite stiffness once, one direction after the other.
  void (*project)(Projection& projection);
  /// Every particle once, colour by colour.
  void (*descend)(Descent& descent);
  /// For tests. From squared lengths: result[i] = k - k L / sqrt(s[i]), and k where s[i] is 0; by a refined
  /// estimate [0] and by division [1].
  void (*spring_scales[2])(const SpringKind& kind, const double* squares, double* result, int count);
  /// For tests. result[i] = 1 / sqrt(s[i]), and 0 where s[i] is 0; likewise.
  void (*inverse_roots[2])(const double* squares, double* result, int count);

  CLOTHLAB_KERNEL_TABLE(GridKernels)
};

}  // namespace cloth::kernels
