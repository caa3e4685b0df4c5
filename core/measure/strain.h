// Strain of a spring: |d|/L - 1.
#pragma once

#include <array>
#include <span>

#include "cloth/cloth_system.h"

namespace cloth {

struct Strain {
  std::array<double, 3> largest{};  ///< elongation per family, indexed by SpringFamily
  double maximum() const;           ///< over structural and shear springs
};

/// The largest strain of each family; negative where every spring of it is compressed, 0 for an absent
/// family.
Strain measure_strain(const ClothSystem& system, const Vec3Field& position);

/// For every particle the largest strain of its structural and shear springs, 0 for a particle without any.
/// `strain` has one element per particle.
void particle_strain(const ClothSystem& system, const Vec3Field& position, std::span<float> strain);

}  // namespace cloth
