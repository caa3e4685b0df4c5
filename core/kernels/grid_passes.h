// The passes of the explicit methods over a band of rows. Included once for every instruction set, after its
// Lanes.
#pragma once

#include "kernels/grid_rows.h"
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

/// The two row buffers of one chain of rows, and the rows' order.
class RowChain {
 public:
  RowChain(const Pass& pass, const Springs& springs, int buffer, int first_row) : pass_(pass) {
    work_.columns = pass.grid.columns;
    work_.a = scratch_row(pass, buffer);
    work_.b = scratch_row(pass, buffer + 1);
    work_.weight = vector_of(pass.weight);
    work_.springs = &springs;
    work_.uses_b = (pass.grid.springs & down_two) != 0;
    has_all_ = pass.grid.springs == (structural_springs | shear_springs | flexion_springs);
    begin(work_.a, load_of(pass, first_row));
    if (first_row + 1 < pass.grid.rows) begin(work_.b, load_of(pass, first_row + 1));
  }

  /// `position(row)` gives a row's positions; rows must come one after the other. The last two before row
  /// `first` only add to the buffers what their springs do to the rows from there on.
  template <class Position, class Update>
  CLOTHLAB_INLINE void run(int row, int first, const Position& position, Update& update) {
    const bool own = row >= first;
    const int below = pass_.grid.rows - 1 - row;
    work_.here = position(row);
    if (below >= 1) work_.below = position(row + 1), work_.load_below = load_of(pass_, row + 1);
    if (below >= 2) work_.second = position(row + 2), work_.load_second = load_of(pass_, row + 2);
    if (has_all_ && own && below >= 2) {
      row_pass<true>(work_, true, update);
      return;
    }
    work_.has_below = below >= 1, work_.has_second = below >= 2;
    work_.present = pass_.grid.springs;
    if (below < 2) work_.present &= ~unsigned{down_two};
    if (below < 1) work_.present &= ~unsigned{down_one | shear_springs};
    if (row < first) work_.present &= ~unsigned{right_one | right_two};
    if (row + 1 < first) work_.present &= unsigned{down_two};
    row_pass<false>(work_, own, update);
  }

 private:
  void begin(const Row& buffer, const ConstRow& load_row) const {
    for (int j = 0; j < work_.columns; j += Lanes::width)
      store(buffer, j, initial<true>(load_row, work_.weight, j, work_.columns - j));
  }

  const Pass& pass_;
  RowWork work_{};
  bool has_all_ = false;
};

/// The sums of squares of a row go to the row's own place, so that their order does not depend on the bands.
inline void store_sum(const Pass& pass, int which, int row, V sum) {
  if (row >= pass.first && row < pass.last)
    pass.squares[static_cast<long>(which) * pass.grid.rows + row] = Lanes::sum(sum);
}

void euler_band(const Pass& pass) {
  const Springs springs(pass.grid);
  const int start = pass.first < 2 ? 0 : pass.first - 2;
  RowChain chain(pass, springs, 0, start);
  EulerUpdate update{};
  update.step = Lanes::set(pass.step), update.damping = Lanes::set(pass.damping);
  update.drift_first = pass.drift_first;
  const auto position = [&](int row) { return row_of(pass, pass.position, row); };
  for (int row = start; row < pass.last; ++row) {
    const bool own = row >= pass.first;
    if (own) {
      update.position = position(row);
      update.velocity = row_of(pass, pass.velocity, row);
      update.inverse_mass = inverse_masses(pass, row);
      update.before = update.after = Lanes::zero();
    }
    chain.run(row, pass.first, position, update);
    store_sum(pass, 0, row, update.before);
    store_sum(pass, 1, row, update.after);
  }
}

