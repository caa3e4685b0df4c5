// The deformation rate: Provot's inverse procedure (Provot 1995, section 4). Every limited spring longer than
// (1 + rate) L is shortened to exactly that, by half of the excess at each end or all of it at the free end.
// Velocities change by (displacement)/h, so that they agree with the positions.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

struct LimiterReport {
  int sweeps = 0;     ///< over the limited springs
  double excess = 0;  ///< largest (|d| - (1 + rate) L)/L that is left, 0 if none is over
};

class DeformationLimiter {
 public:
  DeformationLimiter(const Deformation& deformation, const ClothSystem& system);

  /// True if this deformation limits any spring of this system.
  static bool is_needed(const Deformation& deformation, const ClothSystem& system);

  /// The largest (|d| - (1 + rate) L)/L of a limited spring, 0 if none is over. Above the tolerance `apply`
  /// has work.
  double excess(const ClothSystem& system, const Vec3Field& position) const;
  bool accepts(double excess) const { return excess <= deformation_.tolerance; }

  /// Sweeps until no excess is above the tolerance or the sweeps are used up.
  LimiterReport apply(const ClothSystem& system, double time_step, ClothState& state);

 private:
  double sweep(const ClothSystem& system, bool forward, Vec3Field& position) const;

  Deformation deformation_;
  std::vector<SpringRun> limited_;
  Vec3Field before_;
};

/// Two pins further apart than (1 + rate) times the shortest chain of limited springs between them: no motion
/// can obey the rate. Judged by geometry, at the pins' present positions.
struct UnreachableRate {
  int first = 0, second = 0;  ///< particles
  double distance = 0;        ///< m
  double reach = 0;           ///< m: (1 + rate) times the chain's rest length
};
std::optional<UnreachableRate> find_unreachable_rate(const Scene& scene, const ClothSystem& system,
                                                     const Vec3Field& position);

}  // namespace cloth
