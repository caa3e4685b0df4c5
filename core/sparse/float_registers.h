// Registers of single precision for the kernel sources of multigrid (kernels/kernel_table.h).
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {
namespace {

constexpr int width = 2 * kernels::register_width;  // floats
typedef float Floats __attribute__((vector_size(4 * width), aligned(4), may_alias));

CLOTHLAB_INLINE Floats read(const float* p) {
  return *reinterpret_cast<const Floats*>(p);
}
CLOTHLAB_INLINE void write(float* p, Floats value) {
  *reinterpret_cast<Floats*>(p) = value;
}

}  // namespace
}  // namespace cloth
