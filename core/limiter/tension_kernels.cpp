#include "limiter/tension_kernels.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "cloth/vectorised.h"

namespace cloth::tension {
namespace {

constexpr int parts = 8;

/// 1/sqrt(a) for a >= 0 to a few roundings, large but finite for 0: Newton's iteration from a linear guess in
/// the exponent (Lomont 2003), four times, which is quicker than a root and a division.
[[gnu::always_inline]] inline double inverse_root(double a) {
  const auto bits = std::bit_cast<std::uint64_t>(a);
  double y = std::bit_cast<double>(std::uint64_t{0x5FE6EB50C7B537A9} - (bits >> 1));
  const double half = 0.5 * a;
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  return y * (1.5 - half * y * y);
}

inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double smaller(double a, double b) {
  return a < b ? a : b;
}

double largest_of(const double* part) {
  double found = part[0];
  for (int k = 1; k < parts; ++k) found = larger(found, part[k]);
  return found;
}

double sum_of(const double* part) {
  return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
}

}  // namespace

CLOTH_VECTORISED RowLengths measure_row(const Nodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset,
                                        const double* tension, int count, bool pins) {
  const double *x = nodes.x + i, *y = nodes.y + i, *z = nodes.z + i, *w = nodes.weight + i;
  const double *xe = x + offset, *ye = y + offset, *ze = z + offset, *we = w + offset;
  double longest[parts] = {}, shortest[parts];
  std::fill(shortest, shortest + parts, std::numeric_limits<double>::infinity());
  const auto square = [&](int k) {
    const double dx = xe[k] - x[k], dy = ye[k] - y[k], dz = ze[k] - z[k];
    return dx * dx + dy * dy + dz * dz;
  };
  const auto look = [&](int k, int part) {
    double d = square(k);
    shortest[part] = tension[k] > 0 ? smaller(d, shortest[part]) : shortest[part];
    longest[part] = larger(d, longest[part]);
  };
  int k = 0;
  if (pins) {
    for (; k < count; ++k)
      if (w[k] + we[k] > 0) look(k, k % parts);
  } else {
    for (; k + parts <= count; k += parts)
#pragma GCC ivdep
      for (int part = 0; part < parts; ++part) look(k + part, part);
    for (; k < count; ++k) look(k, k % parts);
  }
  RowLengths found{largest_of(longest), shortest[0]};
  for (int part = 1; part < parts; ++part) found.shortest = smaller(found.shortest, shortest[part]);
  return found;
}

void LineScratch::resize(std::size_t size) {
  for (AlignedDoubles* field : {&ax, &ay, &az, &link, &pivot, &step})
    if (field->size() < size) field->resize(size);
}

namespace {

struct LaneRange {
  int begin, end;
};

LaneRange lanes_of(const LineBlock& block, int n) {
  const int begin = std::clamp(block.begin - n * block.shift, 0, block.lanes);
  return {begin, std::clamp(block.end - n * block.shift, begin, block.lanes)};
}

/// Lanes that have no spring here are links to nothing.
void clear_lanes(LineScratch& s, std::size_t row, int begin, int end) {
  if (begin >= end) return;
  const auto b = row + static_cast<std::size_t>(begin), e = row + static_cast<std::size_t>(end);
  for (AlignedDoubles* field : {&s.ax, &s.ay, &s.az, &s.link, &s.pivot, &s.step})
    std::fill(field->begin() + static_cast<std::ptrdiff_t>(b),
              field->begin() + static_cast<std::ptrdiff_t>(e), 0.0);
}

/// One row of the forward elimination.
[[gnu::always_inline]] inline void eliminate_lines(const LineBlock& block, const SpringRule& rule,
                                                   std::ptrdiff_t i, LaneRange lanes, std::size_t row,
                                                   LineScratch& scratch) {
  const double *x = block.nodes.x + i, *y = block.nodes.y + i, *z = block.nodes.z + i;
  const double *w = block.nodes.weight + i, *t = block.tension + i;
  const std::ptrdiff_t e = block.step;
  double *ax = scratch.ax.data() + row, *ay = scratch.ay.data() + row, *az = scratch.az.data() + row;
  double *link = scratch.link.data() + row, *pivot = scratch.pivot.data() + row;
  double* step = scratch.step.data() + row;
  const std::ptrdiff_t back = -block.lanes;
  const double allowed = rule.square * rule.softness, per_square = 1 / rule.square, limit = rule.limit;
  const double share = 1 + rule.ridge + rule.softness;
#pragma GCC ivdep
  for (int k = lanes.begin; k < lanes.end; ++k) {
    const double dx = x[k + e] - x[k], dy = y[k + e] - y[k], dz = z[k + e] - z[k];
    const double squared = dx * dx + dy * dy + dz * dz, inverse = inverse_root(squared);
    const double both = w[k] + w[k + e];
    const double over = squared * inverse - limit - allowed * both * t[k];
    double active = t[k] > 0 ? 1.0 : over > 0 ? 1.0 : 0.0;
    active = both > 0 ? active : 0.0;
    const double scale = active * inverse;
    const double nx = scale * dx, ny = scale * dy, nz = scale * dz;
    const double l = -w[k] * (nx * ax[k + back] + ny * ay[k + back] + nz * az[k + back]);
    const double u = l * pivot[k + back];
    const double diagonal = both > 0 ? both * share : 1.0;
    const double p = 1 / (diagonal - l * u);
    ax[k] = nx, ay[k] = ny, az[k] = nz;
    link[k] = l, pivot[k] = p;
    step[k] = (active * over * per_square - l * step[k + back]) * p;
  }
}

/// One row of the back substitution. What a clipped tension leaves to do is known to those before it.
[[gnu::always_inline]] inline void substitute_lines(const LineBlock& block, const SpringRule& rule,
                                                    std::ptrdiff_t i, LaneRange lanes, std::size_t row,
                                                    LineScratch& scratch) {
  double *x = block.nodes.x + i, *y = block.nodes.y + i, *z = block.nodes.z + i, *t = block.tension + i;
  const double* w = block.nodes.weight + i;
  const std::ptrdiff_t e = block.step, next = block.lanes;
  const double *ax = scratch.ax.data() + row, *ay = scratch.ay.data() + row, *az = scratch.az.data() + row;
  const double *link = scratch.link.data() + row, *pivot = scratch.pivot.data() + row;
  double* step = scratch.step.data() + row;
#pragma GCC ivdep
  for (int k = lanes.begin; k < lanes.end; ++k) {
    const double free = step[k] - pivot[k] * link[k + next] * step[k + next];
    const double change = free > -t[k] ? free : -t[k];
    step[k] = change;
    t[k] += change;
    const double pull = rule.square * change;
    const double px = pull * ax[k], py = pull * ay[k], pz = pull * az[k];
    x[k + e] -= w[k + e] * px, y[k + e] -= w[k + e] * py, z[k + e] -= w[k + e] * pz;
    x[k] += w[k] * px, y[k] += w[k] * py, z[k] += w[k] * pz;
  }
}

}  // namespace

CLOTH_VECTORISED void sweep_block(const LineBlock& block, const SpringRule& rule, LineScratch& scratch) {
  const auto lanes = static_cast<std::size_t>(block.lanes);
  scratch.resize((static_cast<std::size_t>(block.count) + 2) * lanes);
  clear_lanes(scratch, 0, 0, block.lanes);
  clear_lanes(scratch, (static_cast<std::size_t>(block.count) + 1) * lanes, 0, block.lanes);
  for (int n = 0; n < block.count; ++n) {
    const LaneRange here = lanes_of(block, n);
    const std::size_t row = (static_cast<std::size_t>(n) + 1) * lanes;
    clear_lanes(scratch, row, 0, here.begin);
    clear_lanes(scratch, row, here.end, block.lanes);
    eliminate_lines(block, rule, block.first + n * block.step, here, row, scratch);
  }
  for (int n = block.count; n-- > 0;)
    substitute_lines(block, rule, block.first + n * block.step, lanes_of(block, n),
                     (static_cast<std::size_t>(n) + 1) * lanes, scratch);
}

CLOTH_VECTORISED RowResidual evaluate_row(const Nodes& nodes, std::ptrdiff_t i, std::ptrdiff_t offset,
                                          const double* t, int count, const SpringRule& rule,
                                          const SpringRows& rows) {
  const double *x = nodes.x + i, *y = nodes.y + i, *z = nodes.z + i, *w = nodes.weight + i;
  const double allowed = rule.square * rule.softness, per_square = 1 / rule.square, limit = rule.limit;
  constexpr double none = -std::numeric_limits<double>::infinity();
  double over[parts], slack[parts];
  std::fill(over, over + parts, none);
  std::fill(slack, slack + parts, none);
  const auto evaluate = [&](int k, int part) {
    const double dx = x[k + offset] - x[k], dy = y[k + offset] - y[k], dz = z[k + offset] - z[k];
    const double squared = dx * dx + dy * dy + dz * dz, inverse = inverse_root(squared);
    const double both = w[k] + w[k + offset];
    double c = squared * inverse - limit - allowed * both * t[k];
    double active = t[k] > 0 ? 1.0 : c > 0 ? 1.0 : 0.0;
    active = both > 0 ? active : 0.0;
    const double seen = both > 0 ? c : none;
    over[part] = larger(seen, over[part]);
    slack[part] = t[k] > 0 ? larger(-c, slack[part]) : slack[part];
    c = both > 0 ? active * c : 0.0;
    const double scale = active * inverse;
    rows.ax[k] = scale * dx, rows.ay[k] = scale * dy, rows.az[k] = scale * dz;
    rows.over[k] = c, rows.residual[k] = c * per_square;
  };
  int k = 0;
  for (; k + parts <= count; k += parts)
#pragma GCC ivdep
    for (int part = 0; part < parts; ++part) evaluate(k + part, part);
  for (; k < count; ++k) evaluate(k, k % parts);
  return {largest_of(over), largest_of(slack)};
}

CLOTH_VECTORISED void factorise_row(const FactorRow& row, const FactorRow& before, double ridge, int count) {
  const double *ax = row.ax, *ay = row.ay, *az = row.az, *w = row.weight, *we = row.weight_end;
  const double *bx = before.ax, *by = before.ay, *bz = before.az, *pivot_before = before.pivot;
  double *link = row.link, *pivot = row.pivot;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const double l = -w[k] * (ax[k] * bx[k] + ay[k] * by[k] + az[k] * bz[k]);
    const double both = w[k] + we[k];
    const double diagonal = both > 0 ? both * (1 + ridge) : 1.0;
    link[k] = l;
    pivot[k] = 1 / (diagonal - l * (l * pivot_before[k]));
  }
}

