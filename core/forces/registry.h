// The list of the forces that a scene can have. To add a force, see docs/architecture.md.
#pragma once

#include <memory>
#include <vector>

#include "forces/force.h"
#include "scene/blocks.h"

namespace cloth {

struct ForceEntry {
  /// Makes the force from the scene; null where the scene does not have it. The system must outlive the
  /// force.
  std::unique_ptr<Force> (*make)(const Scene&, const ClothSystem&);
  /// The entry of Work that its power is added to; null for a conservative force.
  double Work::*work = nullptr;
  /// Its entries in the list of stages that `explain` prints.
  std::vector<StageInfo> (*explain)(const Scene&, const ClothSystem&);
};

/// The stage of a force that is present where the parameter at `path` is greater than 0.
StageInfo coefficient_stage(const char* name, const Scene& scene, const std::string& path);

/// In the order in which their forces are added.
const std::vector<ForceEntry>& force_registry();

/// Whether the scene has a force whose power is booked as `work`.
bool has_work(const Scene& scene, const ClothSystem& system, double Work::*work);

/// The sum of the forces' damping coefficients that do not couple particles; they hold for every shape of the
/// cloth.
NodeDamping particle_damping(const Scene& scene);

}  // namespace cloth
