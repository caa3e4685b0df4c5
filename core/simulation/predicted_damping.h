// How Verlet finds the damping at the end of a step (integrators/end_velocity.h), and the step at which
// `auto` lets it predict.
#pragma once

#include "integrators/end_velocity.h"
#include "scene/scene.h"

namespace cloth {

/// How strong damping is for a step, beside the inertia of the particles.
struct DampingLoads {
  double whole = 0;    ///< predicted_damping_load() of measure/stability_limit.h
  double damping = 0;  ///< damping_load()
};

DampingLoads damping_loads(const Scene& scene, double step);

/// The cheapest way that these loads allow.
EndVelocity end_velocity_for(const Scene& scene, const DampingLoads& loads);

/// The predicted_damping_load() (measure/stability_limit.h) up to which a scene's damping is predicted. With
/// contact particle by particle less than for stability alone: contact changes velocities after the closing
/// kick, whose damping was that of the prediction, so that the ledger's error grows with (omega h)^2 there.
double allowed_damping_load(const Scene& scene);

/// The number of steps to a record interval of `interval` s where `parts` are enough for stability: `parts`,
/// or the smallest larger number at which Verlet may predict the damping of a grid's dampers, if that is one
/// more or takes no more time than the solves would: at most 24 times as many, 8 times with contact particle
/// by particle.
double parts_to_predict(const Scene& scene, double interval, double parts);

}  // namespace cloth
