// Starts that no scene file describes: what the engine does with them.
#include <gtest/gtest.h>

#include <limits>

#include "contact/obstacle_contact.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/obstacle_shape.h"
#include "simulation/simulation.h"
#include "support/scenes.h"

namespace cloth::test::extreme_starts_test {
namespace {

TEST(APositionThatIsNotFinite, StopsTheRunThoughEveryVelocityIs) {
  Scene scene = bare_sheet(3, 3);  // without springs no force feels it
  scene.integrator.time_step = 0.01;
  Simulation simulation(scene, [](ClothSystem&, ClothState& state) {
    state.position.set(4, {0, std::numeric_limits<double>::quiet_NaN(), 0});
  });
  const auto divergence = simulation.step();
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->particle, 4);
  EXPECT_EQ(divergence->row, 1);
  EXPECT_EQ(divergence->step, 1);
  EXPECT_EQ(divergence->cause, "its position is not finite");
}

TEST(PositionsWhoseSumOverflows, AreFinite) {
  Scene scene = bare_sheet(3, 3);
  scene.integrator.time_step = 0.01;
  Simulation simulation(scene, [](ClothSystem&, ClothState& state) {
    for (std::size_t i = 0; i < state.position.size(); ++i) state.position.set(i, Vec3::Constant(1e308));
  });
  EXPECT_FALSE(simulation.step());
}

TEST(AStartBeyondTheRate, IsBroughtWithinItAndStaysAtRest) {
  Scene scene = bare_sheet(5, 5);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 0, .damping = 0};
  scene.deformation = Deformation{.rate = 0.1};
  scene.integrator.time_step = 1e-6;  // any displacement over it would be a speed of hundreds of m/s
  Simulation simulation(scene, [](ClothSystem&, ClothState& state) {
    for (double& x : state.position.flat()) x *= 1.5;
  });
  EXPECT_LE(simulation.measure().strain.maximum(), 0.1 + scene.deformation->tolerance);
  EXPECT_EQ(simulation.measure().energy.kinetic, 0);
  EXPECT_EQ(simulation.measure().energy_error(), 0);
  EXPECT_FALSE(simulation.step());
}

TEST(AStopOfAPreparedCloth, NamesTheLimitOfItsMasses) {
  Scene scene = bare_sheet(5, 5);
  scene.springs = only(SpringFamily::structural, 100);
  scene.gravity = Vec3(0, -9.81, 0);
  scene.cloth.pins = {NamedPin::top_left};
  scene.integrator.time_step = 0.01;  // half of the limit of the scene's own masses
  Simulation simulation(scene, [](ClothSystem& system, ClothState&) {
    for (std::size_t i = 0; i < system.mass.size(); ++i)
      if (!system.pinned[i]) system.mass[i] *= 1e-4, system.inverse_mass[i] *= 1e4;
  });
  std::optional<Divergence> divergence;
  for (int step = 0; step < 200 && !divergence; ++step) divergence = simulation.step();
  ASSERT_TRUE(divergence);
  EXPECT_NEAR(divergence->stable_step, 2 / guaranteed_frequency(simulation.system()), 1e-12);
  EXPECT_LT(divergence->stable_step, 0.02 * *guaranteed_step("verlet", scene));
}

TEST(Tunnelling, IsPossibleWhereAParticleMovesFurtherThanTheThinnestObstacle) {
  const std::vector<Obstacle> obstacles{Obstacle{.shape = &sphere_shape(), .radius = 0.3},
                                        Obstacle{.shape = &box_shape(), .size = {1, 0.05, 1}},
                                        Obstacle{.shape = &plane_shape()}};
  Scene scene = bare_sheet(2, 2);
  scene.integrator.time_step = 0.01;
  const Simulation simulation(scene);
  ClothState state = simulation.state();
  state.velocity.set(3, {0, 4.9, 0});
  EXPECT_FALSE(find_tunnelling(obstacles, simulation.system(), state, 0.01));
  state.velocity.set(3, {0, 5.1, 0});
  const auto risk = find_tunnelling(obstacles, simulation.system(), state, 0.01);
  ASSERT_TRUE(risk);
  EXPECT_EQ(risk->particle, 3);
  EXPECT_EQ(risk->obstacle, 1u);
  EXPECT_DOUBLE_EQ(risk->travel, 0.051);
  EXPECT_DOUBLE_EQ(risk->thickness, 0.05);
  EXPECT_FALSE(find_tunnelling({Obstacle{.shape = &plane_shape()}}, simulation.system(), state, 0.01));
}

}  // namespace
}  // namespace cloth::test::extreme_starts_test
