// The list of methods, and how a stepper is chosen. To add a method, see docs/architecture.md.
#pragma once

#include <memory>
#include <string>

#include "scene/method_facts.h"

namespace cloth {

class ForceModel;
class Integrator;
struct IntegratorChoice;

/// The general method, which works with any forces. Precondition: `choice.method` is one of
/// integrator_names().
std::unique_ptr<Integrator> make_integrator(const IntegratorChoice& choice);

/// Whether the method has a fused stepper (fused_steppers.h) that supports all of `forces`; `constrained`:
/// together with a DriftConstraint.
bool suits_fused_stepper(const std::string& method, const ForceModel& forces, bool constrained);

/// The fused stepper where it is suitable, else the general method. Call it again after a change of the
/// forces, the cloth or the constraint.
std::unique_ptr<Integrator> make_stepper(const IntegratorChoice& choice, const ForceModel& forces,
                                         bool constrained);

}  // namespace cloth
