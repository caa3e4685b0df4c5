#include "kernels/grid_sweep.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "cloth/grid.h"
#include "cloth/sums.h"

namespace cloth {
namespace {

using kernels::BandField;
using kernels::Grid;
using kernels::Pass;
using kernels::RowBlock;

/// Bits of kernels::SpringBit in the order of spring_directions().
constexpr std::array direction_bits{kernels::right_one,    kernels::down_one,  kernels::diagonal,
                                    kernels::antidiagonal, kernels::right_two, kernels::down_two};

/// Takes the runs of one direction from `runs` on, as make_grid writes them. Returns how many there were.
std::size_t take_direction(const ClothSystem& system, const SpringDirection& direction, std::size_t at,
                           kernels::SpringKind& kind) {
  const int rows = system.rows - direction.rows, columns = system.columns - std::abs(direction.columns);
  if (rows <= 0 || columns <= 0) return 0;
  const bool one_run = direction.columns == 0;
  const std::size_t count = one_run ? 1 : static_cast<std::size_t>(rows);
  if (at + count > system.springs.size()) return 0;
  const SpringRun& first = system.springs[at];
  for (std::size_t k = 0; k < count; ++k) {
    SpringRun expected = first;
    expected.family = direction.family;
    expected.first = system.index(static_cast<int>(k), std::max(0, -direction.columns));
    expected.count = one_run ? rows * columns : columns;
    expected.offset = direction.rows * system.columns + direction.columns;
    if (!(system.springs[at + k] == expected)) return 0;
  }
  kind = {first.stiffness, first.stiffness * first.rest_length};
  return count;
}

/// A band repeats up to two rows of the one above.
constexpr int fewest_rows = 12;

/// Doubles that the copies of a field's rows on both sides of a band take.
std::size_t halo_size(int rows, std::size_t columns) {
  constexpr std::size_t components = 3, sides = 2;
  return sides * static_cast<std::size_t>(rows) * components * columns;
}

}  // namespace

std::optional<Grid> recognise_grid(const ClothSystem& system) {
  Grid grid;
  grid.rows = system.rows, grid.columns = system.columns;
  std::array<bool, 3> present{}, absent{};  // some direction of a family that could be there
  std::size_t at = 0;
  for (std::size_t d = 0; d < direction_bits.size(); ++d) {
    const SpringDirection& direction = spring_directions()[d];
    if (system.rows <= direction.rows || system.columns <= std::abs(direction.columns)) continue;
    kernels::SpringKind kind;
    const std::size_t taken = take_direction(system, direction, at, kind);
    const auto family = static_cast<std::size_t>(direction.family);
    (taken > 0 ? present : absent)[family] = true;
    if (taken == 0) continue;
    at += taken;
    grid.kind[__builtin_ctz(direction_bits[d])] = kind;
  }
  if (at != system.springs.size() || at == 0) return std::nullopt;
  constexpr std::array families{kernels::structural_springs, kernels::shear_springs,
                                kernels::flexion_springs};
  for (std::size_t f = 0; f < families.size(); ++f) {
    if (present[f] && absent[f]) return std::nullopt;
    if (present[f]) grid.springs |= families[f];
  }
  return grid;
}

const kernels::GridKernels& grid_kernels(InstructionSet set) {
  switch (set) {
#ifdef CLOTHLAB_X86_KERNELS
    case InstructionSet::sse2:
      return kernels::sse2_grid_kernels();
    case InstructionSet::avx2:
      return kernels::avx2_grid_kernels();
    case InstructionSet::avx512:
      return kernels::avx512_grid_kernels();
#endif
    default:
      return kernels::portable_grid_kernels();
  }
}

GridSweep::GridSweep(const ClothSystem& system, const Grid& grid, std::optional<double> mass)
    : SpringSweep(mass), system_(&system), grid_(grid), kernels_(&grid_kernels(active_instruction_set())) {}

int GridSweep::threads() const {
  return std::clamp(std::min(grid_.rows * grid_.columns / fewest_particles, grid_.rows / fewest_rows), 1,
                    team_size());
}

void GridSweep::make_room(const Plan& plan, std::size_t bands) {
  const auto rows = static_cast<std::size_t>(grid_.rows), columns = static_cast<std::size_t>(grid_.columns);
  const auto pitch = static_cast<std::size_t>(kernels::pitch_of(grid_.columns));
  const std::size_t scratch = static_cast<std::size_t>(plan.scratch_rows) * pitch;
  std::size_t halo = 0;
  for (const Attached& attached : plan.fields) halo += halo_size(attached.halo_rows, columns);
  if (bands == 1) halo = 0;
  squares_.resize(kernels::runge_kutta_sums * rows);
  bands_.resize(bands);
  for (Band& band : bands_) {
    if (band.scratch.size() < scratch) band.scratch.resize(scratch);
    if (band.halo.size() < halo) band.halo.resize(halo);
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
  pass.mass_of_free = has_common_mass() ? mass() : 1;
  pass.step = plan.step;
  pass.drift_first = plan.drift_first;
  pass.scratch = band.scratch.data();
  pass.squares = squares_.data();
  double* halo = band.halo.data();
  for (const Attached& attached : plan.fields) {
    if (!attached.values) continue;
    pass.*attached.field = with_copies(attached, pass, halo);
    halo += halo_size(attached.halo_rows, static_cast<std::size_t>(grid_.columns));
  }
}

/// The field as the band sees it; copies of the rows around the band's own lie from `to` on.
BandField GridSweep::with_copies(const Attached& attached, const Pass& pass, double* to) const {
  const Vec3Field& values = *attached.values;
  const RowBlock all{attached.values->x(), attached.values->y(), attached.values->z(), 0};
  if (bands_.size() == 1 || attached.halo_rows == 0) return {all, all, all};
  const auto columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t run = static_cast<std::size_t>(attached.halo_rows) * columns;
  const auto copy = [&](int first, int last) {
    const RowBlock block{to, to + run, to + 2 * run, first};
    const auto begin = static_cast<std::size_t>(first) * columns;
    const std::size_t count = static_cast<std::size_t>(last - first) * columns;
    std::copy_n(values.x() + begin, count, block.x);
    std::copy_n(values.y() + begin, count, block.y);
    std::copy_n(values.z() + begin, count, block.z);
    to += 3 * run;
    return block;
  };
  const RowBlock above = copy(std::max(0, pass.first - attached.halo_rows), pass.first);
  const RowBlock below = copy(pass.last, std::min(grid_.rows, pass.last + attached.halo_rows));
  return {all, above, below};
}

void GridSweep::run(const Plan& plan) {
  const int count = begin_pass(plan.kind);
  make_room(plan, static_cast<std::size_t>(count));
  if (count == 1) {
    prepare(plan, 0);
    plan.kernel(bands_.front().pass);
  } else {
    team()->run(count, [this, &plan](int b) {
      prepare(plan, static_cast<std::size_t>(b));
      team()->meet();  // nobody steps a row before its neighbours have it
      plan.kernel(bands_[static_cast<std::size_t>(b)].pass);
    });
  }
  end_pass(plan.kind);
}

double GridSweep::sum_of(int which) const {
  const auto rows = static_cast<std::size_t>(grid_.rows);
  return ordered_sum(rows, [p = squares_.data() + static_cast<std::size_t>(which) * rows](std::size_t row) {
    return p[row];
  });
}

SpringSweep::Squares GridSweep::euler(double step, bool drift_first, const SweepLoads& loads,
                                      ClothState& state) {
  assert(has_common_mass());
  run({.kind = PassKind::step,
       .kernel = kernels_->euler,
       .loads = loads,
       .step = step,
       .drift_first = drift_first,
       .fields = {{{&Pass::position, &state.position, kernels::euler_halo},
                   {&Pass::velocity, &state.velocity, 0}}}});
  return {sum_of(0), sum_of(1)};
}

SpringSweep::Squares GridSweep::verlet(double step, const SweepLoads& loads, Vec3Field& force,
                                       ClothState& state) {
  assert(has_common_mass() && !loads.load);
  run({.kind = PassKind::step,
       .kernel = kernels_->verlet,
       .loads = loads,
       .step = step,
       .fields = {{{&Pass::position, &state.position, kernels::euler_halo},
                   {&Pass::velocity, &state.velocity, kernels::euler_halo},
                   {&Pass::force, &force, kernels::euler_halo}}}});
  return {0, sum_of(1)};
}

void GridSweep::verlet_steps(double step, const SweepLoads& loads, std::span<double> squares,
                             Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load);
  const auto pass = [&](PassKind kind, Kernel kernel) {
    run({.kind = kind,
         .kernel = kernel,
         .loads = loads,
         .step = step,
         .fields = {{{&Pass::position, &state.position, kernels::euler_halo},
                     {&Pass::velocity, &state.velocity, 0},
                     {&Pass::force, &force, 0}}}});
  };
  pass(PassKind::opening, kernels_->verlet_open);
  for (std::size_t k = 0; k + 1 < squares.size(); ++k) {
    pass(PassKind::between, kernels_->verlet_between);
    squares[k] = sum_of(1);
  }
  pass(PassKind::closing, kernels_->verlet_close);
  squares.back() = sum_of(1);
}

std::array<double, 5> GridSweep::runge_kutta(double step, const SweepLoads& loads, ClothState& state) {
  assert(has_common_mass() && !loads.load);
  run({.kind = PassKind::step,
       .kernel = kernels_->runge_kutta,
       .loads = loads,
       .step = step,
       .fields = {{{&Pass::position, &state.position, kernels::runge_kutta_halo},
                   {&Pass::velocity, &state.velocity, kernels::runge_kutta_halo}}},
       .scratch_rows = kernels::runge_kutta_scratch_rows});
  return {sum_of(0), sum_of(1), sum_of(2), sum_of(3), sum_of(4)};
}

void GridSweep::evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) {
  run({.kind = PassKind::evaluation,
       .kernel = kernels_->evaluate,
       .loads = loads,
       .fields = {{{&Pass::position, const_cast<Vec3Field*>(&position), 0},  // only read
                   {&Pass::force, &force, 0}}}});
}

double GridSweep::squares(const Vec3Field& velocity) {
  run({.kind = PassKind::sums,
       .kernel = kernels_->sum_squares,
       .loads = {},
       .fields = {{{&Pass::velocity, const_cast<Vec3Field*>(&velocity), 0}}}});  // only read
  return sum_of(1);
}

}  // namespace cloth
