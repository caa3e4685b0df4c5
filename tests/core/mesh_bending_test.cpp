// Bending of triangle meshes: exact quadratic surfaces, constant moments, free edges and clamps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth/mesh_patch.h"
#include "integrators/integrator.h"
#include "kernels/mesh_products.h"
#include "scene/scene_cloth.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::mesh_bending_test {
namespace {

constexpr double width = 0.6, height = 0.4;  // m

/// The sheet as a surface over itself.
template <class HeightAt>
double bending_of_surface(const ClothSystem& system, HeightAt height_at) {
  Vec3Field position = system.start;
  for (std::size_t i = 0; i < position.size(); ++i)
    position.set(i, {position[i].x(), position[i].y(), height_at(position[i])});
  return bending_energy(system.bending, position);
}

/// Of every triangle, whether it has one across every edge and they have, too: all that its bending depends
/// on.
std::vector<bool> are_surrounded(const ClothSystem& system) {
  const TriangleNeighbours neighbours = neighbours_of(system.triangles);
  const auto is_complete = [&](std::size_t t) {
    return std::all_of(neighbours[t].begin(), neighbours[t].end(),
                       [](const AcrossEdge& across) { return across.triangle >= 0; });
  };
  std::vector<bool> surrounded(neighbours.size());
  for (std::size_t t = 0; t < neighbours.size(); ++t)
    surrounded[t] =
        is_complete(t) && std::all_of(neighbours[t].begin(), neighbours[t].end(),
                                      [&](const AcrossEdge& a) { return is_complete(at(a.triangle)); });
  return surrounded;
}

double surrounded_area(const ClothSystem& system) {
  const std::vector<bool> surrounded = are_surrounded(system);
  double area = 0;
  for (std::size_t t = 0; t < surrounded.size(); ++t) {
    const Triangle& corner = system.triangles[t];
    const Vec3 a = system.start[at(corner[0])];
    if (surrounded[t])
      area += 0.5 * (system.start[at(corner[1])] - a).cross(system.start[at(corner[2])] - a).norm();
  }
  return area;
}

double quadratic(const Vec3& p) {
  return 0.065 * p.x() * p.x() - 0.105 * p.y() * p.y() + 0.17 * p.x() * p.y() + 0.4 * p.x() - 0.3;
}

TEST(MeshBending, OfAQuadraticSurfaceIsExactOnEveryTriangleWithNeighboursWhateverItsShape) {
  Random random;
  const Material m = any_material();
  for (const Scene& scene : meshes_of_a_sheet(width, height, m, random)) {
    const ClothSystem system = make_cloth(scene);
    const double density =
        0.5 * (m.bending_weft * 0.13 * 0.13 + m.bending_warp * 0.21 * 0.21 + 2 * m.twist * 0.17 * 0.17);
    const double energy = bending_of_surface(system, quadratic);
    // Those at a free edge have no more than the surface has, and no less than nothing.
    EXPECT_GE(energy, (1 - 1e-9) * density * surrounded_area(system));
    EXPECT_LE(energy, (1 + 1e-9) * density * width * height);
  }
}

/// A quadratic surface has the same moment everywhere; what the free edges change ends some cells from them.
TEST(MeshBending, OfAConstantMomentIsInEquilibriumAwayFromFreeEdgesOnEveryMesh) {
  Random random;
  for (const double disorder : {0.0, 0.3}) {
    const ClothSystem system =
        make_cloth(material_mesh_sheet(25, 21, width, height, disorder, any_material(), random));
    Vec3Field position = system.start, force(position.size());
    for (std::size_t i = 0; i < position.size(); ++i)
      position.set(i, {position[i].x(), position[i].y(), quadratic(position[i])});
    add_bending_product(system.bending, -1, position, force);
    constexpr double some_cells = 0.13;
    int inside = 0;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 p = system.start[i];
      if (std::min({p.x(), width - p.x(), -p.y(), height + p.y()}) < some_cells) continue;
      EXPECT_LE(force[i].norm(), 1e-10 * largest_norm(force)) << i << " at a disorder of " << disorder;
      ++inside;
    }
    EXPECT_GT(inside, 50);
  }
}

