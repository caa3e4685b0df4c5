#include "contact/feature_pairs.h"

#include <algorithm>
#include <cmath>

#include "contact/feature_sides.h"
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

/// Of the triangles that have a point of their border in common, one.
bool is_in_charge_of(const Side& side, const Surface& surface, int triangle) {
  if (side.vertex >= 0) return surface.triangle_of_vertex[at(side.vertex)] == triangle;
  return side.edge < 0 || surface.triangle_of_edge[at(side.edge)] == triangle;
}

/// Of a face of the cloth with an obstacle's vertex: the pairs of the cloth's vertices hold their points.
bool is_in_charge_beside_vertex(const Side& side, const Surface& cloth, int triangle) {
  return side.vertex < 0 && is_in_charge_of(side, cloth, triangle);
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

void set_near_level(Separation& s, const ClothSide& cloth) {
  s.near_level = std::numeric_limits<double>::infinity();
  for (int k = 0; k < s.near_count; ++k)
    s.near_level = std::min(s.near_level, s.normal.dot(cloth(s.particle[at(k)])));
}

template <class Far>
Separation vertex_face(const FeaturePair& pair, const FeaturePoints& points, const PointTriangle& closest,
                       const ClothSide& cloth, const Far& far, double slack, double within) {
  const auto& [p, a, b, c] = points;
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, closest.separation, closest.squared_distance);
  s.weight[0] = 1;
  s.near_level = s.normal.dot(p);
  s.far_level = std::max({s.normal.dot(a), s.normal.dot(b), s.normal.dot(c)});
  s.far_point = p - closest.separation;
  if (is_own(pair)) add_weights(s, closest.weights, -1);
  if (s.distance >= within) return s;

  const Side side = side_of_triangle(far.surface, pair.far_feature, closest.weights);
  s.nearest = is_in_charge_of(side, far.surface, pair.far_feature) &&
              bends_away(far.surface, side, s.far_point, s.normal, slack, far);
  return s;
}

/// `far_bends_away(point, normal)` says it of the surface beside the far edge.
template <class BendsAway>
Separation edge_edge(const FeaturePair& pair, const FeaturePoints& points, const SegmentSegment& closest,
                     const ClothSide& cloth, double within, const BendsAway& far_bends_away) {
  const auto& [a, b, c, d] = points;
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, closest.separation, closest.squared_distance);
  add_weights<2>(s, {1 - closest.first, closest.first}, 1);
  s.near_level = std::min(s.normal.dot(a), s.normal.dot(b));
  s.far_level = std::max(s.normal.dot(c), s.normal.dot(d));
  s.far_point = c + closest.second * (d - c);
  if (is_own(pair)) add_weights<2>(s, {1 - closest.second, closest.second}, -1);
  if (s.distance >= within) return s;

  if (!is_in_charge(closest)) return s;
  const Vec3 near_point = s.far_point + closest.separation;
  s.nearest = bends_away(cloth.surface, {-1, pair.feature}, near_point, -s.normal, slack_of_cloth, cloth) &&
              far_bends_away(s.far_point, s.normal);
  return s;
}

/// With an edge of a box: nearest only where the normal lies between those of the box's two sides.
bool lies_between(const ObstacleBody& body, const Pose& pose, int edge, const Vec3& normal) {
  const auto& [c, d] = body.surface.edges[at(edge)];
  const Vec3 local = body.box.axes.transpose() * (pose.rotation.transpose() * normal);
  for (int axis = 0; axis < 3; ++axis) {
    if ((c ^ d) >> axis & 1) continue;  // along the edge
    const double outward = (c >> axis & 1) ? local[axis] : -local[axis];
    if (outward < -slack_of_obstacle) return false;
  }
  return true;
}

/// Of a face of the cloth with a point beyond it, but for what is there.
Separation face_and_point(const FeaturePair& pair, const PointTriangle& closest, const ClothSide& cloth) {
  Separation s{particles_of(pair, cloth.surface)};
  set_normal(s, -closest.separation, closest.squared_distance);
  add_weights(s, closest.weights, 1);
  set_near_level(s, cloth);
  return s;
}

/// `points`: the obstacle's vertex and the face of the cloth.
Separation face_vertex(const FeaturePair& pair, const FeaturePoints& points, const PointTriangle& closest,
                       const ClothSide& cloth, double within) {
  const Vec3& vertex = points[0];
  Separation s = face_and_point(pair, closest, cloth);
  s.far_level = s.normal.dot(vertex);
  s.far_point = vertex;
  if (s.distance >= within) return s;

  const Side side = side_of_triangle(cloth.surface, pair.feature, closest.weights);
  const Vec3 near_point = vertex - closest.separation;
  s.nearest = is_in_charge_beside_vertex(side, cloth.surface, pair.feature) &&
              bends_away(cloth.surface, side, near_point, -s.normal, slack_of_cloth, cloth);
  return s;
}

