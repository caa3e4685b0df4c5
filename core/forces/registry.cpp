#include "forces/registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "cloth/grid.h"
#include "forces/air.h"
#include "forces/gravity.h"
#include "forces/skin_friction.h"
#include "forces/springs.h"
#include "forces/viscous.h"

namespace cloth {
namespace {

using Made = std::unique_ptr<Force>;
using Stages = std::vector<StageInfo>;

StageInfo coefficient_stage(const char* name, bool has_block, const char* block, double value,
                            const char* key) {
  if (!has_block) return {name, false, fmt::format("the scene has no \"{}\"", block)};
  if (!(value > 0)) return {name, false, fmt::format("{} is 0", key)};
  return {name, true, fmt::format("{} = {} N s/m", key, value)};
}

StageInfo family_stage(const Scene& scene, const ClothSystem& system, SpringFamily family) {
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

Stages explain_springs(const Scene& scene, const ClothSystem& system) {
  Stages stages;
  for (const SpringFamily family : spring_families) stages.push_back(family_stage(scene, system, family));
  return stages;
}

Stages explain_gravity(const Scene& scene, const ClothSystem&) {
  if (!scene.gravity) return {{"gravity", false, "the scene has no \"gravity\""}};
  if (!(scene.gravity->squaredNorm() > 0)) return {{"gravity", false, "gravity is 0"}};
  const Vec3& g = *scene.gravity;
  return {{"gravity", true, fmt::format("[{}, {}, {}] m/s^2", g.x(), g.y(), g.z())}};
}

StageInfo wind_stage(const Scene& scene) {
  if (!scene.air || !(scene.air->drag > 0 || scene.air->skin_friction > 0)) return {"wind", false, "there is no air to blow"};
  if (!(scene.air->wind.squaredNorm() > 0)) return {"wind", false, "air.wind is 0: the air only drags"};
  const bool gusts = scene.air->gust && scene.air->gust->amplitude > 0;
  return {"wind", true,
          fmt::format("{:.4g} m/s{}", scene.air->wind.norm(), gusts ? " with gusts" : ", steady")};
}

Stages explain_air(const Scene& scene, const ClothSystem&) {
  return {
      coefficient_stage("air drag", scene.air.has_value(), "air", scene.air.value_or(Air{}).drag, "air.drag"),
      wind_stage(scene)};
}

}  // namespace

const std::vector<ForceEntry>& force_registry() {
  static const std::vector<ForceEntry> entries{
      {.make = [](const Scene&, const ClothSystem& system) -> Made {
         return system.springs.empty() ? nullptr : std::make_unique<SpringForce>();
       },
       .explain = explain_springs},
      {.make = [](const Scene& scene, const ClothSystem& system) -> Made {
         if (system.springs.empty() || !(scene.springs->damping > 0)) return nullptr;
         return std::make_unique<SpringDamping>(system, scene.springs->damping);
       },
       .work = &Work::damping_loss,
       .explain =
           [](const Scene& scene, const ClothSystem&) {
             return Stages{coefficient_stage("spring damping", scene.springs.has_value(), "springs",
                                             scene.springs.value_or(SpringMaterial{}).damping,
                                             "springs.damping")};
           }},
      {.make = [](const Scene& scene, const ClothSystem&) -> Made {
         if (!(scene.damping.value_or(0) > 0)) return nullptr;
         return std::make_unique<ViscousDamping>(*scene.damping);
       },
       .work = &Work::damping_loss,
       .explain =
           [](const Scene& scene, const ClothSystem&) {
             return Stages{coefficient_stage("viscous damping", scene.damping.has_value(), "damping",
                                             scene.damping.value_or(0), "damping")};
           }},
      {.make = [](const Scene& scene, const ClothSystem&) -> Made {
         if (!(gravity_of(scene).squaredNorm() > 0)) return nullptr;
         return std::make_unique<Gravity>(*scene.gravity);
       },
       .explain = explain_gravity},
      {.make = [](const Scene& scene, const ClothSystem&) -> Made {
         if (!scene.air || !(scene.air->drag > 0)) return nullptr;
         return std::make_unique<AirForce>(*scene.air);
       },
       .work = &Work::air,
       .explain = explain_air},
      {.make = [](const Scene& scene, const ClothSystem&) -> Made {
         if (!scene.air || !(scene.air->skin_friction > 0)) return nullptr;
         return std::make_unique<SkinFriction>(*scene.air);
       },
       .work = &Work::air,
       .explain =
           [](const Scene& scene, const ClothSystem&) {
             return Stages{coefficient_stage("skin friction", scene.air.has_value(), "air",
                                             scene.air.value_or(Air{}).skin_friction, "air.skin_friction")};
           }},
  };
  return entries;
}

bool has_work(const Scene& scene, const ClothSystem& system, double Work::*work) {
  return std::any_of(force_registry().begin(), force_registry().end(), [&](const ForceEntry& entry) {
    return entry.work == work && entry.make(scene, system);
  });
}

NodeDamping particle_damping(const Scene& scene) {
  const ClothSystem no_springs;
  NodeDamping damping;
  for (const ForceEntry& entry : force_registry())
    if (const auto force = entry.make(scene, no_springs)) force->add_node_damping(damping);
  damping.normal = nullptr;  // of a force that is gone
  return damping;
}

}  // namespace cloth
