// How far a cloth hangs down, on cloths that can be measured by hand.
#include "measure/droop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/grid.h"

namespace cloth::test::droop_test {
namespace {

/// 2 x 3 particles 1 m apart in the x-z plane at height 5 m, held by its left edge.
ClothSheet level_sheet() {
  ClothSheet sheet;
  sheet.rows = 2, sheet.columns = 3;
  sheet.width = 2, sheet.height = 1;
  sheet.origin = {0, 5, 0};
  sheet.across = {1, 0, 0}, sheet.down = {0, 0, 1};
  sheet.pins = {NamedPin::left_edge};
  return sheet;
}

void lower(Vec3Field& position, int particle, double height) {
  position.y()[particle] -= height;
}

const Vec3 gravity{0, -9.81, 0};

TEST(Droop, IsTheLowestParticleSeenFromTheNearestPin) {
  const ClothSystem cloth = make_grid(level_sheet(), {});
  Vec3Field position = cloth.start;
  lower(position, 2, 0.5);
  lower(position, 4, 0.25);
  const Droop droop = measure_droop(cloth, position, gravity);
  EXPECT_DOUBLE_EQ(droop.lowest, 4.5);
  EXPECT_DOUBLE_EQ(droop.drop, 0.5);
  EXPECT_DOUBLE_EQ(droop.reach, 2);
  EXPECT_DOUBLE_EQ(droop.ratio(), 0.25);
}

TEST(Droop, IsMeasuredAlongGravityWhereverThatPoints) {
  const ClothSystem cloth = make_grid(level_sheet(), {});
  Vec3Field position = cloth.start;
  position.x()[5] += 1;  // along this gravity
  const Droop droop = measure_droop(cloth, position, {3, 0, 0});
  EXPECT_DOUBLE_EQ(droop.lowest, -3);
  EXPECT_DOUBLE_EQ(droop.drop, 3);
  EXPECT_DOUBLE_EQ(droop.reach, 0) << "straight below the pin in its own row";
  EXPECT_TRUE(std::isnan(droop.ratio()));
  EXPECT_DOUBLE_EQ(measure_droop(cloth, cloth.start, Vec3::Zero()).lowest, 5) << "without gravity along +y";
}

TEST(Droop, OfALevelClothIsNone) {
  const ClothSystem cloth = make_grid(level_sheet(), {});
  const Droop droop = measure_droop(cloth, cloth.start, gravity);
  EXPECT_EQ(droop.drop, 0);
  EXPECT_EQ(droop.ratio(), 0);
}

TEST(Droop, OfAFreeClothIsALowestPointAndNoMore) {
  ClothSheet free = level_sheet();
  free.pins.clear();
  const ClothSystem cloth = make_grid(free, {});
  const Droop droop = measure_droop(cloth, cloth.start, gravity);
  EXPECT_DOUBLE_EQ(droop.lowest, 5);
  EXPECT_TRUE(std::isnan(droop.drop) && std::isnan(droop.reach) && std::isnan(droop.ratio()));
}

}  // namespace
}  // namespace cloth::test::droop_test
