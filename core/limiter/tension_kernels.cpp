#include "limiter/tension_kernels.h"

#include "kernels/kernel_loops.h"
#include "limiter/spring_equation.h"

namespace cloth {
namespace {

using kernels::in_parts, kernels::larger, kernels::smaller, kernels::size_of;

constexpr int parts = 8;         // of doubles
constexpr int float_parts = 16;  // of floats
constexpr double infinity = __builtin_huge_val();

template <class Number, std::size_t count>
Number largest_of(const Number (&part)[count]) {
  Number found = part[0];
  for (const Number p : part) found = larger(p, found);
  return found;
}

template <class Number, std::size_t count>
double sum_of(const Number (&part)[count]) {
  double sum = 0;
  for (const Number p : part) sum += static_cast<double>(p);
  return sum;
}

RowLengths measure_row(const GridNodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* tension,
                       int count, bool pins) {
  const double *x = nodes.x + i, *y = nodes.y + i, *z = nodes.z + i, *w = nodes.weight + i;
  double longest[parts] = {}, shortest[parts];
  for (double& part : shortest) part = infinity;
  const auto look = [&](int k, int part) {
    const double dx = x[k + offset] - x[k], dy = y[k + offset] - y[k], dz = z[k + offset] - z[k];
    const double square = dx * dx + dy * dy + dz * dz;
    shortest[part] = tension[k] > 0 ? smaller(square, shortest[part]) : shortest[part];
    longest[part] = larger(square, longest[part]);
  };
  if (pins) {
    for (int k = 0; k < count; ++k)
      if (w[k] + w[k + offset] > 0) look(k, k % parts);
  } else {
    in_parts<parts>(count, look);
  }
  RowLengths found{largest_of(longest), shortest[0]};
  for (const double part : shortest) found.shortest = smaller(part, found.shortest);
  return found;
}

struct LaneRange {
  int begin, end;
};

LaneRange lanes_of(const LineBlock& block, int n) {
  const int begin = smaller(larger(block.begin - n * block.shift, 0), block.lanes);
  return {begin, smaller(larger(block.end - n * block.shift, begin), block.lanes)};
}

/// Lanes without a spring here get zeros.
void clear_lanes(const LineScratch& s, std::ptrdiff_t row, int begin, int end) {
  float* const fields[] = {s.ax, s.ay, s.az, s.link, s.pivot, s.step};
  for (float* field : fields)
    for (std::ptrdiff_t k = row + begin; k < row + end; ++k) field[k] = 0;
}

/// One row of the forward elimination.
CLOTHLAB_INLINE void eliminate_lines(const LineBlock& block, const EquationRule& rule, float share,
                                     std::ptrdiff_t i, LaneRange lanes, std::ptrdiff_t row,
                                     const LineScratch& scratch) {
  const double *x = block.nodes.x + i, *y = block.nodes.y + i, *z = block.nodes.z + i;
  const double *w = block.nodes.weight + i, *t = block.tension + i;
  const std::ptrdiff_t e = block.step, back = -block.lanes;
  float *ax = scratch.ax + row, *ay = scratch.ay + row, *az = scratch.az + row;
  float *link = scratch.link + row, *pivot = scratch.pivot + row;
  float* step = scratch.step + row;
#pragma GCC ivdep
  for (int k = lanes.begin; k < lanes.end; ++k) {
    const float weight = static_cast<float>(w[k]), both = weight + static_cast<float>(w[k + e]);
    const Equation found = equation_of(rule, x[k + e] - x[k], y[k + e] - y[k], z[k + e] - z[k], t[k], both);
    const float l = -weight * (found.ax * ax[k + back] + found.ay * ay[k + back] + found.az * az[k + back]);
    const float u = l * pivot[k + back];
    const float diagonal = both > 0 ? both * share : 1.0f;
    const float p = 1 / (diagonal - l * u);
    ax[k] = found.ax, ay[k] = found.ay, az[k] = found.az;
    link[k] = l, pivot[k] = p;
    step[k] = ((found.active ? found.over : 0.0f) - l * step[k + back]) * p;
  }
}

/// One row of the back substitution. Earlier springs of a line see the clipped tensions of later ones.
CLOTHLAB_INLINE void substitute_lines(const LineBlock& block, std::ptrdiff_t i, LaneRange lanes,
                                      std::ptrdiff_t row, const LineScratch& scratch) {
  double *x = block.nodes.x + i, *y = block.nodes.y + i, *z = block.nodes.z + i, *t = block.tension + i;
  const double* w = block.nodes.weight + i;
  const std::ptrdiff_t e = block.step, next = block.lanes;
  const float *ax = scratch.ax + row, *ay = scratch.ay + row, *az = scratch.az + row;
  const float *link = scratch.link + row, *pivot = scratch.pivot + row;
  float* step = scratch.step + row;
#pragma GCC ivdep
  for (int k = lanes.begin; k < lanes.end; ++k) {
    const float free = step[k] - pivot[k] * link[k + next] * step[k + next];
    const float least = -static_cast<float>(t[k]);
    const bool kept = free > least;
    const float change = kept ? free : least;
    step[k] = change;
    t[k] = kept ? t[k] + static_cast<double>(change) : 0.0;
    const double px = static_cast<double>(change * ax[k]), py = static_cast<double>(change * ay[k]),
                 pz = static_cast<double>(change * az[k]);
    x[k + e] -= w[k + e] * px, y[k + e] -= w[k + e] * py, z[k + e] -= w[k + e] * pz;
    x[k] += w[k] * px, y[k] += w[k] * py, z[k] += w[k] * pz;
  }
}

void sweep_block(const LineBlock& block, const SpringRule& rule, const LineScratch& scratch) {
  const std::ptrdiff_t lanes = block.lanes;
  const EquationRule equation = equation_rule(rule);
  const float share = static_cast<float>(1 + rule.ridge + rule.softness);
  clear_lanes(scratch, 0, 0, block.lanes);
  clear_lanes(scratch, (block.count + 1) * lanes, 0, block.lanes);
  for (int n = 0; n < block.count; ++n) {
    const LaneRange here = lanes_of(block, n);
    const std::ptrdiff_t row = (n + 1) * lanes;
    clear_lanes(scratch, row, 0, here.begin);
    clear_lanes(scratch, row, here.end, block.lanes);
    eliminate_lines(block, equation, share, block.first + n * block.step, here, row, scratch);
  }
  for (int n = block.count; n-- > 0;)
    substitute_lines(block, block.first + n * block.step, lanes_of(block, n), (n + 1) * lanes, scratch);
}

void evaluate_row(const GridNodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset, const double* t, int count,
                  const SpringRule& rule, const SpringRows& rows) {
  const double *x = nodes.x + i, *y = nodes.y + i, *z = nodes.z + i, *w = nodes.weight + i;
  const EquationRule equation = equation_rule(rule);
  float *ax = rows.ax, *ay = rows.ay, *az = rows.az, *over = rows.over, *residual = rows.residual;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const float both = static_cast<float>(w[k]) + static_cast<float>(w[k + offset]);
    const Equation found =
        equation_of(equation, x[k + offset] - x[k], y[k + offset] - y[k], z[k + offset] - z[k], t[k], both);
    const float c = found.active ? found.over : 0.0f;
    ax[k] = found.ax, ay[k] = found.ay, az[k] = found.az;
    over[k] = c, residual[k] = c;
  }
}

RowResidual residual_row(const double* t, const float* over, int count) {
  RowResidual found;
  for (int k = 0; k < count; ++k) {
    const auto c = static_cast<double>(over[k]);
    found.over = larger(c, found.over);
    if (t[k] > 0) found.slack = larger(-c, found.slack);
    found.active = found.active || c > 0 || t[k] > 0;
  }
  return found;
}

void factorise_row(const FactorRow& row, const FactorRow& before, double ridge, int count) {
  const float *ax = row.ax, *ay = row.ay, *az = row.az, *w = row.weight, *we = row.weight_end;
  const float *bx = before.ax, *by = before.ay, *bz = before.az, *pivot_before = before.pivot;
  float *link = row.link, *pivot = row.pivot;
  const float share = static_cast<float>(1 + ridge);
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const float l = -w[k] * (ax[k] * bx[k] + ay[k] * by[k] + az[k] * bz[k]);
    const float both = w[k] + we[k];
    const float diagonal = both > 0 ? both * share : 1.0f;
    link[k] = l;
    pivot[k] = 1 / (diagonal - l * (l * pivot_before[k]));
  }
}

