// What may change while a simulation runs, and what must not change with it.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::simulation_edit_test {
namespace {

Scene swinging() {
  Scene scene = smooth_scene(6, 6);
  scene.integrator.time_step = 0.001;
  return scene;
}

void run(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) ASSERT_FALSE(simulation.step());
}

template <class Change>
void expect_state_and_ledger_kept(Change change) {
  Simulation simulation(swinging());
  run(simulation, 200);
  const ClothState state = simulation.state();
  const Measurement before = simulation.measure();
  Scene edited = simulation.scene();
  change(edited);
  simulation.edit(edited);
  EXPECT_EQ(simulation.state(), state);
  const double scale = std::abs(before.energy.total()) + std::abs(simulation.measure().energy.total());
  EXPECT_NEAR(simulation.measure().energy_error(), before.energy_error(), 1e-13 * scale);
  EXPECT_EQ(simulation.measure().ledger.forces.damping_loss, before.ledger.forces.damping_loss);
  run(simulation, 200);
  EXPECT_NEAR(simulation.measure().energy_error(), before.energy_error(), 2e-3);
}

TEST(ALiveEdit, OfAStiffnessKeepsTheStateAndTheLedgersError) {
  expect_state_and_ledger_kept([](Scene& scene) { scene.springs->structural = 80; });
  expect_state_and_ledger_kept([](Scene& scene) { scene.springs->shear = 0; });
}

TEST(ALiveEdit, OfAnyForceKeepsTheStateAndTheLedgersError) {
  expect_state_and_ledger_kept([](Scene& scene) { scene.gravity = Vec3(1, 2, 3); });
  expect_state_and_ledger_kept([](Scene& scene) { scene.gravity.reset(); });
  expect_state_and_ledger_kept([](Scene& scene) { scene.damping = 0.05; });
  expect_state_and_ledger_kept([](Scene& scene) { scene.air.reset(); });
  expect_state_and_ledger_kept([](Scene& scene) { scene.springs->damping = 0.01; });
  expect_state_and_ledger_kept([](Scene& scene) { scene.cloth.mass *= 1.5; });
}

TEST(ALiveEdit, OfTheMethodKeepsTheStateAndTheLedgersError) {
  expect_state_and_ledger_kept([](Scene& scene) { scene.integrator.method = "rk4"; });
}

TEST(ALiveEdit, ThatChangesNothingChangesNoBit) {
  Simulation edited(swinging()), plain(swinging());
  for (Simulation* simulation : {&edited, &plain}) run(*simulation, 100);
  edited.edit(edited.scene());
  for (Simulation* simulation : {&edited, &plain}) run(*simulation, 100);
  EXPECT_EQ(edited.state(), plain.state());
}

TEST(ALiveEdit, OfTheTimeStepKeepsTimeExact) {
  Simulation simulation(swinging());
  run(simulation, 100);
  Scene edited = simulation.scene();
  edited.integrator.time_step = 0.0003;
  simulation.edit(edited);
  EXPECT_EQ(simulation.time(), 100 * 0.001);
  EXPECT_EQ(simulation.time_step(), 0.0003);
  for (int n = 1; n <= 500; ++n) {
    simulation.step();
    EXPECT_EQ(simulation.time(), 100 * 0.001 + n * 0.0003);
    EXPECT_EQ(simulation.state().step, 100 + n);
  }
}

TEST(ALiveEdit, BringsStagesInAndOut) {
  Simulation simulation(swinging());
  run(simulation, 10);
  EXPECT_FALSE(simulation.quantities().limiter);
  Scene edited = simulation.scene();
  edited.deformation = Deformation{};
  edited.obstacles.emplace_back();
  edited.damping.reset();
  simulation.edit(edited);
  EXPECT_TRUE(simulation.quantities().limiter);
  EXPECT_TRUE(simulation.quantities().contact);
  EXPECT_FALSE(simulation.quantities().damping);
  run(simulation, 10);
}

TEST(APinAdded, HoldsItsParticleWhereItIsAndAtRest) {
  Simulation simulation(swinging());
  run(simulation, 300);
  const Vec3 where = simulation.state().position[35];
  ASSERT_GT(simulation.state().velocity[35].norm(), 0.1);
  const double error = simulation.measure().energy_error();
  Scene edited = simulation.scene();
  edited.cloth.pins.emplace_back(PinnedParticle{5, 5});
  simulation.edit(edited);
  EXPECT_NEAR(simulation.measure().energy_error(), error, 1e-13);
  run(simulation, 200);
  EXPECT_EQ(simulation.state().position[35], where);
  EXPECT_EQ(simulation.state().velocity[35], Vec3(0, 0, 0));
}

