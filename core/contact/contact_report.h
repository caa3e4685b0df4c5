// What contact did in a step.
#pragma once

#include <optional>

#include "cloth/vec3_field.h"

namespace cloth {

/// An obstacle could not go its way without passing through cloth that cannot give way.
struct Pinch {
  int obstacle = 0;
  int particle = 0;
  Vec3 place{0, 0, 0};  ///< m
  /// What the cloth is held by there, as far as it is known; another obstacle is `holding_obstacle`.
  enum class Holder { unknown, pin, obstacle, itself } holder = Holder::unknown;
  int holding_obstacle = -1;
};

struct ContactReport {
  bool acted = false;  ///< the state is another one than without contact
  int contacts = 0;    ///< particles that were touched; particle by particle, once for each obstacle
  int held_back = 0;   ///< particles that did not get where they should: something was in the way to the end
  double work = 0;        ///< J, given to the cloth by contact's impulses
  Vec3 impulse{0, 0, 0};  ///< N s, given to the cloth; only continuous contact says it
  int rounds = 0;         ///< of continuous contact
  std::size_t pairs = 0;  ///< of features near each other, of the last round
  std::optional<Pinch> pinch;
  bool exhausted = false;    ///< the obstacles' ways were too much work: like a pinch, at the same place
  bool interrupted = false;  ///< the stop test ended it: the positions are of no use
};

}  // namespace cloth
