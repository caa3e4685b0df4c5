#include "contact/start_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "cloth/mesh_cloth.h"
#include "contact/continuous_contact.h"
#include "contact/obstacle_body.h"
#include "contact/obstacle_contact.h"
#include "geometry/at.h"
#include "geometry/box_tree.h"
#include "geometry/triangle_intersection.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

Corners corners_of(const std::vector<Vec3>& vertices, const Triangle& t) {
  return {vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])]};
}

std::vector<Bounds> boxes_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  std::vector<Bounds> boxes;
  for (const Triangle& t : triangles)
    boxes.push_back(bounds_of(vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])]));
  return boxes;
}

/// Of two faces of a cloth, without the vertices that they share.
Intersection own_intersection(const TriangleMesh& cloth, const BoxPair& both) {
  Triangle a = cloth.triangles[at(both.query)], b = cloth.triangles[at(both.index)];
  const auto is_shared_by = [](const Triangle& other) {
    return [&other](int vertex) { return std::find(other.begin(), other.end(), vertex) != other.end(); };
  };
  const auto shared = std::partition(a.begin(), a.end(), is_shared_by(b)) - a.begin();
  std::partition(b.begin(), b.end(), is_shared_by(a));
  const Corners of_a = corners_of(cloth.vertices, a), of_b = corners_of(cloth.vertices, b);
  if (shared == 0) return intersection_of(of_a, of_b);
  if (shared == 1) return intersection_beyond_corner(of_a, of_b);
  return shared == 2 ? intersection_beyond_edge(of_a[0], of_a[1], of_a[2], of_b[2]) : Intersection::apart;
}

std::optional<int> first_face_at_mesh(const TriangleMesh& cloth, const ObstacleBody& body, const Pose& pose) {
  std::vector<Vec3> vertices = body.vertices;
  for (Vec3& vertex : vertices) vertex = pose.at(vertex);
  std::vector<BoxPair> overlaps;
  BoxTree(boxes_of(vertices, body.surface.triangles))
      .collect(boxes_of(cloth.vertices, cloth.triangles), overlaps);
  for (const BoxPair& both : overlaps)
    if (intersection_of(corners_of(cloth.vertices, cloth.triangles[at(both.query)]),
                        corners_of(vertices, body.surface.triangles[at(both.index)])) != Intersection::apart)
      return both.query;
  return std::nullopt;
}

/// The first face of the cloth that touches the obstacle.
std::optional<int> first_face_at(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose) {
  const ObstacleShape& shape = shape_of(obstacle);
  if (shape.body == BodyKind::surface) return first_face_at_mesh(cloth, body_of(obstacle), pose);
  for (std::size_t f = 0; f < cloth.triangles.size(); ++f)
    if (shape.touches(obstacle, pose, corners_of(cloth.vertices, cloth.triangles[f])))
      return static_cast<int>(f);
  return std::nullopt;
}

Problem problem_at(const std::string& path, const char* rule, int particle, const Vec3& place) {
  return {path,
          "",
          fmt::format("{}, first near particle {} at ({:.4g}, {:.4g}, {:.4g}) m", rule, particle, place.x(),
                      place.y(), place.z()),
          "",
          0,
          0};
}

/// Without continuous contact a particle that starts inside an obstacle would be moved to its surface in the
/// first step, however deep it is, and so stretch its springs.
std::vector<Problem> find_particles_inside(const Scene& scene, const ClothSystem& system) {
  std::vector<Problem> problems;
  const double rounding = 1e-9 * system.diagonal;
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    for (std::size_t i = 0; i < system.start.size(); ++i) {
      if (system.pinned[i]) continue;
      const auto surface = penetration(scene.obstacles[k], system.start[i]);
      if (!surface || (surface->point - system.start[i]).norm() <= rounding) continue;
      problems.push_back(problem_at(fmt::format("obstacles.{}", k), "the cloth starts in this obstacle",
                                    static_cast<int>(i), system.start[i]));
      break;
    }
  return problems;
}

/// Features without a common particle must start further apart than the thickness of self-contact, or contact
/// would deform a cloth at rest.
void check_own_distance(const TriangleMesh& cloth, const Vec3Field& position, double thickness,
                        std::vector<Problem>& problems) {
  SweptBounds around{.own_reach = thickness};
  around.from = around.to = position;
  around.radius.assign(position.size(), 0);
  const Surface surface = make_surface(static_cast<int>(cloth.vertices.size()), cloth.triangles);
  std::vector<FeaturePair> pairs;
  PairSearch(surface, position, {}, true, 0).find(around, {}, pairs);
  double least = thickness;
  for (const FeaturePair& pair : pairs)
    least = std::min(least, separate(pair, {surface, position, {}, {}}, 0).distance);
  if (least < thickness)
    problems.push_back(
        {"self_contact.thickness", fmt::format("{} m", thickness),
         fmt::format("must be at most {:.4g} m: so near parts of the cloth are at the start", least), "", 0,
         0});
}

}  // namespace

std::vector<Problem> find_start_problems(const Scene& scene) {
  const bool is_continuous = has_continuous_contact(scene);
  if (!is_continuous && scene.obstacles.empty()) return {};
  const ClothSystem system = make_cloth(scene);
  if (!is_continuous) return find_particles_inside(scene, system);
  TriangleMesh cloth{{}, triangles_of(system)};
  for (std::size_t i = 0; i < system.start.size(); ++i) cloth.vertices.push_back(system.start[i]);
  std::vector<Problem> problems;
  const auto add = [&](const std::string& path, const char* rule, int particle) {
    problems.push_back(problem_at(path, rule, particle, cloth.vertices[at(particle)]));
  };
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    if (const auto face = first_face_at(cloth, scene.obstacles[k], pose_of(scene.obstacles[k], 0)))
      add(fmt::format("obstacles.{}", k), "the cloth starts in this obstacle or touches it",
          cloth.triangles[at(*face)][0]);
  if (!scene.self_contact) return problems;
  if (const auto found = find_self_intersection(cloth))
    add("self_contact",
        found->passes ? "the cloth starts passing through itself" : "the cloth starts touching itself",
        found->particle);
  else
    check_own_distance(cloth, system.start, scene.self_contact->thickness, problems);
  return problems;
}

SceneReading read_runnable_scene(const std::string& text, const std::string& place,
                                 const std::vector<Override>& overrides, const MeshSource& meshes) {
  return read_scene(text, place, overrides, meshes, find_start_problems);
}

bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose) {
  return first_face_at(cloth, obstacle, pose).has_value();
}

std::optional<SelfIntersection> find_self_intersection(const TriangleMesh& cloth) {
  std::vector<BoxPair> overlaps;
  BoxTree(boxes_of(cloth.vertices, cloth.triangles)).collect_own(overlaps);
  std::optional<SelfIntersection> first;
  for (const BoxPair& both : overlaps) {
    const Intersection found = own_intersection(cloth, both);
    const SelfIntersection here{found == Intersection::crossing, cloth.triangles[at(both.query)][0]};
    if (here.passes) return here;
    if (found == Intersection::touching && !first) first = here;
  }
  return first;
}

}  // namespace cloth
