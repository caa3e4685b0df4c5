// The outcome of contact in a step.
#pragma once

#include <optional>

#include "geometry/vec3_field.h"

namespace cloth {

/// An obstacle could not move on without passing through cloth that cannot move out of its way.
struct Pinch {
  int obstacle = 0;
  int particle = 0;
  Vec3 place{0, 0, 0};  ///< m
  /// What holds the cloth there, as far as it is known; Holder::obstacle refers to `holding_obstacle`.
  enum class Holder { unknown, pin, obstacle, itself } holder = Holder::unknown;
  int holding_obstacle = -1;
};

struct ContactReport {
  bool acted = false;     ///< contact has changed the state
  int contacts = 0;       ///< particles in contact; without continuous contact counted once for each obstacle
  int held_back = 0;      ///< particles that did not reach their target position within the rounds
  double work = 0;        ///< J, given to the cloth by contact's impulses
  Vec3 impulse{0, 0, 0};  ///< N s, given to the cloth; only of continuous contact
  int rounds = 0;         ///< of continuous contact
  std::size_t pairs = 0;  ///< pairs of near features in the last round
  std::optional<Pinch> pinch;
  bool exhausted = false;    ///< the bound on the work of a step was reached; treated like a pinch
  bool interrupted = false;  ///< the stop test ended it: the positions are not usable
};

}  // namespace cloth
