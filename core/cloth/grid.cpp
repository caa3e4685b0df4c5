#include "cloth/grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace cloth {

SpringBlock direction_block(const ClothSystem& grid, const SpringDirection& direction, double rest_length,
                            double stiffness) {
  const int rows = grid.rows - direction.rows;
  const int columns = grid.columns - std::abs(direction.columns);
  if (rows <= 0 || columns <= 0) return {{}, 0};
  const int offset = direction.rows * grid.columns + direction.columns;
  const int first = std::max(0, -direction.columns);
  SpringRun run{direction.family, first, columns, offset, rest_length, stiffness};
  if (direction.columns != 0) return {run, rows, grid.columns};
  run.count = rows * columns;
  return {run};
}

GridCell cell_of(const ClothSheet& sheet) {
  return {sheet.across.normalized() * (sheet.width / (sheet.columns - 1)),
          sheet.down.normalized() * (sheet.height / (sheet.rows - 1))};
}

const std::array<SpringDirection, 6>& spring_directions() {
  static const std::array<SpringDirection, 6> directions{{{SpringFamily::structural, 0, 1},
                                                          {SpringFamily::structural, 1, 0},
                                                          {SpringFamily::shear, 1, 1},
                                                          {SpringFamily::shear, 1, -1},
                                                          {SpringFamily::flexion, 0, 2},
                                                          {SpringFamily::flexion, 2, 0}}};
  return directions;
}

double stiffness_of(const SpringMaterial& material, SpringFamily family) {
  return std::array{material.structural, material.shear, material.flexion}.at(
      static_cast<std::size_t>(family));
}

void give_particles(const ClothSheet& sheet, ClothSystem& system) {
  const auto size = static_cast<std::size_t>(system.size());
  const double mass = sheet.mass / static_cast<double>(size);
  system.mass.assign(size, mass);
  system.inverse_mass.assign(size, 1 / mass);
  system.pinned.assign(size, 0);
  system.start = Vec3Field(size);
  for (const int particle : pinned_particles(sheet)) {
    system.inverse_mass[static_cast<std::size_t>(particle)] = 0;
    system.pinned[static_cast<std::size_t>(particle)] = 1;
  }
}

ClothSystem make_grid(const ClothSheet& sheet, const SpringMaterial& material) {
  ClothSystem system;
  system.rows = sheet.rows;
  system.columns = sheet.columns;
  give_particles(sheet, system);
  const Vec3 across = sheet.across.normalized(), down = sheet.down.normalized();
  for (int row = 0; row < sheet.rows; ++row)
    for (int column = 0; column < sheet.columns; ++column)
      system.start.set(static_cast<std::size_t>(system.index(row, column)),
                       sheet.origin + across * (column * sheet.width / (sheet.columns - 1)) +
                           down * (row * sheet.height / (sheet.rows - 1)));
  system.diagonal = (across * sheet.width + down * sheet.height).norm();

  // The rest length is the distance at the start, taken from the cell rather than from rounded coordinates.
  const GridCell cell = cell_of(sheet);
  for (const SpringDirection& direction : spring_directions()) {
    const double stiffness = stiffness_of(material, direction.family);
    const double rest_length = (direction.columns * cell.across + direction.rows * cell.down).norm();
    const SpringBlock block = direction_block(system, direction, rest_length, stiffness);
    if (stiffness > 0 && block.rows > 0) system.springs.blocks().push_back(block);
  }
  return system;
}

ClothState starting_state(const ClothSystem& system) {
  return {system.start, Vec3Field(static_cast<std::size_t>(system.size())), 0.0, 0};
}

}  // namespace cloth
