// The force of the sliders of hysteresis (cloth/bending_sliders.h) on a grid, row by row within a pass. With
// g = K a c clamp(kappa - slip), a the slider's area, a slider pushes its middle by 2 g n and its ends by
// -g n each. Included once for every instruction set, after its Lanes; everything here has internal linkage.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/lane_vectors.h"
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

template <bool Edge>
CLOTHLAB_INLINE V load_number(const double* row, int j, int count) {
  if constexpr (Edge) return Lanes::load(row + j, count, Lanes::zero());
  return Lanes::load(row + j);
}

/// The sliders of one row's particles.
struct SliderRow {
  const double *curvature = nullptr, *slip = nullptr;
  ConstRow normal;
};
inline SliderRow slider_row(const Pass& pass, const SliderLine& line, int row) {
  const long at = static_cast<long>(row) * pass.grid.columns;
  const double* const* n = pass.sliders.normal;
  return {line.curvature + at, line.slip + at, {n[0] + at, n[1] + at, n[2] + at}};
}

/// kappa - slip in 1/m and what of it is elastic, of sliders with c, of which `bent` is x_- - 2 x + x_+.
struct SliderStretch {
  V whole, elastic;
  CLOTHLAB_INLINE SliderStretch(V curvature, V slip, const Vector& normal, const Vector& bent, V most)
      : whole(Lanes::sub(Lanes::mul(curvature, product(normal, bent)), slip)),
        elastic(Lanes::max(Lanes::sub(Lanes::zero(), most), Lanes::min(most, whole))) {}
};

class SliderRows {
 public:
  /// Before the first row: only of grids by cells. `above` and `middle` are rows of scratch.
  void begin(const Pass& pass, const Row& above, const Row& middle) {
    pass_ = &pass;
    above_ = above, middle_ = middle;
    const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
    for (int j = 0; j < pass.grid.columns; j += Lanes::width)
      store(above_, j, nothing), store(middle_, j, nothing);
  }

  /// Of one row after the other, with the two below it as far as they exist: adds what the sliders do to the
  /// row's particles to `force`, where there is one.
  void run(int row, V of_row, const ConstRow& here, const ConstRow& below, const ConstRow& second,
           const Row& force) {
    row + 2 < pass_->grid.rows ? run_row<true>(row, of_row, here, below, second, force)
                               : run_row<false>(row, of_row, here, below, second, force);
    const Row last = above_;
    above_ = middle_, middle_ = last;
  }

 private:
  /// The rows from which blocks are taken. Sliders along columns are those with their middle in the row
  /// below.
  struct Work {
    SliderRow across, down;
    V push_across, push_down, most_across, most_down;
    ConstRow here, below, second;
    Row force;
  };

  template <bool HasSecond>
  void run_row(int row, V of_row, const ConstRow& here, const ConstRow& below, const ConstRow& second,
               const Row& force) {
    const SliderPass& sliders = pass_->sliders;
    Work work{.across = slider_row(*pass_, sliders.across, row),
              .down = {},
              .push_across = Lanes::mul(of_row, Lanes::set(sliders.across.push)),
              .push_down = Lanes::set(sliders.down.push),
              .most_across = Lanes::set(sliders.across.most),
              .most_down = Lanes::set(sliders.down.most),
              .here = here,
              .below = below,
              .second = second,
              .force = force};
    if (HasSecond) work.down = slider_row(*pass_, sliders.down, row + 1);
    const V zero = Lanes::zero();
    Vector carry{zero, zero, zero};
    int j = 0;
    const int columns = pass_->grid.columns;
    for (; j + Lanes::width + 2 <= columns; j += Lanes::width)
      block<HasSecond, false>(work, j, Lanes::width, carry);
    for (; j < columns; j += Lanes::width) block<HasSecond, true>(work, j, columns - j, carry);
  }

  /// g n of the sliders along the row whose first ends are the block's particles.
  template <bool Edge>
  CLOTHLAB_INLINE Vector across(const Work& work, int j, int count, const Vector& x) const {
    const auto ahead = [&](int columns) {
      if constexpr (Edge) return load(work.here, j + columns, count - columns, x);
      return load(work.here, j + columns);
    };
    const Vector right = ahead(1), bent = (ahead(2) - right) - (right - x);
    const Vector n = load_part<Edge>(work.across.normal, j + 1, count - 1);
    const SliderStretch stretch(load_number<Edge>(work.across.curvature, j + 1, count - 1),
                                load_number<Edge>(work.across.slip, j + 1, count - 1), n, bent,
                                work.most_across);
    return scaled(Lanes::mul(work.push_across, stretch.elastic), n);
  }

  template <bool Edge>
  CLOTHLAB_INLINE Vector down(const Work& work, int j, int count, const Vector& x) const {
    const Vector below = load_part<Edge>(work.below, j, count);
    const Vector bent = (load_part<Edge>(work.second, j, count) - below) - (below - x);
    const Vector n = load_part<Edge>(work.down.normal, j, count);
    const SliderStretch stretch(load_number<Edge>(work.down.curvature, j, count),
                                load_number<Edge>(work.down.slip, j, count), n, bent, work.most_down);
    const V push = Lanes::mul(work.push_down, Lanes::load(pass_->shares.part + j));
    return scaled(Lanes::mul(push, stretch.elastic), n);
  }

  template <bool HasSecond, bool Edge>
  CLOTHLAB_INLINE void block(const Work& work, int j, int count, Vector& carry) const {
    const V two = Lanes::set(2);
    const Vector x = load_part<Edge>(work.here, j, count);
    const Vector above = load(above_, j), middle = load(middle_, j);
    Vector push = plus(Vector{Lanes::zero(), Lanes::zero(), Lanes::zero()} - above, two, middle);
    Vector next{Lanes::zero(), Lanes::zero(), Lanes::zero()};
    if constexpr (HasSecond) {
      next = down<Edge>(work, j, count, x);
      push = push - next;
    }
    store(above_, j, next);
    if (!work.force.x) return;
    const Vector first = across<Edge>(work, j, count, x);
    push = plus(push - first - moved_two(carry, first), two, moved_one(carry, first));
    carry = first;
    store(work.force, j, load(work.force, j) + push);
  }

  const Pass* pass_ = nullptr;
  Row above_{}, middle_{};  ///< g n of the sliders along columns with their middle there
};

}  // namespace
}  // namespace cloth::kernels
