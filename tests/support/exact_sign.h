// On which side points lie, without any error: the sign of the determinant in doubles, then in long doubles,
// where its error bound allows, else by expansions, sums of doubles that are exact (Shewchuk 1997).
// Exact as long as no product of three coordinate differences leaves the range of doubles.
#pragma once

#include "geometry/vec3_field.h"

namespace cloth::test {

/// 1 where `point` lies on the side to which (b - a) x (c - a) points, -1 on the other, 0 in the plane.
int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// The same by expansions alone: to test the above.
int side_of_plane_by_expansions(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// 1 where a, b, c turn anticlockwise as seen along `axis` from above it, -1 clockwise, 0 on a line.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

/// The sign of normal . (point - origin).
int side_of_half_space(const Vec3& normal, const Vec3& origin, const Vec3& point);

}  // namespace cloth::test
