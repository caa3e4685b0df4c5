#include "limiter/sweep_kernels.h"

#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

using kernels::larger;

constexpr int parts = 8;

double longest(const SpringRow& row, double limit, ConstPoints p) {
  const double squared_limit = limit * limit;
  const double *x = p.x + row.first, *y = p.y + row.first, *z = p.z + row.first;
  const long e = row.offset;
  double found[parts] = {};
  kernels::in_parts<parts>(row.count, [&](int k, int part) {
    const double dx = x[k + e] - x[k], dy = y[k + e] - y[k], dz = z[k + e] - z[k];
    found[part] = larger(dx * dx + dy * dy + dz * dz, found[part]);
  });
  double largest = found[0];
  for (const double squared : found) largest = larger(squared, largest);
  return largest > squared_limit ? largest : 0;
}

/// Up to `parts` springs, `stride` particles apart. Returns the largest squared length, 0 if none is too
/// long.
template <class Count>
[[gnu::always_inline]] inline double shorten_some(Points p, long first, long stride, long offset,
                                                  double limit, double relaxation, Count springs) {
  const int count = springs;
  double *x = p.x + first, *y = p.y + first, *z = p.z + first;
  double *xe = x + offset, *ye = y + offset, *ze = z + offset;
  const double squared_limit = limit * limit, half_relaxation = 0.5 * relaxation;
  double squared[parts], found = 0;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const long i = k * stride;
    const double dx = xe[i] - x[i], dy = ye[i] - y[i], dz = ze[i] - z[i];
    squared[k] = dx * dx + dy * dy + dz * dz;
  }
  for (int k = 0; k < count; ++k) found = larger(squared[k], found);
  if (!(found > squared_limit)) return 0;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const long i = k * stride;
    const bool over = squared[k] > squared_limit;
    const double length = __builtin_sqrt(squared[k]);
    const double share = half_relaxation * ((length - limit) / length);
    const double dx = xe[i] - x[i], dy = ye[i] - y[i], dz = ze[i] - z[i];
    const double sx = share * dx, sy = share * dy, sz = share * dz;
    x[i] = over ? x[i] + sx : x[i], xe[i] = over ? xe[i] - sx : xe[i];
    y[i] = over ? y[i] + sy : y[i], ye[i] = over ? ye[i] - sy : ye[i];
    z[i] = over ? z[i] + sz : z[i], ze[i] = over ? ze[i] - sz : ze[i];
  }
  return found;
}

struct WholeBlock {
  constexpr operator int() const { return parts; }
};

double shorten(const SpringRow& row, double limit, double relaxation, Points p) {
  double largest = 0;
  int k = 0;
  const auto first = [&] { return row.first + static_cast<long>(k) * row.stride; };
  for (; k + parts <= row.count; k += parts)
    largest = larger(row.stride == 1
                         ? shorten_some(p, first(), 1, row.offset, limit, relaxation, WholeBlock{})
                         : shorten_some(p, first(), row.stride, row.offset, limit, relaxation, WholeBlock{}),
                     largest);
  if (k == row.count) return largest;
  return larger(shorten_some(p, first(), row.stride, row.offset, limit, relaxation, row.count - k), largest);
}

constexpr SweepKernels table{longest, shorten};

}  // namespace

const SweepKernels& SweepKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
