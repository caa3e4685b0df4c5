// Exact orientation predicates: the sign of a determinant of coordinate differences, in doubles where the
// error bound allows, else by floating-point expansions (Shewchuk 1997). Exact as long as no product of
// coordinate differences leaves the range of doubles.
#pragma once

#include "geometry/vec3_field.h"

namespace cloth {

/// 1 where `point` lies on the side to which (b - a) x (c - a) points, -1 on the other, 0 in the plane (and
/// always where a, b, c lie on a line).
int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// The orientation of a, b, c projected along a coordinate axis and seen against it: 1 anticlockwise, -1
/// clockwise, 0 collinear.
int turn_around(int axis, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cloth
