#include "integrators/registry.h"

#include <algorithm>
#include <cassert>
#include <functional>

#include "integrators/dormand_prince.h"
#include "integrators/euler.h"
#include "integrators/implicit_methods.h"
#include "integrators/projective.h"
#include "integrators/rk4.h"
#include "integrators/verlet.h"
#include "integrators/xpbd.h"
#include "scene/scene.h"

namespace cloth {
namespace {

struct Entry {
  MethodFacts facts;
  std::function<std::unique_ptr<Integrator>(const IntegratorChoice&)> make;
};

template <class Method>
std::unique_ptr<Integrator> made(const IntegratorChoice&) {
  return std::make_unique<Method>();
}

template <class Method>
std::unique_ptr<Integrator> made_with_newton(const IntegratorChoice& choice) {
  return std::make_unique<Method>(choice.tolerance, static_cast<int>(choice.newton_iterations));
}

const std::vector<Entry>& registry() {
  static const std::vector<Entry> entries{
      {{"explicit-euler", "Explicit Euler", 1, 1, "Euler 1768"}, made<ExplicitEuler>},
      {{"semi-implicit-euler", "Semi-implicit Euler", 1, 1, "Provot 1995; report, Eqs. (5)-(7)"},
       made<SemiImplicitEuler>},
      {{"verlet", "Verlet", 2, 1, "Verlet 1967; report, Eq. (14)", true}, made<Verlet>},
      {{"rk4", "Runge-Kutta 4", 4, 4, "Kutta 1901; report, Eqs. (8)-(13)"}, made<Rk4>},
      {{"dormand-prince", "Dormand-Prince 5(4)", 5, 0, "Dormand and Prince 1980", true,
        MethodSettings::error_control},
       [](const IntegratorChoice& choice) { return std::make_unique<DormandPrince>(choice.tolerance); }},
      {{"implicit-euler", "Implicit Euler", 1, 0, "Baraff and Witkin 1998", false, MethodSettings::newton},
       made_with_newton<ImplicitEuler>},
      {{"implicit-midpoint", "Implicit midpoint", 2, 0, "Volino and Magnenat-Thalmann 2005", false,
        MethodSettings::newton},
       made_with_newton<ImplicitMidpoint>},
      {{"bdf2", "BDF2", 2, 0, "Curtiss and Hirschfelder 1952; Choi and Ko 2002", false,
        MethodSettings::newton},
       made_with_newton<Bdf2>},
      {{"projective", "Projective dynamics", 1, 0, "Liu et al. 2013; Liu, Bouaziz, Kavan 2017", false,
        MethodSettings::projective},
       [](const IntegratorChoice& choice) {
         return std::make_unique<Projective>(static_cast<int>(choice.projective_iterations));
       }},
      {{"xpbd", "XPBD", 1, 0, "Macklin, Müller, Chentanez 2016; Macklin et al. 2019", false,
        MethodSettings::xpbd},
       [](const IntegratorChoice& choice) {
         return std::make_unique<Xpbd>(static_cast<int>(choice.substeps),
                                       static_cast<int>(choice.xpbd_iterations));
       }},
  };
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

}  // namespace cloth
