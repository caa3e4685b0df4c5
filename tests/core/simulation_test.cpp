// The loop: the order of a step's stages, its ledger, what it notices.
#include "simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "simulation/recorder.h"
#include "simulation/stages.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::simulation_test {
namespace {

TEST(Simulation, StartsAtRestWithoutErrorOrWork) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Simulation simulation(builtin_scene(builtin.name));
    const Measurement m = simulation.measure();
    EXPECT_EQ(m.time, 0);
    EXPECT_EQ(m.energy.kinetic, 0);
    EXPECT_EQ(m.energy.gravity, 0);
    EXPECT_LE(m.energy.elastic, 1e-20);
    EXPECT_EQ(m.energy_error(), 0);
    EXPECT_NEAR(m.strain.maximum(), 0, 1e-12);
  }
}

TEST(Simulation, CountsTimeInWholeStepsAndNeverAddsUp) {
  Scene scene = smooth_scene(3, 3);
  scene.integrator.time_step = 0.001;
  Simulation simulation(scene);
  for (int n = 1; n <= 1000; ++n) {
    simulation.step();
    EXPECT_EQ(simulation.time(), n * 0.001);
  }
}

TEST(Simulation, EvaluatesForcesAsOftenAsTheMethodsFactsSay) {
  for (const MethodFacts& facts : integrator_facts()) {
    if (facts.evaluations_per_step == 0) continue;  // as many as needed
    Scene scene = smooth_scene(4, 4);
    scene.integrator = {facts.name, 1e-4};
    Simulation simulation(scene);
    for (int n = 0; n < 100; ++n) simulation.step();
    const std::int64_t first = facts.keeps_force ? 1 : 0;  // the force that the first step starts from
    EXPECT_EQ(simulation.count().force_evaluations, 100 * facts.evaluations_per_step + first) << facts.name;
  }
}

TEST(Simulation, KeepsPinsWhereTheyAre) {
  for (const std::string& method : integrator_names()) {
    Scene scene = builtin_scene("wind");
    scene.integrator = {method, 1e-4};
    Simulation simulation(scene);
    for (int n = 0; n < 50; ++n) simulation.step();
    for (const std::size_t pin : {std::size_t{0}, std::size_t{32}}) {
      EXPECT_EQ(simulation.state().position[pin], simulation.system().start[pin]);
      EXPECT_EQ(simulation.state().velocity[pin], Vec3(0, 0, 0));
    }
  }
}

TEST(Simulation, LimitsAfterItIntegrates) {
  Scene scene = bare_sheet(2, 2, 0.1, 0.01);
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = only(SpringFamily::structural, 1);
  scene.gravity = Vec3(0, -10, 0);
  scene.deformation = Deformation{};
  scene.deformation->tolerance = 1e-13;
  scene.integrator = {"semi-implicit-euler", 0.1};  // falls 0.1 m in its first step, 0.01 m is allowed
  Simulation simulation(scene);
  simulation.step();
  EXPECT_NEAR(simulation.state().position[2].y(), -0.11, 1e-12);
  EXPECT_NEAR(simulation.state().velocity[2].y(), -1 + 0.09 / 0.1, 1e-12);
  EXPECT_GT(simulation.measure().limiter_sweeps, 0);
  EXPECT_LT(simulation.measure().ledger.limiter, 0);
}

TEST(Simulation, ContactComesAfterTheLimiter) {
  Scene scene = bare_sheet(2, 2, 0.1, 0.01);
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = only(SpringFamily::structural, 1);
  scene.gravity = Vec3(0, -10, 0);
  scene.deformation = Deformation{};
  scene.integrator = {"semi-implicit-euler", 0.1};
  scene.obstacles.emplace_back().shape = &plane_shape();
  scene.obstacles[0].point = {0, -0.105, 0};
  Simulation simulation(scene);
  simulation.step();
  EXPECT_NEAR(simulation.state().position[2].y(), -0.105, 1e-12);
  EXPECT_EQ(simulation.measure().contacts, 2);
}

