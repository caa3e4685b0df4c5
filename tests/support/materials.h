// Small scenes of materials, and what a material's cloth has by its definition.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth::test {

/// Every constant another one, springs that fit cells up to twice as long as wide.
Material any_material();
/// The same with friction between its threads.
Material material_with_hysteresis();

/// A sheet in the plane z = 0 of cells `across` by `down` metres, hanging from the origin, without physics
/// but the material's own.
Scene material_sheet(int rows, int columns, double across, double down, const Material& material);

/// A sheet held by its top edge, with every force of its own and wind.
Scene complete_material_scene();

/// Grids of one sheet, 0.6 m by 0.4 m, with cells of any shape.
std::vector<Scene> grids_of_a_sheet(const Material& material);

Vec3Field mapped(const Vec3Field& from, const Eigen::Matrix3d& by);

double elastic_energy_of(const ClothSystem& system, const Vec3Field& position);  ///< J

/// What all forces of the scene exert at rest in this shape, N.
Vec3Field force_of(const Scene& scene, const Vec3Field& position);

/// Every method goes to where RK4's small steps go after 0.04 s, with its order; in steps from 0.08 to 0.2
/// ms.
void expect_the_same_by_every_method(const Scene& scene);

/// d2E/dx2 of the bending elements, from their definition; particle i's component a is row 3 i + a.
Eigen::MatrixXd bending_hessian(const ClothSystem& system);

}  // namespace cloth::test
