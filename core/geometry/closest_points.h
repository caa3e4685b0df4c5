// Closest points of points, segments, triangles and boxes, with their barycentric weights.
//
// All finite input is valid: segments without length, parallel segments, triangles without area. Weights lie
// in [0, 1] and sum to 1 up to rounding; among equally close points the choice is deterministic. The returned
// points lie on the features, so that a distance is never too small; it is too large by rounding only, or by
// up to 2e-8 of the length of triangles whose height is less than 1e-4 of their length. Separations are
// computed from differences of the input, so that accuracy does not depend on the distance from the origin.
#pragma once

#include <array>

#include "geometry/vec3_field.h"

namespace cloth {

struct PointSegment {
  double weight = 0;            ///< of the segment's second end; its first has 1 - weight
  Vec3 separation{0, 0, 0};     ///< m, from the segment to the point
  double squared_distance = 0;  ///< m^2
};

struct PointTriangle {
  std::array<double, 3> weights{1, 0, 0};  ///< of the triangle's vertices
  Vec3 separation{0, 0, 0};                ///< m, from the triangle to the point
  double squared_distance = 0;             ///< m^2
};

struct SegmentSegment {
  double first = 0, second = 0;  ///< weights of the second ends of the first and of the second segment
  Vec3 separation{0, 0, 0};      ///< m, from the second segment to the first
  double squared_distance = 0;   ///< m^2
};

/// The solid box of the points center + axes u, |u_k| <= half_k.
struct OrientedBox {
  Vec3 center{0, 0, 0};                                ///< m
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns of length one, perpendicular to each other
  Vec3 half{0, 0, 0};                                  ///< m, half of each side
};

struct PointBox {
  Vec3 point{0, 0, 0};  ///< m, of the surface
  Vec3 normal{0, 1,
              0};  ///< of length one: from `point` outward, through the given point where that is outside
  double distance = 0;  ///< m, negative inside
};

inline PointSegment closest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b);
inline PointTriangle closest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// The ends a and b of the first segment, c and d of the second. Where they are parallel, one of the closest
/// points is an end.
inline SegmentSegment closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// For points inside: the surface point along the axis of least depth (of equal ones the first).
PointBox closest_on_box(const Vec3& point, const OrientedBox& box);

/// Corner k lies on the upper side along axis i where bit i of k is set.
std::array<Vec3, 8> corners(const OrientedBox& box);

/// Pairs of corners.
inline constexpr std::array<std::array<int, 2>, 12> box_edges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

// ---------------------------------------------------------------------------------------------------------------

namespace closest_points {

/// Clamps to [0, 1]; NaN becomes 0.
inline double clamped(double t) {
  return t > 0 ? (t < 1 ? t : 1) : 0;
}

/// Squared sine of an angle below which the cross product is too inexact to classify inside and outside.
inline constexpr double slender = 1e-8;

/// `apart` and `along` are taken from the segment's first end, to the point and to the other end.
inline PointSegment from_first_end(const Vec3& apart, const Vec3& along, double squared_length) {
  PointSegment result;
  result.weight = squared_length > 0 ? clamped(apart.dot(along) / squared_length) : 0;
  result.separation = apart - result.weight * along;
  result.squared_distance = result.separation.squaredNorm();
  return result;
}

/// The closest of the edges k (opposite vertex k) with `beyond[k]`.
PointTriangle closest_of_edges(const Vec3& point, const std::array<Vec3, 3>& vertices,
                               const std::array<bool, 3>& beyond);

/// The closest of all edges and the given inner point.
PointTriangle closest_on_slender(const Vec3& point, const std::array<Vec3, 3>& vertices,
                                 const PointTriangle& inner);

/// The closest of the pairs that have an end; `apart` goes from the second segment's first end to the
/// first's.
SegmentSegment closest_with_an_end(const Vec3& apart, const Vec3& first, const Vec3& second);

/// The closest of those and the given inner pair.
SegmentSegment closest_nearly_parallel(const Vec3& apart, const Vec3& first, const Vec3& second,
                                       const SegmentSegment& inner);

inline PointTriangle at_weights(const Vec3& apart, const Vec3& ab, const Vec3& ac, double b, double c) {
  PointTriangle result;
  result.weights = {clamped(1 - b - c), b, c};
  result.separation = apart - b * ab - c * ac;
  result.squared_distance = result.separation.squaredNorm();
  return result;
}

inline SegmentSegment at_weights_of_both(const Vec3& apart, const Vec3& first, const Vec3& second, double s,
                                         double t) {
  SegmentSegment result;
  result.first = s, result.second = t;
  result.separation = apart + s * first - t * second;
  result.squared_distance = result.separation.squaredNorm();
  return result;
}

}  // namespace closest_points

inline PointSegment closest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return closest_points::from_first_end(point - a, along, along.squaredNorm());
}

/// The foot of the perpendicular if it falls into the triangle, else the closest edge among those that the
/// foot lies beyond.
inline PointTriangle closest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  using namespace closest_points;
  const Vec3 ab = b - a, ac = c - a, apart = point - a;
  const Vec3 normal = ab.cross(ac);
  const double squared = normal.squaredNorm();
  const double to_b = apart.cross(ac).dot(normal), to_c = ab.cross(apart).dot(normal);
  const double to_a = squared - to_b - to_c;
  const bool inside = to_a >= 0 && to_b >= 0 && to_c >= 0 && squared > 0;
  const bool sound = squared > slender * ab.squaredNorm() * ac.squaredNorm();
  if (inside) {
    const PointTriangle foot = at_weights(apart, ab, ac, clamped(to_b / squared), clamped(to_c / squared));
    return sound ? foot : closest_on_slender(point, {a, b, c}, foot);
  }
  if (!sound) return closest_of_edges(point, {a, b, c}, {true, true, true});
  return closest_of_edges(point, {a, b, c}, {to_a < 0, to_b < 0, to_c < 0});
}

/// The lines' common perpendicular if it meets both segments, else the closest of the four pairs that have an
/// end.
inline SegmentSegment closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using namespace closest_points;
  const Vec3 first = b - a, second = d - c, apart = a - c;
  const Vec3 normal = first.cross(second);
  const double squared = normal.squaredNorm();
  const double s = second.cross(apart).dot(normal), t = first.cross(apart).dot(normal);
  const bool inside = s > 0 && s < squared && t > 0 && t < squared;
  if (!inside) return closest_with_an_end(apart, first, second);
  const SegmentSegment inner =
      at_weights_of_both(apart, first, second, clamped(s / squared), clamped(t / squared));
  const bool sound = squared > slender * first.squaredNorm() * second.squaredNorm();
  return sound ? inner : closest_nearly_parallel(apart, first, second, inner);
}

}  // namespace cloth
