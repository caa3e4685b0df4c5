// A particle's three numbers, and a fourth that is 0, in one register. Included once for every instruction
// set; everything here has internal linkage.
#pragma once

#include "kernels/kernel_table.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth::kernels {
namespace {

using Four [[gnu::vector_size(32)]] = double;

CLOTHLAB_INLINE Four load_four(const double* from) {
  Four v;
  __builtin_memcpy(&v, __builtin_assume_aligned(from, sizeof v), sizeof v);
  return v;
}
CLOTHLAB_INLINE void store_four(double* to, const Four& v) {
  __builtin_memcpy(__builtin_assume_aligned(to, sizeof v), &v, sizeof v);
}
CLOTHLAB_INLINE double product(const Four& a, const Four& b) {
  const Four c = a * b;
  return c[0] + c[1] + c[2];
}

}  // namespace
}  // namespace cloth::kernels