CLOTH_VECTORISED void eliminate_row(const double* residual, const double* link, const double* pivot,
                                    const double* before, double* solved, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) solved[k] = (residual[k] - link[k] * before[k]) * pivot[k];
}

CLOTH_VECTORISED void substitute_row(const double* pivot, const double* link_next, const double* next,
                                     double* solved, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) solved[k] -= pivot[k] * link_next[k] * next[k];
}

/// out[column * lanes + lane] = in[lane][column]; zero in lanes without a row.
void into_lanes(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out) {
  for (int lane = 0; lane < lanes_of_rows; ++lane)
    for (int c = 0; c < columns; ++c)
      out[c * lanes_of_rows + lane] = lane < rows ? in[lane * stride + c] : 0.0;
}

void out_of_lanes(const double* in, std::ptrdiff_t stride, int rows, int columns, double* out) {
  for (int lane = 0; lane < rows; ++lane)
    for (int c = 0; c < columns; ++c) out[lane * stride + c] = in[c * lanes_of_rows + lane];
}

CLOTH_VECTORISED void solve_lanes(const LaneFactors& f, const double* residual, std::ptrdiff_t stride,
                                  int rows, int count, int across, double* solved) {
  double* v = f.scratch;
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

CLOTH_VECTORISED void pull_row(const PullTerm* terms, int term_count, const double* weight, double* sx,
                               double* sy, double* sz, int count) {
  for (int n = 0; n < term_count; ++n) {
    const double *ax = terms[n].ax, *ay = terms[n].ay, *az = terms[n].az, *value = terms[n].value;
    const double sign = terms[n].sign, begin = n == 0 ? 0.0 : 1.0;
#pragma GCC ivdep
    for (int k = 0; k < count; ++k) {
      const double v = sign * value[k];
      sx[k] = begin * sx[k] + v * ax[k];
      sy[k] = begin * sy[k] + v * ay[k];
      sz[k] = begin * sz[k] + v * az[k];
    }
  }
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) sx[k] *= weight[k], sy[k] *= weight[k], sz[k] *= weight[k];
}

