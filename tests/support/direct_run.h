// A force model and an integrator without the loop around them: for laws of the method alone, from any state.
#pragma once

#include <memory>
#include <string>

#include "integrators/integrator.h"
#include "integrators/registry.h"
#include "scene/scene.h"

namespace cloth::test {

/// The method with settings that leave nothing but its step to decide the answer: no error control, no
/// substeps, Newton's method to rounding, and iterations over local solves or constraints, each of which
/// gains a factor of w^2, as many as reach rounding and two more, at most 30. w: omega h or more; omega in
/// rad/s of the fastest motion.
IntegratorChoice exactly(const std::string& method, std::optional<double> time_step = {}, double w = 1);

class DirectRun {
 public:
  DirectRun(const Scene& scene, const IntegratorChoice& choice);
  DirectRun(const Scene& scene, const std::string& method) : DirectRun(scene, exactly(method)) {}
  /// A system made by hand; the scene gives the forces beside its springs.
  DirectRun(ClothSystem made, const Scene& scene, const IntegratorChoice& choice);
  DirectRun(const DirectRun&) = delete;
  DirectRun& operator=(const DirectRun&) = delete;

  /// `steps` steps of length `step`; time goes on as n * step. Throws what an integrator gives up for.
  void advance(int steps, double step);

  /// The acceleration of every particle at the present state, in m/s^2; zero on pins.
  Vec3Field acceleration();

  /// The stepper that suits the forces now.
  Integrator& integrator();

  /// Verlet takes damping so from now on: whether the step allows it is not asked here.
  void take_damping(EndVelocity end) { end_velocity_ = end; }

  ClothSystem system;
  ClothState state;
  ForceModel forces;
  Work work;
  int force_evaluations = 0, inner_steps = 0, rejected_steps = 0;

 private:
  IntegratorChoice choice_;
  EndVelocity end_velocity_ = EndVelocity::solved;
  StepperKind kind_;
  std::unique_ptr<Integrator> integrator_;
};

/// Takes a step of `h` seconds: the largest m (v' - v) - h f of a free particle that it leaves, f the forces
/// at its end, over the largest m (v' - v).
double left_of_the_step_equations(DirectRun& run, double h);

}  // namespace cloth::test
