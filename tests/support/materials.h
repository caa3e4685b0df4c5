// Small scenes of materials, and what a material's cloth has by its definition.
#pragma once

#include <Eigen/Core>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth::test {

/// Every constant another one, springs that fit cells up to twice as long as wide.
Material any_material();

/// A sheet in the plane z = 0 of cells `across` by `down` metres, hanging from the origin, without physics
/// but the material's own.
Scene material_sheet(int rows, int columns, double across, double down, const Material& material);

/// d2E/dx2 of the bending elements, from their definition; particle i's component a is row 3 i + a.
Eigen::MatrixXd bending_hessian(const ClothSystem& system);

}  // namespace cloth::test
