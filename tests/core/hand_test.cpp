// What a person's hand does: the wind brush and the pull.
#include <gtest/gtest.h>

#include <cmath>

#include "forces/air.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::hand_test {
namespace {

BrushGust brush_at(const Eigen::Vector2d& cursor, double radius = 80) {
  BrushGust brush;
  brush.velocity = {0, 5, 0};
  brush.cursor = cursor;
  brush.radius = radius;
  return brush;
}

TEST(BrushFalloff, IsACosineOfTheDistanceOnTheScreen) {
  const BrushGust brush = brush_at({10, 20}, 80);
  EXPECT_DOUBLE_EQ(brush_falloff(brush, {10, 20, 7}), 1);
  EXPECT_NEAR(brush_falloff(brush, {10 + 40, 20, 7}), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(brush_falloff(brush, {10, 20 - 80 * 2 / 3.0, 7}), 0.5, 1e-15);
}

TEST(BrushFalloff, IsZeroOnAndOutsideTheRadius) {
  const BrushGust brush = brush_at({0, 0}, 80);
  EXPECT_EQ(brush_falloff(brush, {80, 0, 0}), 0);
  EXPECT_EQ(brush_falloff(brush, {60, 61, 0}), 0);
  EXPECT_EQ(brush_falloff(brush, {1e9, 0, 0}), 0);
  EXPECT_EQ(brush_falloff(brush_at({0, 0}, 0), {0, 0, 0}), 0);
}

TEST(BrushFalloff, DividesByTheDepthOfAPerspectiveView) {
  BrushGust brush = brush_at({0, 0}, 80);
  brush.world_to_screen.row(3) << 0, 0, 1, 0;  // w = z
  EXPECT_NEAR(brush_falloff(brush, {80, 0, 2}), std::sqrt(0.5), 1e-15);
}

TEST(BrushFalloff, IsZeroBehindTheEye) {
  BrushGust brush = brush_at({0, 0}, 80);
  brush.world_to_screen.row(3) << 0, 0, 1, 0;
  EXPECT_EQ(brush_falloff(brush, {0, 0, -2}), 0);
  EXPECT_EQ(brush_falloff(brush, {0, 0, 0}), 0);
}

Vec3Field force_in(DirectRun& run) {
  Vec3Field force(run.state.position.size());
  run.forces.update(run.state.position, 0);
  run.forces.force(run.state.position, run.state.velocity, force);
  return force;
}

/// Particles 1 m apart in the plane y = 0, seen from above: x is x on the screen, z is y.
Scene seen_from_above() {
  Scene scene = lying_sheet(3, 3, 1.0);
  scene.air = Air{.drag = 0.02, .wind = {0, 1, 0}, .gust = std::nullopt};
  return scene;
}

BrushGust brush_from_above() {
  BrushGust brush = brush_at({0, 0}, 2);
  brush.world_to_screen << 1, 0, 0, 0,  //
      0, 0, 1, 0,                       //
      0, 1, 0, 0,                       //
      0, 0, 0, 1;
  return brush;
}

TEST(Brush, AddsItsShareOfTheGustToTheWind) {
  DirectRun run(seen_from_above(), "verlet");
  run.forces.set_brush(brush_from_above());
  const Vec3Field force = force_in(run);
  EXPECT_NEAR(force[0].y(), 0.02 * (1 + 5), 1e-15);
  EXPECT_NEAR(force[1].y(), 0.02 * (1 + 5 * std::sqrt(0.5)), 1e-15);
  EXPECT_NEAR(force[2].y(), 0.02 * 1, 1e-15);
}

TEST(Brush, WorksAsMuchAsItsForceTimesTheVelocity) {
  DirectRun run(seen_from_above(), "verlet");
  run.forces.set_brush(brush_from_above());
  run.state.velocity.set(0, {0, 3, 0});
  force_in(run);
  const Work power = run.forces.power(run.state.position, run.state.velocity);
  EXPECT_NEAR(power.brush, 0.02 * 5 * 3, 1e-15);
  EXPECT_NEAR(power.air, 0.02 * (1 - 3) * 3, 1e-15);
}

TEST(Brush, WithoutAirDoesNothing) {
  DirectRun run(lying_sheet(3, 3), "verlet");
  run.forces.set_brush(brush_from_above());
  EXPECT_EQ(largest_norm(force_in(run)), 0);
}

TEST(Brush, TakenAwayLeavesTheWindAlone) {
  DirectRun run(seen_from_above(), "verlet");
  run.forces.set_brush(brush_from_above());
  force_in(run);
  run.forces.set_brush(std::nullopt);
  EXPECT_NEAR(force_in(run)[0].y(), 0.02, 1e-17);
  EXPECT_EQ(run.forces.power(run.state.position, run.state.velocity).brush, 0);
}

TEST(Pull, IsADampedSpringOfZeroLengthToItsTarget) {
  DirectRun run(lying_sheet(2, 2), "verlet");
  run.forces.set_pull(Pull{3, {0.1, 0.5, 0.1}}, 40, 2);
  run.state.velocity.set(3, {0, 1, 0});
  const Vec3Field force = force_in(run);
  EXPECT_LE((force[3] - Vec3(0, 40 * 0.5 - 2 * 1, 0)).norm(), 1e-14);
  for (const std::size_t other : {0u, 1u, 2u}) EXPECT_EQ(force[other].norm(), 0);
  EXPECT_NEAR(run.forces.power(run.state.position, run.state.velocity).pull, 18, 1e-13);
}

TEST(Pull, OnAPinnedParticleDoesNothing) {
  Scene scene = lying_sheet(2, 2);
  scene.cloth.pins = {PinnedParticle{1, 1}};
  DirectRun run(scene, "verlet");
  run.forces.set_pull(Pull{3, {9, 9, 9}}, 40, 2);
  EXPECT_EQ(largest_norm(force_in(run)), 0);
  EXPECT_FALSE(run.forces.has_damping());
}

}  // namespace
}  // namespace cloth::test::hand_test
