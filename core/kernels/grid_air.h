// The air's push on a grid, row by row within a pass: F = c_n (n . w) n + c_t (w - (n . w) n), w = u - v
// (forces/air.h), where n is the normalised sum of the cross products of the particle's triangles (see
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
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

CLOTHLAB_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {Lanes::fnma(a.z, b.y, Lanes::mul(a.y, b.z)), Lanes::fnma(a.x, b.z, Lanes::mul(a.z, b.x)),
          Lanes::fnma(a.y, b.x, Lanes::mul(a.x, b.y))};
}

class AirRows {
 public:
  /// Before the first row, whose cells above do not matter or are not there. `lower` and `upper` are rows of
  /// scratch.
  void begin(const Pass& pass, const double* wind, const Row& lower, const Row& upper) {
    columns_ = pass.grid.columns;
    along_ = Lanes::set(pass.air_drag - pass.air_friction), friction_ = Lanes::set(pass.air_friction);
    has_friction_ = pass.air_friction > 0;
    wind_ = vector_of(wind);
    lower_ = lower, upper_ = upper;
    for (int j = 0; j < columns_; j += Lanes::width) store(lower_, j, nothing()), store(upper_, j, nothing());
  }

  /// Of one row after the other: adds the push to `force`, where there is one. Returns its power.
  template <bool HasBelow, Share share>
  V run(const RowShares<share>& shares, const ConstRow& here, const ConstRow& below, const ConstRow& velocity,
        const Row& force) {
    V power = Lanes::zero();
    Carry carry{nothing(), nothing()};
    int j = 0;
    for (; j + Lanes::width + 1 <= columns_; j += Lanes::width)
      block<HasBelow, false>(shares, here, below, velocity, force, j, Lanes::width, carry, power);
    for (; j < columns_; j += Lanes::width)
      block<HasBelow, true>(shares, here, below, velocity, force, j, columns_ - j, carry, power);
    return power;
  }

 private:
  /// Of the cells one column to the left.
  struct Carry {
    Vector above, below;
  };

  static Vector nothing() { return {Lanes::zero(), Lanes::zero(), Lanes::zero()}; }

  /// At an edge a corner that is missing is replaced by the particle itself, which leaves no area.
  template <bool HasBelow, bool Edge, Share share>
  CLOTHLAB_INLINE void block(const RowShares<share>& shares, const ConstRow& here, const ConstRow& below,
                             const ConstRow& velocity, const Row& force, int j, int count, Carry& carry,
                             V& power) {
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
    if (!force.x) return;
    const V inverse = Lanes::inverse_root<true>(squared(sum));
    const Vector n = scaled(inverse, sum), v = load_part<Edge>(velocity, j, count);
    const Vector w = wind_ - v;
    const V along = Lanes::mul(shares.of(along_, j), product(n, w));
    power = Lanes::fma(along, product(n, v), power);
    Vector with_air = plus(load(force, j), along, n);
    if (has_friction_) {
      const V friction = shares.of(friction_, j);
      power = Lanes::fma(friction, product(w, v), power);
      with_air = plus(with_air, friction, w);
    }
    store(force, j, with_air);
  }

  int columns_ = 0;
  bool has_friction_ = false;
  V along_{}, friction_{};  // c_n - c_t and c_t
  Vector wind_{};
  Row lower_{}, upper_{};
};

}  // namespace
}  // namespace cloth::kernels
