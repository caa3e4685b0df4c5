#include "kernels/grid_sweep.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "cloth/grid.h"
#include "cloth/sums.h"
#include "kernels/instruction_set.h"
#include "kernels/slider_grid.h"

namespace cloth {
namespace {

using kernels::BandField;
using kernels::Grid;
using kernels::Pass;
using kernels::RowBlock;

/// A band repeats up to two rows of the one above, Runge-Kutta's up to eight on either side.
constexpr int fewest_rows = 12;
static_assert(fewest_rows >= kernels::runge_kutta_halo);

constexpr std::size_t components = 3, sides = 2;

/// Doubles that so many rows of a field take.
std::size_t rows_size(int rows, int columns) {
  return components * static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

/// The rows that lie from `at` on, one component after the other.
RowBlock copied_rows(double* at, int first, int rows, int columns) {
  const std::size_t run = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  return {at, at + run, at + 2 * run, first};
}

void copy_rows(const Vec3Field& from, int rows, int columns, const RowBlock& to) {
  const auto begin = static_cast<std::size_t>(to.first) * static_cast<std::size_t>(columns);
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  std::copy_n(from.x() + begin, count, to.x);
  std::copy_n(from.y() + begin, count, to.y);
  std::copy_n(from.z() + begin, count, to.z);
}

}  // namespace

GridSweep::GridSweep(const ClothSystem& system, const Grid& grid, std::optional<double> mass)
    : SpringSweep(mass), system_(&system), grid_(grid), kernels_(&active_kernels<kernels::GridKernels>()) {}

GridSweep::GridSweep(const ClothSystem& system, CellLayout layout)
    : SpringSweep(layout.mass),
      system_(&system),
      grid_(layout.grid),
      layout_(std::move(layout)),
      kernels_(&active_kernels<kernels::GridKernels>()) {}

int GridSweep::threads() const {
  return std::clamp(std::min(grid_.rows * grid_.columns / fewest_particles, grid_.rows / fewest_rows), 1,
                    team_size());
}

void GridSweep::make_room(const Plan& plan, std::size_t passes, std::size_t bands) {
  const auto rows = static_cast<std::size_t>(grid_.rows);
  const auto pitch = static_cast<std::size_t>(kernels::pitch_of(grid_.columns));
  const int air_rows = plan.loads.air.acts() ? plan.evaluations * kernels::air_scratch_rows : 0;
  const int slider_rows = plan.loads.sliders ? plan.evaluations * kernels::slider_scratch_rows : 0;
  const std::size_t scratch = static_cast<std::size_t>(plan.scratch_rows + air_rows + slider_rows) * pitch;
  std::size_t edges = 0;
  for (const Attached& attached : plan.fields) edges += sides * rows_size(attached.halo_rows, grid_.columns);
  if (bands == 1) edges = 0;
  const std::size_t sums = passes * static_cast<std::size_t>(plan.sums) * rows;
  if (sums_.size() < sums) sums_.resize(sums);
  while (bands_.size() > bands) bands_.pop_back();
  while (bands_.size() < bands) bands_.emplace_back();
  for (Band& band : bands_) {
    if (band.scratch.size() < scratch) band.scratch.resize(scratch);
    for (AlignedDoubles& turn : band.edges)
      if (turn.size() < edges) turn.resize(edges);
  }
}

/// By the thread that will step the band: what another core has written takes long to come.
void GridSweep::prepare(const Plan& plan, std::size_t index) {
  Band& band = bands_[index];
  const auto first_row = [&](std::size_t b) {
    return static_cast<int>(static_cast<std::size_t>(grid_.rows) * b / bands_.size());
  };
  Pass& pass = band.pass;
  pass = Pass{};
  pass.grid = grid_;
  pass.first = first_row(index), pass.last = first_row(index + 1);
  pass.inverse_mass = system_->inverse_mass.data();
  if (const Vec3Field* load = plan.loads.load)
    pass.load[0] = load->x(), pass.load[1] = load->y(), pass.load[2] = load->z();
  for (int axis = 0; axis < 3; ++axis) pass.weight[axis] = plan.loads.weight[axis];
  pass.damping = plan.loads.damping;
  pass.has_dampers = plan.loads.has_dampers();
  for (int k = 0; k < kernels::spring_kinds; ++k)
    pass.spring_damping[k] = plan.loads.spring_damping + plan.loads.stretch_time * grid_.kind[k].stiffness;
  pass.bending_time = plan.loads.bending_time;
  if (has_shares()) pass.shares = layout_.shares();
  if (plan.loads.sliders) pass.sliders = plan.loads.sliders->pass();
  if (const SweptAir& air = plan.loads.air; air.acts()) {
    pass.has_air = true;
    pass.air_drag = air.drag, pass.air_friction = air.friction;
    for (int k = 0; k < plan.evaluations; ++k)
      for (int axis = 0; axis < 3; ++axis) pass.wind[k][axis] = air.wind[static_cast<std::size_t>(k)][axis];
  }
  pass.mass_of_free = has_common_mass() ? mass() : 1;
  pass.step = plan.step;
  pass.drift_first = plan.drift_first;
  pass.gain = plan.update.gain, pass.held = plan.update.held;
  pass.scratch = band.scratch.data();
  for (const Attached& attached : plan.fields) {
    if (!attached.values) continue;
    const RowBlock all{attached.values->x(), attached.values->y(), attached.values->z(), 0};
    pass.*attached.field = {all, all, all};
  }
}

/// Leaves the rows at the band's edges for the bands beside it, before `pass`.
void GridSweep::publish(const Plan& plan, std::size_t index, std::size_t pass) {
  Band& band = bands_[index];
  double* to = band.edges[pass % 2].data();
  const int columns = grid_.columns;
  for (const Attached& attached : plan.fields) {
    const int rows = attached.halo_rows;
    if (!attached.values || rows == 0) continue;
    const RowBlock upper = copied_rows(to, band.pass.first, rows, columns);
    const RowBlock lower = copied_rows(to + rows_size(rows, columns), band.pass.last - rows, rows, columns);
    if (index > 0) copy_rows(*attached.values, rows, columns, upper);
    if (index + 1 < bands_.size()) copy_rows(*attached.values, rows, columns, lower);
    to += sides * rows_size(rows, columns);
  }
  band.published.reach(static_cast<int>(pass) + 1);
}

/// Lets the band see what the bands beside it have left for it. By then these have made the pass before, so
/// that the place where the band will leave its own edges next is free.
void GridSweep::await_neighbours(const Plan& plan, std::size_t index, std::size_t pass) {
  Band& band = bands_[index];
  Band* above = index > 0 ? &bands_[index - 1] : nullptr;
  Band* below = index + 1 < bands_.size() ? &bands_[index + 1] : nullptr;
  for (const Band* other : {above, below})
    if (other) other->published.await(static_cast<int>(pass) + 1);
  const auto edge = [&](Band& of, std::size_t at, int first, int rows) {
    return copied_rows(of.edges[pass % 2].data() + at, first, rows, grid_.columns);
  };
  std::size_t upper = 0;  // where a field's upper edge begins; its lower one follows
  for (const Attached& attached : plan.fields) {
    const int rows = attached.halo_rows;
    if (!attached.values || rows == 0) continue;
    const std::size_t lower = upper + rows_size(rows, grid_.columns);
    BandField& field = band.pass.*attached.field;
    if (above) field.above = edge(*above, lower, band.pass.first - rows, rows);
    if (below) field.below = edge(*below, upper, band.pass.last, rows);
    upper = lower + rows_size(rows, grid_.columns);
  }
}

void GridSweep::run(const Plan& plan, std::size_t passes, int threads) {
  make_room(plan, passes, static_cast<std::size_t>(threads));
  for (Band& band : bands_) band.published.begin();
  if (threads == 1)
    step_band(plan, 0, passes);
  else
    team()->run(threads, [&](int share) { step_band(plan, static_cast<std::size_t>(share), passes); });
}

/// All passes, one thread a band: between two of them it waits only for the bands beside it.
void GridSweep::step_band(const Plan& plan, std::size_t index, std::size_t passes) {
  prepare(plan, index);
  Band& band = bands_[index];
  const bool has_edges = bands_.size() > 1 && plan.has_edges();
  if (has_edges && !plan.opening) publish(plan, index, 0);
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const bool is_first = pass == 0, is_last = pass + 1 == passes;
    if (has_edges && !(is_first && plan.opening)) await_neighbours(plan, index, pass);
    band.pass.sums = sums_.data() + pass * static_cast<std::size_t>(plan.sums * grid_.rows);
    const Kernel kernel = is_first && plan.opening  ? plan.opening
                          : is_last && plan.closing ? plan.closing
                                                    : plan.kernel;
    kernel(band.pass);
    if (has_edges && !is_last) publish(plan, index, pass + 1);
  }
}

double GridSweep::sum_of(const Plan& plan, std::size_t pass, int which) const {
  const auto rows = static_cast<std::size_t>(grid_.rows);
  const std::size_t first =
      (pass * static_cast<std::size_t>(plan.sums) + static_cast<std::size_t>(which)) * rows;
  return ordered_sum(rows, [p = sums_.data() + first](std::size_t row) { return p[row]; });
}

StepSums GridSweep::step_sums_of(const Plan& plan, std::size_t pass) const {
  StepSums sums{sum_of(plan, pass, kernels::squares_before), sum_of(plan, pass, kernels::squares_after)};
  if (plan.loads.has_dampers()) sums.dampers = sum_of(plan, pass, kernels::dampers_before);
  if (plan.loads.air.acts()) sums.air = sum_of(plan, pass, kernels::air_before);
  return sums;
}

void GridSweep::euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
                      ClothState& state) {
  assert(has_common_mass() && (!loads.load || sums.size() == 1));
  const int velocity_halo = loads.has_dampers() ? kernels::step_halo : 0;
  const Plan plan{.kernel = kernels_->euler,
                  .loads = loads,
                  .step = step,
                  .drift_first = drift_first,
                  .fields = {{{&Pass::position, &state.position, kernels::step_halo},
                              {&Pass::velocity, &state.velocity, velocity_halo}}}};
  in_jobs(kind_of(sums.size()), sums.size(), [&](std::size_t first, std::size_t count, int threads) {
    run(plan, count, threads);
    for (std::size_t k = 0; k < count; ++k) sums[first + k] = step_sums_of(plan, k);
  });
}

