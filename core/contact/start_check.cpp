#include "contact/start_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "cloth/mesh_cloth.h"
#include "contact/at.h"
#include "contact/continuous_contact.h"
#include "contact/obstacle_body.h"
#include "geometry/box_tree.h"

namespace cloth {
namespace {

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether a segment passes through a triangle; touching counts, lying in its plane does not.
bool meets(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const double before = volume(t[0], t[1], t[2], p), after = volume(t[0], t[1], t[2], q);
  if (before * after > 0 || (before == 0 && after == 0)) return false;
  const double u = volume(p, q, t[0], t[1]), v = volume(p, q, t[1], t[2]), w = volume(p, q, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

using Corners = std::array<Vec3, 3>;

bool cross(const Corners& a, const Corners& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (meets(a[k], a[(k + 1) % 3], b) || meets(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

/// The solid box |x| <= half and a triangle in its frame: a corner or an edge of the triangle in the box, or
/// an edge of the box through the triangle.
bool meets_box(const Corners& triangle, const OrientedBox& box) {
  Corners local;
  for (std::size_t k = 0; k < 3; ++k) local[k] = box.axes.transpose() * (triangle[k] - box.center);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 p = local[k], way = local[(k + 1) % 3] - p;
    double from = 0, to = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-box.half[axis] - p[axis]) / way[axis], b = (box.half[axis] - p[axis]) / way[axis];
      if (way[axis] != 0)
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
      else if (std::abs(p[axis]) > box.half[axis])
        to = -1;
    }
    if (from <= to) return true;
  }
  const std::array<Vec3, 8> corner = corners(box);
  return std::any_of(box_edges.begin(), box_edges.end(), [&](const auto& edge) {
    return meets(corner[at(edge[0])], corner[at(edge[1])], triangle);
  });
}

/// Where a cloth first touches something, or itself.
class TouchSearch {
 public:
  explicit TouchSearch(const TriangleMesh& cloth) : cloth_(cloth) {}

  /// A face, or none.
  std::optional<int> first_in(const Obstacle& obstacle, const Pose& pose) const {
    const ObstacleBody body = body_of(obstacle);
    switch (body.shape) {
      case Shape::sphere:
        return first_face([&](const Corners& t) {
          const auto closest = closest_on_triangle(pose.at(body.center), t[0], t[1], t[2]);
          const double radius = pose.stretch.x() * body.radius;
          return closest.squared_distance <= radius * radius;
        });
      case Shape::plane: {
        const Vec3 normal = pose.turn * body.normal, point = pose.at(body.point);
        return first_face([&](const Corners& t) {
          return std::any_of(t.begin(), t.end(), [&](const Vec3& x) { return normal.dot(x - point) <= 0; });
        });
      }
      case Shape::box: {
        const OrientedBox box{pose.at(body.box.center), pose.turn * body.box.axes,
                              body.box.half.cwiseProduct(pose.stretch)};
        return first_face([&](const Corners& t) { return meets_box(t, box); });
      }
      case Shape::mesh:
        return first_in_mesh(body, pose);
    }
    return std::nullopt;
  }

  std::optional<int> first_in_itself() const {
    std::vector<BoxPair> overlaps;
    const std::vector<Bounds> faces = boxes();
    BoxTree(faces).collect(faces, overlaps);
    for (const BoxPair& both : overlaps) {
      const Triangle &a = cloth_.triangles[at(both.query)], &b = cloth_.triangles[at(both.index)];
      const bool apart = std::none_of(
          a.begin(), a.end(), [&](int vertex) { return std::find(b.begin(), b.end(), vertex) != b.end(); });
      if (apart && cross(corners_of(cloth_.vertices, a), corners_of(cloth_.vertices, b))) return both.query;
    }
    return std::nullopt;
  }

 private:
  static Corners corners_of(const std::vector<Vec3>& vertices, const Triangle& t) {
    return {vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])]};
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
      if (cross(corners_of(cloth_.vertices, cloth_.triangles[at(both.query)]),
                corners_of(vertices, body.surface.triangles[at(both.index)])))
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
      : scene_(scene), cloth_(mesh_of(make_cloth(scene.cloth, scene.springs.value_or(SpringMaterial{})))) {}

  std::vector<Problem> problems() {
    const TouchSearch search(cloth_);
    for (std::size_t k = 0; k < scene_.obstacles.size(); ++k) {
      const Obstacle& obstacle = scene_.obstacles[k];
      const std::optional<int> face = search.first_in(obstacle, pose_of(obstacle, 0));
      if (face) add(fmt::format("obstacles.{}", k), "the cloth starts in this obstacle or touches it", *face);
    }
    if (scene_.self_contact) {
      const std::optional<int> face = search.first_in_itself();
      if (face)
        add("self_contact", "the cloth starts passing through itself", *face);
      else
        check_own_distance();
    }
    return std::move(problems_);
  }

 private:
  /// Features that share no particle must be apart at the start, or contact would tear at a cloth at rest.
  void check_own_distance() {
    const double thickness = scene_.self_contact->thickness;
    Vec3Field position(cloth_.vertices.size());
    Ways around{.own_reach = thickness};
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

  void add(const std::string& path, const char* rule, int face) {
    const int particle = cloth_.triangles[at(face)][0];
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
  TriangleMesh cloth_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> find_start_problems(const Scene& scene) {
  if (!has_continuous_contact(scene)) return {};
  return StartCheck(scene).problems();
}

bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose) {
  return TouchSearch(cloth).first_in(obstacle, pose).has_value();
}

bool passes_through_itself(const TriangleMesh& cloth) {
  return TouchSearch(cloth).first_in_itself().has_value();
}

}  // namespace cloth
