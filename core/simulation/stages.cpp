#include "simulation/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "contact/continuous_contact.h"
#include "forces/registry.h"
#include "integrators/integrator.h"
#include "integrators/registry.h"
#include "limiter/deformation_limiter.h"
#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"
#include "simulation/predicted_damping.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

StageInfo limiter_stage(const Scene& scene, const ClothSystem& system) {
  const char* name = "deformation rate";
  if (auto absent = absent_stage(name, scene, "deformation")) return *absent;
  if (!DeformationLimiter::is_needed(*scene.deformation, system))
    return {name, false, "no spring of the families in deformation.springs exists"};
  const Deformation& deformation = *scene.deformation;
  std::string how = fmt::format("at most {} sweeps a step", deformation.max_sweeps);
  if (deformation.solver == "direct") how = "the nearest shape, by the direct solver";
  if (deformation.solver == "auto") how = "by tensions of the springs";
  return {name, true,
          fmt::format("{} springs to {} %, {}", fmt::join(deformation.springs, " and "),
                      100 * deformation.rate, how)};
}

StageInfo contact_stage(const Scene& scene) {
  if (auto absent = absent_stage("contact", scene, "obstacles")) return *absent;
  const std::string count =
      fmt::format("{} obstacle{}", scene.obstacles.size(), scene.obstacles.size() == 1 ? "" : "s");
  const char* when =
      facts_of(scene.integrator.method).has_inner_steps ? ", at the end of every inner step" : "";
  if (!has_continuous_contact(scene)) return {"contact", true, count + when};
  const auto moving = std::count_if(scene.obstacles.begin(), scene.obstacles.end(), &moves);
  return {"contact", true,
          fmt::format("{}{}, without gaps, {} m thick{}", count,
                      moving > 0 ? fmt::format(" ({} moving)", moving) : "",
                      scene.contact.value_or(ContactSettings{}).thickness, when)};
}

StageInfo self_contact_stage(const Scene& scene) {
  if (auto absent = absent_stage("self-contact", scene, "self_contact")) return *absent;
  return {"self-contact", true, fmt::format("without gaps, {} m thick", scene.self_contact->thickness)};
}

std::string evaluations_text(const MethodFacts& method) {
  const int count = method.evaluations_per_step;
  if (count == 0) return "as many force evaluations a step as needed";
  return fmt::format("{} force evaluation{} a step", count, count == 1 ? "" : "s");
}

std::string visits_text(Integrator& integrator, const Scene& scene, const ClothSystem& system) {
  const std::string text = integrator.visits_text(ForceModel(scene, system));
  return text.empty() ? "" : ", " + text;
}

/// How Verlet takes the damping, and why.
std::string damping_text(const Scene& scene, const ClothSystem& system, bool limited) {
  const auto step = resolved_time_step(scene);
  const ForceModel forces(scene, system);
  if (!facts_of(scene.integrator.method).predicts_damping || !step || !forces.has_damping()) return "";
  const DampingLoads loads = damping_loads(scene, *step);
  const StepperKind kind =
      stepper_kind(scene.integrator.method, forces,
                   {.constrained = limited, .end_velocity = end_velocity_for(scene, loads)});
  const double most = allowed_damping_load(scene);
  const char* const where = kind.fused ? " in the pass of the forces" : "";
  if (!forces.couples_particles() && kind.end_velocity == EndVelocity::solved)
    return ", damping solved for each particle by itself";
  if (kind.end_velocity == EndVelocity::predicted)
    return fmt::format(", damping at the predicted velocity{} (h^2 K + 4 h D is {:.2f} of 4 m, at most {})",
                       where, loads.whole, most);
  const std::string reason = fmt::format(
      "(h^2 K + 4 h D may reach {:.2f} of 4 m, predicted up to {}; h D {:.2f} of m, evaluated "
      "twice up to {}, three times up to {})",
      loads.whole, most, loads.damping, largest_corrected_load, largest_corrected_twice_load);
  if (kind.end_velocity == EndVelocity::corrected)
    return fmt::format(", damping evaluated twice{} {}", where, reason);
  if (kind.end_velocity == EndVelocity::corrected_twice)
    return fmt::format(", damping evaluated three times{} {}", where, reason);
  return ", damping solved for by conjugate gradients " + reason;
}

}  // namespace

std::vector<StageInfo> explain_stages(const Scene& scene) {
  const ClothSystem system = make_cloth(scene);
  const MethodFacts& method = facts_of(scene.integrator.method);
  const std::unique_ptr<Integrator> integrator = make_integrator(scene.integrator);
  const bool limits_within = integrator->set_drift_constraint(nullptr);
  const bool limited = limiter_stage(scene, system).present;
  const StageInfo contact = contact_stage(scene);
  const bool moved_later = contact.present || scene.self_contact || (!limits_within && limited);
  std::vector<StageInfo> stages;
  for (const ForceEntry& force : force_registry())
    for (StageInfo& stage : force.explain(scene, system)) stages.push_back(std::move(stage));
  stages.push_back(
      {"integrate", true,
       fmt::format("{}: order {}, {}", method.title, method.order, evaluations_text(method)) +
           visits_text(*integrator, scene, system) + damping_text(scene, system, limited) +
           (method.keeps_force && moved_later ? ", one more after a step that the stages below changed"
                                              : "")});
  stages.push_back(limiter_stage(scene, system));
  stages.push_back(contact);
  stages.push_back(self_contact_stage(scene));
  return stages;
}

}  // namespace cloth
