// The end of a step with sliders of hysteresis (cloth/bending_sliders.h), row by row: slips follow where
// sliders have yielded, normals are taken anew. Old values are only read and new ones stored elsewhere, so
// that bands need no copies of each other's rows. Included once for every instruction set, after its Lanes;
// everything here has internal linkage.
#pragma once

#include "kernels/grid_normals.h"
#include "kernels/grid_row_chain.h"
#include "kernels/grid_sliders.h"

namespace cloth::kernels {
namespace {

/// What the sliders along rows, or along columns, need in every block.
struct SliderNumbers {
  V push, most, whole;
  explicit SliderNumbers(const SliderLine& line)
      : push(Lanes::set(line.push)),
        most(Lanes::set(line.most)),
        whole(Lanes::set(line.curvature_of_whole)) {}

  /// J/m, over push / c: 1/2 s^2 where a slider is elastic.
  CLOTHLAB_INLINE V energy(const SliderStretch& s) const {
    return Lanes::mul(s.elastic, Lanes::fnma(Lanes::set(0.5), s.elastic, s.whole));
  }
  /// N m^2: from that to J.
  CLOTHLAB_INLINE V scale(V share, V curvature) const {
    return Lanes::div(Lanes::mul(push, share), Lanes::max(curvature, whole));
  }
};

/// x_- - 2 x + x_+ of a block along both directions; where a neighbour is missing, so is the slider.
struct BentBlock {
  Vector here, across, down;
  template <bool Edge>
  CLOTHLAB_INLINE static BentBlock at(const ConstRow& above, const ConstRow& row, const ConstRow& below,
                                      int j, int count, Vector& left) {
    const Vector x = load_part<Edge>(row, j, count);
    Vector right;
    if constexpr (Edge)
      right = load(row, j + 1, count - 1, x);
    else
      right = load(row, j + 1);
    const Vector before = j == 0 ? x : left;
    left = x;
    return {x, (right - x) - (x - moved_one(before, x)),
            (load_part<Edge>(below, j, count) - x) - (x - load_part<Edge>(above, j, count))};
  }
};

inline const double* row_at(const double* values, const Pass& pass, int row) {
  return values + static_cast<long>(row) * pass.grid.columns;
}
inline double* row_at(double* values, const Pass& pass, int row) {
  return values + static_cast<long>(row) * pass.grid.columns;
}
inline ConstRow position_row(const Pass& pass, int row) {
  const int last = pass.grid.rows - 1;
  return row_of(pass, pass.position, row < 0 ? 0 : row > last ? last : row);
}

/// Lets the cells of a row go by.
inline void cells_of_row(const Pass& pass, const CellNormals& normals, int row) {
  const ConstRow here = position_row(pass, row), below = position_row(pass, row + 1);
  CellNormals::Carry carry = CellNormals::none();
  const int columns = pass.grid.columns;
  int j = 0;
  for (; j + Lanes::width + 1 <= columns; j += Lanes::width)
    normals.sum<true, false>(here, below, j, Lanes::width, carry);
  for (; j < columns; j += Lanes::width) normals.sum<true, true>(here, below, j, columns - j, carry);
}

/// The rows of a band at the end of a step. With `Change` the held force follows, for which the sliders of
/// the rows beside the band are computed too.
template <bool Change>
class SliderEnds {
 public:
  explicit SliderEnds(const Pass& pass)
      : pass_(pass), across_(pass.sliders.across), down_(pass.sliders.down) {
    first_ = Change && pass.first > 0 ? pass.first - 1 : pass.first;
    last_ = Change && pass.last < pass.grid.rows ? pass.last + 1 : pass.last;
    normals_.begin(pass.grid.columns, scratch_row(pass, 0), scratch_row(pass, 1));
    if (!Change) return;
    for (int k = 0; k < 3; ++k) changed_down_[k] = scratch_row(pass, 2 + k);
    for (int k = 0; k < 2; ++k) changed_across_[k] = scratch_row(pass, 5 + k);
    const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
    for (int j = 0; j < pass.grid.columns; j += Lanes::width)
      for (const Row& row : changed_down_) store(row, j, nothing);
  }

  void run() {
    if (first_ > 0) cells_of_row(pass_, normals_, first_ - 1);
    for (int row = first_; row < last_; ++row) {
      row + 1 < pass_.grid.rows ? end_row<true>(row) : end_row<false>(row);
      if (Change && row - 1 >= pass_.first) change_force(row - 1);
    }
    if (Change && last_ == pass_.grid.rows) {
      clear(changed_down(last_));
      change_force(last_ - 1);
    }
  }

 private:
  Row changed_down(int row) const { return changed_down_[(row + 3) % 3]; }
  Row changed_across(int row) const { return changed_across_[row % 2]; }
  void clear(const Row& row) const {
    const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
    for (int j = 0; j < pass_.grid.columns; j += Lanes::width) store(row, j, nothing);
  }

