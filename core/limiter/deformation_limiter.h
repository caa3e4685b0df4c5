// The deformation rate, by one of two solvers. Sweeps are Provot's inverse procedure (Provot 1995, section
// 4): every limited spring longer than (1 + rate) L is shortened to exactly that, by half of the excess at
// each end or all of it at the free end, over and over. The direct one finds the nearest shape that obeys the
// rate. Velocities change by (displacement)/h, so that they agree with the positions.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "limiter/nearest_shape.h"
#include "scene/scene.h"

namespace cloth {

struct LimiterReport {
  int sweeps = 0;             ///< over the limited springs
  int direct_iterations = 0;  ///< of the direct solver, one sparse factorisation each
  double excess = 0;          ///< largest (|d| - (1 + rate) L)/L that is left, 0 if none is over
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

  /// Leaves no excess above the tolerance, or as much as the solver's most sweeps or iterations leave. The
  /// same state gives the same bits: nothing is kept from one call to the next.
  LimiterReport apply(const ClothSystem& system, double time_step, ClothState& state);

  /// Whether the pins are known to make the rate unreachable. "auto" then stays with sweeps.
  void set_unreachable(bool unreachable) { unreachable_ = unreachable; }

 private:
  double sweep(const ClothSystem& system, bool forward, Vec3Field& position) const;
  bool sweep_all(const ClothSystem& system, LimiterReport& report, Vec3Field& position);
  bool direct_is_cheaper(double remaining_sweeps, int sweeps);
  void solve_directly(const ClothSystem& system, LimiterReport& report, Vec3Field& position);

  Deformation deformation_;
  std::vector<SpringRun> limited_;
  NearestShape nearest_;
  bool unreachable_ = false;
  Vec3Field before_;
  double direct_cost_ = 0;  ///< of the present call, in sweeps; 0: not estimated yet
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
