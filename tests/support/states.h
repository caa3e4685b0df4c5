// States and what is measured on them.
#pragma once

#include "cloth/cloth_system.h"
#include "support/random.h"

namespace cloth::test {

/// The starting positions, every free particle moved by a random amount; velocities of the given deviation.
ClothState crumpled_state(const ClothSystem& system, double deviation, double speed, Random& random);

/// A free sheet stretched and sheared a little, turning and waving smoothly.
ClothState waving_state(const ClothSystem& system, double strain, double speed);

Vec3 momentum(const ClothSystem& system, const ClothState& state);
Vec3 angular_momentum(const ClothSystem& system, const ClothState& state);

double rms_distance(const Vec3Field& a, const Vec3Field& b);
double largest_distance(const Vec3Field& a, const Vec3Field& b);
double largest_norm(const Vec3Field& field);
bool all_finite(const Vec3Field& field);
bool all_finite(const ClothState& state);

}  // namespace cloth::test
