// A run of a scene of contact with any method and step, whose frames the checker of crossings looks at; from
// the scene's start or from somewhere on its way.
#pragma once

#include <optional>

#include "simulation/energy_account.h"
#include "support/contact_scenes.h"

namespace cloth::test {

/// A frame is checked every 1/60 s, or as often as the scene records where that is more; at longer steps
/// every step.
double frame_interval(const Scene& scene);

struct CheckedRun {
  int frames = 0;  ///< that were checked
  Count crossings;
  double crossed_at = 0;           ///< s, the first
  double begin = 0, end = 0;       ///< s, of what was run
  int touched = 0, held_back = 0;  ///< particles, the most in a step
  double cost = 0;                 ///< s of processor time, without the checker
  std::optional<Divergence> stop;  ///< before its end
  bool gave_up = false;            ///< out of patience
};

struct CheckedWay {
  double duration = 0;                ///< s
  double interval = 0;                ///< s between checked states; 0: a frame's
  const Checkpoint* start = nullptr;  ///< maybe of another method and step; without it the scene's start
  Preparation prepare = {};
  double patience = infinity;  ///< s of processor time, after which no further step is begun
};

/// Runs the scene to the way's end, or until its method diverges. Crossings do not end it.
CheckedRun check_run(const Scene& scene, const CheckedWay& way);

struct RestingWay {
  double time = 5;     ///< s, by which it should rest
  double watched = 1;  ///< s, that it is looked at from then on
  Preparation prepare = {};
};

struct RestingRun {
  double peak = 0;            ///< J, the highest kinetic energy
  double kinetic = 0;         ///< J, at the time by which it should rest
  double resting_since = 0;   ///< s, from when on it stayed below 1e-6 of the peak; infinity: never
  double highest_after = 0;   ///< J, while it was watched
  double furthest_after = 0;  ///< m, that a particle was away from where it was at that time
  int touched = 0;            ///< particles, in the last step
  std::optional<Divergence> stop;
};

RestingRun rest_run(const Scene& scene, const RestingWay& way);

/// What contact did with the energy of a run, and how even its steps were in processor time.
struct ContactLedger {
  EnergyAccount account;
  double work = 0;          ///< J, of contact
  double positive = 0;      ///< J, what the steps that gave something gave
  double largest_gift = 0;  ///< J, of a step
  double largest_strain = 0;
  double gain = 0;          ///< J, the most that the error has been above zero: energy that nothing gave
  double median_step = 0, worst_step = 0;  ///< s of this thread
  double worst_at = 0;                     ///< s, in the run
  std::optional<Divergence> stop;

  double unevenness() const { return median_step > 0 ? worst_step / median_step : 0; }
};

ContactLedger ledger_run(const Scene& scene, const Preparation& prepare, double duration);

/// A state of a run with Verlet at the step `auto`, at `time` s.
Checkpoint state_at(const Scene& scene, double time);

/// The last one at least `lead` s before something is touched, or that of the start.
Checkpoint state_before_touch(const Scene& scene, double lead);

/// With a part of the particles along every edge, at least 3.
Scene coarser(Scene scene, double part);

/// N, of a step of `weight` seconds that ended in a state, where it is led to these positions, in m, instead.
Vec3Field force_after_step(ForceModel& forces, const ClothState& ended, double weight,
                           const Vec3Field& position);

}  // namespace cloth::test
