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

namespace cloth {
namespace {

/// Where a cloth first touches something, or itself.
class TouchSearch {
 public:
  explicit TouchSearch(const TriangleMesh& cloth) : cloth_(cloth) {}

  /// A face, or none.
  std::optional<int> first_in(const Obstacle& obstacle, const Pose& pose) const {
    const ObstacleShape& shape = shape_of(obstacle);
    if (shape.body == BodyKind::surface) return first_in_mesh(body_of(obstacle), pose);
    return first_face([&](const Corners& face) { return shape.touches(obstacle, pose, face); });
  }

  /// The first place where the cloth passes through itself; where it does not, the first where it touches
  /// itself.
  std::optional<SelfIntersection> own_meeting() const {
    std::vector<BoxPair> overlaps;
    BoxTree(boxes()).collect_own(overlaps);
    std::optional<SelfIntersection> first;
    for (const BoxPair& both : overlaps) {
      const Intersection meeting = own_meeting_of(both);
      if (meeting == Intersection::crossing)
        return SelfIntersection{true, cloth_.triangles[at(both.query)][0]};
      if (meeting == Intersection::touching && !first)
        first = SelfIntersection{false, cloth_.triangles[at(both.query)][0]};
    }
    return first;
  }

 private:
  static Corners corners_of(const std::vector<Vec3>& vertices, const Triangle& t) {
    return {vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])]};
  }
  /// Of two faces; what they share is no meeting.
  Intersection own_meeting_of(const BoxPair& both) const {
    Triangle a = cloth_.triangles[at(both.query)], b = cloth_.triangles[at(both.index)];
    const auto is_shared_by = [](const Triangle& other) {
      return [&other](int vertex) { return std::find(other.begin(), other.end(), vertex) != other.end(); };
    };
    const auto shared = std::partition(a.begin(), a.end(), is_shared_by(b)) - a.begin();
    std::partition(b.begin(), b.end(), is_shared_by(a));
    const Corners of_a = corners_of(cloth_.vertices, a), of_b = corners_of(cloth_.vertices, b);
    if (shared == 0) return intersection_of(of_a, of_b);
    if (shared == 1) return intersection_beyond_corner(of_a, of_b);
    return shared == 2 ? intersection_beyond_edge(of_a[0], of_a[1], of_a[2], of_b[2]) : Intersection::apart;
  }

  static Bounds box_of(const Corners& t) { return bounds_of(t[0], t[1], t[2]); }

  template <class Test>
  std::optional<int> first_face(const Test& test) const {
    for (std::size_t f = 0; f < cloth_.triangles.size(); ++f)
      if (test(corners_of(cloth_.vertices, cloth_.triangles[f]))) return static_cast<int>(f);
    return std::nullopt;
  }

  std::optional<int> first_in_mesh(const ObstacleBody& body, const Pose& pose) const {
    std::vector<Vec3> vertices = body.vertices;
    for (Vec3& vertex : vertices) vertex = pose.at(vertex);
    std::vector<Bounds> boxes;
    for (const Triangle& triangle : body.surface.triangles)
      boxes.push_back(box_of(corners_of(vertices, triangle)));
    std::vector<BoxPair> overlaps;
    BoxTree(boxes).collect(this->boxes(), overlaps);
    for (const BoxPair& both : overlaps)
      if (intersection_of(corners_of(cloth_.vertices, cloth_.triangles[at(both.query)]),
                          corners_of(vertices, body.surface.triangles[at(both.index)])) !=
          Intersection::apart)
        return both.query;
    return std::nullopt;
  }

  std::vector<Bounds> boxes() const {
    std::vector<Bounds> boxes;
    for (const Triangle& triangle : cloth_.triangles)
      boxes.push_back(box_of(corners_of(cloth_.vertices, triangle)));
    return boxes;
  }

  const TriangleMesh& cloth_;
};

class StartCheck {
 public:
  explicit StartCheck(const Scene& scene)
      : scene_(scene),
        system_(make_cloth(scene.cloth, scene.springs.value_or(SpringMaterial{}))),
        cloth_(mesh_of(system_)) {}

