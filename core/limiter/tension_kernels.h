// The innermost loops of the tensions of a grid: lines side by side and rows of springs. All are plain loops
// over contiguous numbers, without fused operations and with sums and maxima in eight parts, so that every
// instruction set gives the same bits. Legend: tension_rounds.h.
#pragma once

#include <cstddef>

#include "cloth/aligned.h"

namespace cloth::tension {

/// Particles and the springs that begin at them, in one numbering.
struct Nodes {
  double* x;  ///< m
  double* y;
  double* z;
  const double* weight;  ///< inverse mass, 1/kg
};

struct SpringRule {
  double limit = 0;     ///< m
  double square = 0;    ///< h^2
  double softness = 0;  ///< TensionTask
  double ridge = 0;     ///< of the diagonal, added to it
};

/// What a row of springs is found to be.
struct RowLengths {
  double longest = 0;   ///< m^2, largest |d|^2 of springs with an end that is free
  double shortest = 0;  ///< m^2, least |d|^2 of those that have a tension; infinite where there are none
};

/// Springs i .. i + count, each from a particle to the one `offset` further.
RowLengths measure_row(const Nodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* tension,
                       int count, bool pins);

/// Lines of springs side by side: spring n of lane l begins at particle first + l + n step and ends at
/// particle first + l + (n + 1) step, where the next one begins. Lane l of spring n is there where
/// begin <= l + n shift < end.
struct LineBlock {
  Nodes nodes;
  double* tension;
  std::ptrdiff_t first, step;
  int count, lanes;
  int begin, end, shift;
};

/// Rows of `lanes` numbers for every spring of a block, and one of zeros before and after.
struct LineScratch {
  AlignedDoubles ax, ay, az, link, pivot, step;
  void resize(std::size_t size);
};

/// Solves along every line for the tensions of springs that are over their limit or have one, clips them and
/// moves the particles.
void sweep_block(const LineBlock& block, const SpringRule& rule, LineScratch& scratch);

/// Of a row of springs: directions and equations of those that are over their limit or have a tension, zeros
/// of the others.
struct SpringRows {
  double* ax;
  double* ay;
  double* az;
  double* over;      ///< C less what the softness allows
  double* residual;  ///< the same over h^2
};
struct RowResidual {
  double over = 0, slack = 0;  ///< m: largest C, and largest -C of those that have a tension; or -infinite
};
RowResidual evaluate_row(const Nodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* tension,
                         int count, const SpringRule& rule, const SpringRows& rows);

/// Factors of the tridiagonal equations, of a row whose springs go on those of `before`.
struct FactorRow {
  const double *ax, *ay, *az, *weight, *weight_end;
  double *link, *pivot;
};
void factorise_row(const FactorRow& row, const FactorRow& before, double ridge, int count);

/// solved <- (residual - link before) pivot
void eliminate_row(const double* residual, const double* link, const double* pivot, const double* before,
                   double* solved, int count);
/// solved -= pivot link_next next
void substitute_row(const double* pivot, const double* link_next, const double* next, double* solved,
                    int count);

/// Both, of rows side by side: spring c of a row goes on spring c - across. Rows are `stride` apart.
struct LaneFactors {
  const double *link, *pivot;
  double* scratch;  ///< count + 2 across columns of lanes
};
inline constexpr int lanes_of_rows = 16;
void solve_lanes(const LaneFactors& factors, const double* residual, std::ptrdiff_t stride, int rows,
                 int count, int across, double* solved);
void into_lanes(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out);
void out_of_lanes(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out);

/// Particles: s <- weight * sum of sign value a over the terms.
struct PullTerm {
  const double *ax, *ay, *az, *value;
  double sign;
};
void pull_row(const PullTerm* terms, int term_count, const double* weight, double* sx, double* sy, double* sz,
              int count);

/// product <- a . (s - s of the other end) + ridge (w + w_end) value; returns product . value.
struct AnswerRow {
  const double *ax, *ay, *az, *value, *weight;
  const double *sx, *sy, *sz;
  double* product;
};
double answer_row(const AnswerRow& row, std::ptrdiff_t offset, double ridge, int count);

/// direction <- solved + share direction
void turn_row(const double* solved, double share, double* direction, int count);
/// change += length direction, residual -= length product; returns the largest |residual|.
double advance_row(double length, const double* direction, const double* product, double* change,
                   double* residual, int count);
double dot_row(const double* a, const double* b, int count);
double largest_row(const double* a, int count);
/// to += factor from
void add_row(double factor, const double* from, double* to, int count);

/// change <- max(change, -tension); returns change . over, and whether any was less.
struct ClippedRow {
  double gain = 0;
  bool clipped = false;
};
ClippedRow clip_row(const double* tension, const double* over, double* change, int count);
/// change <- max(share residual / (w + w_end), -tension)
void steepest_row(double share, const double* residual, const double* weight, const double* weight_end,
                  const double* tension, double* change, int count);
/// tension <- max(0, tension + length change)
void raise_row(double length, const double* change, double* tension, int count);
/// force += tension a of the springs that begin in a row and end `offset` further.
struct ForceRow {
  const double *x, *y, *z;
  double *fx, *fy, *fz;
};
void force_row(const ForceRow& row, std::ptrdiff_t offset, const double* tension, double* scratch, int count);

}  // namespace cloth::tension
