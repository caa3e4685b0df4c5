#include "geometry/triangle_intersection.h"

#include <algorithm>

#include "geometry/bounds.h"
#include "geometry/exact_signs.h"

namespace cloth {
namespace {

/// Whether signs are of no two sides.
bool is_one_sided(int a, int b, int c) {
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// An axis along which the projections of three points are not collinear; -1 where the points are.
int axis_that_sees(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (turn_around(axis, a, b, c) != 0) return axis;
  return -1;
}

/// Of segments in one plane that is seen along the axis, or all on one line: axis -1.
bool planar_segments_touch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int axis) {
  if (!overlap(bounds_of(a, b), bounds_of(c, d))) return false;
  if (axis < 0) return true;
  return turn_around(axis, a, b, c) * turn_around(axis, a, b, d) <= 0 &&
         turn_around(axis, c, d, a) * turn_around(axis, c, d, b) <= 0;
}

bool segments_touch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (side_of_plane(a, b, c, d) != 0) return false;
  const int axis = std::max({axis_that_sees(a, b, c), axis_that_sees(a, b, d), axis_that_sees(c, d, a)});
  return planar_segments_touch(a, b, c, d, axis);
}

/// Of a segment in the plane of the triangle.
bool touches_in_plane(const Vec3& p, const Vec3& q, const Corners& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segments_touch(p, q, t[k], t[(k + 1) % 3])) return true;
  const int axis = axis_that_sees(t[0], t[1], t[2]);
  return axis >= 0 && is_one_sided(turn_around(axis, t[0], t[1], p), turn_around(axis, t[1], t[2], p),
                                   turn_around(axis, t[2], t[0], p));
}

/// Whether an axis separates the points by more than the rounding error: decides nearly all pairs without
/// exact arithmetic, also coplanar ones.
template <std::size_t M, std::size_t N>
bool is_parted_by(const Vec3& axis, const std::array<Vec3, M>& a, const std::array<Vec3, N>& b) {
  constexpr double rounding = 1e-12;
  double low = 0, high = 0, size = 0;  // of a, from its first point
  double other_low = Bounds::infinity, other_high = -Bounds::infinity;
  for (std::size_t k = 1; k < M; ++k) {
    const Vec3 from = a[k] - a[0];
    low = std::min(low, axis.dot(from)), high = std::max(high, axis.dot(from));
    size = std::max(size, from.cwiseAbs().maxCoeff());
  }
  for (const Vec3& point : b) {
    const Vec3 from = point - a[0];
    other_low = std::min(other_low, axis.dot(from)), other_high = std::max(other_high, axis.dot(from));
    size = std::max(size, from.cwiseAbs().maxCoeff());
  }
  const double margin = rounding * size * axis.cwiseAbs().sum();
  return other_low > high + margin || other_high < low - margin;
}

/// Along the triangle's normal, or across one of its edges or one of the other's within its plane.
template <std::size_t N>
bool is_clearly_beside(const Corners& of, const std::array<Vec3, N>& other) {
  const Vec3 normal = (of[1] - of[0]).cross(of[2] - of[0]);
  if (is_parted_by(normal, of, other)) return true;
  for (std::size_t k = 0; k < 3; ++k)
    if (is_parted_by(normal.cross(of[(k + 1) % 3] - of[k]), of, other)) return true;
  for (std::size_t k = 0; k + 1 < N; ++k)
    if (is_parted_by(normal.cross(other[k + 1] - other[k]), of, other)) return true;
  return is_parted_by(normal.cross(other[0] - other[N - 1]), of, other);
}

Intersection edge_meeting(const Vec3& p, const Vec3& q, const Corners& triangle) {
  return is_clearly_beside(triangle, std::array{p, q}) ? Intersection::apart
                                                       : intersection_of(p, q, triangle);
}

}  // namespace

Intersection intersection_of(const Vec3& p, const Vec3& q, const Corners& t) {
  const int before = side_of_plane(t[0], t[1], t[2], p), after = side_of_plane(t[0], t[1], t[2], q);
  if (before * after > 0) return Intersection::apart;
  if (before == 0 && after == 0)
    return touches_in_plane(p, q, t) ? Intersection::touching : Intersection::apart;
  const int first = side_of_plane(p, q, t[0], t[1]), second = side_of_plane(p, q, t[1], t[2]),
            third = side_of_plane(p, q, t[2], t[0]);
  if (!is_one_sided(first, second, third)) return Intersection::apart;
  const bool is_within = first != 0 && second != 0 && third != 0;
  return is_within && before != 0 && after != 0 ? Intersection::crossing : Intersection::touching;
}

Intersection intersection_of(const Corners& a, const Corners& b) {
  if (is_clearly_beside(a, b) || is_clearly_beside(b, a)) return Intersection::apart;
  Intersection worst = Intersection::apart;
  for (std::size_t k = 0; k < 3; ++k)
    worst =
        std::max({worst, intersection_of(a[k], a[(k + 1) % 3], b), intersection_of(b[k], b[(k + 1) % 3], a)});
  return worst;
}

Intersection intersection_beyond_corner(const Corners& a, const Corners& b) {
  return std::max(edge_meeting(a[1], a[2], b), edge_meeting(b[1], b[2], a));
}

Intersection intersection_beyond_edge(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 edge = b - a, one = edge.cross(c - a), other = edge.cross(d - a);
  if (one.dot(other) < 0) return Intersection::apart;  // the angle between them is more than a right one
  if (side_of_plane(a, b, c, d) != 0) return Intersection::apart;
  const int axis = axis_that_sees(a, b, c);
  return axis >= 0 && turn_around(axis, a, b, c) == turn_around(axis, a, b, d) ? Intersection::touching
                                                                               : Intersection::apart;
}

}  // namespace cloth
