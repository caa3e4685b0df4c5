// Many steps at once are the same motion as one by one.
#include <gtest/gtest.h>

#include "integrators/registry.h"
#include "kernels/instruction_set.h"
#include "simulation/simulation.h"
#include "support/scenes.h"

namespace cloth::test::advance_test {
namespace {

Scene hanging(const std::string& method, double damping = 0.01) {
  Scene scene = bare_sheet(23, 37);
  scene.springs = SpringMaterial{.structural = 70, .shear = 40, .flexion = 15, .damping = 0};
  scene.gravity = Vec3(0.3, -9.81, 0.1);
  if (damping > 0) scene.damping = damping;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.integrator.method = method;
  scene.integrator.time_step = 5e-4;
  return scene;
}

std::optional<Divergence> one_by_one(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k)
    if (auto divergence = simulation.step()) return divergence;
  return std::nullopt;
}

void expect_same(const Simulation& a, const Simulation& b, const std::string& what) {
  EXPECT_EQ(a.state(), b.state()) << what;
  EXPECT_EQ(a.measure().ledger.forces.damping_loss, b.measure().ledger.forces.damping_loss) << what;
  EXPECT_EQ(a.measure().ledger.forces.air, b.measure().ledger.forces.air) << what;
  EXPECT_EQ(a.count().steps, b.count().steps) << what;
  EXPECT_EQ(a.count().force_evaluations, b.count().force_evaluations) << what;
}

/// Numbers of steps around those at which the way of taking them changes.
constexpr int parts[] = {1, 7, 8, 9, 31, 32, 33, 40, 100};

TEST(ManyStepsAtOnce, AreTheStepsOneByOneToTheBitForEveryMethod) {
  for (const std::string& method : integrator_names()) {
    Scene scene = hanging(method);
    if (method == "explicit-euler") scene.integrator.time_step = 2e-5;
    scene.cloth.rows = 7, scene.cloth.columns = 9;
    Simulation single(scene), many(scene);
    for (const int part : {3, 8, 20}) {
      ASSERT_FALSE(one_by_one(single, part)) << method;
      ASSERT_FALSE(many.advance(part)) << method;
      expect_same(single, many, method);
    }
  }
}

TEST(ManyStepsAtOnce, AreTheSameInEveryInstructionSet) {
  for (const InstructionSet set : supported_instruction_sets())
    for (const double damping : {0.0, 0.01}) {
      set_instruction_set(set);
      const Scene scene = hanging("verlet", damping);
      Simulation single(scene), many(scene);
      for (const int part : parts) {
        ASSERT_FALSE(one_by_one(single, part));
        ASSERT_FALSE(many.advance(part));
        expect_same(single, many, std::string(name_of(set)) + ", " + std::to_string(part));
      }
    }
  set_instruction_set(std::nullopt);
}

TEST(ManyStepsAtOnce, AreTheSameForAnyNumberOfThreads) {
  for (const std::string method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4", "damped rk4",
                                   "damped semi-implicit-euler"}) {
    const bool damped = method.starts_with("damped ");
    Scene scene = hanging(damped ? method.substr(7) : method);
    if (damped) scene.springs->damping = 0.01;
    scene.cloth.rows = 151, scene.cloth.columns = 103;
    scene.integrator.time_step = 1e-4;
    Simulation single(scene);
    ASSERT_FALSE(one_by_one(single, 60));
    for (const int threads : {2, 3, 5}) {
      Simulation many(scene);
      many.set_threads(threads, ThreadUse::always);
      for (const int part : {9, 1, 50}) ASSERT_FALSE(many.advance(part));
      expect_same(single, many, method + ", " + std::to_string(threads));
    }
  }
}

/// While the number of threads is being found out, it changes within a batch of steps.
TEST(ManyStepsAtOnce, AreTheSameWhileThreadsAreTried) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    Scene scene = hanging(method);
    scene.cloth.rows = 61, scene.cloth.columns = 53;
    scene.integrator.time_step = 1e-4;
    Simulation single(scene), many(scene);
    many.set_threads(3);
    ASSERT_FALSE(one_by_one(single, 200));
    ASSERT_FALSE(many.advance(200));
    expect_same(single, many, method);
  }
}

TEST(ManyStepsAtOnce, AreTheSameWithEveryStage) {
  const auto change = [](int which, Scene& scene) {
    if (which == 0) scene.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = std::nullopt};
    if (which == 4) scene.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = Gust{0.5, 20}};
    if (which == 1) scene.springs->damping = 0.01;
    if (which == 2) scene.deformation = Deformation{.rate = 0.01};
    if (which == 3) scene.obstacles = {Obstacle{.center = {0.5, -0.6, 0.1}}};
  };
  for (const char* method : {"verlet", "semi-implicit-euler", "rk4"})
    for (int which = 0; which < 5; ++which) {
      Scene scene = hanging(method);
      scene.cloth.rows = 61, scene.cloth.columns = 53;
      scene.integrator.time_step = 1e-4;
      change(which, scene);
      Simulation single(scene), many(scene);
      many.set_threads(2, ThreadUse::always);
      ASSERT_EQ(many.threads(), 2);
      ASSERT_FALSE(one_by_one(single, 150));
      ASSERT_FALSE(many.advance(150));
      expect_same(single, many, method + std::to_string(which));
    }
}

TEST(ManyStepsAtOnce, GoOnFromAnEditALiveHandAndACheckpoint) {
  const Scene scene = hanging("verlet");
  Scene edited = scene;
  edited.springs->shear = 20;
  Simulation single(scene), many(scene);
  const auto expect_same_after = [&](const char* what) {
    ASSERT_FALSE(one_by_one(single, 45)) << what;
    ASSERT_FALSE(many.advance(45)) << what;
    EXPECT_EQ(single.state(), many.state()) << what;
  };
  expect_same_after("the start");
  single.edit(edited), many.edit(edited);
  expect_same_after("an edit");
  const Pull pull{.particle = 400, .target = {0.2, -0.8, 0.3}};
  single.set_pull(pull), many.set_pull(pull);
  expect_same_after("a pull");
  single.set_pull(std::nullopt), many.set_pull(std::nullopt);
  expect_same_after("letting go");
  const Checkpoint checkpoint = many.checkpoint();
  single.restore(checkpoint);
  expect_same_after("a checkpoint");
}

TEST(ManyStepsAtOnce, StopAtTheStepWhereOneByOneStops) {
  for (const double step : {4e-3, 1.2e-2, 1.0}) {
    Scene scene = hanging("verlet");
    scene.integrator.time_step = step;
    Simulation single(scene), many(scene);
    const auto expected = one_by_one(single, 4000), stop = many.advance(4000);
    ASSERT_EQ(expected.has_value(), stop.has_value()) << step;
    ASSERT_TRUE(expected || step < 0.01) << step;  // at least the longer steps must diverge
    if (!expected) continue;
    EXPECT_EQ(describe(*expected), describe(*stop));
    EXPECT_EQ(single.state().step, many.state().step);
  }
}

}  // namespace
}  // namespace cloth::test::advance_test
