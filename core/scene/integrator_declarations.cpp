// The parameters of the time integrator: those of all methods and what some have of their own.
#include <map>

#include "params/field_builders.h"
#include "scene/method_facts.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

Fields<IntegratorChoice> common_integrator_fields() {
  using I = IntegratorChoice;
  return {
      field(
          &I::method,
          {.key = "method", .label = "Method", .doc = "The time integrator.", .choices = integrator_names()}),
      number_or_auto(&I::time_step,
                     positive({.key = "time_step",
                               .label = "Time step",
                               .unit = "s",
                               .doc = "Length of a step; auto takes 80 % of the method's limit for the "
                                      "flat cloth, and at most 95 % of that for every shape.",
                               .scale = Scale::logarithmic,
                               .slider_minimum = 1e-6,
                               .slider_maximum = 0.1})),
  };
}

Field<IntegratorChoice> tolerance_field(double minimum, bool excluded, const char* doc) {
  return field(&IntegratorChoice::tolerance, {.key = "tolerance",
                                              .label = "Tolerance",
                                              .doc = doc,
                                              .scale = Scale::logarithmic,
                                              .minimum = minimum,
                                              .maximum = 1,
                                              .minimum_excluded = excluded,
                                              .slider_minimum = 1e-12,
                                              .slider_maximum = 1e-2});
}

Field<IntegratorChoice> count_field(std::int64_t IntegratorChoice::*member, const char* key,
                                    const char* label, const char* doc) {
  return field(member, {.key = key,
                        .label = label,
                        .doc = doc,
                        .scale = Scale::logarithmic,
                        .minimum = 1,
                        .maximum = 100000,
                        .slider_minimum = 1,
                        .slider_maximum = 200});
}

Fields<IntegratorChoice> own_integrator_fields(MethodSettings settings) {
  using I = IntegratorChoice;
  switch (settings) {
    case MethodSettings::none:
      return {};
    case MethodSettings::error_control:
      return {
          tolerance_field(0, false,
                          "Largest error of an inner step, relative to the cloth's diagonal; 0 takes every "
                          "time step as it is.")};
    case MethodSettings::newton:
      return {
          tolerance_field(0, true,
                          "Change of the velocities at which Newton's method ends, relative to the largest."),
          count_field(&I::newton_iterations, "iterations", "Most iterations",
                      "Iterations of Newton's method after which a step has failed.")};
    case MethodSettings::projective:
      return {count_field(&I::projective_iterations, "iterations", "Iterations",
                          "Local and global solves of a step."),
              field(&I::projective_acceleration,
                    {.key = "acceleration",
                     .label = "Acceleration",
                     .doc = "How the iterations of a step are accelerated; the limit is the same.",
                     .choices = {"none", "chebyshev", "anderson", "l-bfgs"}})};
    case MethodSettings::xpbd:
      return {count_field(&I::substeps, "substeps", "Substeps", "Parts that a time step is taken in."),
              count_field(&I::xpbd_iterations, "iterations", "Iterations",
                          "Passes over all springs in a substep.")};
    case MethodSettings::vbd:
      return {
          count_field(&I::vbd_iterations, "iterations", "Iterations", "Visits of every particle in a step."),
          field(&I::vbd_acceleration, {.key = "acceleration",
                                       .label = "Acceleration",
                                       .doc = "What extrapolates between the iterations.",
                                       .choices = {"none", "chebyshev"}})};
  }
  return {};
}

}  // namespace

const Fields<IntegratorChoice>& integrator_fields(const std::string& method) {
  static const auto all = [] {
    std::map<std::string, Fields<IntegratorChoice>> fields;
    for (const MethodFacts& facts : integrator_facts()) {
      Fields<IntegratorChoice>& of_method = fields[facts.name] = common_integrator_fields();
      for (Field<IntegratorChoice>& own : own_integrator_fields(facts.settings))
        of_method.push_back(std::move(own));
    }
    fields[""] = common_integrator_fields();
    return fields;
  }();
  const auto found = all.find(method);
  return found == all.end() ? all.at("") : found->second;
}

}  // namespace cloth
