#include "cloth/normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::normals_test {
namespace {

Vec3Field normals_of(int rows, int columns, const Vec3Field& position) {
  Vec3Field normal(position.size());
  particle_normals(rows, columns, position, normal);
  return normal;
}

TEST(Normals, OfAFlatSheetPointDownCrossAcross) {
  const Scene scene = bare_sheet(4, 5);
  const ClothSystem system = make_grid(scene.cloth, {});
  const Vec3 front = scene.cloth.down.cross(scene.cloth.across);  // model.md
  const Vec3Field normal = normals_of(4, 5, system.start);
  for (std::size_t i = 0; i < normal.size(); ++i) EXPECT_LE((normal[i] - front).norm(), 1e-15) << i;
}

/// Of every size around those at which the way of computing them changes: the cross products of the triangles
/// at each particle, added up one by one.
TEST(Normals, AreTheSumsOverTheTrianglesAtEveryParticle) {
  Random random;
  for (const auto& [rows, columns] :
       {std::pair{2, 2}, {3, 2}, {2, 127}, {3, 128}, {5, 129}, {4, 130}, {3, 257}}) {
    const ClothSystem system = make_grid(lying_sheet(rows, columns).cloth, {});
    const Vec3Field position = crumpled_state(system, 0.02, 0, random).position;
    Vec3Field expected(position.size());
    for (const Triangle& t : triangles_of(system)) {
      const auto corner = [&](int k) { return static_cast<std::size_t>(t[static_cast<std::size_t>(k)]); };
      const Vec3 u = position[corner(1)] - position[corner(0)], v = position[corner(2)] - position[corner(0)];
      for (int k = 0; k < 3; ++k) expected.add(corner(k), u.cross(v));
    }
    for (std::size_t i = 0; i < expected.size(); ++i) expected.set(i, expected[i].normalized());
    EXPECT_LE(largest_distance(normals_of(rows, columns, position), expected), 1e-14)
        << rows << " x " << columns;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_LE((particle_normal(rows, columns, position, i) - expected[i]).norm(), 1e-14)
          << rows << " x " << columns << " " << i;
  }
}

TEST(Normals, AlongAFoldHalveTheAngle) {
  // Two columns of cells, the right one folded up by 90 degrees along the middle column.
  const ClothSystem system = make_grid(lying_sheet(2, 3).cloth, {});
  Vec3Field position = system.start;
  for (const std::size_t right : {2u, 5u}) position.set(right, {0.1, 0.1, position[right].z()});
  const Vec3Field normal = normals_of(2, 3, position);
  EXPECT_LE((normal[0] - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LE((normal[2] - Vec3(-1, 0, 0)).norm(), 1e-15);
  // Particle 1 has one triangle (a, c, b) of the left cell and two of the right: weights 1 and 2.
  EXPECT_LE((normal[1] - Vec3(-2, 1, 0).normalized()).norm(), 1e-15);
  // Particle 4 has both triangles of the left cell and (a, d, c) of the right: weights 2 and 1.
  EXPECT_LE((normal[4] - Vec3(-1, 2, 0).normalized()).norm(), 1e-15);
}

TEST(Normals, AreWeightedByTheTrianglesAreas) {
  const ClothSystem system = make_grid(lying_sheet(2, 3).cloth, {});
  Vec3Field position = system.start;
  for (const std::size_t right : {2u, 5u}) position.set(right, {0.1, 0.3, position[right].z()});
  EXPECT_LE((normals_of(2, 3, position)[1] - Vec3(-6, 1, 0).normalized()).norm(), 1e-15);
}

TEST(Normals, OfACollapsedSheetAreZero) {
  Vec3Field point(9);
  for (std::size_t i = 0; i < 9; ++i) point.set(i, {1, 2, 3});
  EXPECT_EQ(largest_norm(normals_of(3, 3, point)), 0);

  Vec3Field line(9);
  for (std::size_t i = 0; i < 9; ++i) line.set(i, {static_cast<double>(i), 0, 0});
  EXPECT_EQ(largest_norm(normals_of(3, 3, line)), 0);
}

TEST(Normals, AreOfLengthOneOnACrumpledSheet) {
  Random random;
  const ClothSystem system = make_grid(bare_sheet(7, 6).cloth, {});
  const ClothState state = crumpled_state(system, 0.1, 0, random);
  const Vec3Field normal = normals_of(7, 6, state.position);
  for (std::size_t i = 0; i < normal.size(); ++i) EXPECT_NEAR(normal[i].norm(), 1, 1e-15);
}

}  // namespace
}  // namespace cloth::test::normals_test
