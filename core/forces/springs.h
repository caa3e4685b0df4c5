// The energy of springs, Eq. (1) of the report (Provot 1995): F_i = k (|d| - L) d/|d|, d = x_j - x_i; 0 where
// |d| = 0. The forces of springs and of their dampers are in springs.cpp.
#pragma once

#include <array>

#include "cloth/cloth_system.h"

namespace cloth {

/// sum 1/2 k (|d| - L)^2 per family, in J, indexed by SpringFamily.
std::array<double, 3> elastic_energy(const ClothSystem& system, const Vec3Field& position);

}  // namespace cloth
