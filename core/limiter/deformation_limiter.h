// The deformation rate, by one of two solvers. Sweeps are Provot's inverse procedure (Provot 1995, section
// 4): every limited spring longer than (1 + rate) L is shortened to exactly that, by half of the excess at
// each end or all of it at the free end. What that leaves, because neighbours pull on each other, further
// sweeps take with over-relaxation (Young 1954): more than the excess. The direct solver finds the nearest
// shape that obeys the rate. Velocities change by (displacement)/h, so that they agree with the positions.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "limiter/nearest_shape.h"
#include "limiter/sweep_dispatch.h"
#include "limiter/sweep_plan.h"
#include "scene/scene.h"

namespace cloth {

struct LimiterReport {
  int sweeps = 0;             ///< over the limited springs
  int direct_iterations = 0;  ///< of the direct solver, one sparse factorisation each
  double excess = 0;          ///< largest (|d| - (1 + rate) L)/L that is left, 0 if none is over
};

class DeformationLimiter {
 public:
  /// Times the excess is what every sweep but the first takes. The nearer to 2, the fewer the sweeps; but
  /// what is taken too much comes back as speed, as in a bounce, and from 1.8 on that makes the motion
  /// chaotic: a scene and the same scene turned come apart (tests/laws/invariance_test.cpp).
  static constexpr double over_relaxation = 1.5;

  /// The kernels decide how fast it is, not what comes out.
  DeformationLimiter(const Deformation& deformation, const ClothSystem& system,
                     const SweepKernels& kernels = sweep_kernels());

  /// True if this deformation limits any spring of this system.
  static bool is_needed(const Deformation& deformation, const ClothSystem& system);

  /// The largest (|d| - (1 + rate) L)/L of a limited spring, 0 if none is over. Above the tolerance `apply`
  /// has work.
  double excess(const Vec3Field& position) const;
  bool accepts(double excess) const { return excess <= deformation_.tolerance; }

  /// Leaves no excess above the tolerance, or as much as the solver's most sweeps or iterations leave. The
  /// same state gives the same bits: nothing is kept from one call to the next.
  LimiterReport apply(const ClothSystem& system, double time_step, ClothState& state);

  /// What the last `apply` gave to the cloth, in J: kinetic, elastic and potential energy after it less
  /// before, summed over what it moved. `state` and `time_step` are those of that call.
  double work(const ClothSystem& system, const Vec3& gravity, double time_step,
              const ClothState& state) const;

  /// Whether the pins are known to make the rate unreachable. "auto" then stays with sweeps.
  void set_unreachable(bool unreachable) { unreachable_ = unreachable; }

 private:
  void begin_sweeps(int rows);
  bool has_changed(const SpringBatch& batch, std::int64_t since) const;
  double shorten(const SpringBatch& batch, double relaxation, Vec3Field& position) const;
  double sweep(double relaxation, Vec3Field& position);
  bool sweep_all(const ClothSystem& system, LimiterReport& report, Vec3Field& position);
  NearestShape& nearest(const ClothSystem& system);
  bool direct_is_cheaper(const ClothSystem& system, double remaining_sweeps, int sweeps);
  void solve_directly(const ClothSystem& system, LimiterReport& report, Vec3Field& position);
  void change_velocity(const ClothSystem& system, double time_step, ClothState& state) const;
  bool has_moved(int row) const { return !swept_ || last_move_[static_cast<std::size_t>(row)] > 0; }

  Deformation deformation_;
  const SweepKernels* kernels_;
  std::vector<SpringBatch> pieces_, batches_;  ///< of the limited springs
  std::vector<SpringBatch> elastic_;           ///< pieces of all springs
  std::optional<NearestShape> nearest_;        ///< made when it is first asked for
  bool unreachable_ = false;

  // Of the present or last call.
  Vec3Field before_;
  bool swept_ = true;
  std::int64_t moves_ = 0;                 ///< batches that moved something
  std::vector<std::int64_t> last_move_;    ///< of each row of particles, 0 if none
  std::vector<std::int64_t> found_still_;  ///< of each batch: `moves_` when all was within the limit, or -1
  double direct_cost_ = 0;                 ///< in sweeps; 0: not estimated yet
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