inline void kick_drift_row(const Pass& pass, int row) {
  if (row >= pass.grid.rows) return;
  const Row x = row_of(pass, pass.position, row), v = row_of(pass, pass.velocity, row);
  const ConstRow p = row_of(pass, pass.force, row);
  const double* inverse_mass = inverse_masses(pass, row);
  const V half_step = Lanes::set(0.5 * pass.step), step = Lanes::set(pass.step),
          damping = Lanes::set(pass.damping);
  const int columns = pass.grid.columns;
  int j = 0;
  for (; j + Lanes::width <= columns; j += Lanes::width)
    kick_drift_block<false>(x, v, p, inverse_mass, half_step, step, damping, j, Lanes::width);
  if (j < columns) kick_drift_block<true>(x, v, p, inverse_mass, half_step, step, damping, j, columns - j);
}

inline V centring(const Pass& pass) {
  return Lanes::set(centring(pass.step, pass.damping, pass.mass_of_free));
}

/// With the kick and the drift before the force, or after a pass that has done them.
template <bool KickAndDrift>
void verlet_band(const Pass& pass) {
  const Springs springs(pass.grid);
  const int start = pass.first < 2 ? 0 : pass.first - 2;
  RowChain chain(pass, springs, 0, start);
  VerletUpdate update{};
  update.half_step = Lanes::set(0.5 * pass.step);
  update.centred = centring(pass);
  const auto position = [&](int row) { return row_of(pass, pass.position, row); };
  if (KickAndDrift) kick_drift_row(pass, start);
  if (KickAndDrift) kick_drift_row(pass, start + 1);
  for (int row = start; row < pass.last; ++row) {
    if (KickAndDrift) kick_drift_row(pass, row + 2);
    const bool own = row >= pass.first;
    if (own) {
      update.velocity = row_of(pass, pass.velocity, row);
      update.force = row_of(pass, pass.force, row);
      update.inverse_mass = inverse_masses(pass, row);
      update.after = Lanes::zero();
    }
    chain.run(row, pass.first, position, update);
    store_sum(pass, 1, row, update.after);
  }
}

void verlet_open_band(const Pass& pass) {
  for (int row = pass.first; row < pass.last; ++row) kick_drift_row(pass, row);
}

void verlet_between_band(const Pass& pass) {
  const Springs springs(pass.grid);
  const int start = pass.first < 2 ? 0 : pass.first - 2;
  RowChain chain(pass, springs, 0, start);
  VerletBetweenUpdate update{};
  update.half_step = Lanes::set(0.5 * pass.step), update.step = Lanes::set(pass.step);
  update.centred = centring(pass), update.damping = Lanes::set(pass.damping);
  const auto position = [&](int row) { return row_of(pass, pass.position, row); };
  for (int row = start; row < pass.last; ++row) {
    const bool own = row >= pass.first;
    if (own) {
      update.position = position(row);
      update.velocity = row_of(pass, pass.velocity, row);
      update.inverse_mass = inverse_masses(pass, row);
      update.after = Lanes::zero();
    }
    chain.run(row, pass.first, position, update);
    store_sum(pass, 1, row, update.after);
  }
}

void evaluate_band(const Pass& pass) {
  const Springs springs(pass.grid);
  const int start = pass.first < 2 ? 0 : pass.first - 2;
  RowChain chain(pass, springs, 0, start);
  EvaluateUpdate update{};
  const auto position = [&](int row) { return row_of(pass, pass.position, row); };
  for (int row = start; row < pass.last; ++row) {
    const bool own = row >= pass.first;
    if (own) update.force = row_of(pass, pass.force, row);
    chain.run(row, pass.first, position, update);
  }
}

void sum_squares_band(const Pass& pass) {
  const int columns = pass.grid.columns;
  for (int row = pass.first; row < pass.last; ++row) {
    const ConstRow velocity = row_of(pass, pass.velocity, row);
    V sum = Lanes::zero();
    int j = 0;
    for (; j + Lanes::width <= columns; j += Lanes::width)
      sum = plus_square(sum, load_part<false>(velocity, j, Lanes::width));
    if (j < columns) sum = plus_square(sum, load_part<true>(velocity, j, columns - j));
    store_sum(pass, 1, row, sum);
  }
}

