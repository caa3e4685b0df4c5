// Triangulation of simple polygons by a plane sweep.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A polygon in space, projected along a coordinate axis, seen from the side where it is anticlockwise.
struct FlatPolygon {
  std::vector<Vec3> points;
  int axis = 2;
  bool seen_from_below = false;

  std::size_t size() const { return points.size(); }
  const Vec3& point(int k) const { return points[static_cast<std::size_t>(k)]; }
  double across(int k) const { return point(k)[(axis + (seen_from_below ? 2 : 1)) % 3]; }
  double up(int k) const { return point(k)[(axis + (seen_from_below ? 1 : 2)) % 3]; }
  /// Exact: 1 where these three turn left, -1 right, 0 on a line.
  int turn(int a, int b, int c) const;
};

/// Triangles of indices of points, two fewer than there are points, in O(n log n) (Hertel and Mehlhorn 1983).
/// Nothing where the sweep meets a self-intersection of the polygon.
std::optional<std::vector<Triangle>> sweep_polygon(const FlatPolygon& polygon);

}  // namespace cloth
