// The cloth of a scene: of springs or of a material.
#pragma once

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

/// Precondition: a valid scene (scene_checks.h), its meshes loaded.
ClothSystem make_cloth(const Scene& scene);

/// The mass in kg of a particle inside the cloth, none of its cells missing; those at the borders of a
/// material's grid have a half and a quarter of it.
double particle_mass(const Scene& scene);

/// Sides of a grid's cells in m: along its rows and along its columns.
struct CellSides {
  double across = 0, down = 0;
};
CellSides cell_sides(const ClothSheet& sheet);

/// Whether something holds the particles together.
inline bool has_stiffness(const Scene& scene) {
  return scene.springs || scene.material;
}

/// Multiplies every stiffness, in stretching and in bending.
void scale_stiffness(Scene& scene, double factor);

/// Multiplies the cloth's mass.
void scale_mass(Scene& scene, double factor);

/// The stiffness in N/m that stands for all when they are varied together: structural, or along the warp.
double leading_stiffness(const Scene& scene);

}  // namespace cloth
