// The numbering of general meshes.
#include "cloth/mesh_order.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "cloth/grid.h"
#include "support/direct_run.h"
#include "support/meshes.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::mesh_order_test {
namespace {

std::vector<ClothSystem> some_meshes(Random& random) {
  std::vector<ClothSystem> meshes{irregular_triangulation(3, 4, 80, true, random),
                                  irregular_triangulation(40, 53, 80, true, random),
                                  shuffled_grid(33, 30, random)};
  for (std::size_t k = meshes.size(); k-- > 0;)
    meshes.push_back(renumbered(meshes[k], small_bandwidth_order(meshes[k])));
  return meshes;
}

Vec3Field crumpled(const ClothSystem& system, Random& random) {
  return crumpled_state(system, 0.02, 0, random).position;
}

TEST(MeshOrder, IsAPermutationAndItsInverseUndoesIt) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const ParticleOrder order = small_bandwidth_order(system);
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), system.mass.size());
    ClothState state = crumpled_state(system, 0.1, 1, random);
    state.time = 3, state.step = 5;
    EXPECT_NE(renumbered(state, order), state);
    EXPECT_EQ(renumbered(renumbered(state, order), inverse_of(order)), state);
    EXPECT_EQ(inverse_of(inverse_of(order)), order);
  }
}

TEST(MeshOrder, KeepsEveryParticleItsMassPinAndSprings) {
  Random random;
  ClothSystem system = irregular_triangulation(9, 11, 80, true, random);
  for (double& mass : system.mass) mass = random.uniform(1, 2);
  const ParticleOrder order = small_bandwidth_order(system);
  const ClothSystem ordered = renumbered(system, order);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto old = static_cast<std::size_t>(order[k]);
    EXPECT_EQ(ordered.mass[k], system.mass[old]);
    EXPECT_EQ(ordered.inverse_mass[k], system.inverse_mass[old]);
    EXPECT_EQ(ordered.pinned[k], system.pinned[old]);
    EXPECT_EQ(ordered.start[k], system.start[old]);
  }
  const Vec3Field position = crumpled(system, random);
  const Vec3Field expected = renumbered(spring_forces(springs_of(system), position), order);
  const Vec3Field force = spring_forces(springs_of(ordered), renumbered(position, order));
  EXPECT_LE(largest_distance(force, expected), 1e-12 * largest_norm(expected));
  for (const SpringFamily family : spring_families)
    EXPECT_EQ(ordered.spring_count(family), system.spring_count(family));
}

TEST(MeshOrder, HasTheBandwidthOfASheetHoweverItWasNumbered) {
  Random random;
  const int side = 30;
  for (const ClothSystem& system :
       {shuffled_grid(side, side, random), irregular_triangulation(side, side, 80, false, random)}) {
    EXPECT_GT(bandwidth_of(system), side * side / 2);
    EXPECT_LE(bandwidth_of(renumbered(system, small_bandwidth_order(system))), 4 * side);
  }
}

TEST(MeshOrder, TakesAChainFromEndToEnd) {
  Random random;
  const int size = 50;
  std::vector<MeshSpring> springs;
  for (int i = 0; i + 1 < size; ++i) springs.push_back({i, i + 1, 1, 1});
  const ClothSystem chain = mesh_system(random.field(size, 1), springs, {});
  const ClothSystem shuffled = renumbered(chain, random_order(size, random));
  EXPECT_EQ(bandwidth_of(renumbered(shuffled, small_bandwidth_order(shuffled))), 1);
}

TEST(MeshOrder, TakesPartsAndLonelyParticlesOneAfterTheOther) {
  Random random;
  const ClothSystem system = mesh_system(random.field(9, 1), {{0, 8, 1, 1}, {1, 7, 1, 1}, {2, 6, 1, 1}}, {});
  const ParticleOrder order = small_bandwidth_order(system);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 9u);
  EXPECT_EQ(bandwidth_of(renumbered(system, order)), 1);
}

TEST(MeshOrder, ForSweepsHasParticlesOfEquallyManySpringsSideBySideAndKeepsTheBandwidth) {
  Random random;
  const ClothSystem system = irregular_triangulation(64, 64, 80, false, random);
  const ParticleOrder order = order_for_sweeps(system);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), system.mass.size());
  EXPECT_LE(bandwidth_of(renumbered(system, order)),
            bandwidth_of(renumbered(system, small_bandwidth_order(system))) + 2 * 64);
  std::vector<int> springs(system.mass.size());
  for (const SpringRun& run : system.springs)
    ++springs[static_cast<std::size_t>(run.first)],
        ++springs[static_cast<std::size_t>(run.first + run.offset)];
  int changes = 0;
  for (std::size_t k = 1; k < order.size(); ++k)
    changes += springs[static_cast<std::size_t>(order[k])] != springs[static_cast<std::size_t>(order[k - 1])];
  EXPECT_LE(changes, static_cast<int>(order.size()) / 4);
}

}  // namespace
}  // namespace cloth::test::mesh_order_test
