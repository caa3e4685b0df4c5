// The one list of the forces that a scene can have.
#pragma once

#include <memory>
#include <vector>

#include "forces/force.h"
#include "scene/scene.h"
#include "scene/stage_info.h"

namespace cloth {

struct ForceEntry {
  /// The force as the scene has it, null: it has none. The system must outlive it.
  std::unique_ptr<Force> (*make)(const Scene&, const ClothSystem&);
  /// What its power is booked as; null: it is the derivative of an energy.
  double Work::*work = nullptr;
  /// Its stages in a step.
  std::vector<StageInfo> (*explain)(const Scene&, const ClothSystem&);
};

/// The stage of a force that is present where the number at a parameter's path is above 0.
StageInfo coefficient_stage(const char* name, const Scene& scene, const std::string& path);

/// In the order in which their forces are added.
const std::vector<ForceEntry>& force_registry();

/// Whether the scene has a force whose power is booked as `work`.
bool has_work(const Scene& scene, const ClothSystem& system, double Work::*work);

/// What the scene's forces damp particle by particle: the coefficients of NodeDamping, in any shape.
NodeDamping particle_damping(const Scene& scene);

}  // namespace cloth
