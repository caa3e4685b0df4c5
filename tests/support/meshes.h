// Systems made by hand whose springs have no constant offset.
#pragma once

#include <vector>

#include "cloth/mesh_order.h"
#include "scene/scene.h"
#include "support/random.h"

namespace cloth::test {

/// What a mesh is made of.
struct MeshSpring {
  int i, j;
  double rest_length, stiffness;
  SpringFamily family = SpringFamily::structural;
};

/// One row of particles of 1 g each, springs as runs of length one, at rest at `start`.
ClothSystem mesh_system(const Vec3Field& start, const std::vector<MeshSpring>& springs,
                        const std::vector<int>& pinned);

/// A sheet of rows x columns particles moved about at random within their cells and joined to triangles, each
/// cell divided along the one or the other diagonal; edges are structural springs of their own lengths and
/// `stiffness`, the pairs across an edge flexion springs of a tenth of it. Numbered at random; the last
/// particle of each row is pinned where `pins`.
ClothSystem irregular_triangulation(int rows, int columns, double stiffness, bool pins, Random& random);

/// A sheet of rows x columns particles on a grid, pinned at its upper corners, with springs of three
/// stiffnesses. Numbered at random.
ClothSystem shuffled_grid(int rows, int columns, Random& random);

/// The same cloth with its particles in this order: springs one by one, by family and then by their ends. A
/// grid becomes a mesh of one row.
ClothSystem renumbered(const ClothSystem& system, const ParticleOrder& order);
ClothState renumbered(const ClothState& state, const ParticleOrder& order);
Vec3Field renumbered(const Vec3Field& field, const ParticleOrder& order);

/// The order of a shuffle.
std::vector<int> random_order(int size, Random& random);

}  // namespace cloth::test
