#include "cloth/material_grid.h"

#include <cmath>

#include "cloth/bending_builder.h"
#include "cloth/grid.h"

namespace cloth {
namespace {

double part_at_border(int index, int count) {
  return index == 0 || index == count - 1 ? 0.5 : 1;
}

/// One row of springs that begin at `first`: those of the first and the last are of half the stiffness where
/// `halves_ends`.
void add_row(SpringRuns& springs, SpringRun run, bool halves_ends) {
  if (!(run.stiffness > 0) || run.count <= 0) return;
  if (!halves_ends) return springs.push_back(run);
  const int count = run.count;
  SpringRun end = run;
  end.count = 1;
  end.stiffness = 0.5 * run.stiffness;
  springs.push_back(end);
  if (count > 2) {
    run.first += 1, run.count = count - 2;
    springs.push_back(run);
  }
  end.first += count - 1;
  springs.push_back(end);
}

void add_springs(const GridCell& cell, const CellSprings& k, ClothSystem& system) {
  const int rows = system.rows, columns = system.columns;
  for (int row = 0; row < rows; ++row)
    add_row(system.springs,
            {SpringFamily::structural, system.index(row, 0), columns - 1, 1, cell.across.norm(),
             part_at_border(row, rows) * k.across},
            false);
  for (int row = 0; row + 1 < rows; ++row)
    add_row(system.springs,
            {SpringFamily::structural, system.index(row, 0), columns, columns, cell.down.norm(), k.down},
            true);
  const double diagonal = (cell.across + cell.down).norm();
  for (const SpringDirection& direction : spring_directions())
    if (direction.family == SpringFamily::shear && k.diagonal > 0)
      system.springs.blocks().push_back(direction_block(system, direction, diagonal, k.diagonal));
}

void add_bending(const CellBending& k, ClothSystem& system) {
  const int rows = system.rows, columns = system.columns;
  const auto line = [](int step) {
    return BendingRun{.points = 3, .offset = {0, step, 2 * step}, .coefficient = {1, -2, 1}};
  };
  const BendingRun across = line(1), down = line(columns),
                   twist{.points = 4, .offset = {0, 1, columns, columns + 1}, .coefficient = {1, -1, -1, 1}};
  BendingBuilder builder(system);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column + 2 < columns; ++column)
      builder.add(system.index(row, column), across, part_at_border(row, rows) * k.across);
  for (int row = 0; row + 2 < rows; ++row)
    for (int column = 0; column < columns; ++column)
      builder.add(system.index(row, column), down, part_at_border(column, columns) * k.down);
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column)
      builder.add(system.index(row, column), twist, k.twist);
}

/// 2HB is the width of the loop, so that the moment is up to half of it.
void add_sliders(const Material& m, double across, double down, ClothSystem& system) {
  const int rows = system.rows, columns = system.columns;
  BendingBuilder builder(system);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column + 2 < columns; ++column)
      builder.add_slider(system.index(row, column), system.index(row, column + 1),
                         system.index(row, column + 2), across, part_at_border(row, rows) * across * down,
                         slider_stiffness_ratio * m.bending_weft, 0.5 * m.hysteresis_weft);
  for (int row = 0; row + 2 < rows; ++row)
    for (int column = 0; column < columns; ++column)
      builder.add_slider(system.index(row, column), system.index(row + 1, column),
                         system.index(row + 2, column), down,
                         part_at_border(column, columns) * across * down,
                         slider_stiffness_ratio * m.bending_warp, 0.5 * m.hysteresis_warp);
}

/// A quarter of a cell's mass for each cell that a particle is a corner of.
void give_masses(double of_cell, ClothSystem& system) {
  for (int row = 0; row < system.rows; ++row)
    for (int column = 0; column < system.columns; ++column) {
      const auto i = static_cast<std::size_t>(system.index(row, column));
      system.mass[i] = of_cell * part_at_border(row, system.rows) * part_at_border(column, system.columns);
      system.inverse_mass[i] = system.pinned[i] ? 0 : 1 / system.mass[i];
    }
}

}  // namespace

ClothSystem make_material_grid(const ClothSheet& sheet, const Material& material) {
  ClothSystem system = make_grid(sheet, SpringMaterial{});
  const GridCell cell = cell_of(sheet);
  const double across = cell.across.norm(), down = cell.down.norm();
  give_masses(material.areal_density * across * down, system);
  add_springs(cell, cell_springs(material, across, down), system);
  add_bending(cell_bending(material, across, down), system);
  add_sliders(material, across, down, system);
  return system;
}

}  // namespace cloth
