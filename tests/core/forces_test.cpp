// Forces computed by hand on a few particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/grid.h"
#include "forces/air.h"
#include "forces/registry.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::forces_test {
namespace {

constexpr double spacing = 0.1;  // m

/// The force on every particle at the run's state.
Vec3Field force_in(DirectRun& run, double time = 0) {
  Vec3Field force(run.state.position.size());
  run.forces.update(run.state.position, time);
  run.forces.force(run.state.position, run.state.velocity, force);
  return force;
}

void expect_vector(const Vec3& actual, const Vec3& expected, double tolerance) {
  EXPECT_LE((actual - expected).norm(), tolerance)
      << "actual " << actual.transpose() << ", expected " << expected.transpose();
}

Scene two_by_two(const SpringMaterial& material) {
  Scene scene = bare_sheet(2, 2, spacing);
  scene.springs = material;
  return scene;
}

/// As the forces take them where no kernel knows the springs.
TEST(SpringDamping, ByRunsIsTheSumOverTheSprings) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{2, 3}, {9, 21}, {5, 300}}) {
    Scene scene = bare_sheet(rows, columns);
    scene.springs = SpringMaterial{.structural = 70, .shear = 40, .flexion = 15, .damping = 0};
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    ClothState state = crumpled_state(system, 0.04, 0.3, random);
    state.position.set(1, state.position[0]);  // a spring of no length
    scene.springs->damping = 0.7;
    const auto entry =
        std::find_if(force_registry().begin(), force_registry().end(), [&](const ForceEntry& e) {
          const auto force = e.make(scene, system);
          return force && force->is_swept_damper({.spring_damping = 0.7});
        });
    const auto damping = entry->make(scene, system);
    Vec3Field product(state.position.size()), none(state.position.size()), expected;
    damping->update(system, state.position, 0, none);
    damping->add_damping(state.position, state.velocity, product);
    Work power;
    damping->add_power(state.position, state.velocity, power);
    const double loss = damper_product(system, 0.7, state, expected);
    EXPECT_LE(largest_distance(product, expected), 2e-14 * largest_norm(expected));
    EXPECT_NEAR(power.damping_loss, loss, 1e-13 * loss);
    EXPECT_EQ(largest_norm(none), 0);
  }
}

TEST(SpringForce, PullsBackInProportionToItsElongation) {
  for (const double elongation : {-0.05, -0.01, 0.0, 0.02, 0.3}) {
    DirectRun run(two_by_two({.structural = 100}), "verlet");
    for (const std::size_t right : {1u, 3u}) run.state.position.add(right, {elongation, 0, 0});
    const Vec3Field force = force_in(run);
    expect_vector(force[0], {100 * elongation, 0, 0}, 1e-12);
    expect_vector(force[1], {-100 * elongation, 0, 0}, 1e-12);
  }
}

TEST(SpringForce, ActsAlongTheSpringInSpace) {
  DirectRun run(two_by_two({.shear = 50}), "verlet");
  // The diagonal 0-3 turned out of the plane and stretched to the length 0.3 along (1, 2, 2)/3.
  run.state.position.set(3, run.state.position[0] + Vec3(0.1, 0.2, 0.2));
  const double tension = 50 * (0.3 - spacing * std::sqrt(2.0));
  expect_vector(force_in(run)[0], tension * Vec3(1, 2, 2) / 3, 1e-12);
  expect_vector(force_in(run)[3], -tension * Vec3(1, 2, 2) / 3, 1e-12);
}

TEST(SpringForce, IsZeroAtRestInEveryFamily) {
  for (const SpringFamily family : spring_families) {
    Scene scene = bare_sheet(5, 4, spacing);
    scene.springs = only(family, 1000);
    DirectRun run(scene, "verlet");
    EXPECT_LE(largest_norm(force_in(run)), 1e-11) << name_of(family);
  }
}

TEST(SpringForce, OfZeroLengthIsZeroAndFinite) {
  DirectRun run(two_by_two({.structural = 100, .shear = 50, .flexion = 10, .damping = 0.1}), "verlet");
  for (std::size_t i = 0; i < 4; ++i) run.state.position.set(i, {0.3, 0.2, 0.1});
  run.state.velocity.set(0, {1, 2, 3});
  const Vec3Field force = force_in(run);
  EXPECT_TRUE(all_finite(force));
  EXPECT_EQ(largest_norm(force), 0);
}

TEST(SpringForce, OfZeroLengthLeavesEveryMethodFinite) {
  for (const char* method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"}) {
    Scene scene = two_by_two({.structural = 100, .shear = 50, .flexion = 0, .damping = 0.1});
    scene.air = Air{.drag = 0.01, .wind = {1, 2, 3}, .gust = std::nullopt};
    DirectRun run(scene, method);
    run.state.position.set(1, run.state.position[0]);
    run.advance(100, 1e-4);
    EXPECT_TRUE(all_finite(run.state)) << method;
  }
}

TEST(SpringDamping, ResistsOnlyTheRateOfStretching) {
  DirectRun run(two_by_two({.structural = 100, .damping = 0.5}), "verlet");
  for (const std::size_t right : {1u, 3u}) run.state.velocity.set(right, {2, 0, 0});
  expect_vector(force_in(run)[0], {0.5 * 2, 0, 0}, 1e-12);
  expect_vector(force_in(run)[1], {-0.5 * 2, 0, 0}, 1e-12);

  for (const std::size_t right : {1u, 3u}) run.state.velocity.set(right, {0, 0, 2});
  EXPECT_LE(largest_norm(force_in(run)), 1e-12);  // across the springs
}

