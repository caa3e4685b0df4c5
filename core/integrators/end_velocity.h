// How Verlet finds the damping at the end of a step, which depends on the velocity there (verlet.h).
#pragma once

#include <span>

#include "kernels/spring_sweep.h"

namespace cloth {

enum class EndVelocity {
  solved,           ///< the linear system, exactly; stable at every damping
  corrected_twice,  ///< evaluated three times, where h D is less than 2 m
  corrected,        ///< evaluated twice, where h D is at most m
  predicted         ///< evaluated once, where h^2 K + 4 h D is less than 4 m
};

/// The evaluations of a step, the first after the drift. None where the velocity is solved for.
std::span<const VelocityUpdate> evaluations_of(EndVelocity end);

}  // namespace cloth
