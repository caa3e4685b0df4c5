// The constant part of an assembled cloth (springs, masses, pins) and its state (positions, velocities,
// time).
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/bending.h"
#include "cloth/bending_rows.h"
#include "cloth/bending_sliders.h"
#include "cloth/membrane.h"
#include "cloth/spring_runs.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// A grid of rows x columns particles, or the vertices of a mesh: one row, and triangles.
struct ClothSystem {
  int rows = 0, columns = 0;
  std::vector<Triangle> triangles;   ///< of a mesh; none: a grid, whose cells triangles_of() cuts in two
  SpringRuns springs;                ///< in the order structural, shear, flexion
  BendingRuns bending;               ///< of a material
  BendingRows bending_rows;          ///< of the same elements, on a mesh
  BendingSliders sliders;            ///< of a material with hysteresis
  Membrane membrane;                 ///< of a material on a mesh, whose springs have no stiffness then
  std::vector<double> mass;          ///< kg, one of each particle
  std::vector<double> inverse_mass;  ///< 1/kg; 0 where pinned
  std::vector<std::uint8_t> pinned;  ///< 1 where pinned
  Vec3Field start;                   ///< m, positions at t = 0
  double diagonal = 0;               ///< m, of the sheet at rest

  int size() const { return rows * columns; }
  int index(int row, int column) const { return row * columns + column; }
  bool is_mesh() const { return !triangles.empty(); }
  double total_mass() const;  ///< kg
  std::int64_t spring_count(SpringFamily family) const;
};

struct ClothState {
  Vec3Field position;  ///< m
  Vec3Field velocity;  ///< m/s
  double time = 0;     ///< s
  std::int64_t step = 0;
  bool operator==(const ClothState&) const = default;
};

}  // namespace cloth
