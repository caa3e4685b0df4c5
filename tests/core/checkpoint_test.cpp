// Going back to a checkpoint and on from there: the same bits, for every method and every stage.
#include <gtest/gtest.h>

#include <functional>

#include "integrators/registry.h"
#include "scene/obstacle_shape.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"
#include "support/scenes.h"

namespace cloth::test::checkpoint_test {
namespace {

struct Case {
  const char* name;
  std::function<void(Scene&)> change;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"viscous damping, air and gust", [](Scene&) {}},
      {"no damping", [](Scene& scene) { scene.air.reset(), scene.damping = 0.001; }},
      {"spring damping", [](Scene& scene) { scene.springs->damping = 0.02; }},
      {"deformation rate", [](Scene& scene) { scene.deformation = Deformation{.rate = 0.01}; }},
      {"contact",
       [](Scene& scene) {
         Obstacle ball;
         ball.center = {0.5, -0.5, 0.05};
         scene.obstacles = {ball};
       }},
      {"all at once",
       [](Scene& scene) {
         scene.springs->damping = 0.01;
         scene.deformation = Deformation{.rate = 0.02};
         Obstacle box;
         box.shape = &box_shape();
         box.center = {0.3, -0.7, 0.3};
         scene.obstacles = {box};
       }},
  };
  return all;
}

Scene scene_of(const std::string& method, const Case& the_case) {
  Scene scene = smooth_scene(6, 6);
  the_case.change(scene);
  scene.integrator.method = method;
  scene.integrator.time_step = std::min(resolved_time_step(scene).value_or(1e-4), 0.008);
  return scene;
}

BrushGust gust() {
  BrushGust brush;
  brush.velocity = {1, 0, 6};
  brush.radius = 3;  // the identity as matrix: one pixel is one metre
  return brush;
}

/// Every number that a later row could show.
std::vector<double> numbers_of(const Simulation& simulation) {
  const Measurement m = simulation.measure();
  return {m.time,
          m.energy.total(),
          m.ledger.forces.damping_loss,
          m.ledger.forces.air,
          m.ledger.forces.brush,
          m.ledger.forces.pull,
          m.ledger.limiter,
          m.ledger.contact,
          m.ledger.initial,
          m.limiter_excess,
          static_cast<double>(m.limiter_sweeps),
          static_cast<double>(m.contacts)};
}

void expect_same_bits(const Simulation& simulation, const ClothState& state,
                      const std::vector<double>& numbers, const std::string& what) {
  EXPECT_EQ(simulation.state(), state) << what;
  EXPECT_EQ(numbers_of(simulation), numbers) << what;
}

void run(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) ASSERT_FALSE(simulation.step()) << simulation.scene().integrator.method;
}

template <class Check>
void for_every_method_and_stage(Check check) {
  for (const std::string& method : integrator_names())
    for (const Case& the_case : cases()) check(scene_of(method, the_case), method + ", " + the_case.name);
}

constexpr int half = 40;

TEST(ACheckpointOfAnyMethod, GoesOnToTheSameBits) {
  for_every_method_and_stage([](const Scene& scene, const std::string& what) {
    Simulation simulation(scene);
    run(simulation, half);
    const Checkpoint checkpoint = simulation.checkpoint();
    const auto numbers_there = numbers_of(simulation);
    run(simulation, half);
    const ClothState state = simulation.state();
    const auto numbers = numbers_of(simulation);
    simulation.restore(checkpoint);
    expect_same_bits(simulation, checkpoint.state, numbers_there, what);
    run(simulation, half);
    expect_same_bits(simulation, state, numbers, what);
  });
}

TEST(ACheckpointOfAnyMethod, GoesOnToTheSameBitsInAnotherSimulation) {
  for_every_method_and_stage([](const Scene& scene, const std::string& what) {
    Simulation first(scene), second(scene);
    run(first, half);
    second.restore(first.checkpoint());
    run(first, half);
    run(second, half);
    expect_same_bits(second, first.state(), numbers_of(first), what);
    EXPECT_EQ(second.quantities(), first.quantities()) << what;
  });
}

TEST(ACheckpointOfAnyMethod, HasTheHandInIt) {
  for_every_method_and_stage([](const Scene& scene, const std::string& what) {
    Simulation simulation(scene);
    simulation.set_pull(Pull{35, simulation.state().position[35] + Vec3(0.05, 0, 0.1)});
    simulation.set_brush(gust());
    run(simulation, half);
    const Checkpoint checkpoint = simulation.checkpoint();
    run(simulation, half);
    const ClothState state = simulation.state();
    const auto numbers = numbers_of(simulation);
    simulation.set_pull(std::nullopt);
    simulation.set_brush(std::nullopt);
    run(simulation, 3);
    simulation.restore(checkpoint);
    run(simulation, half);
    expect_same_bits(simulation, state, numbers, what);
  });
}

TEST(ACheckpoint, TakesBackTheColumnsOfAHandThatCameLater) {
  Simulation simulation(smooth_scene(4, 4));
  const Checkpoint checkpoint = simulation.checkpoint();
  simulation.set_pull(Pull{15, {0, 0, 0}});
  simulation.set_brush(gust());
  EXPECT_TRUE(simulation.quantities().pull && simulation.quantities().brush);
  simulation.restore(checkpoint);
  EXPECT_FALSE(simulation.quantities().pull || simulation.quantities().brush);
  EXPECT_FALSE(simulation.pull() || simulation.brush());
}

TEST(ACheckpoint, TakesBackTheCountOfSteps) {
  Simulation simulation(smooth_scene(4, 4));
  run(simulation, 5);
  const Checkpoint checkpoint = simulation.checkpoint();
  run(simulation, 5);
  simulation.restore(checkpoint);
  EXPECT_EQ(simulation.count().steps, 5);
}

TEST(ACheckpoint, OfAMethodThatIsNoLongerInForceGivesTheStateAlone) {
  for (const std::string& method : integrator_names()) {
    Scene scene = scene_of(method, cases().front());
    Simulation simulation(scene);
    run(simulation, 5);
    const Checkpoint checkpoint = simulation.checkpoint();
    for (const std::string& other : integrator_names()) {
      scene.integrator.method = other;
      simulation.edit(scene);
      simulation.restore(checkpoint);
      EXPECT_EQ(simulation.state(), checkpoint.state);
      run(simulation, 2);
    }
  }
}

}  // namespace
}  // namespace cloth::test::checkpoint_test
