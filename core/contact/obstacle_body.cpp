#include "contact/obstacle_body.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

constexpr double max_rotation = 0.2;  ///< rad, of an obstacle in a substep
/// Largest displacement of a point of a mesh in a substep, in mean edges of the cloth: with longer ones the
/// pairs of features that may collide become too many.
constexpr double max_displacement = 0.5;
constexpr double max_substeps = 1e6;

void add_box(const Obstacle& obstacle, ObstacleBody& body) {
  body.box.center = obstacle.center;
  body.box.half = 0.5 * obstacle.size;
  const std::array<Vec3, 8> all = corners(body.box);
  body.vertices.assign(all.begin(), all.end());
  body.surface.edges.assign(box_edges.begin(), box_edges.end());
}

void add_mesh(const Obstacle& obstacle, ObstacleBody& body) {
  TriangleMesh mesh = placed_mesh(obstacle);
  body.vertices = std::move(mesh.vertices);
  body.surface = make_surface(static_cast<int>(body.vertices.size()), std::move(mesh.triangles));
}

}  // namespace

ObstacleBody body_of(const Obstacle& obstacle) {
  ObstacleBody body;
  body.kind = shape_of(obstacle).body;
  body.pivot = pivot_of(obstacle);
  body.center = obstacle.center;
  body.radius = obstacle.radius;
  body.point = obstacle.point;
  body.normal = obstacle.normal.normalized();
  if (body.kind == BodyKind::box) add_box(obstacle, body);
  if (body.kind == BodyKind::surface) add_mesh(obstacle, body);
  if (body.kind == BodyKind::ball) body.reach = obstacle.radius;
  for (const Vec3& vertex : body.vertices) body.reach = std::max(body.reach, (vertex - body.pivot).norm());
  body.friction = obstacle.friction;
  body.restitution = obstacle.restitution;
  body.reflects = obstacle.response == "reflect";
  return body;
}

double longest_path(const ObstacleBody& body, const PoseInterpolation& path) {
  if (path.is_still()) return 0;
  const double straight = (path.pivot(1) - path.pivot(0)).norm() + path.growth() * body.reach;
  if (body.kind == BodyKind::ball || path.angle() == 0) return straight;
  return body.kind == BodyKind::half_space ? Bounds::infinity
                                           : straight + path.angle() * path.largest_stretch() * body.reach;
}

bool same_place(const ObstacleBody& body, const Pose& a, const Pose& b) {
  return a == b ||
         (body.kind == BodyKind::ball && a.at(body.center) == b.at(body.center) && a.stretch == b.stretch);
}

std::int64_t substeps_for(const std::vector<ObstacleBody>& bodies,
                          const std::vector<PoseInterpolation>& paths, double edge) {
  double substeps = 1;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].kind != BodyKind::ball) substeps = std::max(substeps, paths[k].angle() / max_rotation);
    if (bodies[k].kind == BodyKind::surface)
      substeps = std::max(substeps, longest_path(bodies[k], paths[k]) / (max_displacement * edge));
  }
  return static_cast<std::int64_t>(std::ceil(std::min(substeps, max_substeps)));
}

bool comes_near(const ObstacleBody& body, const PoseInterpolation& path, const Bounds& cloth, double reach) {
  if (body.kind == BodyKind::half_space) return true;
  const Bounds pivots = bounds_of(path.pivot(0), path.pivot(1));
  return overlap(pivots.grown(path.largest_stretch() * body.reach + reach), cloth);
}

}  // namespace cloth
