// A sitting rabbit, modelled here from ellipsoids that melt into each other.
#pragma once

#include "geometry/triangle_mesh.h"

namespace cloth {

/// About the signed distance to the rabbit's surface, m.
double bunny_distance(const Vec3& position);

/// Its surface as triangles, closed and facing outward: 1 m high from the ground y = 0, looking along x.
TriangleMesh make_bunny(double cell);

}  // namespace cloth
