// The one list of methods.
#pragma once

#include <memory>
#include <string>

#include "scene/method_facts.h"

namespace cloth {

class ForceModel;
class Integrator;
struct IntegratorChoice;

/// The method for any forces. Precondition: `choice.method` is one of integrator_names().
std::unique_ptr<Integrator> make_integrator(const IntegratorChoice& choice);

/// Whether the method has a fused stepper (fused_steppers.h) that knows all of `forces`; `constrained`:
/// beside a DriftConstraint.
bool suits_fused_stepper(const std::string& method, const ForceModel& forces, bool constrained);

/// The fused stepper where it suits, else the general method. What it is made for may not change: a pull, a
/// brush, another cloth may need the other one.
std::unique_ptr<Integrator> make_stepper(const IntegratorChoice& choice, const ForceModel& forces,
                                         bool constrained);

}  // namespace cloth
