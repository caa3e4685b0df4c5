#include "cloth/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "support/reference.h"
#include "support/scenes.h"

namespace cloth::test::grid_test {
namespace {

const SpringMaterial all_families{.structural = 3, .shear = 2, .flexion = 1, .damping = 0};

TEST(Grid, HasAsManySpringsOfEachFamilyAsTheFormulaSays) {
  for (const auto& [rows, columns] : {std::pair(2, 2), std::pair(2, 5), std::pair(3, 3), std::pair(7, 4)}) {
    const ClothSystem system = make_grid(bare_sheet(rows, columns).cloth, all_families);
    EXPECT_EQ(system.spring_count(SpringFamily::structural), rows * (columns - 1) + (rows - 1) * columns);
    EXPECT_EQ(system.spring_count(SpringFamily::shear), 2 * (rows - 1) * (columns - 1));
    EXPECT_EQ(system.spring_count(SpringFamily::flexion), rows * (columns - 2) + (rows - 2) * columns);
  }
}

using Key = std::tuple<SpringFamily, int, int>;

std::vector<Key> keys_of(const std::vector<SpringPair>& springs) {
  std::vector<Key> keys;
  for (const SpringPair& s : springs) keys.emplace_back(s.family, std::min(s.i, s.j), std::max(s.i, s.j));
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(Grid, JoinsExactlyThePairsOfTheTable) {
  for (const auto& [rows, columns] : {std::pair(2, 2), std::pair(5, 2), std::pair(3, 3), std::pair(6, 9)}) {
    Scene scene = bare_sheet(rows, columns);
    scene.springs = all_families;
    EXPECT_EQ(keys_of(springs_of(make_grid(scene.cloth, all_families))),
              keys_of(springs_by_the_table(scene)));
  }
}

TEST(Grid, RestLengthsAreTheDistancesAtTheStart) {
  Scene scene = bare_sheet(5, 4);
  scene.cloth.width = 0.7, scene.cloth.height = 1.3;
  scene.cloth.across = {1, 0.2, 0}, scene.cloth.down = {0.1, -2, 1};  // neither of length one nor square
  const ClothSystem system = make_grid(scene.cloth, all_families);
  for (const SpringPair& spring : springs_of(system)) {
    const double distance =
        (system.start[static_cast<std::size_t>(spring.i)] - system.start[static_cast<std::size_t>(spring.j)])
            .norm();
    EXPECT_NEAR(spring.rest_length, distance, 1e-15);
  }
}

TEST(Grid, GivesEachFamilyItsStiffnessAndLeavesOutThoseOfZero) {
  const ClothSystem system = make_grid(bare_sheet(4, 4).cloth, {.structural = 3, .shear = 0, .flexion = 1});
  EXPECT_EQ(system.spring_count(SpringFamily::shear), 0);
  for (const SpringPair& spring : springs_of(system))
    EXPECT_EQ(spring.stiffness, spring.family == SpringFamily::structural ? 3 : 1);
}

TEST(Grid, PlacesParticlesFromTheOriginAcrossAndDown) {
  Scene scene = bare_sheet(3, 5);
  scene.cloth.origin = {1, 2, 3};
  scene.cloth.width = 2, scene.cloth.height = 1;
  scene.cloth.across = {0, 0, 5};  // a direction of any length
  const ClothSystem system = make_grid(scene.cloth, {});
  EXPECT_EQ(system.size(), 15);
  EXPECT_LE((system.start[0] - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LE((system.start[static_cast<std::size_t>(system.index(0, 4))] - Vec3(1, 2, 5)).norm(), 1e-15);
  EXPECT_LE((system.start[static_cast<std::size_t>(system.index(2, 1))] - Vec3(1, 1, 3.5)).norm(), 1e-15);
  EXPECT_NEAR(system.diagonal, std::sqrt(5.0), 1e-15);
}

TEST(Grid, SharesTheMassEqually) {
  Scene scene = bare_sheet(4, 5);
  scene.cloth.mass = 3;
  scene.cloth.pins = {NamedPin::top_left};
  const ClothSystem system = make_grid(scene.cloth, {});
  EXPECT_DOUBLE_EQ(system.mass.front(), 3.0 / 20);
  EXPECT_EQ(system.inverse_mass[0], 0);
  for (std::size_t i = 1; i < 20; ++i) EXPECT_DOUBLE_EQ(system.inverse_mass[i], 20.0 / 3);
}

std::vector<int> pinned_by(std::vector<Pin> pins) {
  Scene scene = bare_sheet(3, 4);
  scene.cloth.pins = std::move(pins);
  const ClothSystem system = make_grid(scene.cloth, {});
  std::vector<int> particles;
  for (int i = 0; i < system.size(); ++i)
    if (system.pinned[static_cast<std::size_t>(i)]) particles.push_back(i);
  EXPECT_EQ(particles, pinned_particles(scene.cloth));
  return particles;
}

TEST(Pins, ByNameHoldCornersAndEdges) {
  using List = std::vector<int>;
  EXPECT_EQ(pinned_by({NamedPin::top_left}), List({0}));
  EXPECT_EQ(pinned_by({NamedPin::top_right}), List({3}));
  EXPECT_EQ(pinned_by({NamedPin::bottom_left}), List({8}));
  EXPECT_EQ(pinned_by({NamedPin::bottom_right}), List({11}));
  EXPECT_EQ(pinned_by({NamedPin::top_edge}), List({0, 1, 2, 3}));
  EXPECT_EQ(pinned_by({NamedPin::bottom_edge}), List({8, 9, 10, 11}));
  EXPECT_EQ(pinned_by({NamedPin::left_edge}), List({0, 4, 8}));
  EXPECT_EQ(pinned_by({NamedPin::right_edge}), List({3, 7, 11}));
}

TEST(Pins, GivenTwiceHoldOnce) {
  EXPECT_EQ(pinned_by({NamedPin::top_edge, NamedPin::top_left, PinnedParticle{0, 2}, PinnedParticle{1, 2}}),
            std::vector<int>({0, 1, 2, 3, 6}));
  EXPECT_EQ(pinned_by({}), std::vector<int>());
}

TEST(Pins, NamesReadBack) {
  for (int pin = 0; pin < named_pin_count; ++pin)
    EXPECT_EQ(pin_named(name_of(static_cast<NamedPin>(pin))), static_cast<NamedPin>(pin));
  EXPECT_EQ(pin_named("middle"), std::nullopt);
}

TEST(StartingState, IsAtRestWhereTheSheetStarts) {
  const ClothSystem system = make_grid(bare_sheet(3, 4).cloth, {});
  const ClothState state = starting_state(system);
  EXPECT_EQ(state.position, system.start);
  EXPECT_EQ(state.velocity, Vec3Field(12));
  EXPECT_EQ(state.time, 0);
  EXPECT_EQ(state.step, 0);
}

}  // namespace
}  // namespace cloth::test::grid_test
