// The passes of the explicit methods over a band of rows. Included once for every instruction set, after its
// Lanes.
#pragma once

#include "kernels/grid_projection.h"
#include "kernels/grid_row_chain.h"
#include "kernels/grid_slider_ends.h"
#include "kernels/grid_visits.h"

namespace cloth::kernels {
namespace {

/// Lets an update that moves the particles stand at one of the band's own rows.
template <Share share, template <Share> class Update>
void stand_at(const Pass& pass, int row, Update<share>& update) {
  update.shares = row_shares<share>(pass, row);
  update.position = row_of(pass, pass.position, row);
  update.velocity = row_of(pass, pass.velocity, row);
  update.inverse_mass = inverse_masses(pass, row);
}

template <Law law, Share share>
void euler_rows(const Pass& pass) {
  EulerUpdate<share> update{};
  update.step = Lanes::set(pass.step), update.damping = Lanes::set(pass.damping);
  update.drift_first = pass.drift_first;
  band_pass<law, share>(
      pass, update,
      [&](int row, bool own) {
        if (!own) return;
        stand_at(pass, row, update);
        update.before = update.after = Lanes::zero();
      },
      [&](int row, const Powers& powers) {
        store_sum(pass, squares_before, row, update.before);
        store_sum(pass, squares_after, row, update.after);
        if constexpr (law == Law::damped) store_sum(pass, dampers_before, row, powers.dampers);
        if (pass.has_air) store_sum(pass, air_before, row, powers.air);
      });
}

void euler_band(const Pass& pass) {
  if (pass.shares.part)
    pass.has_dampers ? euler_rows<Law::damped, Share::by_cell>(pass)
                     : euler_rows<Law::elastic, Share::by_cell>(pass);
  else
    pass.has_dampers ? euler_rows<Law::damped, Share::equal>(pass)
                     : euler_rows<Law::elastic, Share::equal>(pass);
}

template <Share share>
void kick_drift_row(const Pass& pass, int row) {
  if (row >= pass.grid.rows) return;
  const Row x = row_of(pass, pass.position, row), v = row_of(pass, pass.velocity, row);
  const ConstRow p = row_of(pass, pass.force, row);
  const double* inverse_mass = inverse_masses(pass, row);
  const V half_step = Lanes::set(0.5 * pass.step), step = Lanes::set(pass.step),
          damping = Lanes::set(pass.damping);
  const RowShares<share> shares = row_shares<share>(pass, row);
  const int columns = pass.grid.columns;
  int j = 0;
  for (; j + Lanes::width <= columns; j += Lanes::width)
    kick_drift_block<false>(x, v, p, inverse_mass, half_step, step, shares.of(damping, j), j, Lanes::width);
  if (j < columns)
    kick_drift_block<true>(x, v, p, inverse_mass, half_step, step, shares.of(damping, j), j, columns - j);
}

inline V centring(const Pass& pass) {
  return Lanes::set(centring(pass.step, pass.damping, pass.mass_of_free));
}

/// With the kick and the drift before the force, or after a pass that has done them.
template <bool KickAndDrift, Share share>
void verlet_rows(const Pass& pass) {
  VerletUpdate<share> update{};
  update.half_step = Lanes::set(0.5 * pass.step);
  update.centred = centring(pass);
  const int start = first_row_of_springs(pass.first);
  if (KickAndDrift) kick_drift_row<share>(pass, start);
  if (KickAndDrift) kick_drift_row<share>(pass, start + 1);
  band_pass<Law::elastic, share>(
      pass, update,
      [&](int row, bool own) {
        if (KickAndDrift) kick_drift_row<share>(pass, row + 2);
        if (!own) return;
        update.velocity = row_of(pass, pass.velocity, row);
        update.force = row_of(pass, pass.force, row);
        update.inverse_mass = inverse_masses(pass, row);
        update.shares = row_shares<share>(pass, row);
        update.after = Lanes::zero();
      },
      [&](int row, const Powers&) { store_sum(pass, squares_after, row, update.after); });
}

template <bool KickAndDrift>
void verlet_band(const Pass& pass) {
  pass.shares.part ? verlet_rows<KickAndDrift, Share::by_cell>(pass)
                   : verlet_rows<KickAndDrift, Share::equal>(pass);
}

void verlet_open_band(const Pass& pass) {
  for (int row = pass.first; row < pass.last; ++row)
    pass.shares.part ? kick_drift_row<Share::by_cell>(pass, row) : kick_drift_row<Share::equal>(pass, row);
}

template <Share share>
void verlet_between_rows(const Pass& pass) {
  VerletBetweenUpdate<share> update{};
  update.half_step = Lanes::set(0.5 * pass.step), update.step = Lanes::set(pass.step);
  update.centred = centring(pass), update.damping = Lanes::set(pass.damping);
  band_pass<Law::elastic, share>(
      pass, update,
      [&](int row, bool own) {
        if (!own) return;
        stand_at(pass, row, update);
        update.after = Lanes::zero();
      },
      [&](int row, const Powers&) { store_sum(pass, squares_after, row, update.after); });
}

void verlet_between_band(const Pass& pass) {
  pass.shares.part ? verlet_between_rows<Share::by_cell>(pass) : verlet_between_rows<Share::equal>(pass);
}

void drift_predict_row(const Pass& pass, int row) {
  if (row >= pass.grid.rows) return;
  const Row x = row_of(pass, pass.position, row), v = row_of(pass, pass.velocity, row);
  const ConstRow f = row_of(pass, pass.force, row);
  const double* inverse_mass = inverse_masses(pass, row);
  const V half_step = Lanes::set(0.5 * pass.step), step = Lanes::set(pass.step);
  const V ahead = Lanes::set(0.5 * pass.step * pass.held);
  const int columns = pass.grid.columns;
  int j = 0;
  for (; j + Lanes::width <= columns; j += Lanes::width)
    drift_predict_block<false>(x, v, f, inverse_mass, half_step, step, ahead, j, Lanes::width);
  if (j < columns) drift_predict_block<true>(x, v, f, inverse_mass, half_step, step, ahead, j, columns - j);
}

template <bool Drift, Law law, Share share>
void predicted_rows(const Pass& pass) {
  PredictedUpdate<share> update{};
  update.half_step = Lanes::set(0.5 * pass.step), update.damping = Lanes::set(pass.damping);
  update.gain = Lanes::set(pass.gain), update.held = Lanes::set(pass.held);
  const int start = first_row_of_springs(pass.first);
  if (Drift) drift_predict_row(pass, start);
  if (Drift) drift_predict_row(pass, start + 1);
  band_pass<law, share>(
      pass, update,
      [&](int row, bool own) {
        if (Drift) drift_predict_row(pass, row + 2);
        if (!own) return;
        update.velocity = row_of(pass, pass.velocity, row);
        update.force = row_of(pass, pass.force, row);
        update.inverse_mass = inverse_masses(pass, row);
        update.shares = row_shares<share>(pass, row);
        update.before = update.after = Lanes::zero();
      },
      [&](int row, const Powers& powers) {
        store_sum(pass, squares_before, row, update.before);
        store_sum(pass, squares_after, row, update.after);
        if constexpr (law == Law::damped) store_sum(pass, dampers_before, row, powers.dampers);
        if (pass.has_air) store_sum(pass, air_before, row, powers.air);
      });
}

template <bool Drift>
void predicted_band(const Pass& pass) {
  if (pass.shares.part)
    pass.has_dampers ? predicted_rows<Drift, Law::damped, Share::by_cell>(pass)
                     : predicted_rows<Drift, Law::elastic, Share::by_cell>(pass);
  else
    pass.has_dampers ? predicted_rows<Drift, Law::damped, Share::equal>(pass)
                     : predicted_rows<Drift, Law::elastic, Share::equal>(pass);
}

void predicted_open_band(const Pass& pass) {
  for (int row = pass.first; row < pass.last; ++row) drift_predict_row(pass, row);
}

template <Share share>
void evaluate_rows(const Pass& pass) {
  EvaluateUpdate update{};
  band_pass<Law::elastic, share>(
      pass, update,
      [&](int row, bool own) {
        if (own) update.force = row_of(pass, pass.force, row);
      },
      [](int, const Powers&) {});
}

void evaluate_band(const Pass& pass) {
  pass.shares.part ? evaluate_rows<Share::by_cell>(pass) : evaluate_rows<Share::equal>(pass);
}

template <Share share>
void damp_rows(const Pass& pass) {
  DampUpdate update{};
  band_pass<Law::damper, share>(
      pass, update,
      [&](int row, bool own) {
        if (own) update.product = row_of(pass, pass.force, row);
      },
      [&](int row, const Powers& powers) { store_sum(pass, dampers_before, row, powers.dampers); });
}

void damp_band(const Pass& pass) {
  pass.shares.part ? damp_rows<Share::by_cell>(pass) : damp_rows<Share::equal>(pass);
}

template <Share share>
void sum_squares_rows(const Pass& pass) {
  const int columns = pass.grid.columns;
  for (int row = pass.first; row < pass.last; ++row) {
    const ConstRow velocity = row_of(pass, pass.velocity, row);
    const RowShares<share> shares = row_shares<share>(pass, row);
    V sum = Lanes::zero();
    int j = 0;
    for (; j + Lanes::width <= columns; j += Lanes::width)
      sum = shares.plus_square(sum, load_part<false>(velocity, j, Lanes::width), j);
    if (j < columns) sum = shares.plus_square(sum, load_part<true>(velocity, j, columns - j), j);
    store_sum(pass, squares_after, row, sum);
  }
}

void sum_squares_band(const Pass& pass) {
  pass.shares.part ? sum_squares_rows<Share::by_cell>(pass) : sum_squares_rows<Share::equal>(pass);
}

/// The rows that the four stages read and write: rings of three for each stage's state, of seven for the
/// sums.
struct KuttaRows {
  static constexpr int stage_ring = 3, sum_ring = 7, first_ring_row = 2 * kutta_stages;
  static constexpr int first_sum_row = first_ring_row + 3 * stage_ring * 2,
                       first_air_row = first_sum_row + sum_ring * 2;
  const Pass& pass;

