// What is known of each method: one entry of integrators/registry.cpp holds it all. Scene files, forms,
// stability theory and reports read it here, without the methods themselves.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cloth {

/// Which settings of IntegratorChoice a method has beside its step.
enum class MethodSettings { none, error_control, newton, projective, xpbd };

/// A step on the oscillator x'' = -omega^2 x - c x'; measure/amplification.h computes with it. Of the
/// Runge-Kutta family: R(z) = (1 + z/a (1 + z/b (1 + ...))) / (1 - implicit z), `divisors` a, b, ...
/// (stability functions: Hairer et al., II, IV.2 and IV.3).
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
  int evaluations_per_step = 0;  ///< of the force; 0: as many as its iterations or its error control take
  std::string source;
  MethodSettings settings = MethodSettings::none;
  bool keeps_force = false;  ///< over to the next step: one more evaluation if something else moved the cloth
  OscillatorStep oscillator = {};
  /// The largest stable step in s for the oscillator with omega and c in 1/s, not both 0: 0 if none is
  /// stable. No closed form: scanned_limit() of measure/amplification.h. Not asked where `a_stable`.
  double (*limit)(double omega, double c) = nullptr;
  bool a_stable = false;  ///< stable for every oscillator at every step
  /// The part of the step with which forces count in the equations that the method solves.
  std::optional<double> stage_weight = {};
  bool controls_error = false;       ///< divides its steps where a tolerance is given
  bool may_heat = false;             ///< can gain energy slowly below its limit, so that "auto" looks for it
  bool bounds_jointly = false;       ///< springs and dampers share one bound, h^2 K + 2 h C < 4 m
  bool iterates_to_residual = true;  ///< an open residual means that its equations are not solved
};

/// All methods, in the order in which they are listed everywhere.
const std::vector<MethodFacts>& integrator_facts();
const std::vector<std::string>& integrator_names();
/// Precondition: `name` is one of integrator_names().
const MethodFacts& facts_of(const std::string& name);

}  // namespace cloth
