#include "forces/registry.h"

#include <fmt/format.h>

#include <algorithm>

namespace cloth {

// Each in the file of its force.
ForceEntry spring_entry();
ForceEntry bending_entry();
ForceEntry membrane_entry();
ForceEntry spring_damping_entry();
ForceEntry bending_damping_entry();
ForceEntry membrane_damping_entry();
ForceEntry hysteresis_entry();
ForceEntry viscous_damping_entry();
ForceEntry mass_damping_entry();
ForceEntry gravity_entry();
ForceEntry air_entry();
ForceEntry skin_friction_entry();

const std::vector<ForceEntry>& force_registry() {
  static const std::vector<ForceEntry> entries{
      spring_entry(),         membrane_entry(),         bending_entry(),
      hysteresis_entry(),     spring_damping_entry(),   membrane_damping_entry(),
      bending_damping_entry(), viscous_damping_entry(), mass_damping_entry(),
      gravity_entry(),        air_entry(),              skin_friction_entry()};
  return entries;
}

StageInfo coefficient_stage(const char* name, const Scene& scene, const std::string& path) {
  const auto block = parent_path(path);
  if (auto absent = absent_stage(name, scene, block.empty() ? path : block)) return *absent;
  const auto parameter = find_parameter(scene, path);
  const double value = std::get<double>(parameter->get(scene));
  if (!(value > 0)) return {name, false, fmt::format("{} is 0", path)};
  return {name, true, fmt::format("{} = {} {}", path, value, parameter->info.unit)};
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
