// The innermost loops of the tensions of a grid: lines side by side and rows of springs. All are plain loops
// over contiguous numbers, without fused operations and with sums and maxima in eight parts, so that every
// instruction set gives the same bits. Legend: tension_rounds.h.
//
// Positions and tensions are doubles, and what says how far a spring is from its limit. The equations for the
// changes of tensions, which need not be solved exactly, are floats: twice as many at once. Weights are in
// units of the largest one and tensions in metres, times h^2 and that unit, so that no number is out of
// range.
#pragma once

#include <cstddef>
#include <vector>

#include "cloth/aligned.h"

namespace cloth::tension {

/// Particles and the springs that begin at them, in one numbering.
struct Nodes {
  double* x;  ///< m
  double* y;
  double* z;
  const double* weight;  ///< inverse mass over the largest one
};

using AlignedFloats = std::vector<float, CacheLineAllocator<float>>;

struct SpringRule {
  double limit = 0;     ///< m
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
  AlignedFloats ax, ay, az, link, pivot, step;
  void resize(std::size_t size);
};

/// Solves along every line for the tensions of springs that are over their limit or have one, clips them and
/// moves the particles.
void sweep_block(const LineBlock& block, const SpringRule& rule, LineScratch& scratch);

/// Of a row of springs: directions and equations of those that are over their limit or have a tension, zeros
/// of the others.
struct SpringRows {
  float* ax;
  float* ay;
  float* az;
  float* over;      ///< m, C less what the softness allows
  float* residual;  ///< the same
};
void evaluate_row(const Nodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* tension,
                  int count, const SpringRule& rule, const SpringRows& rows);

/// Of a row so evaluated.
struct RowResidual {
  double over = 0, slack = 0;  ///< m: largest C, and largest -C of those that have a tension
  bool active = false;         ///< any is over its limit or has a tension
};
RowResidual residual_row(const double* tension, const float* over, int count);

/// Factors of the tridiagonal equations, of a row whose springs go on those of `before`.
struct FactorRow {
  const float *ax, *ay, *az, *weight, *weight_end;
  float *link, *pivot;
};
void factorise_row(const FactorRow& row, const FactorRow& before, double ridge, int count);

/// solved <- (residual - link before) pivot
void eliminate_row(const float* residual, const float* link, const float* pivot, const float* before,
                   float* solved, int count);
/// solved -= pivot link_next next
void substitute_row(const float* pivot, const float* link_next, const float* next, float* solved, int count);

/// Both, of rows side by side: spring c of a row goes on spring c - across. Rows are `stride` apart.
struct LaneFactors {
  const float *link, *pivot;
  float* scratch;  ///< count + 2 across columns of lanes
};
inline constexpr int lanes_of_rows = 16;
void solve_lanes(const LaneFactors& factors, const float* residual, std::ptrdiff_t stride, int rows,
                 int count, int across, float* solved);
template <class Number>
void into_lanes(const Number* in, std::ptrdiff_t stride, int rows, int columns, Number* out);
template <class Number>
void out_of_lanes(const Number* in, std::ptrdiff_t stride, int rows, int columns, Number* out);

/// Particles: s <- weight * sum of sign value a over the terms.
struct PullTerm {
  const float *ax, *ay, *az, *value;
  float sign;
};
void pull_row(const PullTerm* terms, int term_count, const float* weight, float* sx, float* sy, float* sz,
              int count);
/// x += length of that, in doubles: equal and opposite at the two ends.
void move_row(const PullTerm* terms, int term_count, double length, const double* weight, double* x,
              double* y, double* z, int count);

/// product <- a . (s - s of the other end) + ridge (w + w_end) value; returns product . value.
struct AnswerRow {
  const float *ax, *ay, *az, *value, *weight;
  const float *sx, *sy, *sz;
  float* product;
};
double answer_row(const AnswerRow& row, std::ptrdiff_t offset, double ridge, int count);

/// direction <- solved + share direction
void turn_row(const float* solved, float share, float* direction, int count);
/// change += length direction, residual -= length product; returns the largest |residual|.
float advance_row(float length, const float* direction, const float* product, float* change, float* residual,
                  int count);
double dot_row(const float* a, const float* b, int count);
float largest_row(const float* a, int count);

/// change <- max(change, -tension); returns change . over, and whether any was less.
struct ClippedRow {
  double gain = 0;
  bool clipped = false;
};
ClippedRow clip_row(const double* tension, const float* over, float* change, int count);
/// change <- max(share over / (w + w_end), -tension)
void steepest_row(float share, const float* over, const float* weight, const float* weight_end,
                  const double* tension, float* change, int count);
/// tension <- max(0, tension + length change)
void raise_row(double length, const float* change, double* tension, int count);
/// force += tension a of the springs that begin in a row and end `offset` further.
struct ForceRow {
  const double *x, *y, *z;
  double *fx, *fy, *fz;
};
void force_row(const ForceRow& row, std::ptrdiff_t offset, const double* tension, double* scratch, int count);

}  // namespace cloth::tension
