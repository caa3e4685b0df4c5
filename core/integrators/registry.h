// The one visible list of methods.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace cloth {

class Integrator;
struct IntegratorChoice;

/// Which settings of IntegratorChoice a method has beside its step.
enum class MethodSettings { none, error_control, newton, projective, xpbd };

/// Names as they stand in scene files, in the order in which they are listed everywhere.
const std::vector<std::string>& integrator_names();

struct MethodFacts {
  std::string name;
  std::string title;             ///< for people: "Semi-implicit Euler"
  int order = 1;                 ///< of the position error, for smooth scenes
  int evaluations_per_step = 1;  ///< of the force; 0: as many as its iterations or its error control take
  std::string source;
  bool keeps_force = false;  ///< over to the next step: one more evaluation if something else moved the cloth
  MethodSettings settings = MethodSettings::none;
};

const std::vector<MethodFacts>& integrator_facts();
const MethodFacts& facts_of(const std::string& name);

/// Precondition: `choice.method` is one of integrator_names().
std::unique_ptr<Integrator> make_integrator(const IntegratorChoice& choice);

}  // namespace cloth
