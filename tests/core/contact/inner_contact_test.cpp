// Contact within the steps of methods that divide them.
#include "contact/inner_contact.h"

#include <gtest/gtest.h>

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
  for (const char* method : {"xpbd", "dormand-prince"}) {
    Scene scene = coarser(builtin_scene("disc"), 1);
    scene.integrator = {.method = method, .time_step = 0.01};
    Simulation whole(scene);
    while (whole.last_contact().contacts == 0 && whole.state().time < 1) ASSERT_FALSE(whole.step());
    for (int n = 0; n < 10; ++n) ASSERT_FALSE(whole.step());
    Simulation resumed(scene);
    resumed.restore(whole.checkpoint());
    for (int n = 0; n < 5; ++n) {
      ASSERT_FALSE(whole.step());
      ASSERT_FALSE(resumed.step());
    }
    EXPECT_GT(whole.last_contact().contacts, 0);
    for (std::size_t k = 0; k < whole.state().position.flat().size(); ++k)
      ASSERT_EQ(whole.state().position.flat()[k], resumed.state().position.flat()[k]) << method;
    EXPECT_EQ(whole.measure().ledger.contact, resumed.measure().ledger.contact) << method;
  }
}

}  // namespace
}  // namespace cloth::test::inner_contact_test
