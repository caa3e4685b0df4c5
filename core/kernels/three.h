// A vector of three numbers, or of three registers with a number of each particle in every lane. Included
// once for every instruction set; everything here has internal linkage.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth::kernels {
namespace {

template <class Number>
struct Three {
  Number x, y, z;

  CLOTHLAB_INLINE friend Three operator+(const Three& a, const Three& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  CLOTHLAB_INLINE friend Three operator-(const Three& a, const Three& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  CLOTHLAB_INLINE friend Three operator*(const Number& factor, const Three& a) {
    return {factor * a.x, factor * a.y, factor * a.z};
  }
  CLOTHLAB_INLINE friend Number dot(const Three& a, const Three& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
  }
};

}  // namespace
}  // namespace cloth::kernels