CLOTH_VECTORISED double answer_row(const AnswerRow& row, std::ptrdiff_t e, double ridge, int count) {
  const double *sx = row.sx, *sy = row.sy, *sz = row.sz, *value = row.value, *w = row.weight;
  double sum[parts] = {};
  const auto answer = [&](int k, int part) {
    const double product = row.ax[k] * (sx[k] - sx[k + e]) + row.ay[k] * (sy[k] - sy[k + e]) +
                           row.az[k] * (sz[k] - sz[k + e]) + ridge * (w[k] + w[k + e]) * value[k];
    row.product[k] = product;
    sum[part] += product * value[k];
  };
  int k = 0;
  for (; k + parts <= count; k += parts)
#pragma GCC ivdep
    for (int part = 0; part < parts; ++part) answer(k + part, part);
  for (; k < count; ++k) answer(k, k % parts);
  return sum_of(sum);
}

CLOTH_VECTORISED void turn_row(const double* solved, double share, double* direction, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) direction[k] = solved[k] + share * direction[k];
}

CLOTH_VECTORISED double advance_row(double length, const double* direction, const double* product,
                                    double* change, double* residual, int count) {
  double largest[parts] = {};
  const auto advance = [&](int k, int part) {
    change[k] += length * direction[k];
    const double left = residual[k] - length * product[k];
    residual[k] = left;
    largest[part] = larger(left > 0 ? left : -left, largest[part]);
  };
  int k = 0;
  for (; k + parts <= count; k += parts)
#pragma GCC ivdep
    for (int part = 0; part < parts; ++part) advance(k + part, part);
  for (; k < count; ++k) advance(k, k % parts);
  return largest_of(largest);
}