/// `points`: the centre and the face of the cloth.
Separation face_sphere(const FeaturePair& pair, const FeaturePoints& points, const PointTriangle& closest,
                       const ClothSide& cloth, double radius) {
  const Vec3& center = points[0];
  Separation s = face_and_point(pair, closest, cloth);
  s.distance -= radius;
  s.far_level = s.normal.dot(center) + radius;
  s.far_point = center + radius * s.normal;

  const Side side = side_of_triangle(cloth.surface, pair.feature, closest.weights);
  s.nearest = is_in_charge_of(side, cloth.surface, pair.feature);
  return s;
}

Separation vertex_plane(const FeaturePair& pair, const ClothSide& cloth, const PlacedBodies::Plane& plane) {
  const Vec3 p = cloth(pair.feature);
  Separation s{particles_of(pair, cloth.surface)};
  s.normal = plane.normal;
  s.weight[0] = 1;
  s.near_level = s.normal.dot(p);
  s.far_level = plane.level;
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

/// m, of a ball in its pose.
double radius_of(const FeaturePair& pair, const PairSetting& setting) {
  return setting.poses[at(pair.obstacle)].stretch.x() * setting.bodies[at(pair.obstacle)].radius;
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

FeaturePoints points_of(const FeaturePair& pair, const PairSetting& setting) {
  FeaturePoints points;
  with_points(pair, setting, [&](const auto& points_of) { points = points_of(pair); });
  return points;
}

Separation separation_of(const FeaturePair& pair, const FeaturePoints& points, const SegmentSegment& closest,
                         const PairSetting& setting, double within) {
  const ClothSide cloth{setting.cloth, setting.position};
  const auto with = [&](const auto& far, double slack) {
    return edge_edge(pair, points, closest, cloth, within, [&](const Vec3& point, const Vec3& normal) {
      return bends_away(far.surface, {-1, pair.far_feature}, point, normal, slack, far);
    });
  };
  if (is_own(pair)) return with(cloth, slack_of_cloth);
  const ObstacleBody& body = setting.bodies[at(pair.obstacle)];
  if (body.kind != BodyKind::box) return with(body_side(pair, setting), slack_of_obstacle);
  return edge_edge(pair, points, closest, cloth, within, [&](const Vec3&, const Vec3& normal) {
    return lies_between(body, setting.poses[at(pair.obstacle)], pair.far_feature, normal);
  });
}

Separation separation_of(const FeaturePair& pair, const FeaturePoints& points, const PointTriangle& closest,
                         const PairSetting& setting, double within) {
  const ClothSide cloth{setting.cloth, setting.position};
  if (pair.kind == PairKind::face_sphere)
    return face_sphere(pair, points, closest, cloth, radius_of(pair, setting));
  if (pair.kind == PairKind::face_vertex) return face_vertex(pair, points, closest, cloth, within);
  if (is_own(pair)) return vertex_face(pair, points, closest, cloth, cloth, slack_of_cloth, within);
  return vertex_face(pair, points, closest, cloth, body_side(pair, setting), slack_of_obstacle, within);
}

/// At their ends a vertex's pair holds them.
bool is_in_charge(const SegmentSegment& closest) {
  const auto inside = [](double w) { return w > edge_weight && w < 1 - edge_weight; };
  return inside(closest.first) && inside(closest.second);
}

bool is_in_charge(const FeaturePair& pair, const PointTriangle& closest, const PairSetting& setting) {
  const bool is_far_face = pair.kind == PairKind::vertex_face;
  const Surface& surface =
      is_far_face && !is_own(pair) ? setting.bodies[at(pair.obstacle)].surface : setting.cloth;
  const int triangle = is_far_face ? pair.far_feature : pair.feature;
  const Side side = side_of_triangle(surface, triangle, closest.weights);
  return pair.kind == PairKind::face_vertex ? is_in_charge_beside_vertex(side, surface, triangle)
                                            : is_in_charge_of(side, surface, triangle);
}

double distance_of(const FeaturePair& pair, double squared_distance, const PairSetting& setting) {
  const double distance = std::sqrt(squared_distance);
  return pair.kind == PairKind::face_sphere ? distance - radius_of(pair, setting) : distance;
}

Separation separate(const FeaturePair& pair, const PairSetting& setting, double within) {
  switch (shape_of(pair.kind)) {
    case PairShape::segments: {
      const FeaturePoints points = points_of(pair, setting);
      const auto& [a, b, c, d] = points;
      return separation_of(pair, points, closest_of_segments(a, b, c, d), setting, within);
    }
    case PairShape::point_and_triangle: {
      const FeaturePoints points = points_of(pair, setting);
      const auto& [p, a, b, c] = points;
      return separation_of(pair, points, closest_on_triangle(p, a, b, c), setting, within);
    }
    case PairShape::point_and_solid:
      break;
  }
  const ClothSide cloth{setting.cloth, setting.position};
  if (pair.kind == PairKind::vertex_plane) return vertex_plane(pair, cloth, setting.plane(pair.obstacle));
  return vertex_box(pair, cloth, setting.bodies[at(pair.obstacle)], setting.poses[at(pair.obstacle)]);
}

}  // namespace cloth