/// The four stages follow each other down the rows, two rows apart, so that what lies between them never
/// leaves the cache: rings of three rows for each stage's state, of seven for the sums. Near the band's ends
/// the first stages also do the rows of other bands that the later ones will need.
void runge_kutta_band(const Pass& pass) {
  const Springs springs(pass.grid);
  const int rows = pass.grid.rows;
  constexpr int stage_ring = 3, sum_ring = 7, first_ring_row = 2 * stage_count;
  const auto stage_row = [&](int stage, int row, int field) {  // of stages 1, 2, 3
    return scratch_row(pass, first_ring_row + ((stage - 1) * stage_ring + row % stage_ring) * 2 + field);
  };
  const auto sum_row = [&](int row, int field) {
    return scratch_row(pass, first_ring_row + 3 * stage_ring * 2 + (row % sum_ring) * 2 + field);
  };
  const auto state_row = [&](int row, int field) {
    return row_of(pass, field == 0 ? pass.position : pass.velocity, row);
  };

  int start[stage_count], begin[stage_count], end[stage_count];  // rows that add, rows that are done
  for (int s = 0; s < stage_count; ++s) {
    const int reach = 2 * (stage_count - 1 - s);
    begin[s] = pass.first - reach < 0 ? 0 : pass.first - reach;
    start[s] = begin[s] < 2 ? 0 : begin[s] - 2;
    end[s] = pass.last + reach > rows ? rows : pass.last + reach;
  }
  RowChain chains[stage_count] = {{pass, springs, 0, start[0]},
                                  {pass, springs, 2, start[1]},
                                  {pass, springs, 4, start[2]},
                                  {pass, springs, 6, start[3]}};

  for (int front = start[0]; front < pass.last + 2 * (stage_count - 1); ++front)
    for (int s = 0; s < stage_count; ++s) {
      const int row = front - 2 * s;
      if (row < start[s] || row >= end[s]) continue;
      const bool own = row >= begin[s];
      StageUpdate update{};
      if (own) {
        const bool is_last = s + 1 == stage_count;
        update.weight = Lanes::set(pass.step * stage_weight[s]);
        update.ahead = Lanes::set(pass.step * stage_ahead[s]);
        update.damping = Lanes::set(pass.damping);
        update.is_last = is_last;
        update.stage_velocity = s == 0 ? state_row(row, 1) : stage_row(s, row, 1);
        update.inverse_mass = inverse_masses(pass, row);
        update.sum_position = s == 0 ? state_row(row, 0) : sum_row(row, 0);
        update.sum_velocity = s == 0 ? state_row(row, 1) : sum_row(row, 1);
        update.next_sum_position = is_last ? state_row(row, 0) : sum_row(row, 0);
        update.next_sum_velocity = is_last ? state_row(row, 1) : sum_row(row, 1);
        update.state_position = state_row(row, 0);
        update.state_velocity = state_row(row, 1);
        if (!is_last) {
          update.next_position = stage_row(s + 1, row, 0);
          update.next_velocity = stage_row(s + 1, row, 1);
        }
      }
      if (s == 0)
        chains[s].run(
            row, begin[s], [&](int r) { return state_row(r, 0); }, update);
      else
        chains[s].run(
            row, begin[s], [&](int r) { return stage_row(s, r, 0); }, update);
      if (own) store_sum(pass, s, row, update.squares);
      if (own && s + 1 == stage_count) store_sum(pass, stage_count, row, update.after);
    }
}

template <bool Divide>
void spring_scales(const SpringKind& kind, const double* squares, double* result, int count) {
  const Lanes::Spring spring = Lanes::spring(kind.stiffness, kind.rest_tension);
  for (int i = 0; i < count; i += Lanes::width) {
    const V s = Lanes::load(squares + i, count - i, Lanes::set(1));
    Lanes::store(result + i, Lanes::spring_scale<Divide>(s, spring), count - i);
  }
}

constexpr GridKernels grid_kernels{
    euler_band,          verlet_band<true>,  verlet_open_band,
    verlet_between_band, verlet_band<false>, runge_kutta_band,
    evaluate_band,       sum_squares_band,   {spring_scales<false>, spring_scales<true>}};

}  // namespace
}  // namespace cloth::kernels