double GridSweep::verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load && !loads.has_dampers());
  const Plan plan{.kernel = kernels_->verlet,
                  .loads = loads,
                  .step = step,
                  .fields = {{{&Pass::position, &state.position, kernels::step_halo},
                              {&Pass::velocity, &state.velocity, kernels::step_halo},
                              {&Pass::force, &force, kernels::step_halo}}}};
  run_once(PassKind::step, plan);
  return sum_of(plan, 0, kernels::squares_after);
}

void GridSweep::verlet_steps(double step, const SweepLoads& loads, std::span<double> squares,
                             Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load && !loads.has_dampers());
  const Plan plan{.kernel = kernels_->verlet_between,
                  .opening = kernels_->verlet_open,
                  .closing = kernels_->verlet_close,
                  .loads = loads,
                  .step = step,
                  .fields = {{{&Pass::position, &state.position, kernels::step_halo},
                              {&Pass::velocity, &state.velocity, 0},
                              {&Pass::force, &force, 0}}}};
  in_jobs(PassKind::several_steps, squares.size(), [&](std::size_t first, std::size_t count, int threads) {
    run(plan, count + 1, threads);
    for (std::size_t k = 0; k < count; ++k) squares[first + k] = sum_of(plan, k + 1, kernels::squares_after);
  });
}

