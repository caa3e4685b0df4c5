#include "simulation/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "contact/continuous_contact.h"
#include "integrators/integrator.h"
#include "integrators/registry.h"
#include "limiter/deformation_limiter.h"

namespace cloth {
namespace {

StageInfo spring_stage(const Scene& scene, const ClothSystem& system, SpringFamily family) {
  const std::string name = fmt::format("{} springs", name_of(family));
  if (!scene.springs) return {name, false, "the scene has no \"springs\""};
  const double stiffness = stiffness_of(*scene.springs, family);
  if (!(stiffness > 0)) return {name, false, fmt::format("springs.{} is 0", name_of(family))};
  const auto count = system.spring_count(family);
  if (count == 0 && family == SpringFamily::shear && system.is_mesh())
    return {name, false, "a mesh has edges and no cells to shear"};
  if (count == 0) return {name, false, "the grid is too small for any"};
  return {name, true, fmt::format("{} springs of {} N/m", count, stiffness)};
}

StageInfo positive_stage(const char* name, bool block, const char* block_name, double value, const char* key,
                         const char* unit) {
  if (!block) return {name, false, fmt::format("the scene has no \"{}\"", block_name)};
  if (!(value > 0)) return {name, false, fmt::format("{} is 0", key)};
  return {name, true, fmt::format("{} = {} {}", key, value, unit)};
}

StageInfo gravity_stage(const Scene& scene) {
  if (!scene.gravity) return {"gravity", false, "the scene has no \"gravity\""};
  if (!(scene.gravity->squaredNorm() > 0)) return {"gravity", false, "gravity is 0"};
  const Vec3& g = *scene.gravity;
  return {"gravity", true, fmt::format("[{}, {}, {}] m/s^2", g.x(), g.y(), g.z())};
}

StageInfo wind_stage(const Scene& scene) {
  if (!scene.air || !(scene.air->drag > 0)) return {"wind", false, "there is no air to blow"};
  if (!(scene.air->wind.squaredNorm() > 0)) return {"wind", false, "air.wind is 0: the air only drags"};
  const bool gusts = scene.air->gust && scene.air->gust->amplitude > 0;
  return {"wind", true,
          fmt::format("{:.4g} m/s{}", scene.air->wind.norm(), gusts ? " with gusts" : ", steady")};
}

StageInfo limiter_stage(const Scene& scene, const ClothSystem& system) {
  const char* name = "deformation rate";
  if (!scene.deformation) return {name, false, "the scene has no \"deformation\""};
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
  if (scene.obstacles.empty()) return {"contact", false, "the scene has no \"obstacles\""};
  const std::string count =
      fmt::format("{} obstacle{}", scene.obstacles.size(), scene.obstacles.size() == 1 ? "" : "s");
  if (!has_continuous_contact(scene)) return {"contact", true, count};
  const auto moving = std::count_if(scene.obstacles.begin(), scene.obstacles.end(), &moves);
  return {"contact", true,
          fmt::format("{}{}, without gaps, {} m thick", count,
                      moving > 0 ? fmt::format(" ({} moving)", moving) : "",
                      scene.contact.value_or(ContactSettings{}).thickness)};
}

StageInfo self_contact_stage(const Scene& scene) {
  if (!scene.self_contact) return {"self-contact", false, "the scene has no \"self_contact\""};
  return {"self-contact", true, fmt::format("without gaps, {} m thick", scene.self_contact->thickness)};
}

std::string evaluations_text(const MethodFacts& method) {
  const int count = method.evaluations_per_step;
  if (count == 0) return "as many force evaluations a step as needed";
  return fmt::format("{} force evaluation{} a step", count, count == 1 ? "" : "s");
}

}  // namespace

std::vector<StageInfo> explain_stages(const Scene& scene) {
  const SpringMaterial material = scene.springs.value_or(SpringMaterial{});
  const ClothSystem system = make_cloth(scene.cloth, material);
  const MethodFacts& method = facts_of(scene.integrator.method);
  const bool limits_within = make_integrator(scene.integrator)->set_drift_constraint(nullptr);
  const bool moved_later = contact_stage(scene).present || scene.self_contact ||
                           (!limits_within && limiter_stage(scene, system).present);
  std::vector<StageInfo> stages;
  for (const SpringFamily family : spring_families) stages.push_back(spring_stage(scene, system, family));
  stages.push_back(positive_stage("spring damping", scene.springs.has_value(), "springs", material.damping,
                                  "springs.damping", "N s/m"));
  stages.push_back(positive_stage("viscous damping", scene.damping.has_value(), "damping",
                                  scene.damping.value_or(0), "damping", "N s/m"));
  stages.push_back(gravity_stage(scene));
  stages.push_back(positive_stage("air drag", scene.air.has_value(), "air", scene.air.value_or(Air{}).drag,
                                  "air.drag", "N s/m"));
  stages.push_back(wind_stage(scene));
  stages.push_back(
      {"integrate", true,
       fmt::format("{}: order {}, {}", method.title, method.order, evaluations_text(method)) +
           (method.keeps_force && moved_later ? ", one more after a step that the stages below changed"
                                              : "")});
  stages.push_back(limiter_stage(scene, system));
  stages.push_back(contact_stage(scene));
  stages.push_back(self_contact_stage(scene));
  return stages;
}

}  // namespace cloth