  /// What a row reads and writes.
  struct Slips {
    const double *curvature, *now;
    double* next;
    Row changed;
  };
  struct Work {
    ConstRow above, here, below, normal;
    Row next_normal;
    Slips across, down;
    V of_row;
    bool own;
  };
  /// The normals of a block before and after the end of the step.
  struct Turn {
    const Vector &normal, &next;
  };
  Slips slips_at(const SliderLine& line, int row, const Row& changed) const {
    return {row_at(line.curvature, pass_, row), row_at(line.slip, pass_, row),
            row_at(line.next_slip, pass_, row), changed};
  }
  Work work_at(int row) const {
    const SliderPass& s = pass_.sliders;
    return {.above = position_row(pass_, row - 1),
            .here = position_row(pass_, row),
            .below = position_row(pass_, row + 1),
            .normal = slider_row(pass_, s.across, row).normal,
            .next_normal = {row_at(s.next_normal[0], pass_, row), row_at(s.next_normal[1], pass_, row),
                            row_at(s.next_normal[2], pass_, row)},
            .across = slips_at(s.across, row, Change ? changed_across(row) : Row{}),
            .down = slips_at(s.down, row, Change ? changed_down(row) : Row{}),
            .of_row = Lanes::set(share_of(pass_, row)),
            .own = row >= pass_.first && row < pass_.last};
  }

  template <bool HasBelow>
  void end_row(int row) {
    const Work work = work_at(row);
    const V zero = Lanes::zero();
    CellNormals::Carry carry = CellNormals::none();
    Vector left{zero, zero, zero};
    V lost = zero;
    const int columns = pass_.grid.columns;
    int j = 0;
    for (; j + Lanes::width + 1 <= columns; j += Lanes::width)
      block<HasBelow, false>(work, j, Lanes::width, carry, left, lost);
    for (; j < columns; j += Lanes::width) block<HasBelow, true>(work, j, columns - j, carry, left, lost);
    store_sum(pass_, energy_of_sliders, row, lost);
  }

  template <bool HasBelow, bool Edge>
  CLOTHLAB_INLINE void block(const Work& work, int j, int count, CellNormals::Carry& carry, Vector& left,
                             V& lost) {
    const Vector sum = normals_.sum<HasBelow, Edge>(work.here, work.below, j, count, carry);
    const Vector next = scaled(Lanes::inverse_root<false>(squared(sum)), sum);
    const Vector n = load_part<Edge>(work.normal, j, count);
    const BentBlock bent = BentBlock::at<Edge>(work.above, work.here, work.below, j, count, left);
    const V of_columns = Lanes::load(pass_.shares.part + j);
    const Turn turn{n, next};
    end_block<Edge>(work, across_, turn, bent.across, work.across, work.of_row, j, count, lost);
    end_block<Edge>(work, down_, turn, bent.down, work.down, of_columns, j, count, lost);
    if (work.own) store<Edge>(work.next_normal, j, count, next);
  }

  /// The sliders of a block along rows, or along columns, bent by `d`.
  template <bool Edge>
  CLOTHLAB_INLINE static void end_block(const Work& work, const SliderNumbers& numbers, const Turn& turn,
                                        const Vector& d, const Slips& slips, V share, int j, int count,
                                        V& lost) {
    const V curvature = load_number<Edge>(slips.curvature, j, count),
            slip = load_number<Edge>(slips.now, j, count);
    const SliderStretch before(curvature, slip, turn.normal, d, numbers.most);
    const V next_slip = Lanes::add(slip, Lanes::sub(before.whole, before.elastic));
    const SliderStretch after(curvature, next_slip, turn.next, d, numbers.most);
    if (work.own) {
      if constexpr (Edge)
        Lanes::store(slips.next + j, next_slip, count);
      else
        Lanes::store(slips.next + j, next_slip);
      lost = Lanes::fma(numbers.scale(share, curvature),
                        Lanes::sub(numbers.energy(before), numbers.energy(after)), lost);
    }
    if constexpr (Change) {
      const V push = Lanes::mul(numbers.push, share);
      store(slips.changed, j,
            minus(scaled(Lanes::mul(push, after.elastic), turn.next), Lanes::mul(push, before.elastic),
                  turn.normal));
    }
  }