void eliminate_row(const float* residual, const float* link, const float* pivot, const float* before,
                   float* solved, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) solved[k] = (residual[k] - link[k] * before[k]) * pivot[k];
}

void substitute_row(const float* pivot, const float* link_next, const float* next, float* solved, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) solved[k] -= pivot[k] * link_next[k] * next[k];
}

template <class Number>
void into_lanes(const Number* in, std::ptrdiff_t stride, int rows, int columns, Number* out) {
  for (int c = 0; c < columns; ++c) {
    Number* to = out + c * lanes_of_rows;
    if (rows == lanes_of_rows)
      for (int lane = 0; lane < lanes_of_rows; ++lane) to[lane] = in[lane * stride + c];
    else
      for (int lane = 0; lane < lanes_of_rows; ++lane)
        to[lane] = lane < rows ? in[lane * stride + c] : Number{};
  }
}

template <class Number>
void out_of_lanes(const Number* in, std::ptrdiff_t stride, int rows, int columns, Number* out) {
  for (int lane = 0; lane < rows; ++lane)
    for (int c = 0; c < columns; ++c) out[lane * stride + c] = in[c * lanes_of_rows + lane];
}

void solve_lanes(const LaneFactors& f, const float* residual, std::ptrdiff_t stride, int rows, int count,
                 int across, float* solved) {
  float* v = f.scratch;
  into_lanes(residual, stride, rows, count, v);
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(across) * lanes_of_rows;
  for (int c = 0; c < count; ++c) {
    const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(c) * lanes_of_rows;
    if (c < across)
      for (std::ptrdiff_t k = i; k < i + lanes_of_rows; ++k) v[k] *= f.pivot[k];
    else
#pragma GCC ivdep
      for (std::ptrdiff_t k = i; k < i + lanes_of_rows; ++k)
        v[k] = (v[k] - f.link[k] * v[k - step]) * f.pivot[k];
  }
  for (int c = count - across; c-- > 0;) {
    const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(c) * lanes_of_rows;
#pragma GCC ivdep
    for (std::ptrdiff_t k = i; k < i + lanes_of_rows; ++k)
      v[k] -= f.pivot[k] * f.link[k + step] * v[k + step];
  }
  out_of_lanes(v, stride, rows, count, solved);
}