  Row stage(int stage, int row, int field) const {  // of stages 1, 2, 3
    return scratch_row(pass, first_ring_row + ((stage - 1) * stage_ring + row % stage_ring) * 2 + field);
  }
  Row sum(int row, int field) const {
    return scratch_row(pass, first_sum_row + (row % sum_ring) * 2 + field);
  }
  Row state(int row, int field) const {
    return row_of(pass, field == 0 ? pass.position : pass.velocity, row);
  }
  ParticleRow particles(int s, int row) const {
    if (s == 0) return {state(row, 0), state(row, 1)};
    return {stage(s, row, 0), stage(s, row, 1)};
  }

  template <Share share>
  StageUpdate<share> update(int s, int row) const {
    const bool is_last = s + 1 == kutta_stages;
    StageUpdate<share> update{};
    update.shares = row_shares<share>(pass, row);
    update.weight = Lanes::set(pass.step * kutta[s].weight);
    update.ahead = Lanes::set(is_last ? 0 : pass.step * kutta[s + 1].node);
    update.damping = Lanes::set(pass.damping);
    update.is_last = is_last;
    update.stage_velocity = s == 0 ? state(row, 1) : stage(s, row, 1);
    update.inverse_mass = inverse_masses(pass, row);
    update.sum_position = s == 0 ? state(row, 0) : sum(row, 0);
    update.sum_velocity = s == 0 ? state(row, 1) : sum(row, 1);
    update.next_sum_position = is_last ? state(row, 0) : sum(row, 0);
    update.next_sum_velocity = is_last ? state(row, 1) : sum(row, 1);
    update.state_position = state(row, 0);
    update.state_velocity = state(row, 1);
    if (!is_last) {
      update.next_position = stage(s + 1, row, 0);
      update.next_velocity = stage(s + 1, row, 1);
    }
    return update;
  }
};

/// The four stages follow each other down the rows, two rows apart, so that what lies between them never
/// leaves the cache. Near the band's ends the first stages also do the rows of other bands that the later
/// ones will need.
template <Law law, Share share>
void runge_kutta_rows(const Pass& pass) {
  const Springs springs(pass);
  const KuttaRows rows{pass};
  int start[kutta_stages], begin[kutta_stages], end[kutta_stages];  // rows that add, rows that are done
  for (int s = 0; s < kutta_stages; ++s) {
    const int reach = 2 * (kutta_stages - 1 - s);
    begin[s] = pass.first - reach < 0 ? 0 : pass.first - reach;
    start[s] = first_row_of_springs(begin[s]);
    end[s] = pass.last + reach > pass.grid.rows ? pass.grid.rows : pass.last + reach;
  }
  const auto chain = [&](int s) {
    const int air = KuttaRows::first_air_row, sliders = pass.has_air ? air + 2 * kutta_stages : air;
    return RowChain<law, share>(pass, springs, {2 * s, air + 2 * s, sliders + 2 * s, s}, start[s]);
  };
  RowChain<law, share> chains[kutta_stages] = {chain(0), chain(1), chain(2), chain(3)};

  for (int front = start[0]; front < pass.last + 2 * (kutta_stages - 1); ++front)
    for (int s = 0; s < kutta_stages; ++s) {
      const int row = front - 2 * s;
      if (row < start[s] || row >= end[s]) continue;
      const bool own = row >= begin[s];
      StageUpdate<share> update = own ? rows.update<share>(s, row) : StageUpdate<share>{};
      const Powers powers = chains[s].run(
          row, begin[s], [&](int r) { return rows.particles(s, r); }, update);
      if (!own) continue;
      store_sum(pass, stage_squares + s, row, update.squares);
      if constexpr (law == Law::damped) store_sum(pass, stage_dampers + s, row, powers.dampers);
      if (pass.has_air) store_sum(pass, stage_air + s, row, powers.air);
      if (s + 1 == kutta_stages) store_sum(pass, squares_of_result, row, update.after);
    }
}

void runge_kutta_band(const Pass& pass) {
  if (pass.shares.part)
    pass.has_dampers ? runge_kutta_rows<Law::damped, Share::by_cell>(pass)
                     : runge_kutta_rows<Law::elastic, Share::by_cell>(pass);
  else
    pass.has_dampers ? runge_kutta_rows<Law::damped, Share::equal>(pass)
                     : runge_kutta_rows<Law::elastic, Share::equal>(pass);
}

template <bool Divide>
void spring_scales(const SpringKind& kind, const double* squares, double* result, int count) {
  const Lanes::Spring spring = Lanes::spring(kind.stiffness, kind.rest_tension);
  for (int i = 0; i < count; i += Lanes::width) {
    const V s = Lanes::load(squares + i, count - i, Lanes::set(1));
    Lanes::store(result + i, Lanes::spring_scale<Divide>(s, spring), count - i);
  }
}

template <bool Divide>
void inverse_roots(const double* squares, double* result, int count) {
  for (int i = 0; i < count; i += Lanes::width) {
    const V s = Lanes::load(squares + i, count - i, Lanes::set(1));
    Lanes::store(result + i, Lanes::inverse_root<Divide>(s), count - i);
  }
}

constexpr GridKernels grid_kernels{euler_band,
                                   verlet_band<true>,
                                   verlet_open_band,
                                   verlet_between_band,
                                   verlet_band<false>,
                                   predicted_band<true>,
                                   predicted_open_band,
                                   predicted_band<false>,
                                   runge_kutta_band,
                                   evaluate_band,
                                   damp_band,
                                   end_sliders_band,
                                   slider_normals_band,
                                   slider_energies_band,
                                   sum_squares_band,
                                   project_springs,
                                   descend_all,
                                   {spring_scales<false>, spring_scales<true>},
                                   {inverse_roots<false>, inverse_roots<true>}};

}  // namespace
}  // namespace cloth::kernels
