// Whether the pins make a deformation rate unreachable.
#pragma once

#include <optional>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

/// Two pins further apart than (1 + rate) times the shortest chain of limited springs between them: no motion
/// can satisfy the rate.
struct UnreachableRate {
  int first = 0, second = 0;  ///< particles
  double distance = 0;        ///< m
  double reach = 0;           ///< m: (1 + rate) times the chain's rest length
};

/// The worst pair of pins, judged by the pins' present positions; none: the rate is reachable.
std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position);

}  // namespace cloth
