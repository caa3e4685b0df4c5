// How an obstacle that an edit puts into the cloth comes to be there: it grows from a size at which it does
// not touch the cloth, and pushes that aside; a plane comes from below it.
#pragma once

#include "contact/obstacle_transition.h"

namespace cloth {

/// Carries nothing where the obstacle does not touch the cloth. `time` in s; `thickness`, in m, is how far
/// from the cloth it begins where it has its pivot in it.
ObstacleTransition entry_of(const Obstacle& obstacle, const TriangleMesh& cloth, double thickness,
                            double time);

}  // namespace cloth
