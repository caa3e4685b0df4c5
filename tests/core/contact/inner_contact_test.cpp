// Contact within the steps of methods that divide them.
#include "simulation/inner_contact.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/contact_check.h"

namespace cloth::test::inner_contact_test {
namespace {

/// The table of `tablecloth`, 4 cm thick, without its ground; the cloth falls 16 cm in a step.
Scene fast_fall(const char* method) {
  Scene scene = coarser(builtin_scene("tablecloth"), 0.3);
  scene.obstacles.resize(1);
  scene.integrator = {.method = method, .time_step = 0.01};
  return scene;
}

double lowest_after(const Scene& scene, int steps) {
  Simulation simulation(scene, [](const ClothSystem&, ClothState& state) {
    for (std::size_t i = 0; i < state.velocity.size(); ++i) state.velocity.set(i, {0, -16, 0});
  });
  for (int n = 0; n < steps; ++n) EXPECT_FALSE(simulation.step());
  double lowest = infinity;
  const Obstacle& table = scene.obstacles[0];
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i) {
    const Vec3 place = simulation.state().position[i] - table.center;
    const bool is_over =
        std::abs(place.x()) < 0.3 * table.size.x() && std::abs(place.z()) < 0.3 * table.size.z();
    if (is_over) lowest = std::min(lowest, place.y() - 0.5 * table.size.y());
  }
  return lowest;
}

TEST(InnerContact, MeetsATableThatAStepWouldPassOver) {
  EXPECT_LT(lowest_after(fast_fall("implicit-euler"), 2), -0.05);  // one step, one look: it is below
  EXPECT_GT(lowest_after(fast_fall("xpbd"), 2), -1e-9);
}

TEST(InnerContact, ReportsTheWorkOfAllInnerSteps) {
  Scene scene = fast_fall("xpbd");
  scene.obstacles[0].friction = 0;
  Simulation simulation(scene, [](const ClothSystem&, ClothState& state) {
    for (std::size_t i = 0; i < state.velocity.size(); ++i) state.velocity.set(i, {0, -16, 0});
  });
  double lost = 0;
  for (int n = 0; n < 2; ++n) {
    EXPECT_FALSE(simulation.step());
    lost += simulation.last_contact().work;
  }
  EXPECT_GT(simulation.last_contact().contacts, 0);
  EXPECT_DOUBLE_EQ(simulation.measure().ledger.contact, lost);
  EXPECT_LT(lost, -0.1 * 0.5 * scene.cloth.mass * 16 * 16);  // the particles over the table have stopped
}

/// What contact remembers, and the tensions that it makes the deformation rate forget, are in a checkpoint.
TEST(InnerContact, GoesOnFromACheckpointToTheBit) {
  for (const char* name : {"disc", "spikes"})
    for (const char* method : {"xpbd", "dormand-prince"}) {
      Scene scene = builtin_scene(name);
      scene.integrator = {.method = method, .time_step = 0.01};
      Simulation whole(scene);
      while (whole.last_contact().contacts == 0 && whole.state().time < 1) ASSERT_FALSE(whole.step());
      for (int n = 0; n < 5; ++n) ASSERT_FALSE(whole.step());
      Simulation resumed(scene);
      resumed.restore(whole.checkpoint());
      for (int n = 0; n < 5; ++n) {
        ASSERT_FALSE(whole.step());
        ASSERT_FALSE(resumed.step());
      }
      EXPECT_GT(whole.last_contact().contacts, 0);
      EXPECT_TRUE(std::ranges::equal(whole.state().position.flat(), resumed.state().position.flat()))
          << name << ", " << method;
      EXPECT_EQ(whole.measure().ledger.contact, resumed.measure().ledger.contact) << name << ", " << method;
    }
}

/// Met once a step, all of these diverged or ended with many times the energy exchanged.
TEST(InnerContact, WithoutGapsKeepsClothsWholeAtLongSteps) {
  for (const char* name : {"corner", "spikes", "twist"})
    for (const char* method : {"xpbd", "dormand-prince"}) {
      Scene scene = coarser(builtin_scene(name), 0.7);
      scene.integrator = {.method = method, .time_step = 0.01};
      const ContactLedger ledger = ledger_run(scene, {}, 0.6);
      const std::string where = std::string(name) + ", " + method;
      EXPECT_FALSE(ledger.stop) << where;
      EXPECT_LT(ledger.gain, 0.25 * ledger.account.exchanged()) << where;
    }
}

TEST(InnerContact, InterruptedInAnyInnerStepLeavesTheStateBeforeTheStepAndGoesOnAsIfItHadNot) {
  for (const char* method : {"xpbd", "dormand-prince"}) {
    Scene scene = coarser(builtin_scene("fast-ball"), 0.5);
    scene.integrator = {.method = method, .time_step = 0.002};
    Simulation whole(scene);
    while (whole.last_contact().contacts == 0 && whole.state().time < 1) ASSERT_FALSE(whole.step());
    Simulation asked(scene);
    const Checkpoint before = whole.checkpoint();
    asked.restore(before);
    ASSERT_FALSE(whole.step());
    int interrupted = 0;
    for (int until = 1; until < 1000; ++until) {
      int times = 0;
      asked.set_stop_test([&] { return ++times == until; });
      ASSERT_FALSE(asked.step());
      if (!asked.interrupted()) break;
      ++interrupted;
      EXPECT_EQ(asked.checkpoint().obstacle_poses, before.obstacle_poses);
      EXPECT_EQ(asked.checkpoint().ledger.contact, before.ledger.contact);
    }
    EXPECT_GT(interrupted, 3) << method;
    EXPECT_TRUE(std::ranges::equal(asked.state().position.flat(), whole.state().position.flat())) << method;
    EXPECT_TRUE(std::ranges::equal(asked.state().velocity.flat(), whole.state().velocity.flat())) << method;
    EXPECT_EQ(asked.measure().ledger.contact, whole.measure().ledger.contact) << method;
  }
}

}  // namespace
}  // namespace cloth::test::inner_contact_test
