#include "contact/obstacle_substeps.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

/// rad, that an obstacle may turn in a substep.
constexpr double most_turn = 0.2;
/// Of a mean edge of the cloth: how far a point of a mesh may go in a substep, since the pairs of small faces
/// with all that lies on their way are many.
constexpr double most_way_part = 0.5;
constexpr double most_substeps = 1e6;

}  // namespace

double longest_path(const ObstacleBody& body, const PoseInterpolation& path) {
  if (path.rests()) return 0;
  const double way = (path.pivot(1) - path.pivot(0)).norm() + path.growth() * body.reach;
  if (body.kind == BodyKind::ball || path.angle() == 0) return way;
  return body.kind == BodyKind::half_space ? Bounds::infinity
                                           : way + path.angle() * path.largest_stretch() * body.reach;
}

std::int64_t substeps_for(const std::vector<ObstacleBody>& bodies,
                          const std::vector<PoseInterpolation>& paths, double edge) {
  double substeps = 1;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].kind != BodyKind::ball) substeps = std::max(substeps, paths[k].angle() / most_turn);
    if (bodies[k].kind == BodyKind::surface)
      substeps = std::max(substeps, longest_path(bodies[k], paths[k]) / (most_way_part * edge));
  }
  return static_cast<std::int64_t>(std::ceil(std::min(substeps, most_substeps)));
}

bool comes_near(const ObstacleBody& body, const PoseInterpolation& path, const Bounds& cloth, double reach) {
  if (body.kind == BodyKind::half_space) return true;
  const Bounds way = bounds_of(path.pivot(0), path.pivot(1));
  return overlap(way.grown(path.largest_stretch() * body.reach + reach), cloth);
}

}  // namespace cloth
