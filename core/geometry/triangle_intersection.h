// Exact intersection tests of triangles (geometry/exact_signs.h): whether they cross, only touch, or are
// apart.
#pragma once

#include <array>

#include "geometry/vec3_field.h"

namespace cloth {

using Corners = std::array<Vec3, 3>;

/// In order of severity. Crossing: an edge of the one has its ends on both sides of the other's plane and
/// crosses it within the other, not on its boundary. Touching: all other common points, also those of
/// triangles that overlap in one plane.
enum class Intersection { apart, touching, crossing };

/// Of the segment from p to q and a triangle; a triangle without area counts as its edges.
Intersection intersection_of(const Vec3& p, const Vec3& q, const Corners& triangle);

/// Of two triangles that share no corner.
Intersection intersection_of(const Corners& a, const Corners& b);

/// Of two triangles that share their first corner, without that corner.
Intersection intersection_beyond_corner(const Corners& a, const Corners& b);

/// Of the triangles (a, b, c) and (a, b, d), without their common edge: touching where they are folded flat
/// onto each other.
Intersection intersection_beyond_edge(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace cloth