void transpose_row(const SpringTerm* terms, int term_count, const float* weight, float* sx, float* sy,
                   float* sz, int count) {
  for (int n = 0; n < term_count; ++n) {
    const float *ax = terms[n].ax, *ay = terms[n].ay, *az = terms[n].az, *value = terms[n].value;
    const float sign = terms[n].sign, begin = n == 0 ? 0.0f : 1.0f;
#pragma GCC ivdep
    for (int k = 0; k < count; ++k) {
      const float v = sign * value[k];
      sx[k] = begin * sx[k] + v * ax[k];
      sy[k] = begin * sy[k] + v * ay[k];
      sz[k] = begin * sz[k] + v * az[k];
    }
  }
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) sx[k] *= weight[k], sy[k] *= weight[k], sz[k] *= weight[k];
}

void move_row(const SpringTerm* terms, int term_count, double length, const double* weight, double* x,
              double* y, double* z, int count) {
  for (int n = 0; n < term_count; ++n) {
    const float *ax = terms[n].ax, *ay = terms[n].ay, *az = terms[n].az, *value = terms[n].value;
    const float sign = terms[n].sign;
#pragma GCC ivdep
    for (int k = 0; k < count; ++k) {
      const float v = sign * value[k];
      const double share = length * weight[k];
      x[k] += share * static_cast<double>(v * ax[k]);
      y[k] += share * static_cast<double>(v * ay[k]);
      z[k] += share * static_cast<double>(v * az[k]);
    }
  }
}

