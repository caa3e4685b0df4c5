// A step in which an obstacle turns far, or a mesh goes far, is followed in substeps, each of which ends with
// the cloth led to where it should be: the plane between two features serves for small turns only, and the
// pairs of all that lies on a long way are too many.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/obstacle_body.h"
#include "geometry/bounds.h"
#include "scene/obstacle_motion.h"

namespace cloth {

/// Substeps for these ways of a whole step, 1 for most; `edge` is a mean one of the cloth, in m.
std::int64_t substeps_for(const std::vector<ObstacleBody>& bodies,
                          const std::vector<PoseInterpolation>& paths, double edge);

/// Whether an obstacle can come within `reach` metres of a box around the cloth.
bool comes_near(const ObstacleBody& body, const PoseInterpolation& path, const Bounds& cloth, double reach);

/// m, at most, of any point on its way; of a plane that turns infinite.
double longest_path(const ObstacleBody& body, const PoseInterpolation& path);

}  // namespace cloth