StepSums GridSweep::predicted(double step, const VelocityUpdate& update, const SweepLoads& loads,
                              Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load);
  const Plan plan{.kernel = kernels_->predicted,
                  .loads = loads,
                  .step = step,
                  .update = update,
                  .fields = {{{&Pass::position, &state.position, kernels::step_halo},
                              {&Pass::velocity, &state.velocity, kernels::step_halo},
                              {&Pass::force, &force, kernels::step_halo}}}};
  run_once(PassKind::step, plan);
  return step_sums_of(plan, 0);
}

void GridSweep::predicted_open(double step, const VelocityUpdate& update, const SweepLoads& loads,
                               Vec3Field& force, ClothState& state) {
  const Plan plan{.kernel = kernels_->predicted_open,
                  .loads = loads,
                  .step = step,
                  .update = update,
                  .fields = {{{&Pass::position, &state.position, 0},
                              {&Pass::velocity, &state.velocity, 0},
                              {&Pass::force, &force, 0}}}};
  run_once(PassKind::drift, plan);
}

StepSums GridSweep::predicted_close(double step, const VelocityUpdate& update, const SweepLoads& loads,
                                    Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load);
  const int velocity_halo = loads.has_dampers() ? kernels::step_halo : 0;
  const Plan plan{.kernel = kernels_->predicted_close,
                  .loads = loads,
                  .step = step,
                  .update = update,
                  .fields = {{{&Pass::position, &state.position, 0},  // only read
                              {&Pass::velocity, &state.velocity, velocity_halo},
                              {&Pass::force, &force, 0}}}};
  run_once(PassKind::closing, plan);
  return step_sums_of(plan, 0);
}