  /// From what g n has become in the row and the rows beside it.
  void change_force(int row) const {
    const Row force = row_of(pass_, pass_.force, row);
    const int columns = pass_.grid.columns;
    const V zero = Lanes::zero();
    Vector left{zero, zero, zero};
    int j = 0;
    for (; j + Lanes::width + 1 <= columns; j += Lanes::width)
      change_block<false>(row, force, j, Lanes::width, left);
    for (; j < columns; j += Lanes::width) change_block<true>(row, force, j, columns - j, left);
  }
  template <bool Edge>
  CLOTHLAB_INLINE void change_block(int row, const Row& force, int j, int count, Vector& left) const {
    const Row along = changed_across(row);
    const Vector across = load(along, j), right = load_part<Edge>(along, j + 1, count - 1);
    const Vector ends =
        (right + moved_one(left, across)) + (load(changed_down(row - 1), j) + load(changed_down(row + 1), j));
    left = across;
    const Vector change = plus(Vector{Lanes::zero(), Lanes::zero(), Lanes::zero()} - ends, Lanes::set(2),
                               across + load(changed_down(row), j));
    store<Edge>(force, j, count, load_part<Edge>(force, j, count) + change);
  }

  const Pass& pass_;
  SliderNumbers across_, down_;
  CellNormals normals_;
  int first_ = 0, last_ = 0;  ///< rows whose sliders are computed
  Row changed_down_[3]{}, changed_across_[2]{};
};

/// Normals alone.
template <bool HasBelow, bool Edge>
CLOTHLAB_INLINE void normal_block(const CellNormals& normals, const ConstRow& here, const ConstRow& below,
                                  const Row& next, int j, int count, CellNormals::Carry& carry) {
  const Vector sum = normals.sum<HasBelow, Edge>(here, below, j, count, carry);
  store<Edge>(next, j, count, scaled(Lanes::inverse_root<false>(squared(sum)), sum));
}
template <bool HasBelow>
void normal_row(const Pass& pass, const CellNormals& normals, int row) {
  const ConstRow here = position_row(pass, row), below = position_row(pass, row + 1);
  double* const* n = pass.sliders.next_normal;
  const Row next{row_at(n[0], pass, row), row_at(n[1], pass, row), row_at(n[2], pass, row)};
  CellNormals::Carry carry = CellNormals::none();
  const int columns = pass.grid.columns;
  int j = 0;
  for (; j + Lanes::width + 1 <= columns; j += Lanes::width)
    normal_block<HasBelow, false>(normals, here, below, next, j, Lanes::width, carry);
  for (; j < columns; j += Lanes::width)
    normal_block<HasBelow, true>(normals, here, below, next, j, columns - j, carry);
}
void slider_normals_band(const Pass& pass) {
  CellNormals normals;
  normals.begin(pass.grid.columns, scratch_row(pass, 0), scratch_row(pass, 1));
  if (pass.first > 0) cells_of_row(pass, normals, pass.first - 1);
  for (int row = pass.first; row < pass.last; ++row)
    row + 1 < pass.grid.rows ? normal_row<true>(pass, normals, row) : normal_row<false>(pass, normals, row);
}

template <bool Edge>
CLOTHLAB_INLINE V stored_in_block(const Pass& pass, int row, int j, int count, Vector& left) {
  const SliderRow across = slider_row(pass, pass.sliders.across, row),
                  down = slider_row(pass, pass.sliders.down, row);
  const Vector n = load_part<Edge>(across.normal, j, count);
  const BentBlock bent = BentBlock::at<Edge>(position_row(pass, row - 1), position_row(pass, row),
                                             position_row(pass, row + 1), j, count, left);
  const auto energy = [&](const SliderLine& line, const SliderRow& at, const Vector& d, V share) {
    const SliderNumbers numbers(line);
    const V curvature = load_number<Edge>(at.curvature, j, count);
    const SliderStretch stretch(curvature, load_number<Edge>(at.slip, j, count), n, d, numbers.most);
    return Lanes::mul(numbers.scale(share, curvature), numbers.energy(stretch));
  };
  return Lanes::add(energy(pass.sliders.across, across, bent.across, Lanes::set(share_of(pass, row))),
                    energy(pass.sliders.down, down, bent.down, Lanes::load(pass.shares.part + j)));
}
void slider_energies_band(const Pass& pass) {
  const int columns = pass.grid.columns;
  for (int row = pass.first; row < pass.last; ++row) {
    const V zero = Lanes::zero();
    Vector left{zero, zero, zero};
    V stored = zero;
    int j = 0;
    for (; j + Lanes::width + 1 <= columns; j += Lanes::width)
      stored = Lanes::add(stored, stored_in_block<false>(pass, row, j, Lanes::width, left));
    for (; j < columns; j += Lanes::width)
      stored = Lanes::add(stored, stored_in_block<true>(pass, row, j, columns - j, left));
    store_sum(pass, energy_of_sliders, row, stored);
  }
}

void end_sliders_band(const Pass& pass) {
  pass.force.own.x ? SliderEnds<true>(pass).run() : SliderEnds<false>(pass).run();
}

}  // namespace
}  // namespace cloth::kernels