  std::vector<Problem> problems() {
    if (!has_continuous_contact(scene_)) {
      check_particles();
      return std::move(problems_);
    }
    const TouchSearch search(cloth_);
    for (std::size_t k = 0; k < scene_.obstacles.size(); ++k) {
      const Obstacle& obstacle = scene_.obstacles[k];
      const std::optional<int> face = search.first_in(obstacle, pose_of(obstacle, 0));
      if (face)
        add(fmt::format("obstacles.{}", k), "the cloth starts in this obstacle or touches it",
            cloth_.triangles[at(*face)][0]);
    }
    if (scene_.self_contact) {
      const std::optional<SelfIntersection> meeting = search.own_meeting();
      if (meeting)
        add("self_contact",
            meeting->passes ? "the cloth starts passing through itself" : "the cloth starts touching itself",
            meeting->particle);
      else
        check_own_distance();
    }
    return std::move(problems_);
  }

 private:
  /// Contact particle by particle would put on the surface in the first step what starts inside, however
  /// deep: a stretch from nowhere. What lies on the surface starts as it should; pins stay where they are.
  void check_particles() {
    const double rounding = 1e-9 * system_.diagonal;
    for (std::size_t k = 0; k < scene_.obstacles.size(); ++k)
      for (std::size_t i = 0; i < system_.start.size(); ++i) {
        if (system_.pinned[i]) continue;
        const auto surface = penetration(scene_.obstacles[k], system_.start[i]);
        if (!surface || (surface->point - system_.start[i]).norm() <= rounding) continue;
        add(fmt::format("obstacles.{}", k), "the cloth starts in this obstacle", static_cast<int>(i));
        break;
      }
  }

  /// Features that share no particle must be apart at the start, or contact would tear at a cloth at rest.
  void check_own_distance() {
    const double thickness = scene_.self_contact->thickness;
    Vec3Field position(cloth_.vertices.size());
    SweptBounds around{.own_reach = thickness};
    for (std::size_t i = 0; i < cloth_.vertices.size(); ++i) {
      position.set(i, cloth_.vertices[i]);
      around.particles.push_back({cloth_.vertices[i], cloth_.vertices[i], 0});
    }
    const Surface surface = make_surface(static_cast<int>(cloth_.vertices.size()), cloth_.triangles);
    std::vector<FeaturePair> pairs;
    PairSearch(surface, {}, true, 0).find(around, {}, pairs);
    double least = thickness;
    for (const FeaturePair& pair : pairs)
      least = std::min(least, separate(pair, surface, position, {}, {}, 0).distance);
    if (least < thickness)
      problems_.push_back(
          {"self_contact.thickness", fmt::format("{} m", thickness),
           fmt::format("must be at most {:.4g} m: so near parts of the cloth are at the start", least), "", 0,
           0});
  }

  void add(const std::string& path, const char* rule, int particle) {
    const Vec3& place = cloth_.vertices[at(particle)];
    problems_.push_back({path, "",
                         fmt::format("{}, first near particle {} at ({:.4g}, {:.4g}, {:.4g}) m", rule,
                                     particle, place.x(), place.y(), place.z()),
                         "", 0, 0});
  }

  static TriangleMesh mesh_of(const ClothSystem& system) {
    TriangleMesh mesh{{}, triangles_of(system)};
    for (int i = 0; i < system.size(); ++i) mesh.vertices.push_back(system.start[at(i)]);
    return mesh;
  }

  const Scene& scene_;
  ClothSystem system_;
  TriangleMesh cloth_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> find_start_problems(const Scene& scene) {
  if (!has_continuous_contact(scene) && scene.obstacles.empty()) return {};
  return StartCheck(scene).problems();
}

SceneReading read_runnable_scene(const std::string& text, const std::string& place,
                                 const std::vector<Override>& overrides, const MeshSource& meshes) {
  return read_scene(text, place, overrides, meshes, find_start_problems);
}

bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose) {
  return TouchSearch(cloth).first_in(obstacle, pose).has_value();
}

std::optional<SelfIntersection> find_self_intersection(const TriangleMesh& cloth) {
  return TouchSearch(cloth).own_meeting();
}

}  // namespace cloth
