// How Verlet finds the damping at the end of a step, which depends on the velocity there (verlet.h).
#pragma once

namespace cloth {

enum class EndVelocity {
  solved,     ///< the linear system, exactly; stable at every damping
  renewed,    ///< evaluated three times, where h D is less than 2 m
  corrected,  ///< evaluated twice, where h D is at most m
  predicted   ///< evaluated once, where h^2 K + 4 h D is less than 4 m
};

}  // namespace cloth
