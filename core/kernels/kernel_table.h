// How kernels are compiled and chosen. A kernel source (the list is in core/CMakeLists.txt) is compiled once
// for every instruction set, with the compiler's options for it, and defines the table of its functions for
// that set:
//
//     struct DenseKernels {                                 // in its header
//       bool (*factorise_columns)(DenseBlock front, int height, int width);
//       CLOTHLAB_KERNEL_TABLE(DenseKernels)
//     };
//     constexpr DenseKernels table{factorise_columns};      // in the kernel source
//     const DenseKernels& DenseKernels::CLOTHLAB_SET() {
//       return table;
//     }
//     active_kernels<DenseKernels>().factorise_columns(front, height, width);   // in a caller
//
// Everything else in a kernel source has internal linkage, and it uses no inline function of the standard
// library: the linker keeps one copy of such a function for the whole program, which may be the one for
// AVX-512.
#pragma once

#define CLOTHLAB_KERNEL_TABLE(Kernels) \
  static const Kernels& portable();    \
  static const Kernels& avx2();        \
  static const Kernels& avx512();

/// Of every function that a kernel's loop calls.
#define CLOTHLAB_INLINE [[gnu::always_inline]] inline

namespace cloth::kernels {

/// Doubles in a register of the instruction set that this file is compiled for: of internal linkage, since it
/// differs from one file to another.
#if defined(__AVX512F__)
constexpr int register_width = 8;
#elif defined(__AVX2__)
constexpr int register_width = 4;
#else
constexpr int register_width = 2;
#endif

}  // namespace cloth::kernels
