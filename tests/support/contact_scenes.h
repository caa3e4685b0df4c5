// Small scenes of continuous contact, and what of a state has come through.
#pragma once

#include "simulation/simulation.h"
#include "support/crossings.h"

namespace cloth::test {

/// A square sheet of 0.4 m lying `height` metres over the origin, a little off the middle so that nothing is
/// symmetric.
Scene sheet_over(double height, int particles_a_side = 9);

/// Shapes of obstacles about the origin that a falling sheet of 0.4 m meets: "sphere", "box", "corner" (a box
/// that stands on its corner), "plane", "cones" (a mesh), "ball-from-below" (moving), "turning-box", "itself"
/// (a sheet that stands and folds on a plane).
Scene contact_scene(const std::string& name);
const std::vector<std::string>& contact_scene_names();

/// All particles of the cloth start with this velocity, in m/s, except pins.
Preparation thrown(const Vec3& velocity);

/// Triangles, edges and vertices of the cloth that touch or have passed an obstacle or, where the scene has
/// self-contact, each other: by the brute-force checker.
Count all_crossings(const Simulation& simulation);

}  // namespace cloth::test
