// The two sides of a pair of features, and the points of many pairs of one kind: what is the same for all of
// them is looked up once.
#pragma once

#include "contact/feature_pairs.h"
#include "geometry/at.h"

namespace cloth {

// Cloth and obstacle as two types with the same members: a surface and the positions of its vertices (m).

struct ClothSide {
  const Surface& surface;
  const Vec3Field& field;
  Vec3 operator()(int vertex) const { return field[at(vertex)]; }
};

struct BodySide {
  const Surface& surface;
  const std::vector<Vec3>& vertices;
  const Pose& pose;
  const Vec3* placed;
  Vec3 operator()(int vertex) const { return placed ? placed[vertex] : pose.at(vertices[at(vertex)]); }
};

inline BodySide body_side(const FeaturePair& pair, const PairSetting& setting) {
  const ObstacleBody& body = setting.bodies[at(pair.obstacle)];
  return {body.surface, body.vertices, setting.poses[at(pair.obstacle)],
          setting.placed_vertices(pair.obstacle)};
}

/// Calls use(points_of), which gives the points of any pair of the kind and the obstacle of `like`.
/// Precondition: no solid.
template <class Use>
void with_points(const FeaturePair& like, const PairSetting& setting, const Use& use) {
  const ClothSide cloth{setting.cloth, setting.position};
  const auto of_edges = [&](const auto& far) {
    use([&](const FeaturePair& pair) -> FeaturePoints {
      const auto& [a, b] = cloth.surface.edges[at(pair.feature)];
      const auto& [c, d] = far.surface.edges[at(pair.far_feature)];
      return {cloth(a), cloth(b), far(c), far(d)};
    });
  };
  const auto of_far_faces = [&](const auto& far) {
    use([&](const FeaturePair& pair) -> FeaturePoints {
      const auto& [a, b, c] = far.surface.triangles[at(pair.far_feature)];
      return {cloth(pair.feature), far(a), far(b), far(c)};
    });
  };
  const auto of_near_faces = [&](const auto& point_of) {
    use([&](const FeaturePair& pair) -> FeaturePoints {
      const auto& [a, b, c] = cloth.surface.triangles[at(pair.feature)];
      return {point_of(pair), cloth(a), cloth(b), cloth(c)};
    });
  };
  const bool is_own = like.obstacle == FeaturePair::cloth_itself;
  if (like.kind == PairKind::edge_edge) return is_own ? of_edges(cloth) : of_edges(body_side(like, setting));
  if (like.kind == PairKind::vertex_face)
    return is_own ? of_far_faces(cloth) : of_far_faces(body_side(like, setting));
  const BodySide far = body_side(like, setting);
  if (like.kind == PairKind::face_vertex)
    return of_near_faces([&](const FeaturePair& pair) { return far(pair.far_feature); });
  const Vec3 center = far.pose.at(setting.bodies[at(like.obstacle)].center);
  of_near_faces([&](const FeaturePair&) { return center; });
}

}  // namespace cloth
