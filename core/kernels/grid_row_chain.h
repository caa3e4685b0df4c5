// A pass over a band of rows: the rows of its fields, and the order in which their forces and updates follow
// each other. Included once for every instruction set, after its Lanes.
#pragma once

#include "kernels/grid_air.h"
#include "kernels/grid_cell_rows.h"
#include "kernels/grid_rows.h"
#include "kernels/grid_sliders.h"
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

inline RowBlock block_of(const Pass& pass, const BandField& field, int row) {
  return row < pass.first ? field.above : row >= pass.last ? field.below : field.own;
}
inline Row row_of(const Pass& pass, const BandField& field, int row) {
  const RowBlock block = block_of(pass, field, row);
  const long offset = static_cast<long>(row - block.first) * pass.grid.columns;
  return {block.x + offset, block.y + offset, block.z + offset};
}
inline ConstRow load_of(const Pass& pass, int row) {
  if (!pass.load[0] || row < pass.first || row >= pass.last) return {};
  const long offset = static_cast<long>(row) * pass.grid.columns;
  return {pass.load[0] + offset, pass.load[1] + offset, pass.load[2] + offset};
}
inline const double* inverse_masses(const Pass& pass, int row) {
  return pass.inverse_mass + static_cast<long>(row) * pass.grid.columns;
}
/// The n-th row of scratch vectors.
inline Row scratch_row(const Pass& pass, int n) {
  const long pitch = pitch_of(pass.grid.columns);
  double* x = pass.scratch + 3 * n * pitch;
  return {x, x + pitch, x + 2 * pitch};
}

/// Lane by lane: what a row's dampers take, and what the air gives it.
struct Powers {
  V dampers, air;
};

/// Where a chain keeps its rows of scratch: two for the springs, two for the air if there is any, two for
/// sliders if there are any.
struct ChainPlace {
  int buffer, air_buffer, slider_buffer;
  int evaluation = 0;  ///< of the step, for the wind
};

/// The share of a row's particles, and of springs along it.
inline double share_of(const Pass& pass, int row) {
  return row == 0 || row == pass.grid.rows - 1 ? 0.5 : 1;
}
template <Share share>
RowShares<share> row_shares(const Pass& pass, int row) {
  if constexpr (share == Share::equal) return {};
  return {Lanes::set(share_of(pass, row)), pass.shares.part};
}

/// The row buffers of one chain of rows, and the rows' order.
template <Law law, Share share>
class RowChain {
 public:
  RowChain(const Pass& pass, const Springs& springs, const ChainPlace& place, int first_row) : pass_(pass) {
    const int buffer = place.buffer;
    work_.columns = pass.grid.columns;
    work_.a = scratch_row(pass, buffer);
    work_.b = scratch_row(pass, buffer + 1);
    work_.weight = vector_of(pass.weight);
    work_.springs = &springs;
    work_.part = pass.shares.part;
    if constexpr (share == Share::equal) {
      work_.uses_b = (pass.grid.springs & down_two) != 0;
      has_all_ = pass.grid.springs == (structural_springs | shear_springs | flexion_springs);
    } else {
      work_.uses_b = bends();
      has_all_ = work_.uses_b && pass.grid.springs == (structural_springs | shear_springs);
    }
    begin(work_.a, first_row);
    if (first_row + 1 < pass.grid.rows) begin(work_.b, first_row + 1);
    if (pass.has_air)
      air_.begin(pass, pass.wind[place.evaluation], scratch_row(pass, place.air_buffer),
                 scratch_row(pass, place.air_buffer + 1));
    if (has_sliders())
      sliders_.begin(pass, scratch_row(pass, place.slider_buffer),
                     scratch_row(pass, place.slider_buffer + 1));
  }

