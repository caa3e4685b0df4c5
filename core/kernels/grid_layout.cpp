#include "kernels/grid_layout.h"

#include <algorithm>

#include "cloth/grid.h"

namespace cloth {
namespace {

using kernels::Grid;

/// Bits of kernels::SpringBit in the order of spring_directions().
constexpr std::array direction_bits{kernels::right_one,    kernels::down_one,  kernels::diagonal,
                                    kernels::antidiagonal, kernels::right_two, kernels::down_two};

double share_at_border(int index, int count) {
  return index == 0 || index == count - 1 ? 0.5 : 1;
}

/// Takes the springs of a system one by one and holds each against what its place in the grid asks.
class CellSpringCheck {
 public:
  explicit CellSpringCheck(const ClothSystem& system) : system_(system) {
    grid_.rows = system.rows, grid_.columns = system.columns;
  }

  /// The springs of all directions; nothing where one is not as it has to be.
  std::optional<Grid> springs() {
    std::array<std::int64_t, kernels::spring_kinds> count{};
    bool holds = true;
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t) {
      const unsigned bit = direction_of(static_cast<int>(i), run.offset);
      if (bit == 0 || !holds) return void(holds = false);
      const auto kind = static_cast<std::size_t>(__builtin_ctz(bit));
      const double whole = run.stiffness / share_of(bit, static_cast<int>(i));
      kernels::SpringKind& known = grid_.kind[kind];
      if (count[kind]++ == 0) known = {whole, whole * run.rest_length};
      holds = known.stiffness == whole && known.rest_tension == whole * run.rest_length;
      grid_.springs |= bit;
    });
    const std::int64_t rows = system_.rows, columns = system_.columns;
    const auto is_all_or_nothing = [&](unsigned bit, std::int64_t all) {
      const std::int64_t found = count[static_cast<std::size_t>(__builtin_ctz(bit))];
      return found == 0 || found == all;
    };
    holds = holds && is_all_or_nothing(kernels::right_one, rows * (columns - 1)) &&
            is_all_or_nothing(kernels::down_one, (rows - 1) * columns) &&
            is_all_or_nothing(kernels::diagonal, (rows - 1) * (columns - 1)) &&
            is_all_or_nothing(kernels::antidiagonal, (rows - 1) * (columns - 1));
    return holds ? std::optional(grid_) : std::nullopt;
  }

 private:
  /// 0: none that such a grid has. An antidiagonal begins at the right.
  unsigned direction_of(int i, int offset) const {
    const int column = i % system_.columns;
    if (offset == 1 && column + 1 < system_.columns) return kernels::right_one;
    if (offset == system_.columns) return kernels::down_one;
    if (offset == system_.columns + 1 && column + 1 < system_.columns) return kernels::diagonal;
    if (offset == system_.columns - 1 && column > 0) return kernels::antidiagonal;
    return 0;
  }
  double share_of(unsigned bit, int i) const {
    if (bit == kernels::right_one) return share_at_border(i / system_.columns, system_.rows);
    if (bit == kernels::down_one) return share_at_border(i % system_.columns, system_.columns);
    return 1;
  }

  const ClothSystem& system_;
  Grid grid_;
};

/// kg; nothing where a particle's mass is not its share.
std::optional<double> mass_of_cell(const ClothSystem& system) {
  const double whole = system.mass[0] * 4;
  for (int row = 0; row < system.rows; ++row)
    for (int column = 0; column < system.columns; ++column) {
      const auto i = static_cast<std::size_t>(system.index(row, column));
      const double mass = whole * share_at_border(row, system.rows) * share_at_border(column, system.columns);
      if (system.mass[i] != mass || (system.inverse_mass[i] != 0 && system.inverse_mass[i] != 1 / mass))
        return std::nullopt;
    }
  return whole;
}

/// Where a run of elements goes; null where the kernels have none like it.
std::vector<double>* place_of(const BendingRun& run, int columns, CellLayout& layout) {
  using Offsets = std::array<int, BendingRun::most_points>;
  using Coefficients = std::array<double, BendingRun::most_points>;
  if (run.points == 4)
    return run.offset == Offsets{0, 1, columns, columns + 1} && run.coefficient == Coefficients{1, -1, -1, 1}
               ? &layout.twist
               : nullptr;
  if (run.coefficient != Coefficients{1, -2, 1}) return nullptr;
  if (run.offset == Offsets{0, 1, 2}) return &layout.across;
  return run.offset == Offsets{0, columns, 2 * columns} ? &layout.down : nullptr;
}

/// False where an element is not one that begins in this row and column and lies in the grid, or comes twice.
bool lay_out_bending(const ClothSystem& system, CellLayout& layout) {
  if (system.bending.empty()) return true;
  for (std::vector<double>* place : {&layout.across, &layout.down, &layout.twist})
    place->assign(static_cast<std::size_t>(system.size()), 0);
  for (const BendingRun& run : system.bending) {
    std::vector<double>* place = place_of(run, system.columns, layout);
    if (!place) return false;
    const int reach = place == &layout.across ? 2 : place == &layout.twist ? 1 : 0;
    for (int e = run.first; e < run.first + run.count; ++e) {
      double& stiffness = (*place)[static_cast<std::size_t>(e)];
      if (stiffness != 0 || e % system.columns + reach >= system.columns) return false;
      stiffness = run.stiffness;
    }
  }
  return true;
}

}  // namespace

std::optional<Grid> grid_springs(const ClothSystem& system) {
  constexpr std::array families{kernels::structural_springs, kernels::shear_springs,
                                kernels::flexion_springs};
  Grid grid;
  grid.rows = system.rows, grid.columns = system.columns;
  std::array<bool, families.size()> absent{};  // a direction of the family that could be there
  const std::vector<SpringBlock>& blocks = system.springs.blocks();
  std::size_t at = 0;
  for (std::size_t d = 0; d < direction_bits.size(); ++d) {
    const SpringRun* run = at < blocks.size() ? &blocks[at].run : nullptr;
    const SpringBlock expected =
        direction_block(system, spring_directions()[d], run ? run->rest_length : 0, run ? run->stiffness : 0);
    if (expected.rows == 0) continue;
    const auto family = static_cast<std::size_t>(spring_directions()[d].family);
    if (!run || !(blocks[at] == expected)) {
      absent[family] = true;
      continue;
    }
    grid.springs |= families[family];
    grid.kind[__builtin_ctz(direction_bits[d])] = {run->stiffness, run->stiffness * run->rest_length};
    ++at;
  }
  if (at != blocks.size() || at == 0) return std::nullopt;
  for (std::size_t f = 0; f < families.size(); ++f)
    if (absent[f] && (grid.springs & families[f])) return std::nullopt;
  return grid;
}

kernels::CellShares CellLayout::shares() const {
  const auto data = [](const std::vector<double>& values) {
    return values.empty() ? nullptr : values.data();
  };
  return {part.data(), data(across), data(down), data(twist)};
}

std::optional<CellLayout> cell_layout(const ClothSystem& system) {
  if (system.is_mesh() || system.rows < 2 || system.columns < 2) return std::nullopt;
  CellLayout layout;
  const auto mass = mass_of_cell(system);
  const auto grid = CellSpringCheck(system).springs();
  if (!mass || !grid || !lay_out_bending(system, layout)) return std::nullopt;
  layout.mass = *mass, layout.grid = *grid;
  layout.part.assign(static_cast<std::size_t>(kernels::pitch_of(system.columns)), 1);
  layout.part[0] = layout.part[static_cast<std::size_t>(system.columns - 1)] = 0.5;
  return layout;
}

}  // namespace cloth
