// Scenes of a material on triangle meshes made by hand.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "support/random.h"

namespace cloth::test {

/// A flat sheet `width` by `height` from the origin along x and -y, in cells that are cut in two along the
/// one or the other diagonal; `disorder`: by how much of a cell particles inside are moved about at random.
/// Warp along -y. The first `straight` columns stay where they are. No physics but the material's own.
Scene material_mesh_sheet(int columns, int rows, double width, double height, double disorder,
                          const Material& material, Random& random, int straight = 1);

/// Such sheets, regular and irregular, coarse and fine.
std::vector<Scene> meshes_of_a_sheet(double width, double height, const Material& material, Random& random);

}  // namespace cloth::test
