#include "integrators/registry.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "integrators/dormand_prince.h"
#include "integrators/euler.h"
#include "integrators/fused_steppers.h"
#include "integrators/implicit_methods.h"
#include "integrators/projective.h"
#include "integrators/rk4.h"
#include "integrators/vbd.h"
#include "integrators/verlet.h"
#include "integrators/xpbd.h"
#include "scene/scene.h"

namespace cloth {
namespace {

using Stepper = std::unique_ptr<Integrator>;

struct Entry {
  MethodFacts facts;
  Stepper (*make)(const IntegratorChoice&);
  bool (*suits_fused)(const ForceModel&, bool constrained) = nullptr;
  Stepper (*make_fused)() = nullptr;
  Stepper (*make_unsolved)(const StepperKind&) = nullptr;  ///< of another EndVelocity than solved
};

template <class Method>
Stepper made(const IntegratorChoice&) {
  return std::make_unique<Method>();
}

template <class Method>
Stepper made_with_newton(const IntegratorChoice& choice) {
  return std::make_unique<Method>(choice.tolerance, static_cast<int>(choice.newton_iterations));
}

using Family = OscillatorStep::Family;

const OscillatorStep implicit_euler_step{.divisors = {}, .implicit = 1};

// Limits in closed form: Jury's test on the matrices of measure/amplification.h.

double explicit_euler_limit(double omega, double c) {
  const double discriminant = 0.25 * c * c - omega * omega;
  return discriminant < 0 ? c / (omega * omega) : 2 / (0.5 * c + std::sqrt(discriminant));
}

double semi_implicit_euler_limit(double omega, double c) {
  return 4 / (std::sqrt(c * c + 4 * omega * omega) + c);
}

double verlet_limit(double omega, double) {
  return omega > 0 ? 2 / omega : infinity;
}

template <class Method>
Stepper made_fused() {
  return std::make_unique<Method>();
}

Stepper made_unsolved_verlet(const StepperKind& kind) {
  if (kind.fused) return std::make_unique<FusedDampedVerlet>(kind.end_velocity);
  return std::make_unique<Verlet>(kind.end_velocity);
}

Entry verlet_entry() {
  return {{.name = "verlet",
           .title = "Verlet",
           .order = 2,
           .evaluations_per_step = 1,
           .source = "Verlet 1967; report, Eq. (14)",
           .keeps_force = true,
           .predicts_damping = true,
           .oscillator = {.family = Family::verlet},
           .limit = verlet_limit,
           .may_heat = true},
          made<Verlet>,
          FusedVerlet::suits,
          made_fused<FusedVerlet>,
          made_unsolved_verlet};
}

/// One entry holds all that is known of a method.
std::vector<Entry> explicit_methods() {
  return {
      {{.name = "explicit-euler",
        .title = "Explicit Euler",
        .order = 1,
        .evaluations_per_step = 1,
        .source = "Euler 1768",
        .oscillator = {.divisors = {1}},
        .limit = explicit_euler_limit},
       made<ExplicitEuler>,
       FusedEuler::suits,
       []() -> Stepper { return std::make_unique<FusedEuler>(true); }},
      {{.name = "semi-implicit-euler",
        .title = "Semi-implicit Euler",
        .order = 1,
        .evaluations_per_step = 1,
        .source = "Provot 1995; report, Eqs. (5)-(7)",
        .oscillator = {.family = Family::semi_implicit_euler},
        .limit = semi_implicit_euler_limit,
        .may_heat = true,
        .bounds_jointly = true},
       made<SemiImplicitEuler>,
       FusedSemiImplicitEuler::suits,
       made_fused<FusedSemiImplicitEuler>},
      verlet_entry(),
      {{.name = "rk4",
        .title = "Runge-Kutta 4",
        .order = 4,
        .evaluations_per_step = kutta_stages,
        .source = "Kutta 1901; report, Eqs. (8)-(13)",
        .oscillator = {.divisors = {1, 2, 3, 4}}},
       made<Rk4>,
       FusedRk4::suits,
       made_fused<FusedRk4>},
      {{.name = "dormand-prince",
        .title = "Dormand-Prince 5(4)",
        .order = 5,
        .source = "Dormand and Prince 1980",
        .settings = MethodSettings::error_control,
        .keeps_force = true,
        .oscillator = {.divisors = {1, 2, 3, 4, 5, 5}},  // ... + z^5/120 + z^6/600
        .has_inner_steps = true,
        .controls_error = true},
       [](const IntegratorChoice& choice) -> Stepper {
         return std::make_unique<DormandPrince>(choice.tolerance);
       }},
  };
}

Entry vbd_entry() {
  return {{.name = "vbd",
           .title = "VBD",
           .order = 1,
           .source = "Chen et al. 2024",
           .settings = MethodSettings::vbd,
           .oscillator = implicit_euler_step,
           .a_stable = true},
          [](const IntegratorChoice& choice) -> Stepper {
            return std::make_unique<Vbd>(static_cast<int>(choice.vbd_iterations),
                                         choice.vbd_acceleration == "chebyshev");
          }};
}

std::vector<Entry> implicit_methods() {
  return {
      {{.name = "implicit-euler",
        .title = "Implicit Euler",
        .order = 1,
        .source = "Baraff and Witkin 1998",
        .settings = MethodSettings::newton,
        .oscillator = implicit_euler_step,
        .a_stable = true,
        .stage_weight = ImplicitEuler::stage_weight},
       made_with_newton<ImplicitEuler>},
      {{.name = "implicit-midpoint",
        .title = "Implicit midpoint",
        .order = 2,
        .source = "Volino and Magnenat-Thalmann 2005",
        .settings = MethodSettings::newton,
        .oscillator = {.divisors = {2}, .implicit = 0.5},
        .a_stable = true,
        .stage_weight = ImplicitMidpoint::stage_weight},
       made_with_newton<ImplicitMidpoint>},
      {{.name = "bdf2",
        .title = "BDF2",
        .order = 2,
        .source = "Curtiss and Hirschfelder 1952; Choi and Ko 2002",
        .settings = MethodSettings::newton,
        .oscillator = {.family = Family::bdf2},
        .a_stable = true,
        .stage_weight = Bdf2::stage_weight},
       made_with_newton<Bdf2>},
      // On a linear oscillator the converged iterations of the next three (compliance 1/k) are implicit
      // Euler.
      {{.name = "projective",
        .title = "Projective dynamics",
        .order = 1,
        .source = "Liu et al. 2013; Liu et al. 2017",
        .settings = MethodSettings::projective,
        .oscillator = implicit_euler_step,
        .a_stable = true},
       [](const IntegratorChoice& choice) -> Stepper {
         return std::make_unique<Projective>(static_cast<int>(choice.projective_iterations),
                                             make_acceleration(choice.projective_acceleration));
       }},
      {{.name = "xpbd",
        .title = "XPBD",
        .order = 1,
        .source = "Macklin et al. 2016; Macklin et al. 2019",
        .settings = MethodSettings::xpbd,
        .oscillator = implicit_euler_step,
        .a_stable = true,
        .has_inner_steps = true,
        .iterates_to_residual = false},
       [](const IntegratorChoice& choice) -> Stepper {
         return std::make_unique<Xpbd>(static_cast<int>(choice.substeps),
                                       static_cast<int>(choice.xpbd_iterations));
       }},
      vbd_entry(),
  };
}

/// In the order in which methods are listed everywhere.
const std::vector<Entry>& registry() {
  static const std::vector<Entry> entries = [] {
    std::vector<Entry> all = explicit_methods();
    for (const Entry& entry : implicit_methods()) all.push_back(entry);
    return all;
  }();
  return entries;
}

template <class Value, class Get>
std::vector<Value> collect(Get get) {
  std::vector<Value> values;
  for (const Entry& entry : registry()) values.push_back(get(entry));
  return values;
}

const Entry& entry_of(const std::string& name) {
  const auto found = std::find_if(registry().begin(), registry().end(),
                                  [&](const Entry& entry) { return entry.facts.name == name; });
  assert(found != registry().end());
  return *found;
}

}  // namespace

const std::vector<std::string>& integrator_names() {
  static const auto names = collect<std::string>([](const Entry& entry) { return entry.facts.name; });
  return names;
}

const std::vector<MethodFacts>& integrator_facts() {
  static const auto facts = collect<MethodFacts>([](const Entry& entry) { return entry.facts; });
  return facts;
}

const MethodFacts& facts_of(const std::string& name) {
  return entry_of(name).facts;
}

std::unique_ptr<Integrator> make_integrator(const IntegratorChoice& choice) {
  return entry_of(choice.method).make(choice);
}

/// Where the end velocity has a closed form for each particle and no pass gains by a prediction, it is
/// solved.
StepperKind stepper_kind(const std::string& method, const ForceModel& forces, const StepperNeeds& needs) {
  const Entry& entry = entry_of(method);
  StepperKind kind;
  if (entry.make_unsolved && needs.end_velocity != EndVelocity::solved) {
    const bool sweeps = FusedDampedVerlet::suits(forces);
    const bool gains = sweeps && needs.end_velocity == EndVelocity::predicted && forces.swept().air;
    if (forces.couples_particles() || gains) return {.fused = sweeps, .end_velocity = needs.end_velocity};
  }
  kind.fused = entry.suits_fused && entry.suits_fused(forces, needs.constrained);
  return kind;
}

std::unique_ptr<Integrator> make_stepper(const IntegratorChoice& choice, const StepperKind& kind) {
  const Entry& entry = entry_of(choice.method);
  if (kind.end_velocity != EndVelocity::solved) return entry.make_unsolved(kind);
  return kind.fused ? entry.make_fused() : make_integrator(choice);
}

}  // namespace cloth