TEST(MeshBending, ByRowsIsTheSameProductAsOverTheElementsAndNoneOfMovingAllAlike) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(width, height, any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    const Vec3Field field = random.field(system.mass.size(), 1);
    Vec3Field by_elements(field.size()), by_rows(field.size()), of_all_alike(field.size());
    add_bending_product(system.bending, 0.7, field, by_elements);
    add_bending_product(system, 0.7, field, by_rows);
    add_scaled(-1, by_elements, by_rows);
    EXPECT_LE(largest_norm(by_rows), 1e-12 * largest_norm(by_elements));
    Vec3Field moved(field.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved.set(i, Vec3(3, -1e6, 0.1));
    add_bending_product(system, 1, moved, of_all_alike);
    EXPECT_EQ(largest_norm(of_all_alike), 0);
  }
}

TEST(MeshBending, OfACylinderIsThatOfItsWholeAreaButWhereItEndsStraightOnAnIrregularMesh) {
  Random random;
  const Material m = any_material();
  double before = 0;
  for (const int cells : {8, 16, 32}) {
    const ClothSystem system =
        make_cloth(material_mesh_sheet(cells + 1, cells + 1, width, height, 0.25, m, random));
    // No curvature across the ends: the free edges' own condition.
    const double k = M_PI / width, amplitude = 0.01;
    const double energy =
        bending_of_surface(system, [&](const Vec3& p) { return amplitude * std::sin(k * p.x()); });
    const double exact = 0.25 * m.bending_weft * amplitude * amplitude * std::pow(k, 4) * width * height;
    const double error = std::abs(energy / exact - 1);
    if (before > 0) {
      EXPECT_LE(error, 0.75 * before) << cells;
    }
    before = error;
  }
  EXPECT_LE(before, 0.02);
}

TEST(MeshBending, DiffersWithTheAngleToTheWarpAsTheMaterialDoes) {
  Random random;
  Material m = any_material();
  m.twist = 4e-3;
  const ClothSystem system = make_cloth(material_mesh_sheet(41, 41, 0.4, 0.4, 0.2, m, random));
  for (const double angle : {0.0, 0.4, M_PI / 4, 1.2, M_PI / 2}) {
    const double energy = bending_of_surface(system, [&](const Vec3& p) {
      const double along = std::sin(angle) * p.x() + std::cos(angle) * p.y();
      return 0.5 * 0.1 * along * along;
    });
    const double whole = 0.5 * 0.01 * bending_at(m, angle) * 0.16;
    EXPECT_NEAR(energy, whole, 0.05 * whole) << angle;  // free edges miss a part of one cell
    EXPECT_GE(energy, 0.5 * 0.01 * bending_at(m, angle) * surrounded_area(system) * (1 - 1e-9)) << angle;
  }
}

TEST(MeshBending, IsHalfAsLongAndTwiceAsStiffAtAClampAndAbsentBehindIt) {
  Random random;
  const Material m = any_material();
  Scene scene = material_mesh_sheet(4, 2, 0.3, 0.1, 0, m, random);
  for (const int i : {0, 1, 4, 5}) scene.cloth.pins.emplace_back(PinnedParticle{0, i});
  const ClothSystem system = make_cloth(scene);
  Vec3Field position = system.start;
  constexpr double up = 1e-3;
  for (const int i : {2, 6}) position.set(at(i), position[at(i)] + Vec3(0, 0, up));
  for (const int i : {3, 7}) position.set(at(i), position[at(i)] + Vec3(0, 0, 2 * up));
  // A fold at the clamp, straight on beyond: curvature 2 up/a^2 over half a cell.
  const double curvature = 2 * up / 0.01;
  EXPECT_NEAR(bending_energy(system.bending, position),
              0.5 * m.bending_weft * curvature * curvature * 0.05 * 0.1, 1e-12);
  for (const BendingRun& run : system.bending) {
    bool moves = false;
    for (std::size_t p = 0; p < std::size_t(run.points); ++p) moves |= !system.pinned[at(run.offset[p])];
    EXPECT_TRUE(moves);
  }
}

}  // namespace
}  // namespace cloth::test::mesh_bending_test
