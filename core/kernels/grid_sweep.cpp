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

/// With fewer particles for each thread the others need not be tried: waking them takes as long as the pass.
constexpr int fewest_particles = 1000;
/// A band repeats up to two rows of the one above.
constexpr int fewest_rows = 12;

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

/// Makes a pass for every band, without its fields.
void GridSweep::share_rows(PassKind kind, int halo_rows, int scratch_rows, const SweepLoads& loads,
                           double step) {
  const int count = begin_pass(kind);
  const auto rows = static_cast<std::size_t>(grid_.rows), pitch = static_cast<std::size_t>(grid_.columns);
  const std::size_t scratch =
      static_cast<std::size_t>(scratch_rows) * static_cast<std::size_t>(kernels::pitch_of(grid_.columns));
  constexpr std::size_t halo_fields = 3, components = 3, sides = 2;
  const std::size_t halo =
      count > 1 ? halo_fields * sides * static_cast<std::size_t>(halo_rows) * components * pitch : 0;
  squares_.resize(kernels::runge_kutta_sums * rows);
  bands_.resize(static_cast<std::size_t>(count));
  for (int b = 0; b < count; ++b) {
    Band& band = bands_[static_cast<std::size_t>(b)];
    if (band.scratch.size() < scratch) band.scratch.resize(scratch);
    if (band.halo.size() < halo) band.halo.resize(halo);
    band.copies.clear();
    Pass& pass = band.pass;
    pass = Pass{};
    pass.grid = grid_;
    pass.first = static_cast<int>(static_cast<long>(grid_.rows) * b / count);
    pass.last = static_cast<int>(static_cast<long>(grid_.rows) * (b + 1) / count);
    pass.inverse_mass = system_->inverse_mass.data();
    if (loads.load)
      pass.load[0] = loads.load->x(), pass.load[1] = loads.load->y(), pass.load[2] = loads.load->z();
    for (int axis = 0; axis < 3; ++axis) pass.weight[axis] = loads.weight[axis];
    pass.damping = loads.damping;
    pass.mass_of_free = has_common_mass() ? mass() : 1;
    pass.step = step;
    pass.scratch = band.scratch.data();
    pass.squares = squares_.data();
  }
}

/// A field of which a band writes its own rows only and reads no others, or which nobody writes.
void GridSweep::attach(BandField Pass::*field, Vec3Field& values) {
  const RowBlock all{values.x(), values.y(), values.z(), 0};
  for (Band& band : bands_) band.pass.*field = {all, all, all};
}

/// A field that is stepped in place: what a band needs of its neighbours' rows is copied beforehand, by the
/// thread that will need it, since rows that another core has written take long to come.
void GridSweep::attach_with_copies(BandField Pass::*field, Vec3Field& values, int halo_rows, int slot) {
  attach(field, values);
  if (bands_.size() == 1) return;
  const auto columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t run = static_cast<std::size_t>(halo_rows) * columns;
  for (Band& band : bands_) {
    double* to = band.halo.data() + static_cast<std::size_t>(slot) * 6 * run;
    const auto copy = [&](int first, int last) {
      const RowBlock block{to, to + run, to + 2 * run, first};
      const auto begin = static_cast<std::size_t>(first) * columns;
      const std::size_t count = static_cast<std::size_t>(last - first) * columns;
      if (count > 0)
        for (const auto& [from, into] :
             {std::pair{values.x(), block.x}, std::pair{values.y(), block.y}, std::pair{values.z(), block.z}})
          band.copies.push_back({from + begin, into, count});
      to += 3 * run;
      return block;
    };
    Pass& pass = band.pass;
    (pass.*field).above = copy(std::max(0, pass.first - halo_rows), pass.first);
    (pass.*field).below = copy(pass.last, std::min(grid_.rows, pass.last + halo_rows));
  }
}

void GridSweep::run(PassKind kind, Kernel kernel) {
  if (bands_.size() == 1) {
    kernel(bands_.front().pass);
  } else {
    const int count = static_cast<int>(bands_.size());
    team()->run(count, [this](int b) {
      for (const Copy& copy : bands_[static_cast<std::size_t>(b)].copies)
        std::copy_n(copy.from, copy.count, copy.to);
    });
    team()->run(count, [this, kernel](int b) { kernel(bands_[static_cast<std::size_t>(b)].pass); });
  }
  end_pass(kind);
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
  share_rows(PassKind::step, kernels::euler_halo, kernels::euler_scratch_rows, loads, step);
  for (Band& band : bands_) band.pass.drift_first = drift_first;
  attach_with_copies(&Pass::position, state.position, kernels::euler_halo, 0);
  attach(&Pass::velocity, state.velocity);
  run(PassKind::step, kernels_->euler);
  return {sum_of(0), sum_of(1)};
}

SpringSweep::Squares GridSweep::verlet(double step, const SweepLoads& loads, Vec3Field& force,
                                       ClothState& state) {
  assert(has_common_mass() && !loads.load);
  share_rows(PassKind::step, kernels::euler_halo, kernels::euler_scratch_rows, loads, step);
  attach_with_copies(&Pass::position, state.position, kernels::euler_halo, 0);
  attach_with_copies(&Pass::velocity, state.velocity, kernels::euler_halo, 1);
  attach_with_copies(&Pass::force, force, kernels::euler_halo, 2);
  run(PassKind::step, kernels_->verlet);
  return {0, sum_of(1)};
}

void GridSweep::verlet_steps(double step, const SweepLoads& loads, std::span<double> squares,
                             Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load);
  const auto pass = [&](PassKind kind, Kernel kernel) {
    share_rows(kind, kernels::euler_halo, kernels::euler_scratch_rows, loads, step);
    attach_with_copies(&Pass::position, state.position, kernels::euler_halo, 0);
    attach(&Pass::velocity, state.velocity);
    attach(&Pass::force, force);
    run(kind, kernel);
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
  share_rows(PassKind::step, kernels::runge_kutta_halo, kernels::runge_kutta_scratch_rows, loads, step);
  attach_with_copies(&Pass::position, state.position, kernels::runge_kutta_halo, 0);
  attach_with_copies(&Pass::velocity, state.velocity, kernels::runge_kutta_halo, 1);
  run(PassKind::step, kernels_->runge_kutta);
  return {sum_of(0), sum_of(1), sum_of(2), sum_of(3), sum_of(4)};
}

void GridSweep::evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) {
  share_rows(PassKind::evaluation, kernels::euler_halo, kernels::euler_scratch_rows, loads, 0);
  attach(&Pass::position, const_cast<Vec3Field&>(position));  // only read
  attach(&Pass::force, force);
  run(PassKind::evaluation, kernels_->evaluate);
}

double GridSweep::squares(const Vec3Field& velocity) {
  share_rows(PassKind::sums, kernels::euler_halo, kernels::euler_scratch_rows, {}, 0);
  attach(&Pass::velocity, const_cast<Vec3Field&>(velocity));  // only read
  run(PassKind::sums, kernels_->sum_squares);
  return sum_of(1);
}

}  // namespace cloth
