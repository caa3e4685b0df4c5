// What a run has come to: all that its next step depends on beside the scene in force.
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

/// What entered the cloth since t = 0, in J; the loss left it.
struct EnergyLedger {
  Work forces;
  double limiter = 0;
  double contact = 0;
  double initial = 0;  ///< total energy at t = 0, moved by what edits added
  double entered() const {
    return forces.air + forces.brush + forces.pull + limiter + contact - forces.damping_loss;
  }
};

struct RunState {
  ClothState state;
  EnergyLedger ledger;
  double time_step = 0;   ///< s, in force since `first_step`, which began at `first_time`
  double first_time = 0;  ///< s
  std::int64_t first_step = 0;
  AutomaticStep automatic;
  std::optional<BrushGust> brush;
  std::optional<Pull> pull;
  bool was_brushed = false, was_pulled = false;  ///< the hand has acted: its column stays
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

/// Enough to go on from here later, to the bit: the run's state, and what its stages remember. Later steps
/// may only cost something else, where a method fills a cache again.
struct Checkpoint : RunState {
  std::string method;  ///< that `memory` is of
  IntegratorMemory memory;
  std::vector<Pose> obstacle_poses;  ///< of continuous contact
  std::vector<double> tension;       ///< N, of the limited springs, as the limiter holds them

  std::size_t bytes() const;
};

}  // namespace cloth
