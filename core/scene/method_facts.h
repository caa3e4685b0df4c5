// The properties of each method, declared in integrators/registry.cpp. Scene files, forms, stability theory
// and reports use them without including the methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cloth {

/// Which settings of IntegratorChoice a method has in addition to its time step.
enum class MethodSettings { none, error_control, newton, projective, xpbd, vbd };

/// The step of a method on the oscillator x'' = -omega^2 x - c x', used by measure/amplification.h. For the
/// Runge-Kutta family the stability function is R(z) = (1 + z/a (1 + z/b (1 + ...))) / (1 - implicit z),
/// `divisors` a, b, ... (stability functions: Hairer et al., II, IV.2 and IV.3).
struct OscillatorStep {
  enum class Family { runge_kutta, semi_implicit_euler, verlet, bdf2 };
  Family family = Family::runge_kutta;
  std::vector<double> divisors = {};
  double implicit = 0;
};

struct MethodFacts {
  std::string name;              ///< as it stands in scene files
  std::string title;             ///< for people: "Semi-implicit Euler"
  int order = 1;                 ///< of the position error, for smooth scenes
  int evaluations_per_step = 0;  ///< of the force; 0: depends on iterations or error control
  std::string source;
  MethodSettings settings = MethodSettings::none;
  /// Reuses the force at the end of a step in the next one. It is evaluated once more where something else
  /// has changed the state in between, such as contact.
  bool keeps_force = false;
  bool predicts_damping = false;  ///< where damping is weak: predicted_damping_load() of stability_limit.h
  OscillatorStep oscillator = {};
  /// The largest stable step in s for the oscillator with omega and c in 1/s, not both 0: 0 if none is
  /// stable. No closed form: scanned_limit() of measure/amplification.h. Not asked where `a_stable`.
  double (*limit)(double omega, double c) = nullptr;
  bool a_stable = false;  ///< stable for every oscillator at every step
  /// The weight of the forces in the equations that the method solves, divided by the step; none: it solves
  /// none.
  std::optional<double> stage_weight = {};
  bool has_inner_steps = false;      ///< divides its steps, and meets contact at the end of each part
  bool controls_error = false;       ///< divides its steps where a tolerance is given
  bool may_heat = false;             ///< may gain energy slowly below its limit (simulation/automatic_step.h)
  bool bounds_jointly = false;       ///< springs and dampers share one bound, h^2 K + 2 h C < 4 m
  bool iterates_to_residual = true;  ///< a residual above tolerance means that its equations are not solved
};

/// All methods, in the order in which they are listed everywhere.
const std::vector<MethodFacts>& integrator_facts();
const std::vector<std::string>& integrator_names();
/// Precondition: `name` is one of integrator_names().
const MethodFacts& facts_of(const std::string& name);

}  // namespace cloth
