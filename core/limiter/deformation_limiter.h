// The deformation rate by moving the particles, with one of two solvers. Sweeps are Provot's inverse
// procedure (Provot 1995, section 4): every limited spring longer than (1 + rate) L is shortened to exactly
// that, by half of the excess at each end, or all of it at the free end. Because this stretches neighbours,
// further sweeps follow, with over-relaxation (Young 1954). The direct solver finds the nearest shape that
// satisfies the rate. Velocities change by displacement / time step.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "limiter/nearest_shape.h"
#include "limiter/sweep_plan.h"
#include "scene/scene.h"

namespace cloth {

struct LimiterReport {
  int sweeps = 0;             ///< over the limited springs
  int direct_iterations = 0;  ///< of the direct solver, one sparse factorisation each
  double excess = 0;          ///< largest (|d| - (1 + rate) L)/L that is left, 0 if none is over
};

/// Solver "direct" takes the nearest shape, any other the sweeps.
class DeformationLimiter {
 public:
  /// Every sweep but the first takes this many times the excess. The nearer to 2, the fewer the sweeps; but
  /// over-correction becomes velocity, and from 1.8 on the motion is chaotic: a scene and the same scene
  /// rotated diverge from each other (tests/laws/motion/invariance_test.cpp).
  static constexpr double over_relaxation = 1.5;

  /// `unreachable`: the pins make the rate unreachable, which saves the direct solver the attempt.
  DeformationLimiter(const Deformation& deformation, const ClothSystem& system, bool unreachable = false);

  /// True if this deformation limits any spring of this system.
  static bool is_needed(const Deformation& deformation, const ClothSystem& system);

  /// The largest (|d| - (1 + rate) L)/L of a limited spring, 0 if none is over.
  double excess(const Vec3Field& position) const;
  bool accepts(double excess) const { return excess <= deformation_.tolerance; }

  /// Leaves no excess above the tolerance, or what the solver's most sweeps or iterations leave. The result
  /// depends on the arguments only.
  LimiterReport apply(const ClothSystem& system, double time_step, ClothState& state);

 private:
  bool has_changed(const SpringBatch& batch, std::int64_t since) const;
  double shorten(const SpringBatch& batch, double relaxation, Vec3Field& position) const;
  double sweep(double relaxation, Vec3Field& position);
  LimiterReport sweep_all(const ClothSystem& system, Vec3Field& position);
  void change_velocity(const ClothSystem& system, double time_step, ClothState& state) const;

  Deformation deformation_;
  const SweepKernels* kernels_;
  std::vector<SpringBatch> pieces_, batches_;  ///< of the limited springs
  std::optional<NearestShape> nearest_;        ///< of the direct solver
  bool unreachable_;

  // Of the present or last call.
  Vec3Field before_;                       ///< m
  std::int64_t moves_ = 0;                 ///< batches that moved something
  std::vector<std::int64_t> last_move_;    ///< of each row of particles, 0 if none
  std::vector<std::int64_t> found_still_;  ///< of each batch: `moves_` when all was within the limit, or -1
};

}  // namespace cloth
