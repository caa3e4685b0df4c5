// Small differences between the distances that an obstacle keeps to the particles of a cloth that started
// flat. A cloth that lies exactly flat never buckles, however it is compressed, because no force leads out of
// its plane.
#pragma once

#include <vector>

#include "contact/surface.h"
#include "scene/scene.h"

namespace cloth {

/// Whether a cloth with these initial positions, in m, is flat and can be compressed: between an obstacle at
/// rest and one that moves.
bool needs_stagger(const std::vector<Obstacle>& obstacles, const Surface& surface, const Vec3Field& start);

/// The distance that an obstacle at rest keeps to a particle: up to half a per cent more than `thickness`, in
/// m.
double staggered(double thickness, int particle);

}  // namespace cloth
