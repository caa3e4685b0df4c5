// The state of a run: everything that its next step depends on in addition to the scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/contact_report.h"
#include "contact/obstacle_transition.h"
#include "forces/hand.h"
#include "integrators/integrator.h"
#include "limiter/deformation_limiter.h"
#include "simulation/automatic_step.h"
#include "simulation/outcome.h"

namespace cloth {

/// The energy that entered the cloth since t = 0, in J. Positive values are energy gained, except
/// forces.damping_loss and forces.hysteresis_loss, which are energy lost.
struct EnergyLedger {
  Work forces;
  double limiter = 0;
  double contact = 0;
  double initial = 0;  ///< total energy at t = 0, plus what edits added
  double entered() const {
    return forces.air + forces.brush + forces.pull + limiter + contact - forces.damping_loss -
           forces.hysteresis_loss;
  }
};

struct RunState {
  ClothState state;
  EnergyLedger ledger;
  double time_step = 0;   ///< s, used since `first_step`, which began at `first_time`
  double first_time = 0;  ///< s
  std::int64_t first_step = 0;
  AutomaticStep automatic;
  std::optional<BrushGust> brush;
  std::optional<Pull> pull;
  bool was_brushed = false, was_pulled = false;  ///< since t = 0; the record then keeps the column
  StepCount count;
  LimiterReport last_limit;  ///< of the last step
  std::optional<RateBreach> rate_breach;
  ContactReport last_contact;  ///< of the last step
  ContactMemory contact_memory;
  Vec3 contact_impulse{0, 0, 0};  ///< N s, of continuous contact since t = 0
  ObstacleTransitions transitions;
  ThicknessTransition thickness_transition;
  double obstacle_speed = 0;  ///< m/s, the highest of any point so far
  double hand_energy = 0;     ///< J, the most that the hand's spring has held so far
};

/// What is needed to continue from here later with bitwise the same results: the run's state and the internal
/// state of its stages. Only the cost of later steps may differ, where a method fills a cache again.
struct Checkpoint : RunState {
  std::string method;  ///< that `memory` is of
  IntegratorMemory memory;
  std::vector<Pose> obstacle_poses;  ///< of continuous contact
  std::vector<double> tension;       ///< N, of the limited springs
  std::vector<double> force_history;  ///< of forces that depend on what has been (Force::history)

  std::size_t bytes() const;
};

}  // namespace cloth
