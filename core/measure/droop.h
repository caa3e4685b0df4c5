// How far a cloth hangs down: what tests of drape and bending read off.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// Heights are measured against gravity; without it along +y.
struct Droop {
  double lowest = 0;  ///< m, height of the lowest particle
  // Of the lowest particle from the pinned one that is nearest to it in the horizontal plane; not a number
  // where nothing is pinned.
  double drop = 0;   ///< m, downwards: H
  double reach = 0;  ///< m, in the horizontal plane: W
  /// H/W; 0 where nothing is below the pins, not a number where the lowest particle hangs straight below one.
  double ratio() const;
};

/// Precondition: there are particles. `gravity` in m/s^2; its length does not matter.
Droop measure_droop(const ClothSystem& system, const Vec3Field& position, const Vec3& gravity);

}  // namespace cloth
