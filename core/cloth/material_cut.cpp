#include "cloth/material_cut.h"

#include "cloth/bending_builder.h"
#include "cloth/cut_grid.h"
#include "cloth/grid.h"

namespace cloth {
namespace {

/// The particles of a cut grid without springs, with a quarter of each cell's mass at its corners.
ClothSystem particles_of(const ClothSheet& sheet, const CutGrid& grid, double mass_of_cell) {
  ClothSystem system;
  system.rows = 1, system.columns = static_cast<int>(grid.place.size());
  give_particles(sheet, system);
  const GridCell cell = cell_of(sheet);
  for (std::size_t i = 0; i < grid.place.size(); ++i) {
    const int row = grid.place[i] / grid.columns, column = grid.place[i] % grid.columns;
    system.start.set(i, sheet.origin + cell.across * column + cell.down * row);
    system.mass[i] = 0.25 * mass_of_cell * grid.cells_around(row, column);
    system.inverse_mass[i] = system.pinned[i] ? 0 : 1 / system.mass[i];
  }
  system.diagonal = (cell.across * (sheet.columns - 1) + cell.down * (sheet.rows - 1)).norm();
  return system;
}

void add_triangles(const CutGrid& grid, ClothSystem& system) {
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      if (!grid.has_cell(row, column)) continue;
      const int a = grid.at(row, column), b = a + 1, d = grid.at(row + 1, column), c = d + 1;
      system.triangles.push_back({a, d, c});
      system.triangles.push_back({a, c, b});
    }
}

/// Springs that are alike and begin at consecutive particles become one run.
class SpringBuilder {
 public:
  explicit SpringBuilder(ClothSystem& system) : system_(system) {}

  void add(SpringFamily family, int from, int to, double rest_length, double stiffness) {
    if (from < 0 || to < 0 || !(stiffness > 0)) return;
    auto& blocks = system_.springs.blocks();
    if (!blocks.empty()) {
      SpringRun& last = blocks.back().run;
      if (last.family == family && last.offset == to - from && last.stiffness == stiffness &&
          last.rest_length == rest_length && last.first + last.count == from) {
        ++last.count;
        return;
      }
    }
    system_.springs.push_back({family, from, 1, to - from, rest_length, stiffness});
  }

 private:
  ClothSystem& system_;
};

template <class Visit>  // visit(row, column)
void for_each_place(const CutGrid& grid, Visit visit) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (grid.at(row, column) >= 0) visit(row, column);
}

void add_springs(const GridCell& cell, const CellSprings& k, const CutGrid& grid, ClothSystem& system) {
  SpringBuilder springs(system);
  const double across = cell.across.norm(), down = cell.down.norm(),
               diagonal = (cell.across + cell.down).norm();
  for_each_place(grid, [&](int r, int c) {
    const double cells = grid.has_cell(r, c) + grid.has_cell(r - 1, c);
    springs.add(SpringFamily::structural, grid.at(r, c), grid.at(r, c + 1), across, 0.5 * cells * k.across);
  });
  for_each_place(grid, [&](int r, int c) {
    const double cells = grid.has_cell(r, c) + grid.has_cell(r, c - 1);
    springs.add(SpringFamily::structural, grid.at(r, c), grid.at(r + 1, c), down, 0.5 * cells * k.down);
  });
  for_each_place(grid, [&](int r, int c) {
    if (grid.has_cell(r, c))
      springs.add(SpringFamily::shear, grid.at(r, c), grid.at(r + 1, c + 1), diagonal, k.diagonal);
  });
  for_each_place(grid, [&](int r, int c) {
    if (grid.has_cell(r, c - 1))
      springs.add(SpringFamily::shear, grid.at(r, c), grid.at(r + 1, c - 1), diagonal, k.diagonal);
  });
}

void add_bending(const CellBending& k, const CutGrid& grid, ClothSystem& system) {
  BendingBuilder builder(system);
  const auto add_line = [&](int before, int middle, int after, double stiffness) {
    if (before < 0 || middle < 0 || after < 0) return;
    builder.add(before,
                {.points = 3, .offset = {0, middle - before, after - before}, .coefficient = {1, -2, 1}},
                stiffness);
  };
  for_each_place(grid, [&](int r, int c) {
    add_line(grid.at(r, c - 1), grid.at(r, c), grid.at(r, c + 1), 0.25 * grid.cells_around(r, c) * k.across);
  });
  for_each_place(grid, [&](int r, int c) {
    add_line(grid.at(r - 1, c), grid.at(r, c), grid.at(r + 1, c), 0.25 * grid.cells_around(r, c) * k.down);
  });
  for_each_place(grid, [&](int r, int c) {
    if (!grid.has_cell(r, c)) return;
    const int a = grid.at(r, c), d = grid.at(r + 1, c);
    builder.add(a, {.points = 4, .offset = {0, 1, d - a, d - a + 1}, .coefficient = {1, -1, -1, 1}}, k.twist);
  });
}

/// As on a whole grid: 2HB is the width of the loop, so that the moment is up to half of it.
void add_sliders(const Material& m, double across, double down, const CutGrid& grid, ClothSystem& system) {
  BendingBuilder builder(system);
  const auto add_line = [&](int before, int middle, int after, double spacing, double cells, double bending,
                            double hysteresis) {
    if (before >= 0 && middle >= 0 && after >= 0)
      builder.add_slider(before, middle, after, spacing, 0.25 * cells * across * down,
                         slider_stiffness_ratio * bending, 0.5 * hysteresis);
  };
  for_each_place(grid, [&](int r, int c) {
    const double cells = grid.cells_around(r, c);
    add_line(grid.at(r, c - 1), grid.at(r, c), grid.at(r, c + 1), across, cells, m.bending_weft,
             m.hysteresis_weft);
    add_line(grid.at(r - 1, c), grid.at(r, c), grid.at(r + 1, c), down, cells, m.bending_warp,
             m.hysteresis_warp);
  });
}

}  // namespace

ClothSystem make_material_cut(const ClothSheet& sheet, const Material& material) {
  const CutGrid grid = cut_grid(sheet);
  const GridCell cell = cell_of(sheet);
  const double across = cell.across.norm(), down = cell.down.norm();
  ClothSystem system = particles_of(sheet, grid, material.areal_density * across * down);
  add_triangles(grid, system);
  add_springs(cell, cell_springs(material, across, down), grid, system);
  add_bending(cell_bending(material, across, down), grid, system);
  add_sliders(material, across, down, grid, system);
  return system;
}

}  // namespace cloth
