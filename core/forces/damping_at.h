// The damping of single particles of a grid, where the fused passes, which know it for all particles at once,
// do not keep it apart from other forces.
#pragma once

#include <array>

#include "cloth/cloth_system.h"
#include "forces/force.h"
#include "geometry/sparse_field.h"

namespace cloth {

class DampingAt {
 public:
  /// Whether it knows all that `terms` hold of D: viscous damping, dampers along the springs of a grid by one
  /// coefficient, air; no damping times, hysteresis or shares of masses.
  static bool suits(const ClothSystem& system, const SweepTerms& terms);
  /// Whether the particles of `change` are so few that asking each takes less time than a pass over all.
  static bool is_worthwhile(const SparseField& change);

  /// Precondition: suits(). Both arguments must outlive it.
  DampingAt(const ClothSystem& system, const SweepTerms& terms);

  /// D v of one particle, N.
  Vec3 product(std::size_t particle, const Vec3Field& position, const Vec3Field& velocity) const;
  /// The sum of -D v . change over the particles of `change` (m/s), W.
  double power(const Vec3Field& position, const Vec3Field& velocity, const SparseField& change) const;

 private:
  static constexpr std::size_t directions = 6;  ///< of a grid's springs
  /// Springs begin in these rows and columns; the second end is `offset` particles further.
  struct Direction {
    int first_row, end_row, first_column, end_column, down, across, offset;
    bool begins_at(int row, int column) const {
      return row >= first_row && row < end_row && column >= first_column && column < end_column;
    }
  };
  static Direction direction_of(const SpringBlock& block, int columns);

  const ClothSystem* system_;
  const SweepTerms* terms_;
  std::array<Direction, directions> directions_{};
  std::size_t count_ = 0;
};

}  // namespace cloth
