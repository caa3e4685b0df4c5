// The energies of a state.
#pragma once

#include <array>

#include "cloth/cloth_system.h"

namespace cloth {

struct Energy {
  double kinetic = 0, elastic = 0, gravity = 0;  ///< J
  std::array<double, 3> elastic_by_family{};     ///< J, indexed by SpringFamily; structural: a mesh's membrane too
  double bending = 0;                            ///< J, the part of `elastic` in bending elements
  double potential() const { return elastic + gravity; }
  double total() const { return kinetic + elastic + gravity; }
};

/// sum 1/2 m |v|^2, in J.
double kinetic_energy(const ClothSystem& system, const Vec3Field& velocity);

/// The energies of `state`; `gravity_acceleration` in m/s^2.
Energy measure_energy(const ClothSystem& system, const Vec3& gravity_acceleration, const ClothState& state);

}  // namespace cloth
