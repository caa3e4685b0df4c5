#include "contact/feature_pairs.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"

namespace cloth {
namespace {

/// Sines of angles by which a surface may bend towards the other without the pair counting as not nearest:
/// the surface that a pair stands on, and the one beyond. Loose where the cloth is, since it is never quite
/// flat.
constexpr double slack_of_obstacle = 1e-3, slack_of_cloth = 0.1;
constexpr double edge_weight = 1e-12;  ///< a weight up to this is one of a boundary

template <std::size_t N>
void append(PairParticles& pair, const std::array<int, N>& particles) {
  for (const int particle : particles) pair.particle[at(pair.count++)] = particle;
}

bool is_own(const FeaturePair& pair) {
  return pair.obstacle == FeaturePair::cloth_itself;
}

/// One side of a pair: where its closest feature lies.
struct Side {
  int vertex = -1,
      edge = -1;  ///< the closest point is this vertex or lies on this edge; neither: within the face
};

Side side_of_triangle(const Surface& surface, int triangle, const std::array<double, 3>& weights) {
  const auto positive =
      std::count_if(weights.begin(), weights.end(), [](double w) { return w > edge_weight; });
  if (positive == 3) return {};
  if (positive <= 1) {
    const auto k = std::max_element(weights.begin(), weights.end()) - weights.begin();
    return {surface.triangles[at(triangle)][static_cast<std::size_t>(k)], -1};
  }
  const auto k = std::min_element(weights.begin(), weights.end()) - weights.begin();
  return {-1, surface.edges_of[at(triangle)][static_cast<std::size_t>((k + 1) % 3)]};
}

/// Whether the surface around an edge's or vertex's `point` does not come closer along `normal`, which points
/// from it to the other feature.
template <class Position>
bool bends_away(const Surface& surface, const Side& side, const Vec3& point, const Vec3& normal, double slack,
                const Position& position) {
  const auto away = [&](int vertex) {
    const Vec3 along = position(vertex) - point;
    return normal.dot(along) <= slack * along.norm();
  };
  if (side.vertex >= 0) {
    const int* list = surface.neighbours.data();
    return std::all_of(list + surface.first_neighbour[at(side.vertex)],
                       list + surface.first_neighbour[at(side.vertex) + 1], away);
  }
  if (side.edge >= 0) {
    const auto& beside = surface.beside_edge[at(side.edge)];
    return away(beside[0]) && (beside[1] < 0 || away(beside[1]));
  }
  return true;
}

void set_normal(Separation& s, const Vec3& separation, double squared_distance) {
  s.distance = std::sqrt(squared_distance);
  s.normal = s.distance > 0 ? Vec3(separation / s.distance) : Vec3::Zero();
}

/// Adds the weights of a feature of the cloth on the near (sign 1) or the far side (-1).
template <std::size_t N>
void add_weights(Separation& s, const std::array<double, N>& weights, double sign) {
  const std::size_t first = sign > 0 ? 0 : at(s.near_count);
  for (std::size_t k = 0; k < N; ++k) s.weight[first + k] = sign * weights[k];
}

/// Cloth and obstacle as two types with the same members: a surface and the positions of its vertices (m).
struct ClothSide {
  const Surface& surface;
  const Vec3Field& field;
  Vec3 operator()(int vertex) const { return field[at(vertex)]; }
};

struct BodySide {
  const Surface& surface;
  const std::vector<Vec3>& vertices;
  const Pose& pose;
  Vec3 operator()(int vertex) const { return pose.at(vertices[at(vertex)]); }
};

void set_near_level(Separation& s, const ClothSide& cloth) {
  s.near_level = std::numeric_limits<double>::infinity();
  for (int k = 0; k < s.near_count; ++k)
    s.near_level = std::min(s.near_level, s.normal.dot(cloth(s.particle[at(k)])));
}

template <class Far>
Separation vertex_face(const FeaturePair& pair, const ClothSide& cloth, const Far& far, double slack,
                       double within) {
  const auto& [a, b, c] = far.surface.triangles[at(pair.far_feature)];
  const Vec3 p = cloth(pair.feature), pa = far(a), pb = far(b), pc = far(c);
  const PointTriangle closest = closest_on_triangle(p, pa, pb, pc);
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, closest.separation, closest.squared_distance);
  s.weight[0] = 1;
  s.near_level = s.normal.dot(p);
  s.far_level = std::max({s.normal.dot(pa), s.normal.dot(pb), s.normal.dot(pc)});
  s.far_point = p - closest.separation;
  if (is_own(pair)) add_weights(s, closest.weights, -1);
  if (s.distance >= within) return s;

