// The list of methods, and how a stepper is chosen. To add a method, see docs/architecture.md.
#pragma once

#include <memory>
#include <string>

#include "integrators/end_velocity.h"
#include "scene/method_facts.h"

namespace cloth {

class ForceModel;
class Integrator;
struct IntegratorChoice;

/// The general method, which works with any forces. Precondition: `choice.method` is one of
/// integrator_names().
std::unique_ptr<Integrator> make_integrator(const IntegratorChoice& choice);

/// What decides between the steppers of a method, beside the forces.
struct StepperNeeds {
  bool constrained = false;                        ///< it steps together with a DriftConstraint
  EndVelocity end_velocity = EndVelocity::solved;  ///< the cheapest that the damping is weak enough for
};

struct StepperKind {
  bool fused = false;  ///< a stepper of fused_steppers.h, else the general method
  /// Another than solved only of Verlet, where damping couples particles or is air's.
  EndVelocity end_velocity = EndVelocity::solved;
  bool operator==(const StepperKind&) const = default;
};

/// The fastest stepper of the method that supports all of `forces`. Ask again after a change of the forces,
/// the cloth or the needs.
StepperKind stepper_kind(const std::string& method, const ForceModel& forces, const StepperNeeds& needs);

std::unique_ptr<Integrator> make_stepper(const IntegratorChoice& choice, const StepperKind& kind);

}  // namespace cloth
