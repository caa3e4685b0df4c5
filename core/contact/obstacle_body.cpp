#include "contact/obstacle_body.h"

#include <algorithm>

namespace cloth {
namespace {

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

}  // namespace cloth