void GridSweep::runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                            ClothState& state) {
  assert(has_common_mass() && !loads.load);
  const Plan plan{.kernel = kernels_->runge_kutta,
                  .loads = loads,
                  .step = step,
                  .fields = {{{&Pass::position, &state.position, kernels::runge_kutta_halo},
                              {&Pass::velocity, &state.velocity, kernels::runge_kutta_halo}}},
                  .sums = kernels::stage_sums,
                  .scratch_rows = kernels::runge_kutta_scratch_rows,
                  .evaluations = 4};
  in_jobs(kind_of(sums.size()), sums.size(), [&](std::size_t first, std::size_t count, int threads) {
    run(plan, count, threads);
    for (std::size_t k = 0; k < count; ++k) {
      StageSums& of_step = sums[first + k];
      for (int stage = 0; stage < 4; ++stage) {
        const auto s = static_cast<std::size_t>(stage);
        of_step.squares[s] = sum_of(plan, k, kernels::stage_squares + stage);
        of_step.dampers[s] = loads.has_dampers() ? sum_of(plan, k, kernels::stage_dampers + stage) : 0;
        of_step.air[s] = loads.air.acts() ? sum_of(plan, k, kernels::stage_air + stage) : 0;
      }
      of_step.after = sum_of(plan, k, kernels::squares_of_result);
    }
  });
}

void GridSweep::evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) {
  run_once(PassKind::evaluation,
           {.kernel = kernels_->evaluate,
            .loads = loads,
            .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0},  // only read
                        {&Pass::force, &force, 0}}}});
}

double GridSweep::damp(const SweepLoads& dampers, const Vec3Field& position, const Vec3Field& velocity,
                       Vec3Field& product) {
  const Plan plan{.kernel = kernels_->damp,
                  .loads = dampers,
                  .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0},  // only read
                              {&Pass::velocity, const_cast<Vec3Field*>(&velocity), 0},  // only read
                              {&Pass::force, &product, 0}}}};
  run_once(PassKind::dampers, plan);
  return sum_of(plan, 0, kernels::dampers_before);
}

double GridSweep::end_sliders(SliderGrid& sliders, const Vec3Field& position, Vec3Field* force) {
  const SweepLoads loads{.sliders = &sliders};
  const Plan plan{.kernel = kernels_->end_sliders,
                  .loads = loads,
                  .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0},  // only read
                              {&Pass::force, force, 0}}},
                  .sums = kernels::slider_sums,
                  .scratch_rows = kernels::slider_end_scratch_rows};
  run_once(PassKind::sliders, plan);
  sliders.take_next();
  return sum_of(plan, 0, kernels::energy_of_sliders);
}

void GridSweep::take_slider_normals(SliderGrid& sliders, const Vec3Field& position) {
  const SweepLoads loads{.sliders = &sliders};
  run_once(PassKind::sums,
           {.kernel = kernels_->slider_normals,
            .loads = loads,
            .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0}}}});  // only read
  sliders.take_next_normals();
}

double GridSweep::slider_energy(SliderGrid& sliders, const Vec3Field& position) {
  const SweepLoads loads{.sliders = &sliders};
  const Plan plan{.kernel = kernels_->slider_energies,
                  .loads = loads,
                  .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0}}},  // only read
                  .sums = kernels::slider_sums};
  run_once(PassKind::sums, plan);
  return sum_of(plan, 0, kernels::energy_of_sliders);
}

double GridSweep::squares(const Vec3Field& velocity) {
  const SweepLoads none;
  const Plan plan{.kernel = kernels_->sum_squares,
                  .loads = none,
                  .fields = {{{&Pass::velocity, const_cast<Vec3Field*>(&velocity), 0}}}};  // only read
  run_once(PassKind::sums, plan);
  return sum_of(plan, 0, kernels::squares_after);
}

bool GridSweep::projects() const {
  return !has_shares() && std::all_of(std::begin(grid_.kind), std::end(grid_.kind),
                                      [](const auto& kind) { return std::isfinite(kind.rest_tension); });
}

void GridSweep::begin_projections(const std::vector<double>& mobility) {
  const auto rows = static_cast<std::size_t>(grid_.rows), columns = static_cast<std::size_t>(grid_.columns);
  mobility_ = mobility.data();
  common_mobility_ = *std::max_element(mobility.begin(), mobility.end());
  is_alike_.resize(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double* of_row = mobility_ + row * columns;
    is_alike_[row] =
        std::all_of(of_row, of_row + columns, [&](double one) { return one == common_mobility_; });
  }
}

double GridSweep::project(double step, double spring_damping, const Vec3Field& position,
                          Vec3Field& velocity) {
  kernels::Projection projection{
      .grid = grid_,
      // The kernels have one type of block, for what they read and what they write.
      .position = {const_cast<double*>(position.x()), const_cast<double*>(position.y()),
                   const_cast<double*>(position.z())},
      .velocity = {velocity.x(), velocity.y(), velocity.z()},
      .mobility = mobility_,
      .is_alike = is_alike_.data(),
      .common_mobility = common_mobility_,
      .spring_damping = spring_damping,
      .step = step};
  kernels_->project(projection);
  return projection.largest_change;
}

}  // namespace cloth
