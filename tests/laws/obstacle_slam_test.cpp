// An obstacle that goes far and turns far within one step: the cloth that can give way does, nothing comes
// through, and the step ends within its budget of work or when it is asked to.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "contact/continuous_contact.h"
#include "scene/obstacle_shape.h"
#include "support/contact_scenes.h"
#include "support/random.h"

namespace cloth::test::obstacle_slam_test {
namespace {

constexpr double step = 1e-4;

/// A cloth of 0.5 m that hangs by its top edge in the plane z = 0, and an obstacle in front of its middle
/// that is elsewhere from 2 steps after the start on.
Scene hung_before(Shape shape, const Vec3& way, const Vec3& turn) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 13;
  scene.cloth.width = scene.cloth.height = 0.5;
  scene.cloth.origin = {-0.25, 0.25, 0};
  scene.cloth.mass = 0.05;
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = SpringMaterial{.structural = 500, .shear = 250, .flexion = 5};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.contact = ContactSettings{};
  scene.integrator.time_step = step;
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.size = {0.3, 0.2, 0.1};
  obstacle.scale = 0.25;
  obstacle.mesh.file = "cone-bed.obj";
  const Vec3 place(0.01, -0.05, 0.25);
  obstacle.center = obstacle.translate = place;
  obstacle.keyframes = {{0, place, {0, 0, 0}}, {2 * step, place, {0, 0, 0}}, {3 * step, place + way, turn}};
  scene.obstacles = {obstacle};
  load_meshes(scene);
  return scene;
}

TEST(AnObstacleThatGoesFarInAStep, PassesClothThatHangsByItsTopEdgeAlone) {
  Random random;
  for (int round = 0; round < 8; ++round) {
    const Shape shape = round % 4 == 3 ? &mesh_shape() : &box_shape();
    const Vec3 turn = 2.2 * random.vector(1).normalized();
    Scene scene = hung_before(shape, {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0), -0.5}, turn);
    if (round % 3 == 2) scene.self_contact = SelfContact{};
    Simulation simulation(scene);
    for (int k = 0; k < 8; ++k) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << "round " << round << ": " << describe(*stop);
      const Count found = all_crossings(simulation);
      ASSERT_EQ(found.number, 0) << "round " << round << ", step " << k << ": " << found.first;
    }
  }
}

TEST(AnObstacleThatGoesFarInAStep, PushesTheClothAsFastAsItGoes) {
  Simulation simulation(hung_before(&box_shape(), {0, 0, -0.5}, {0, 0, 2.2}));
  for (int k = 0; k < 3; ++k) ASSERT_FALSE(simulation.step());
  EXPECT_LT(simulation.state().velocity[6 * 13 + 6].z(), -0.9 * 0.5 / step) << "m/s, before the box's middle";
}

TEST(AnObstacleThatSpinsTooFastToFollow, StopsTheRunWithinTheBudgetOfAStep) {
  Scene scene = hung_before(&box_shape(), {0, 0, 0}, {0, 0, 0});
  scene.obstacles[0].keyframes.clear();
  scene.obstacles[0].center.z() = 0.08;
  scene.obstacles[0].spin = {0, 1e9, 0};
  Simulation simulation(scene);
  std::optional<Divergence> stop;
  for (int k = 0; k < 3 && !stop; ++k) stop = simulation.step();
  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->solver_failed);
  const std::string text = describe(*stop);
  EXPECT_NE(text.find("box 1 (obstacles.0) goes so far in a step"), std::string::npos) << text;
  EXPECT_LT(simulation.last_contact().rounds, 60000);
}

TEST(AStepOfContact, EndsWhenItIsAskedToAndLeavesTheStateBeforeIt) {
  Simulation simulation(hung_before(&box_shape(), {0, 0, -0.5}, {0, 0, 2.2}));
  for (int k = 0; k < 2; ++k) ASSERT_FALSE(simulation.step());
  const Checkpoint before = simulation.checkpoint();
  int asked = 0;
  simulation.set_stop_test([&] { return ++asked == 5; });
  EXPECT_FALSE(simulation.step());
  EXPECT_TRUE(simulation.interrupted());
  EXPECT_EQ(asked, 5);
  const Checkpoint after = simulation.checkpoint();
  EXPECT_EQ(after.state.step, before.state.step);
  EXPECT_TRUE(std::ranges::equal(after.state.position.flat(), before.state.position.flat()));
  EXPECT_TRUE(std::ranges::equal(after.state.velocity.flat(), before.state.velocity.flat()));
  EXPECT_EQ(after.obstacle_poses, before.obstacle_poses);
  EXPECT_EQ(after.ledger.contact, before.ledger.contact);
  simulation.set_stop_test({});
  EXPECT_FALSE(simulation.step());
  EXPECT_FALSE(simulation.interrupted());
  EXPECT_EQ(simulation.state().step, before.state.step + 1);
  EXPECT_EQ(all_crossings(simulation).number, 0);
}

TEST(AStepOfContact, ThatWasInterruptedIsTakenAgainToTheBit) {
  const auto go = [](const Scene& scene, bool interrupts) {
    Simulation simulation(scene);
    int asked = 0, interruptions = 0;
    simulation.set_stop_test([&] { return interrupts && ++asked == 5; });
    while (simulation.state().step < 6) {
      EXPECT_FALSE(simulation.step());
      if (!simulation.interrupted()) continue;
      ++interruptions;
      EXPECT_GT(simulation.state().step, 1);
    }
    EXPECT_EQ(interruptions, interrupts ? 1 : 0);
    return simulation.checkpoint();
  };
  std::set<EndVelocity> ways;
  for (const char* method : {"verlet", "implicit-euler", "bdf2", "dormand-prince", "xpbd", "vbd"})
    for (const double damping : {3e-3, 0.17, 0.3, 1.0}) {
      Scene scene = hung_before(&box_shape(), {0, 0, -0.5}, {0, 0, 2.2});
      scene.integrator.method = method;
      scene.springs->damping = damping;
      if (scene.integrator.method == "verlet") ways.insert(Simulation(scene).stepper().end_velocity);
      const Checkpoint straight = go(scene, false), interrupted = go(scene, true);
      EXPECT_EQ(straight.state, interrupted.state) << method << " " << damping;
      EXPECT_EQ(straight.ledger.forces.damping_loss, interrupted.ledger.forces.damping_loss)
          << method << " " << damping;
      EXPECT_EQ(straight.ledger.contact, interrupted.ledger.contact) << method << " " << damping;
    }
  EXPECT_EQ(ways.size(), 4) << "Verlet took its damping in another way";
}

}  // namespace
}  // namespace cloth::test::obstacle_slam_test