TEST(SpringDamping, ActsOnSpringsOfEveryFamily) {
  for (const SpringFamily family : spring_families) {
    Scene scene = bare_sheet(3, 3, spacing);
    scene.springs = only(family, 100);
    scene.springs->damping = 0.5;
    DirectRun run(scene, "verlet");
    for (std::size_t i = 0; i < 9; ++i) run.state.velocity.set(i, 3 * run.system.start[i]);  // grows evenly
    Vec3 expected = Vec3::Zero();  // on particle 0: every spring of length l lengthens at the rate 3 l
    if (family == SpringFamily::structural) expected = 0.5 * 3 * spacing * Vec3(1, -1, 0);
    if (family == SpringFamily::shear) expected = 0.5 * 3 * spacing * Vec3(1, -1, 0);
    if (family == SpringFamily::flexion) expected = 0.5 * 3 * 2 * spacing * Vec3(1, -1, 0);
    expect_vector(force_in(run)[0], expected, 1e-12);
  }
}

TEST(ViscousDamping, OpposesTheVelocity) {
  Scene scene = bare_sheet(2, 2);
  scene.damping = 0.25;
  DirectRun run(scene, "verlet");
  run.state.velocity.set(2, {1, -2, 3});
  expect_vector(force_in(run)[2], {-0.25, 0.5, -0.75}, 0);
  expect_vector(force_in(run)[1], Vec3::Zero(), 0);
}

TEST(GravityForce, IsTheWeightOfEveryParticle) {
  Scene scene = bare_sheet(3, 2, spacing, 0.02);
  scene.gravity = Vec3(1, -9.81, 0.5);
  DirectRun run(scene, "verlet");
  for (std::size_t i = 0; i < 6; ++i) expect_vector(force_in(run)[i], {0.02, -0.02 * 9.81, 0.01}, 1e-16);
}

Scene airy(const Vec3& wind) {
  Scene scene = lying_sheet(2, 2);
  scene.air = Air{.drag = 0.02, .wind = wind, .gust = std::nullopt};
  return scene;
}

TEST(AirForce, PushesAlongTheNormalOnly) {
  DirectRun run(airy({5, 3, -2}), "verlet");
  for (std::size_t i = 0; i < 4; ++i) expect_vector(force_in(run)[i], {0, 0.02 * 3, 0}, 1e-15);
}

TEST(AirForce, IsDragWhereTheAirIsStill) {
  DirectRun run(airy(Vec3::Zero()), "verlet");
  run.state.velocity.set(0, {4, 2, 1});
  expect_vector(force_in(run)[0], {0, -0.02 * 2, 0}, 1e-15);
}

TEST(AirForce, ComesFromTheDifferenceOfWindAndCloth) {
  DirectRun run(airy({0, 3, 0}), "verlet");
  for (std::size_t i = 0; i < 4; ++i) run.state.velocity.set(i, {7, 3, 7});
  EXPECT_LE(largest_norm(force_in(run)), 1e-15);
}

TEST(AirForce, IsTheSameFromBehind) {
  DirectRun front(airy({0, 3, 0}), "verlet");
  Scene turned = airy({0, 3, 0});
  turned.cloth.across = {-1, 0, 0};  // now the back is up
  DirectRun back(turned, "verlet");
  expect_vector(force_in(back)[0], force_in(front)[0], 1e-16);
}

TEST(AirForce, SwingsWithTheGustAtItsTime) {
  Scene scene = airy({0, 3, 0});
  scene.air->gust = Gust{.amplitude = 0.5, .frequency = 2};
  DirectRun run(scene, "verlet");
  const double eighth = 1.0 / 16;  // of a second: an eighth of the gust's period
  expect_vector(force_in(run, 0)[0], {0, 0.06, 0}, 1e-15);
  expect_vector(force_in(run, eighth)[0], {0, 0.06 * (1 + 0.5 * std::sqrt(0.5)), 0}, 1e-15);
  expect_vector(force_in(run, 2 * eighth)[0], {0, 0.06 * 1.5, 0}, 1e-15);
  expect_vector(force_in(run, 6 * eighth)[0], {0, 0.06 * 0.5, 0}, 1e-15);
}

TEST(AirForce, OfACollapsedClothIsZeroAndFinite) {
  DirectRun run(airy({5, 3, -2}), "verlet");
  for (std::size_t i = 0; i < 4; ++i) run.state.position.set(i, {1, 1, 1});
  const Vec3Field force = force_in(run);
  EXPECT_TRUE(all_finite(force));
  EXPECT_EQ(largest_norm(force), 0);
}

TEST(ForceModel, HasOnlyTheForcesThatTheSceneHas) {
  Scene scene = bare_sheet(3, 3);
  scene.springs = SpringMaterial{};
  scene.damping = 0;
  scene.gravity = Vec3::Zero();
  scene.air = Air{.drag = 0, .wind = {1, 1, 1}, .gust = std::nullopt};
  DirectRun run(scene, "verlet");
  run.state.velocity.set(0, {1, 1, 1});
  EXPECT_FALSE(run.forces.has_damping());
  EXPECT_FALSE(run.forces.has_power());
  EXPECT_EQ(largest_norm(force_in(run)), 0);
}

}  // namespace
}  // namespace cloth::test::forces_test
