// Edits of a running scene and checkpoints under continuous contact: an obstacle that an edit puts elsewhere,
// turns or grows goes its way from where it was.
#include <gtest/gtest.h>

#include "contact/continuous_contact.h"
#include "support/contact_scenes.h"

namespace cloth::test {
namespace {

void run(Simulation& simulation, int steps) {
  for (int step = 0; step < steps; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
  }
}

/// Runs and looks at every state.
void run_checked(Simulation& simulation, int steps) {
  for (int step = 0; step < steps; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
    const Count count = all_crossings(simulation);
    ASSERT_EQ(count.number, 0) << "t = " << simulation.time() << ": " << count.first;
  }
}

/// A sheet that lies on the obstacle of one of the small scenes.
Scene resting(const std::string& name) {
  Scene scene = contact_scene(name);
  scene.damping = 0.004;
  scene.integrator = {.method = "semi-implicit-euler", .time_step = 0.002};
  return scene;
}

TEST(AnEditOfAnObstacle, PushesTheClothThatLiesOnItUp) {
  Scene scene = resting("plane");
  Simulation simulation(scene);
  run(simulation, 100);
  const double before = simulation.state().position[40].y();
  scene.obstacles[0].point.y() += 0.1;
  simulation.edit(scene);
  run_checked(simulation, 60);
  EXPECT_GT(simulation.state().position[40].y(), before + 0.09);
}

TEST(AnEditOfAnObstacle, MayTurnAPlane) {
  Scene scene = resting("plane");
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles[0].normal = {0.02, 1, 0};  // at once: of more the cloth is thrown off
  simulation.edit(scene);
  run_checked(simulation, 100);
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    EXPECT_GT(scene.obstacles[0].normal.dot(simulation.state().position[i]), 0);
}

TEST(AnEditOfAnObstacle, MayTurnABoxByKeyframes) {
  Scene scene = resting("box");
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles[0].keyframes = {{0, scene.obstacles[0].center, {0, 0, 0}},
                                  {simulation.time(), scene.obstacles[0].center, {0.3, 0.2, 0}},
                                  {simulation.time() + 0.1, scene.obstacles[0].center, {0.5, 1, 0}}};
  simulation.edit(scene);
  run_checked(simulation, 100);
}

TEST(AnEditOfAnObstacle, ThatLetsABallGrowLeadsTheClothOut) {
  Scene scene = resting("sphere");
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles[0].radius *= 1.3;
  simulation.edit(scene);
  EXPECT_GT(all_crossings(simulation).number, 0);
  run(simulation, 100);
  EXPECT_EQ(all_crossings(simulation).number, 0);
}

TEST(AnEditOfAnObstacle,
     ThatLetsABoxGrowLeadsTheParticlesOut) {  // its edges and corners may stay in the cloth
  Scene scene = resting("box");
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles[0].size *= 1.3;
  simulation.edit(scene);
  run(simulation, 100);
  const Obstacle& box = scene.obstacles[0];
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i) {
    const Vec3 out = (simulation.state().position[i] - box.center).cwiseAbs() - 0.5 * box.size;
    EXPECT_GT(out.maxCoeff(), 0) << "particle " << i;
  }
}

TEST(AnEditOfTheScene, ThatLeavesObstaclesAloneDoesNotMoveThem) {
  Scene scene = resting("turning-box");
  Simulation simulation(scene);
  run(simulation, 37);
  const Pose before = simulation.obstacle_pose(0, simulation.time());
  scene.gravity = Vec3(0, -5, 0);
  simulation.edit(scene);
  EXPECT_EQ(simulation.obstacle_pose(0, simulation.time()), before);
  run_checked(simulation, 30);
}

TEST(AnEditOfTheScene, MayAddAndTakeAwayObstaclesBesideOneInUse) {
  Scene scene = resting("sphere");
  Simulation simulation(scene);
  run(simulation, 60);
  Obstacle floor;
  floor.shape = Shape::plane;
  floor.point = {0, -0.25, 0};
  scene.obstacles.push_back(floor);
  simulation.edit(scene);
  run_checked(simulation, 60);
  scene.obstacles.erase(scene.obstacles.begin());
  simulation.edit(scene);
  run_checked(simulation, 120);
  EXPECT_LT(simulation.state().position[40].y(), -0.15) << "the ball is gone";
}

TEST(AnEditOfTheScene, MayTurnSelfContactOffAndOnWhereNothingCrosses) {
  Scene scene = resting("plane");
  scene.self_contact = SelfContact{};
  Simulation simulation(scene);
  run_checked(simulation, 20);
  scene.self_contact.reset();
  simulation.edit(scene);
  run_checked(simulation, 20);
  scene.self_contact = SelfContact{};
  simulation.edit(scene);
  run_checked(simulation, 20);
}

TEST(ACheckpointOfContact, SaysWhatItTakesInMemory) {
  Scene scene = contact_scene("sphere");
  const std::size_t one = Simulation(scene).checkpoint().bytes();
  Obstacle floor;
  floor.shape = Shape::plane;
  floor.point = {0, -1, 0};
  for (int n = 0; n < 10; ++n) scene.obstacles.push_back(floor);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.checkpoint().bytes(), one + 10 * sizeof(Pose));
  scene.obstacles[0].center.y() -= 0.1;
  simulation.edit(scene);
  EXPECT_EQ(simulation.checkpoint().bytes(), one + 10 * sizeof(Pose) + 11 * sizeof(ObstacleCarry));
}

TEST(ACheckpointOfContact, HasTheImpulseInIt) {
  Simulation simulation(resting("plane"));
  run(simulation, 60);
  const Checkpoint checkpoint = simulation.checkpoint();
  const Vec3 impulse = simulation.measure().contact_impulse;
  EXPECT_GT(impulse.y(), 0);
  run(simulation, 60);
  EXPECT_GT(simulation.measure().contact_impulse.y(), impulse.y());
  simulation.restore(checkpoint);
  EXPECT_EQ(simulation.measure().contact_impulse, impulse);
}

TEST(TheImpulseOfContact, IsTheMomentumThatGravityDoesNotExplain) {
  Scene scene = contact_scene("sphere");
  scene.damping.reset();
  scene.integrator = {.method = "semi-implicit-euler", .time_step = 0.001};
  Simulation simulation(scene, thrown({0, -2, 0}));
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < simulation.state().velocity.size(); ++i)
      sum += simulation.system().mass[i] * simulation.state().velocity[i];
    return sum;
  };
  const Vec3 before = momentum();
  run(simulation, 80);
  const Vec3 gained = momentum() - before - simulation.time() * scene.cloth.mass * *scene.gravity;
  const Vec3 impulse = simulation.measure().contact_impulse;
  EXPECT_GT(impulse.norm(), 0.05);
  EXPECT_LE((gained - impulse).norm(), 1e-9 * impulse.norm())
      << gained.transpose() << " for " << impulse.transpose();
}

}  // namespace
}  // namespace cloth::test
