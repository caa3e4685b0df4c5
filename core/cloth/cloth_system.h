// The constant part of an assembled cloth (springs, masses, pins) and its state (positions, velocities,
// time).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/vec3_field.h"
#include "geometry/triangle_mesh.h"

namespace cloth {

enum class SpringFamily { structural, shear, flexion };
inline constexpr std::array<SpringFamily, 3> spring_families{SpringFamily::structural, SpringFamily::shear,
                                                             SpringFamily::flexion};
const char* name_of(SpringFamily family);

/// `count` springs with equal properties: spring s joins particle first + s to particle first + s + offset. A
/// grid is a few long runs, so that its kernels need no index pairs; a general mesh is runs of length one.
struct SpringRun {
  SpringFamily family = SpringFamily::structural;
  int first = 0;
  int count = 0;
  int offset = 1;
  double rest_length = 0;  ///< m
  double stiffness = 0;    ///< N/m
  bool operator==(const SpringRun&) const = default;
};

/// A grid of rows x columns particles, or a mesh: one row, and triangles.
struct ClothSystem {
  int rows = 0, columns = 0;
  std::vector<Triangle> triangles;   ///< of a mesh; empty: a grid, see triangles_of()
  std::vector<SpringRun> springs;    ///< in the order structural, shear, flexion
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
