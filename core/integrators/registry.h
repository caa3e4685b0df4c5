// The one visible list of methods.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace cloth {

class Integrator;

/// Names as they stand in scene files, in the order in which they are listed everywhere.
const std::vector<std::string>& integrator_names();

struct MethodFacts {
  std::string name;
  std::string title;  ///< for people: "Semi-implicit Euler"
  int order = 1;      ///< of the position error, for smooth scenes
  int evaluations_per_step = 1;
  std::string source;
  bool keeps_force = false;  ///< over to the next step: one more evaluation if something else moved the cloth
};

const std::vector<MethodFacts>& integrator_facts();
const MethodFacts& facts_of(const std::string& name);

/// Precondition: `name` is one of integrator_names().
std::unique_ptr<Integrator> make_integrator(const std::string& name);

}  // namespace cloth
