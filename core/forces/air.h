// The air. Drag along the normal, Eq. (4) of the report: F_i = c_a (n . (u - v_i)) n, where n is the unit
// normal and u the air's velocity at particle i: the wind, its gusts and the wind brush. The force is written
// in air.cpp; friction along the cloth, F_i = c_t (I - n n^T) (u - v_i), in skin_friction.cpp.
//
// Both are of the form p - D v (force.h): the wind is in p (Force::update), the resistance to the particle's
// own velocity in D (Force::add_damping). Every method receives them through ForceModel. Explicit and
// Runge-Kutta methods evaluate p - D v with the velocity of the evaluation; Verlet does so in its opening
// kick and solves for the velocity at the end of the step in its closing kick, or takes one that a
// step predicts or corrects (verlet.h); the fused steppers compute both on grids within their pass
// (kernels/grid_air.h).
#pragma once

#include "forces/force.h"
#include "forces/hand.h"
#include "scene/scene.h"

namespace cloth {

/// wind * (1 + amplitude * sin(2 pi frequency t)), in m/s, at `time` in s.
Vec3 wind_at(const Air& air, double time);

/// The part of the brush's velocity that a particle at `position` in m feels: cos(pi/2 * r/radius) within the
/// radius, r in pixels on the screen; else 0.
double brush_falloff(const BrushGust& brush, const Vec3& position);

/// The wind of a scene; without "air" none.
Air wind_of(const Scene& scene);

/// c_a and c_t: of "air" for each particle, of a material for each area, which is its mass over its areal
/// density.
NodeCoefficient drag_along_normal(const Scene& scene);
NodeCoefficient drag_along_cloth(const Scene& scene);

/// The parameter that they are given by.
inline const char* normal_drag_path(const Scene& scene) {
  return scene.material ? "material.drag_normal" : "air.drag";
}
inline const char* cloth_drag_path(const Scene& scene) {
  return scene.material ? "material.drag_tangential" : "air.skin_friction";
}

}  // namespace cloth
