// Loops that the compiler vectorises, for kernel sources (kernel_table.h). Sums and maxima are taken in a
// fixed number of parts, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth::kernels {
namespace {

template <class Number>
CLOTHLAB_INLINE Number larger(Number a, Number b) {
  return a > b ? a : b;
}
template <class Number>
CLOTHLAB_INLINE Number smaller(Number a, Number b) {
  return a < b ? a : b;
}
template <class Number>
CLOTHLAB_INLINE Number size_of(Number a) {
  return a > 0 ? a : -a;
}

/// Visits k = 0 .. count in blocks of `parts`, telling each which part of a sum it belongs to.
template <int parts, class Count, class Visit>
CLOTHLAB_INLINE void in_parts(Count count, Visit visit) {
  Count k = 0;
  for (; k + parts <= count; k += parts)
#pragma GCC ivdep
    for (int part = 0; part < parts; ++part) visit(k + static_cast<Count>(part), part);
  for (; k < count; ++k) visit(k, static_cast<int>(k % parts));
}

/// The parts added pairwise, as ordered_sum() of cloth/sums.h does.
CLOTHLAB_INLINE double pairwise_sum(const double (&part)[8]) {
  return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
}

CLOTHLAB_INLINE double dot_product(const double* a, const double* b, std::size_t count) {
  double sum[8] = {};
  in_parts<8>(count, [&](std::size_t k, int part) { sum[part] += a[k] * b[k]; });
  return pairwise_sum(sum);
}

}  // namespace
}  // namespace cloth::kernels
