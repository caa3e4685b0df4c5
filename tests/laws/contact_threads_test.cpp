// Contact is the same to the bit for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth::test::contact_threads_test {
namespace {

struct Outcome {
  std::vector<double> values;
  int touched = 0;
  std::int64_t velocity_iterations = 0;
};

/// The end of a run that is long enough for the cloth to lie on what is under it.
Outcome run_with(int threads, const Scene& scene, double duration) {
  Simulation simulation(scene);
  simulation.set_threads(threads, ThreadUse::always);
  Outcome outcome;
  while (simulation.state().time < duration) {
    const auto stop = simulation.step();
    EXPECT_FALSE(stop) << describe(*stop);
    if (stop) break;
    outcome.touched = std::max(outcome.touched, simulation.last_contact().contacts);
  }
  outcome.velocity_iterations = simulation.count().velocity_iterations;
  for (const Vec3Field* field : {&simulation.state().position, &simulation.state().velocity})
    outcome.values.insert(outcome.values.end(), field->flat().begin(), field->flat().end());
  return outcome;
}

Scene scene_of(const std::string& name, int side) {
  Scene scene = builtin_scene(name);
  scene.cloth.rows = scene.cloth.columns = side;
  scene.integrator.time_step = resolved_time_step(scene).value();
  return scene;
}

void expect_same_for_any_threads(const Scene& scene, double duration) {
  const Outcome alone = run_with(1, scene, duration);
  EXPECT_GT(alone.touched, 0) << "nothing was touched";
  for (const int threads : {2, 3}) {
    const Outcome together = run_with(threads, scene, duration);
    EXPECT_EQ(together.touched, alone.touched) << threads << " threads";
    EXPECT_TRUE(together.values == alone.values) << threads << " threads";
  }
}

TEST(ContactOfManyThreads, IsTheSameOnAMesh) {
  expect_same_for_any_threads(scene_of("bunny", 25), 0.55);
}

TEST(ContactOfManyThreads, IsTheSameOfAClothOnItself) {
  Scene scene = builtin_scene("fold");
  scene.cloth.rows = std::min(scene.cloth.rows, 25);
  scene.cloth.columns = std::min(scene.cloth.columns, 25);
  scene.integrator.time_step = resolved_time_step(scene).value();
  expect_same_for_any_threads(scene, 0.4);
}

/// So many particles and contacts that loops over each are shared.
TEST(ContactOfManyThreads, IsTheSameOfAFineCloth) {
  expect_same_for_any_threads(scene_of("slope", 65), 0.03);
}

/// Contacts of faces, with points at their corners: most corners have weight 0 and are those of other
/// contacts.
TEST(ContactOfManyThreads, IsTheSameOfAFineClothOnALargeBall) {
  Scene scene = scene_of("slope", 65);
  Obstacle& slope = scene.obstacles[0];
  slope.shape = &sphere_shape();
  slope.radius = 20, slope.center = -slope.radius * slope.normal;
  expect_same_for_any_threads(scene, 0.1);
}

TEST(ContactOfManyThreads, IsTheSameWhereStiffDampingIsSolvedFor) {
  Scene scene = scene_of("slope", 65);
  scene.springs->damping *= 20;
  EXPECT_GT(run_with(1, scene, 0.01).velocity_iterations, 0) << "nothing is solved for";
  expect_same_for_any_threads(scene, 0.02);
}

}  // namespace
}  // namespace cloth::test::contact_threads_test
