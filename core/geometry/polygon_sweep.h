// Simple polygons cut into triangles by a sweep from top to bottom.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A polygon of points in space as it is seen along a coordinate axis, from the side where it turns
/// anticlockwise.
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

/// Numbers of points; as many triangles as there are points, less two. In n log n steps (Hertel and Mehlhorn,
/// "Fast triangulation of simple polygons", 1983). Nothing where the polygon crosses or touches itself in a
/// way that the sweep stumbles over.
std::optional<std::vector<Triangle>> sweep_polygon(const FlatPolygon& polygon);

}  // namespace cloth