TEST(Ledger, HoldsWhatLimiterAndContactChanged) {
  Scene scene = builtin_scene("ball");
  Simulation simulation(scene);
  for (int n = 0; n < 3000 && simulation.measure().ledger.contact == 0; ++n) {
    const double error = simulation.measure().energy_error();
    simulation.step();
    // The method's own error of one step is small; a projection that was not booked would not be.
    EXPECT_LE(std::abs(simulation.measure().energy_error() - error), 1e-3);
  }
  EXPECT_LT(simulation.measure().ledger.contact, 0);
}

TEST(UnreachableRate, IsSaidOnceInTheSummaryOfARun) {
  Scene scene = bare_sheet(4, 4);
  scene.springs = only(SpringFamily::structural, 100);
  scene.deformation = Deformation{};
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  EXPECT_FALSE(Simulation(scene).unreachable_rate());  // pins at rest are always reachable
  const std::string text = describe(UnreachableRate{0, 15, 1.5, 1.1}, Simulation(scene).system());
  for (const char* word : {"(row 0, column 0)", "(row 3, column 3)", "1.5 m", "1.1 m"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
}

TEST(Stages, SayOfEachWhetherItIsInAndWhy) {
  const auto stage = [](const Scene& scene, const std::string& name) {
    for (const StageInfo& info : explain_stages(scene))
      if (info.name == name) return info;
    ADD_FAILURE() << "no stage " << name;
    return StageInfo{};
  };
  const Scene ball = builtin_scene("ball"), fall = builtin_scene("free-fall");
  EXPECT_TRUE(stage(ball, "contact").present);
  EXPECT_FALSE(stage(fall, "contact").present);
  EXPECT_EQ(stage(fall, "contact").reason, "the scene has no \"obstacles\"");
  EXPECT_EQ(stage(fall, "viscous damping").reason, "the scene has no \"damping\"");
  EXPECT_EQ(stage(fall, "deformation rate").reason, "the scene has no \"deformation\"");
  EXPECT_TRUE(stage(fall, "structural springs").present);
  EXPECT_EQ(stage(builtin_scene("pendulum"), "flexion springs").reason, "springs.flexion is 0");
  EXPECT_EQ(stage(ball, "wind").reason, "air.wind is 0: the air only drags");
  Scene small = bare_sheet(2, 2);
  small.springs = only(SpringFamily::flexion, 1);
  EXPECT_EQ(stage(small, "flexion springs").reason, "the grid is too small for any");
  for (const BuiltinScene& builtin : builtin_scenes())
    for (const StageInfo& info : explain_stages(builtin_scene(builtin.name)))
      EXPECT_FALSE(info.reason.empty());
}

TEST(Stages, SayHowXpbdAndVbdGoThroughTheCloth) {
  const auto has = [](const char* name, const char* method, const char* text) {
    Scene scene = builtin_scene(name);
    scene.integrator = {.method = method, .time_step = 0.01};
    for (const StageInfo& info : explain_stages(scene))
      if (info.name == "integrate") return info.reason.find(text) != std::string::npos;
    return false;
  };
  EXPECT_TRUE(has("corners-free", "xpbd", "springs by vectors, row by row"));
  EXPECT_TRUE(has("disc", "xpbd", "springs by vectors, colour by colour"));
  EXPECT_TRUE(has("wind-denim", "xpbd", "springs and other elements by vectors, colour by colour"));
  EXPECT_FALSE(has("corners-free", "xpbd", "one by one"));
  EXPECT_TRUE(has("corners-free", "vbd", "particles by vectors"));
  EXPECT_TRUE(has("disc", "vbd", "particles by vectors"));
  EXPECT_TRUE(has("wind-denim", "vbd", "particles by vectors"));
}

}  // namespace
}  // namespace cloth::test::simulation_test
