// Small scenes to start a test from.
#pragma once

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth::test {

/// A sheet of square cells in the plane z = 0, hanging down from the origin, and no physics at all.
Scene bare_sheet(int rows, int columns, double spacing = 0.1, double particle_mass = 0.01);

/// The same sheet lying in the plane y = 0 with its front up.
Scene lying_sheet(int rows, int columns, double spacing = 0.1, double particle_mass = 0.01);

/// Springs of one family alone.
SpringMaterial only(SpringFamily family, double stiffness);

/// Everything that moves smoothly: springs, viscous damping, gravity, air, wind and gust; hung by two
/// corners.
Scene smooth_scene(int rows, int columns);
/// The same with dampers along springs and skin friction.
Scene damped_smooth_scene(int rows, int columns);

}  // namespace cloth::test