TEST(APinRemoved, LetsItsParticleFall) {
  Simulation simulation(swinging());
  run(simulation, 50);
  Scene edited = simulation.scene();
  edited.cloth.pins = {NamedPin::top_left};
  simulation.edit(edited);
  run(simulation, 200);
  EXPECT_LT(simulation.state().position[5].y(), -0.05);
  EXPECT_EQ(simulation.state().position[0], simulation.system().start[0]);
}

TEST(APinAddedFarAway, MakesTheRateUnreachable) {
  Scene scene = swinging();
  scene.springs->structural = 1, scene.springs->shear = 0, scene.springs->flexion = 0;  // soft: stretches far
  Simulation simulation(scene);
  run(simulation, 800);
  Scene edited = simulation.scene();
  edited.cloth.pins.emplace_back(PinnedParticle{5, 0});
  edited.deformation = Deformation{};
  simulation.edit(edited);
  ASSERT_TRUE(simulation.unreachable_rate());
  EXPECT_EQ(simulation.unreachable_rate()->first, 0);
  EXPECT_EQ(simulation.unreachable_rate()->second, 30);
}

TEST(Pull, MovesItsParticleToTheTargetAndLetsGo) {
  Scene scene = swinging();
  scene.damping = 0.1;
  Simulation simulation(scene);
  const Vec3 target = simulation.state().position[35] + Vec3(0.1, 0.1, 0.3);
  simulation.set_pull(Pull{35, target});
  EXPECT_TRUE(simulation.quantities().pull);
  run(simulation, 3000);
  EXPECT_LE((simulation.state().position[35] - target).norm(), 0.1);
  EXPECT_GT(simulation.measure().ledger.forces.pull, 0.01);
  simulation.set_pull(std::nullopt);
  run(simulation, 2000);
  EXPECT_GT((simulation.state().position[35] - target).norm(), 0.1);
}

/// The ledger's error after 0.4 s of pulling, at a step so short that the hand's strength no longer depends
/// on it.
double ledger_error_of_a_pull(int steps) {
  Scene scene = swinging();
  scene.integrator.time_step = 0.4 / steps;
  Simulation simulation(scene);
  simulation.set_pull(Pull{35, simulation.state().position[35] + Vec3(0.1, 0.1, 0.3)});
  run(simulation, steps);
  EXPECT_GT(simulation.measure().ledger.forces.pull, 0.01);
  return std::abs(simulation.measure().energy_error());
}

TEST(Pull, BooksItsWorkAtTheMethodsOrder) {
  EXPECT_NEAR(std::log2(ledger_error_of_a_pull(4000) / ledger_error_of_a_pull(8000)), 2, 0.1);
}

TEST(Pull, IsStableAtTheAutomaticStepOfEveryScene) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    Simulation simulation(builtin_scene(builtin.name));
    const int last = simulation.system().size() - 1;
    simulation.set_pull(
        Pull{last, simulation.state().position[static_cast<std::size_t>(last)] + Vec3(0, 0.2, 0.5)});
    for (int n = 0; n < 200; ++n) ASSERT_FALSE(simulation.step()) << builtin.name;
  }
}

TEST(Brush, DoesWorkThatTheLedgerBooks) {
  Scene scene = swinging();
  scene.air->wind = Vec3::Zero(), scene.air->gust.reset();
  Simulation simulation(scene);
  BrushGust brush;
  brush.velocity = {0, 0, 10};
  brush.radius = 100;  // the identity as matrix: one pixel is one metre
  simulation.set_brush(brush);
  EXPECT_TRUE(simulation.quantities().brush);
  run(simulation, 400);
  EXPECT_GT(simulation.measure().ledger.forces.brush, 0.01);
  EXPECT_GT(simulation.state().position[35].z(), 0.05);
  EXPECT_NEAR(simulation.measure().energy_error(), 0, 1e-2 * simulation.measure().ledger.forces.brush);
}

TEST(Brush, WithoutAirHasNoColumn) {
  Scene scene = swinging();
  scene.air.reset();
  Simulation simulation(scene);
  simulation.set_brush(BrushGust{});
  EXPECT_FALSE(simulation.quantities().brush);
}

TEST(ACheckpoint, GoesOnToTheSameBits) {
  Scene scene = swinging();
  scene.integrator.time_step = 0.0007;
  Simulation simulation(scene);
  run(simulation, 101);
  const Checkpoint checkpoint = simulation.checkpoint();
  run(simulation, 333);
  const ClothState there = simulation.state();
  const double loss = simulation.measure().ledger.forces.damping_loss;
  simulation.restore(checkpoint);
  for (int n = 101; n < 101 + 333; ++n) {
    EXPECT_EQ(simulation.time(), n * 0.0007);
    simulation.step();
  }
  EXPECT_EQ(simulation.state(), there);
  EXPECT_EQ(simulation.measure().ledger.forces.damping_loss, loss);
}

}  // namespace
}  // namespace cloth::test::simulation_edit_test