  /// `particles(row)` gives a row's particles; rows must come one after the other. The last two before row
  /// `first` only add to the buffers what their springs do to the rows from there on.
  template <class ParticlesOf, class Update>
  CLOTHLAB_INLINE Powers run(int row, int first, const ParticlesOf& particles, Update& update) {
    const bool own = row >= first;
    const int below = pass_.grid.rows - 1 - row;
    work_.here = particles(row);
    if (below >= 1) work_.below = particles(row + 1), work_.load_below = load_of(pass_, row + 1);
    if (below >= 2) work_.second = particles(row + 2), work_.load_second = load_of(pass_, row + 2);
    Powers powers{Lanes::zero(), Lanes::zero()};
    if constexpr (share == Share::by_cell) stand_at(row);
    if (pass_.has_air) powers.air = push(row, own, below >= 1);
    if (has_sliders())
      sliders_.run(row, work_.of_row, work_.here.position, work_.below.position, work_.second.position,
                   own ? work_.a : Row{});
    if (has_all_ && own && below >= 2) {
      powers.dampers = row_pass<law, share, true>(work_, true, update);
      return powers;
    }
    work_.has_below = below >= 1, work_.has_second = below >= 2;
    work_.present = pass_.grid.springs;
    if (below < 2) work_.present &= ~unsigned{down_two};
    if (below < 1) work_.present &= ~unsigned{down_one | shear_springs};
    if (row < first) work_.present &= ~unsigned{right_one | right_two};
    if (row + 1 < first) work_.present &= unsigned{down_two};
    powers.dampers = row_pass<law, share, false>(work_, own, update);
    return powers;
  }

 private:
  bool bends() const { return pass_.shares.across && (law != Law::damper || pass_.bending_time > 0); }
  bool has_sliders() const {
    return share == Share::by_cell && law != Law::damper && pass_.sliders.across.curvature;
  }
  void stand_at(int row) {
    work_.of_row = Lanes::set(share_of(pass_, row)), work_.of_below = Lanes::set(share_of(pass_, row + 1));
    work_.of_second = Lanes::set(share_of(pass_, row + 2));
    if (!bends()) return;
    const long at = static_cast<long>(row) * pass_.grid.columns;
    work_.bending = {pass_.shares.across + at, pass_.shares.down + at, pass_.shares.twist + at};
  }
  V push(int row, bool own, bool has_below) {
    const RowShares<share> shares = row_shares<share>(pass_, row);
    const Row force = own ? work_.a : Row{};
    const ConstRow& x = work_.here.position;
    if (has_below)
      return air_.template run<true>(shares, x, work_.below.position, work_.here.velocity, force);
    return air_.template run<false>(shares, x, {}, work_.here.velocity, force);
  }
  void begin(const Row& buffer, int row) const {
    const ConstRow load_row = load_of(pass_, row);
    for (int j = 0; j < work_.columns; j += Lanes::width) {
      const int count = work_.columns - j;
      if constexpr (share == Share::equal)
        store(buffer, j, initial<true>(load_row, work_.weight, j, count));
      else
        store(buffer, j, initial_share<true>(load_row, work_, Lanes::set(share_of(pass_, row)), j, count));
    }
  }

  const Pass& pass_;
  RowWork work_{};
  AirRows air_;
  SliderRows sliders_;
  bool has_all_ = false;
};

/// The first row whose springs reach the row `first`.
inline int first_row_of_springs(int first) {
  return first < 2 ? 0 : first - 2;
}

/// The sums of a row go to the row's own place, so that their order does not depend on the bands.
inline void store_sum(const Pass& pass, int which, int row, V sum) {
  if (row >= pass.first && row < pass.last)
    pass.sums[static_cast<long>(which) * pass.grid.rows + row] = Lanes::sum(sum);
}

/// before(row), for the band's own rows, then the row's force and `update`, then after(row, powers).
template <Law law, Share share, class Update, class Before, class After>
void band_pass(const Pass& pass, Update& update, const Before& before, const After& after) {
  const Springs springs(pass);
  const int start = first_row_of_springs(pass.first);
  RowChain<law, share> chain(pass, springs, {0, 2, pass.has_air ? 4 : 2}, start);
  const bool needs_velocity = law != Law::elastic || pass.has_air;
  const auto particles = [&](int row) -> ParticleRow {
    if (!needs_velocity) return {row_of(pass, pass.position, row), {}};
    return {row_of(pass, pass.position, row), row_of(pass, pass.velocity, row)};
  };
  for (int row = start; row < pass.last; ++row) {
    before(row, row >= pass.first);
    after(row, chain.run(row, pass.first, particles, update));
  }
}

}  // namespace
}  // namespace cloth::kernels
