// The normals of a grid's particles, row by row: sums of the cross products of their triangles (see
// cloth/normals.h). Included once for every instruction set, after its Lanes; everything here has internal
// linkage.
//
// A cell has two triangles, `lower` (d - a) x (c - a) and `upper` (c - a) x (b - a), with a b above and d c
// below. A particle belongs to the lower one and the upper one of the cells above left and below right of it,
// to the lower one of that above right and to the upper one of that below left. What a row's cells above have
// given waits in two row buffers, in whose place the cells below are put as the row is gone along.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/lane_vectors.h"

namespace cloth::kernels {
namespace {

CLOTHLAB_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {Lanes::fnma(a.z, b.y, Lanes::mul(a.y, b.z)), Lanes::fnma(a.x, b.z, Lanes::mul(a.z, b.x)),
          Lanes::fnma(a.y, b.x, Lanes::mul(a.x, b.y))};
}

class CellNormals {
 public:
  /// Of the cells one column to the left.
  struct Carry {
    Vector above, below;
  };
  static Carry none() { return {nothing(), nothing()}; }

  /// Before the first row, whose cells above do not matter or are not there. `lower` and `upper` are rows of
  /// scratch.
  void begin(int columns, const Row& lower, const Row& upper) {
    lower_ = lower, upper_ = upper;
    for (int j = 0; j < columns; j += Lanes::width) store(lower_, j, nothing()), store(upper_, j, nothing());
  }

  /// Of one block of a row after the other, and one row after the other: the sum that points along the
  /// normal. At an edge a corner that is missing is replaced by the particle itself, which leaves no area.
  template <bool HasBelow, bool Edge>
  CLOTHLAB_INLINE Vector sum(const ConstRow& here, const ConstRow& below, int j, int count,
                             Carry& carry) const {
    const Vector lower_above = load(lower_, j), above = lower_above + load(upper_, j);
    Vector lower = nothing(), upper = nothing();
    if constexpr (HasBelow) {
      const Vector a = load_part<Edge>(here, j, count);
      const auto side = [&](const ConstRow& row, int columns) {
        if constexpr (Edge) return load(row, j + columns, count - columns, a) - a;
        return load(row, j + columns) - a;
      };
      const Vector c = side(below, 1);
      lower = cross(side(below, 0), c), upper = cross(c, side(here, 1));
      store(lower_, j, lower), store(upper_, j, upper);
    }
    const Vector sum =
        moved_one(carry.above, above) + lower_above + moved_one(carry.below, upper) + (lower + upper);
    carry = {above, upper};
    return sum;
  }

 private:
  static Vector nothing() { return {Lanes::zero(), Lanes::zero(), Lanes::zero()}; }

  Row lower_{}, upper_{};
};

}  // namespace
}  // namespace cloth::kernels
