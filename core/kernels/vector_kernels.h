// Products of block matrices and vectors, for iterative solvers, and sums over springs. Sums are taken in the
// order of cloth/sums.h, without fused operations, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/kernel_table.h"

namespace cloth {

/// The six numbers of symmetric 3 x 3 blocks, each a contiguous run.
struct BlockRows {
  const double *xx, *xy, *xz, *yy, *yz, *zz;
};
struct BlockSums {
  double *xx, *xy, *xz, *yy, *yz, *zz;
};
struct VectorRows {
  double *x, *y, *z;
};
struct ConstVectorRows {
  const double *x, *y, *z;
};

/// Rows of a symmetric matrix that is 0 on what is alike everywhere (cloth/bending_rows.h).
struct DifferenceRows {
  std::size_t count;
  const std::uint32_t* begin;
  const std::int32_t* column;
  const double* number;
};
/// Triangles (cloth/membrane.h): of number t the corners stand at corner + t * corner_stride, K at k + t *
/// k_stride.
struct TriangleRows {
  std::size_t count;
  const int* corner;
  const double* k;
  std::size_t corner_stride, k_stride;
};

/// Springs that are alike, from particle s to particle s + offset.
struct SpringSlopes {
  double stiffness, rest_length;
  std::ptrdiff_t offset;
  bool clamped;        ///< without the transverse part where it is negative
  double damping = 0;  ///< what resists along the springs alone, in the unit of `stiffness`
};

/// Particles that springs join, at their first ends.
struct MovingRows {
  ConstVectorRows position, velocity, direction;
};

struct VectorKernels {
  /// Springs that add_springs() and add_damper_turns() take at once, at most.
  static constexpr int max_springs = 128;

  /// product = B direction, block by block
  void (*multiply_blocks)(BlockRows blocks, ConstVectorRows direction, VectorRows product, std::size_t count);
  /// For springs from particle s to particle s + offset with block B: adds B (d_s - d_(s + offset)) to the
  /// product of the first end and subtracts it from that of the second.
  void (*add_springs)(BlockRows blocks, ConstVectorRows direction, VectorRows product, std::ptrdiff_t offset,
                      int count);
  /// blocks += stiffness (a a^T + t (I - a a^T)) + damping a a^T, a = d/|d|, t = 1 - rest_length/|d|, or
  /// stiffness I where d is 0. True if stiffness * t is negative for one.
  bool (*add_spring_slopes)(SpringSlopes springs, ConstVectorRows position, BlockSums blocks, int count);
  /// Dampers c (u . a) a with u = v_j - v_i turn as their ends move along `direction`: subtracts what that
  /// adds to the force on the first end from its product, and adds it to that of the second. At most
  /// max_springs.
  void (*add_damper_turns)(double damping, MovingRows particles, VectorRows product, std::ptrdiff_t offset,
                           int count);
  // A particle's x, y, z and 0 stand one after the other in `vectors`, `position` and the like, 64-byte
  // aligned.
  void (*to_vectors)(ConstVectorRows field, double* vectors, std::size_t count);
  /// field += vectors
  void (*add_vectors)(const double* vectors, VectorRows field, std::size_t count);
  /// product = scale sum_j K_ij (d_j - d_i)
  void (*multiply_rows)(DifferenceRows rows, double scale, const double* direction, double* product);
  /// product += scale J^T K J d with J = dq/dx at `position`
  void (*add_triangles)(TriangleRows triangles, double scale, const double* position, const double* direction,
                        double* product);
  /// sum (|x_(s + offset) - x_s| - rest_length)^2 over `count` springs
  double (*squared_stretches)(ConstVectorRows position, std::ptrdiff_t offset, double rest_length,
                              std::size_t count);
  double (*dot)(const double* a, const double* b, std::size_t count);
  /// to += scale from
  void (*add_multiple)(double scale, const double* from, double* to, std::size_t count);
  /// to = scale to + from
  void (*scale_and_add)(double scale, const double* from, double* to, std::size_t count);

  CLOTHLAB_KERNEL_TABLE(VectorKernels)
};

}  // namespace cloth
