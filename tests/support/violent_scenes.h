// Scenes that shake a cloth as hard as a user may: crumpled, sheared, pleated or stretched starts, soft and
// stiff springs in any ratio, gusts, a hand that swings, a deformation rate, obstacles. Drawn by a seed,
// alike everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "simulation/simulation.h"

namespace cloth::test {

struct ViolentScene {
  Scene scene;  ///< at "auto"
  Preparation start;
  std::function<void(Simulation&)> before_step;  ///< the hand
  std::int64_t steps = 0;                        ///< to be run
  std::string family;                            ///< "plain", "limited", "contact", "continuous contact"
};

/// Scene number `number` of a seed.
ViolentScene violent_scene(std::uint64_t seed, std::uint64_t number);

/// How it went.
struct ViolentRun {
  std::optional<Divergence> divergence;
  double largest_error = 0;  ///< of the ledger, in energy scales
  double mean_step = 0;      ///< of the first one
  std::size_t shortened = 0;
};

/// Runs it to its steps' end, or at most to `steps`.
ViolentRun run_violent(const ViolentScene& scene, std::int64_t steps);

}  // namespace cloth::test
