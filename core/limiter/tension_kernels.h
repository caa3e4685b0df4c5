// The innermost loops of the tensions of a grid: lines side by side and rows of springs. All are plain loops
// over contiguous numbers, without fused operations and with sums and maxima in a fixed number of parts, so
// that every instruction set gives the same bits. Legend: tension_rounds.h.
//
// Positions, tensions and the distances of springs from their limits are doubles. The equations for the
// changes of tensions need not be solved exactly and are floats: twice as many at once. Weights are inverse
// masses over the largest one, and tensions are in metres (N times h^2 times the largest inverse mass), so
// that no number leaves the range of floats.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

/// Particles and the springs that begin at them, in one numbering.
struct GridNodes {
  double* x;  ///< m
  double* y;
  double* z;
  const double* weight;  ///< inverse mass over the largest one
};

struct SpringRule {
  double limit = 0;     ///< m
  double softness = 0;  ///< TensionTask
  double ridge = 0;     ///< share of the diagonal that is added to it
};

struct RowLengths {
  double longest = 0;   ///< m^2, largest |d|^2 of springs with a free end
  double shortest = 0;  ///< m^2, least |d|^2 of those with a tension; infinite where there are none
};

/// Lines of springs side by side: spring n of lane l joins particle first + l + n step to particle
/// first + l + (n + 1) step, where the next one begins. Lane l has a spring n where
/// begin <= l + n shift < end.
struct LineBlock {
  GridNodes nodes;
  double* tension;
  std::ptrdiff_t first, step;
  int count, lanes;
  int begin, end, shift;
};

/// (count + 2) * lanes numbers each: a row for every spring of a LineBlock, and one of zeros before and
/// after.
struct LineScratch {
  float *ax, *ay, *az, *link, *pivot, *step;
};

/// Of a row of springs: directions and equations of those that are over their limit or have a tension, zeros
/// of the others.
struct SpringRows {
  float* ax;
  float* ay;
  float* az;
  float* over;      ///< m, C less what the softness allows
  float* residual;  ///< the same
};

/// Of an evaluated row.
struct RowResidual {
  double over = 0, slack = 0;  ///< m: largest C, and largest -C of springs with a tension
  bool active = false;         ///< some spring is over its limit or has a tension
};

/// A row of springs and the factors of its tridiagonal equations.
struct FactorRow {
  const float *ax, *ay, *az, *weight, *weight_end;
  float *link, *pivot;
};

inline constexpr int lanes_of_rows = 16;

/// Factors of rows in lanes.
struct LaneFactors {
  const float *link, *pivot;
  float* scratch;  ///< count + 2 across columns of lanes
};

/// Springs that act on a row of particles, by the sign of their end there.
struct SpringTerm {
  const float *ax, *ay, *az, *value;
  float sign;
};

struct MatrixRow {
  const float *ax, *ay, *az, *value, *weight;
  const float *sx, *sy, *sz;  ///< W J^T value, of the particles
  float* product;
};

struct ClippedRow {
  double gain = 0;  ///< change . over
  bool clipped = false;
};

struct ForceRow {
  const double *x, *y, *z;
  double *fx, *fy, *fz;
};

/// Rows have `count` springs or particles. Springs i .. i + count of a row join each particle to the one
/// `offset` further.
struct TensionKernels {
  /// `pins`: some spring of the row joins two pins.
  RowLengths (*measure_row)(const GridNodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset,
                            const double* tension, int count, bool pins);

  /// Solves along every line for the tensions of springs that are over their limit or have one, clips them at
  /// 0 and moves the particles.
  void (*sweep_block)(const LineBlock& block, const SpringRule& rule, const LineScratch& scratch);

  void (*evaluate_row)(const GridNodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* tension,
                       int count, const SpringRule& rule, const SpringRows& rows);
  RowResidual (*residual_row)(const double* tension, const float* over, int count);

  /// The springs of `row` follow those of `before` in their lines.
  void (*factorise_row)(const FactorRow& row, const FactorRow& before, double ridge, int count);
  /// solved <- (residual - link before) pivot
  void (*eliminate_row)(const float* residual, const float* link, const float* pivot, const float* before,
                        float* solved, int count);
  /// solved -= pivot link_next next
  void (*substitute_row)(const float* pivot, const float* link_next, const float* next, float* solved,
                         int count);
  /// Both, of `rows` rows side by side: spring c of a row follows spring c - across. Rows are `stride` apart.
  void (*solve_lanes)(const LaneFactors& factors, const float* residual, std::ptrdiff_t stride, int rows,
                      int count, int across, float* solved);

  /// Transposes up to lanes_of_rows rows, so that neighbours in a lane vector are of different rows.
  void (*floats_into_lanes)(const float* in, std::ptrdiff_t stride, int rows, int columns, float* out);
  void (*doubles_into_lanes)(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out);
  void (*doubles_out_of_lanes)(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out);

  /// Of particles: s <- weight * sum of sign value a over the terms.
  void (*transpose_row)(const SpringTerm* terms, int term_count, const float* weight, float* sx, float* sy,
                        float* sz, int count);
  /// x += length times that, in doubles: equal and opposite at the two ends of a spring.
  void (*move_row)(const SpringTerm* terms, int term_count, double length, const double* weight, double* x,
                   double* y, double* z, int count);
  /// product <- a . (s - s of the other end) + ridge (w + w_end) value; returns product . value.
  double (*matrix_row)(const MatrixRow& row, std::ptrdiff_t offset, double ridge, int count);
  /// direction <- solved + share direction
  void (*direction_row)(const float* solved, float share, float* direction, int count);
  /// change += length direction, residual -= length product; returns the largest |residual|.
  float (*solution_row)(float length, const float* direction, const float* product, float* change,
                        float* residual, int count);
  double (*dot_row)(const float* a, const float* b, int count);
  float (*largest_row)(const float* a, int count);  ///< largest |a|

  /// change <- max(change, -tension)
  ClippedRow (*clip_row)(const double* tension, const float* over, float* change, int count);
  /// change <- max(share over / (w + w_end), -tension)
  void (*steepest_row)(float share, const float* over, const float* weight, const float* weight_end,
                       const double* tension, float* change, int count);
  /// tension <- max(0, tension + length change)
  void (*add_row)(double length, const float* change, double* tension, int count);
  /// force += tension a, at both ends. `scratch`: 3 count.
  void (*force_row)(const ForceRow& row, std::ptrdiff_t offset, const double* tension, double* scratch,
                    int count);

  CLOTHLAB_KERNEL_TABLE(TensionKernels)
};

}  // namespace cloth
