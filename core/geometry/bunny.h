// A sitting rabbit, modelled as a smooth union of ellipsoids.
#pragma once

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Approximate signed distance to the rabbit's surface, m.
double bunny_distance(const Vec3& position);

/// Its surface as triangles, closed and facing outward: 1 m high from the ground y = 0, facing +x. `cell`:
/// spacing in m of the grid on which the surface is sampled.
TriangleMesh make_bunny(double cell);

}  // namespace cloth
