// The air's push on a grid, row by row within a pass: F = c_n (n . w) n + c_t (w - (n . w) n), w = u - v
// (forces/air.h), where n is the normalised sum of the cross products of the particle's triangles (see
// cloth/normals.h). Included once for every instruction set, after its Lanes; everything here has internal
// linkage.
#pragma once

#include "kernels/grid_normals.h"
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

class AirRows {
 public:
  /// Before the first row, whose cells above do not matter or are not there. `lower` and `upper` are rows of
  /// scratch.
  void begin(const Pass& pass, const double* wind, const Row& lower, const Row& upper) {
    columns_ = pass.grid.columns;
    along_ = Lanes::set(pass.air_drag - pass.air_friction), friction_ = Lanes::set(pass.air_friction);
    has_friction_ = pass.air_friction > 0;
    wind_ = vector_of(wind);
    normals_.begin(columns_, lower, upper);
  }

  /// Of one row after the other: adds the push to `force`, where there is one. Returns its power.
  template <bool HasBelow, Share share>
  V run(const RowShares<share>& shares, const ConstRow& here, const ConstRow& below, const ConstRow& velocity,
        const Row& force) {
    V power = Lanes::zero();
    CellNormals::Carry carry = CellNormals::none();
    int j = 0;
    for (; j + Lanes::width + 1 <= columns_; j += Lanes::width)
      block<HasBelow, false>(shares, here, below, velocity, force, j, Lanes::width, carry, power);
    for (; j < columns_; j += Lanes::width)
      block<HasBelow, true>(shares, here, below, velocity, force, j, columns_ - j, carry, power);
    return power;
  }

 private:
  template <bool HasBelow, bool Edge, Share share>
  CLOTHLAB_INLINE void block(const RowShares<share>& shares, const ConstRow& here, const ConstRow& below,
                             const ConstRow& velocity, const Row& force, int j, int count,
                             CellNormals::Carry& carry, V& power) {
    const Vector sum = normals_.sum<HasBelow, Edge>(here, below, j, count, carry);
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
  CellNormals normals_;
};

}  // namespace
}  // namespace cloth::kernels