  const Side side = side_of_triangle(far.surface, pair.far_feature, closest.weights);
  const bool in_charge = side.vertex >= 0
                             ? far.surface.triangle_of_vertex[at(side.vertex)] == pair.far_feature
                         : side.edge >= 0 ? far.surface.triangle_of_edge[at(side.edge)] == pair.far_feature
                                          : true;
  s.nearest = in_charge && bends_away(far.surface, side, s.far_point, s.normal, slack, far);
  return s;
}

/// `far_bends_away(point, normal)` says it of the surface beside the far edge.
template <class Far, class BendsAway>
Separation edge_edge(const FeaturePair& pair, const ClothSide& cloth, const Far& far, double within,
                     const BendsAway& far_bends_away) {
  const auto& [a, b] = cloth.surface.edges[at(pair.feature)];
  const auto& [c, d] = far.surface.edges[at(pair.far_feature)];
  const Vec3 pa = cloth(a), pb = cloth(b), pc = far(c), pd = far(d);
  const SegmentSegment closest = closest_of_segments(pa, pb, pc, pd);
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, closest.separation, closest.squared_distance);
  add_weights<2>(s, {1 - closest.first, closest.first}, 1);
  s.near_level = std::min(s.normal.dot(pa), s.normal.dot(pb));
  s.far_level = std::max(s.normal.dot(pc), s.normal.dot(pd));
  s.far_point = pc + closest.second * (pd - pc);
  if (is_own(pair)) add_weights<2>(s, {1 - closest.second, closest.second}, -1);
  if (s.distance >= within) return s;

  const auto inside = [](double w) { return w > edge_weight && w < 1 - edge_weight; };
  if (!inside(closest.first) || !inside(closest.second)) return s;  // a vertex's pair holds these
  const Vec3 near_point = s.far_point + closest.separation;
  s.nearest = bends_away(cloth.surface, {-1, pair.feature}, near_point, -s.normal, slack_of_cloth, cloth) &&
              far_bends_away(s.far_point, s.normal);
  return s;
}

/// With an edge of a mesh or of the cloth.
template <class Far>
Separation edge_surface_edge(const FeaturePair& pair, const ClothSide& cloth, const Far& far, double slack,
                             double within) {
  return edge_edge(pair, cloth, far, within, [&](const Vec3& point, const Vec3& normal) {
    return bends_away(far.surface, {-1, pair.far_feature}, point, normal, slack, far);
  });
}

/// With an edge of a box: nearest only where the normal lies between those of the box's two sides.
Separation edge_box_edge(const FeaturePair& pair, const ClothSide& cloth, const ObstacleBody& body,
                         const Pose& pose, double within) {
  const auto& [c, d] = body.surface.edges[at(pair.far_feature)];
  const auto lies_between = [&, c = c, d = d](const Vec3&, const Vec3& normal) {
    const Vec3 local = body.box.axes.transpose() * (pose.rotation.transpose() * normal);
    for (int axis = 0; axis < 3; ++axis) {
      if ((c ^ d) >> axis & 1) continue;  // along the edge
      const double outward = (c >> axis & 1) ? local[axis] : -local[axis];
      if (outward < -slack_of_obstacle) return false;
    }
    return true;
  };
  return edge_edge(pair, cloth, BodySide{body.surface, body.vertices, pose}, within, lies_between);
}

Separation face_vertex(const FeaturePair& pair, const ClothSide& cloth, const Vec3& vertex, double within) {
  const Triangle& face = cloth.surface.triangles[at(pair.feature)];
  const PointTriangle closest = closest_on_triangle(vertex, cloth(face[0]), cloth(face[1]), cloth(face[2]));
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, -closest.separation, closest.squared_distance);
  add_weights(s, closest.weights, 1);
  set_near_level(s, cloth);
  s.far_level = s.normal.dot(vertex);
  s.far_point = vertex;
  if (s.distance >= within) return s;

  const Side side = side_of_triangle(cloth.surface, pair.feature, closest.weights);
  if (side.vertex >= 0) return s;  // the vertex's own pair holds it
  const bool in_charge = side.edge < 0 || cloth.surface.triangle_of_edge[at(side.edge)] == pair.feature;
  const Vec3 near_point = vertex - closest.separation;
  s.nearest = in_charge && bends_away(cloth.surface, side, near_point, -s.normal, slack_of_cloth, cloth);
  return s;
}

Separation vertex_plane(const FeaturePair& pair, const ClothSide& cloth, const ObstacleBody& plane,
                        const Pose& pose) {
  const Vec3 p = cloth(pair.feature);
  Separation s{particles_of(pair, cloth.surface)};
  s.normal = pose.rotation * plane.normal;
  s.weight[0] = 1;
  s.near_level = s.normal.dot(p);
  s.far_level = s.normal.dot(pose.at(plane.point));
  s.distance = s.near_level - s.far_level;
  s.far_point = p - s.distance * s.normal;
  s.nearest = true;
  return s;
}

Separation vertex_box(const FeaturePair& pair, const ClothSide& cloth, const ObstacleBody& body,
                      const Pose& pose) {
  const Vec3 p = cloth(pair.feature);
  const Pose placed{pose.rotation, pose.translation};
  const PointBox closest = closest_on_box(
      placed.inverse(p),
      {body.box.center.cwiseProduct(pose.stretch), body.box.axes, body.box.half.cwiseProduct(pose.stretch)});
  Separation s{particles_of(pair, cloth.surface)};
  s.normal = pose.rotation * closest.normal;
  s.distance = closest.distance;
  s.weight[0] = 1;
  s.far_point = placed.at(closest.point);
  s.near_level = s.normal.dot(p);
  s.far_level = s.near_level - s.distance;  // the whole box lies behind the plane through its closest point
  s.nearest = true;
  return s;
}

