// Perturbs the contact thickness from particle to particle for a cloth that starts flat. A cloth that lies
// exactly in a plane does not buckle under compression, because no force has a component out of the plane;
// the perturbation breaks this symmetry.
#pragma once

#include <vector>

#include "contact/surface.h"
#include "scene/scene.h"

namespace cloth {

/// Whether a cloth with the initial positions `start` (m) is flat and can be compressed between an obstacle
/// at rest and one that moves.
bool needs_stagger(const std::vector<Obstacle>& obstacles, const Surface& surface, const Vec3Field& start);

/// The thickness (m) that an obstacle at rest keeps to this particle: `thickness` increased by a
/// pseudo-random part of up to 0.5 %.
double staggered(double thickness, int particle);

}  // namespace cloth
