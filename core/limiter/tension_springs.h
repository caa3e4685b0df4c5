// The springs that a deformation rate limits, and the lines that they form: springs joined end to end, as
// straight as possible. On a grid these are rows, columns and diagonals. Along a line the equations of the
// tensions are tridiagonal.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

struct TensionSpring {
  std::size_t first = 0, second = 0;  ///< particles
  double rest_length = 0;             ///< m
  double limit = 0;                   ///< m, (1 + rate) times the rest length

  /// Length above the limit, as a part of the rest length; negative below.
  double excess(const Vec3Field& position) const {
    return ((position[second] - position[first]).norm() - limit) / rest_length;
  }
  bool operator==(const TensionSpring&) const = default;
};

/// Whether the deformation rate limits this family.
bool is_limited(const Deformation& deformation, SpringFamily family);
std::vector<SpringRun> limited_runs(const Deformation& deformation, const ClothSystem& system);

/// In the order of the system's springs; those between two pins are among them.
std::vector<TensionSpring> tension_springs(const Deformation& deformation, const ClothSystem& system);

/// The largest excess, 0 if no spring is over its limit.
double largest_excess(const std::vector<TensionSpring>& springs, const Vec3Field& position);

/// Every spring is in exactly one line, and no line contains a particle twice.
struct SpringLines {
  std::vector<std::size_t> springs;  ///< line by line, each in the order along it
  std::vector<std::size_t> begin;    ///< of each line in `springs`, and the end of the last one
  std::size_t count() const { return begin.size() - 1; }
};

SpringLines spring_lines(std::span<const TensionSpring> springs, const ClothSystem& system);

}  // namespace cloth