Separation face_sphere(const FeaturePair& pair, const ClothSide& cloth, const ObstacleBody& body,
                       const Pose& pose) {
  const Triangle& face = cloth.surface.triangles[at(pair.feature)];
  const Vec3 center = pose.at(body.center);
  const double radius = pose.stretch.x() * body.radius;
  const PointTriangle closest = closest_on_triangle(center, cloth(face[0]), cloth(face[1]), cloth(face[2]));
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, -closest.separation, closest.squared_distance);
  add_weights(s, closest.weights, 1);
  set_near_level(s, cloth);
  s.distance -= radius;
  s.far_level = s.normal.dot(center) + radius;
  s.far_point = center + radius * s.normal;

  const Side side = side_of_triangle(cloth.surface, pair.feature, closest.weights);
  s.nearest = side.vertex >= 0 ? cloth.surface.triangle_of_vertex[at(side.vertex)] == pair.feature
              : side.edge >= 0 ? cloth.surface.triangle_of_edge[at(side.edge)] == pair.feature
                               : true;
  return s;
}

/// m, between a vertex or an edge of the cloth and a face or an edge of a surface.
template <class Far>
double distance_to_surface(const FeaturePair& pair, const ClothSide& cloth, const Far& far) {
  if (pair.kind == PairKind::vertex_face) {
    const auto& [a, b, c] = far.surface.triangles[at(pair.far_feature)];
    return std::sqrt(closest_on_triangle(cloth(pair.feature), far(a), far(b), far(c)).squared_distance);
  }
  const auto& [a, b] = cloth.surface.edges[at(pair.feature)];
  const auto& [c, d] = far.surface.edges[at(pair.far_feature)];
  return std::sqrt(closest_of_segments(cloth(a), cloth(b), far(c), far(d)).squared_distance);
}

}  // namespace

PairParticles particles_of(const FeaturePair& pair, const Surface& cloth) {
  PairParticles all;
  switch (pair.kind) {
    case PairKind::vertex_plane:
    case PairKind::vertex_box:
    case PairKind::vertex_face:
      append<1>(all, {pair.feature});
      break;
    case PairKind::edge_edge:
      append(all, cloth.edges[at(pair.feature)]);
      break;
    case PairKind::face_sphere:
    case PairKind::face_vertex:
      append(all, cloth.triangles[at(pair.feature)]);
      break;
  }
  all.near_count = all.count;
  if (!is_own(pair)) return all;
  if (pair.kind == PairKind::edge_edge)
    append(all, cloth.edges[at(pair.far_feature)]);
  else
    append(all, cloth.triangles[at(pair.far_feature)]);
  return all;
}

Separation separate(const FeaturePair& pair, const Surface& surface, const Vec3Field& position,
                    const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses, double within) {
  const ClothSide cloth{surface, position};
  if (is_own(pair))
    return pair.kind == PairKind::vertex_face ? vertex_face(pair, cloth, cloth, slack_of_cloth, within)
                                              : edge_surface_edge(pair, cloth, cloth, slack_of_cloth, within);
  const ObstacleBody& body = bodies[at(pair.obstacle)];
  const Pose& pose = poses[at(pair.obstacle)];
  const BodySide far{body.surface, body.vertices, pose};
  switch (pair.kind) {
    case PairKind::vertex_plane:
      return vertex_plane(pair, cloth, body, pose);
    case PairKind::vertex_box:
      return vertex_box(pair, cloth, body, pose);
    case PairKind::face_sphere:
      return face_sphere(pair, cloth, body, pose);
    case PairKind::vertex_face:
      return vertex_face(pair, cloth, far, slack_of_obstacle, within);
    case PairKind::edge_edge:
      return body.kind == BodyKind::box ? edge_box_edge(pair, cloth, body, pose, within)
                                        : edge_surface_edge(pair, cloth, far, slack_of_obstacle, within);
    case PairKind::face_vertex:
      return face_vertex(pair, cloth, far(pair.far_feature), within);
  }
  return {};
}

double distance_of(const FeaturePair& pair, const Surface& surface, const Vec3Field& position,
                   const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses) {
  if (pair.kind != PairKind::vertex_face && pair.kind != PairKind::edge_edge)
    return separate(pair, surface, position, bodies, poses, 0).distance;
  const ClothSide cloth{surface, position};
  if (is_own(pair)) return distance_to_surface(pair, cloth, cloth);
  const ObstacleBody& body = bodies[at(pair.obstacle)];
  return distance_to_surface(pair, cloth, BodySide{body.surface, body.vertices, poses[at(pair.obstacle)]});
}

}  // namespace cloth
