// The damping of single particles of a grid, where the fused passes, which know it for all particles at once,
// do not keep it apart from other forces.
#pragma once

#include "cloth/cloth_system.h"
#include "forces/force.h"
#include "geometry/sparse_field.h"

namespace cloth {

/// Whether damping_at() knows all that `terms` hold of D: viscous damping, dampers along the springs of a
/// grid by one coefficient, air; no damping times, hysteresis or shares of masses.
bool knows_damping_at(const ClothSystem& system, const SweepTerms& terms);

/// D v of one particle, N. Precondition: knows_damping_at().
Vec3 damping_at(const ClothSystem& system, const SweepTerms& terms, const Vec3Field& position,
                const Vec3Field& velocity, std::size_t particle);

/// The sum of -D v . change over the particles of `change` (m/s), W.
double power_of_damping(const ClothSystem& system, const SweepTerms& terms, const Vec3Field& position,
                        const Vec3Field& velocity, const SparseField& change);

}  // namespace cloth