CLOTH_VECTORISED double dot_row(const double* a, const double* b, int count) {
  double sum[parts] = {};
  int k = 0;
  for (; k + parts <= count; k += parts)
    for (int part = 0; part < parts; ++part) sum[part] += a[k + part] * b[k + part];
  for (; k < count; ++k) sum[k % parts] += a[k] * b[k];
  return sum_of(sum);
}

CLOTH_VECTORISED double largest_row(const double* a, int count) {
  double largest[parts] = {};
  int k = 0;
  for (; k + parts <= count; k += parts)
    for (int part = 0; part < parts; ++part)
      largest[part] = larger(a[k + part] > 0 ? a[k + part] : -a[k + part], largest[part]);
  for (; k < count; ++k) largest[k % parts] = larger(a[k] > 0 ? a[k] : -a[k], largest[k % parts]);
  return largest_of(largest);
}

CLOTH_VECTORISED void add_row(double factor, const double* from, double* to, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) to[k] += factor * from[k];
}

CLOTH_VECTORISED ClippedRow clip_row(const double* t, const double* over, double* change, int count) {
  double gain[parts] = {}, least[parts] = {};
  const auto clip = [&](int k, int part) {
    const double beyond = change[k] + t[k];
    least[part] = smaller(beyond, least[part]);
    const double kept = beyond < 0 ? -t[k] : change[k];
    change[k] = kept;
    gain[part] += kept * over[k];
  };
  int k = 0;
  for (; k + parts <= count; k += parts)
#pragma GCC ivdep
    for (int part = 0; part < parts; ++part) clip(k + part, part);
  for (; k < count; ++k) clip(k, k % parts);
  double lowest = 0;
  for (int part = 0; part < parts; ++part) lowest = smaller(least[part], lowest);
  return {sum_of(gain), lowest < 0};
}

CLOTH_VECTORISED void steepest_row(double share, const double* residual, const double* w, const double* we,
                                   const double* t, double* change, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const double both = w[k] + we[k], step = both > 0 ? share * residual[k] / both : 0.0;
    change[k] = step > -t[k] ? step : -t[k];
  }
}

CLOTH_VECTORISED void raise_row(double length, const double* change, double* t, int count) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) t[k] = larger(t[k] + length * change[k], 0.0);
}

CLOTH_VECTORISED void force_row(const ForceRow& row, std::ptrdiff_t e, const double* tension, double* scratch,
                                int count) {
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

}  // namespace cloth::tension