double matrix_row(const MatrixRow& row, std::ptrdiff_t e, double ridge_share, int count) {
  const float *sx = row.sx, *sy = row.sy, *sz = row.sz, *value = row.value, *w = row.weight;
  const float ridge = static_cast<float>(ridge_share);
  float sum[float_parts] = {};
  in_parts<float_parts>(count, [&](int k, int part) {
    const float product = row.ax[k] * (sx[k] - sx[k + e]) + row.ay[k] * (sy[k] - sy[k + e]) +
                          row.az[k] * (sz[k] - sz[k + e]) + ridge * (w[k] + w[k + e]) * value[k];
    row.product[k] = product;
    sum[part] += product * value[k];
  });
  return sum_of(sum);
}

void direction_row(const float* solved, float share, float* direction, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) direction[k] = solved[k] + share * direction[k];
}

float solution_row(float length, const float* direction, const float* product, float* change, float* residual,
                   int count) {
  float largest[float_parts] = {};
  in_parts<float_parts>(count, [&](int k, int part) {
    change[k] += length * direction[k];
    const float left = residual[k] - length * product[k];
    residual[k] = left;
    largest[part] = larger(size_of(left), largest[part]);
  });
  return largest_of(largest);
}

double dot_row(const float* a, const float* b, int count) {
  float sum[float_parts] = {};
  in_parts<float_parts>(count, [&](int k, int part) { sum[part] += a[k] * b[k]; });
  return sum_of(sum);
}

float largest_row(const float* a, int count) {
  float largest[float_parts] = {};
  in_parts<float_parts>(count,
                        [&](int k, int part) { largest[part] = larger(size_of(a[k]), largest[part]); });
  return largest_of(largest);
}

ClippedRow clip_row(const double* t, const float* over, float* change, int count) {
  float gain[float_parts] = {}, least[float_parts] = {};
  in_parts<float_parts>(count, [&](int k, int part) {
    const float lowest = -static_cast<float>(t[k]), beyond = change[k] - lowest;
    least[part] = smaller(beyond, least[part]);
    const float kept = beyond < 0 ? lowest : change[k];
    change[k] = kept;
    gain[part] += kept * over[k];
  });
  float lowest = 0;
  for (const float part : least) lowest = smaller(part, lowest);
  return {sum_of(gain), lowest < 0};
}

void steepest_row(float share, const float* over, const float* w, const float* we, const double* t,
                  float* change, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const float both = w[k] + we[k], step = both > 0 ? share * over[k] / both : 0.0f;
    const float lowest = -static_cast<float>(t[k]);
    change[k] = step > lowest ? step : lowest;
  }
}

void add_row(double length, const float* change, double* t, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const double raised = t[k] + length * static_cast<double>(change[k]);
    // A tension that was clipped in floats becomes exactly 0.
    const bool gone = length >= 1 && change[k] <= -static_cast<float>(t[k]);
    t[k] = gone ? 0.0 : larger(raised, 0.0);
  }
}

void force_row(const ForceRow& row, std::ptrdiff_t e, const double* tension, double* scratch, int count) {
  const double *x = row.x, *y = row.y, *z = row.z;
  double *px = scratch, *py = scratch + count, *pz = scratch + 2 * count;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const double dx = x[k + e] - x[k], dy = y[k + e] - y[k], dz = z[k + e] - z[k];
    const double pull = tension[k] * inverse_root(dx * dx + dy * dy + dz * dz);
    px[k] = pull * dx, py[k] = pull * dy, pz[k] = pull * dz;
  }
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) row.fx[k] += px[k], row.fy[k] += py[k], row.fz[k] += pz[k];
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) row.fx[k + e] -= px[k], row.fy[k + e] -= py[k], row.fz[k + e] -= pz[k];
}

constexpr TensionKernels table{measure_row,
                               sweep_block,
                               evaluate_row,
                               residual_row,
                               factorise_row,
                               eliminate_row,
                               substitute_row,
                               solve_lanes,
                               into_lanes<float>,
                               into_lanes<double>,
                               out_of_lanes<double>,
                               transpose_row,
                               move_row,
                               matrix_row,
                               direction_row,
                               solution_row,
                               dot_row,
                               largest_row,
                               clip_row,
                               steepest_row,
                               add_row,
                               force_row};

}  // namespace

const TensionKernels& TensionKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
