// Long steps of a cloth whose deformation rate is reached in contact: springs, contact and rate are one
// equation, so that the energy falls and the rate is left by little.
#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"
#include "support/contact_check.h"
#include "support/test_names.h"

namespace cloth::test::contact_rate_test {
namespace {

struct Landing {
  std::string name;
  double rate = 0.01;
  double part = 1;  ///< of the particles along an edge
  double time = 0.5;
};

class LongStepsWithARate : public ::testing::TestWithParam<Landing> {};

/// With the rate kept before contact, in the norm of the masses, contact stretched springs by 60 to 140 %,
/// and cloths gained up to 2.6 times the energy exchanged.
TEST_P(LongStepsWithARate, MakeNoEnergyInContactAndStretchLittle) {
  const auto& [name, rate, part, time] = GetParam();
  for (const char* method : {"implicit-euler", "bdf2", "projective", "vbd"}) {
    Scene scene = coarser(builtin_scene(name), part);
    if (!scene.deformation) scene.deformation.emplace();
    scene.deformation->rate = rate;
    scene.integrator = {.method = method, .time_step = 0.01};
    const ContactLedger ledger = ledger_run(scene, {}, time);
    EXPECT_FALSE(ledger.stop) << method;
    EXPECT_LT(ledger.gain, 0.05 * ledger.account.exchanged()) << method;
    EXPECT_GT(ledger.account.exchanged(), 0.05) << method;
    EXPECT_LT(ledger.largest_strain, rate + 0.1) << method;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, LongStepsWithARate,
                         ::testing::Values(Landing{"ball"}, Landing{"tablecloth"}, Landing{"cube", 0.001},
                                           Landing{"rectangle"}, Landing{"disc", 0.01, 0.5, 0.3},
                                           Landing{"tablecloth-denim", 0.005, 0.7},
                                           Landing{"corner", 0.01, 0.7}, Landing{"spikes", 0.01, 0.7},
                                           Landing{"twist", 0.01, 0.7}, Landing{"bunny", 0.01, 0.5}),
                         [](const auto& landing) { return test_word(landing.param.name); });

/// The integrator's positions alone exceed the rate, those with contact reach the surface: neither is lost.
TEST(LongStepsWithARate, KeepThePinsAndTheObstacles) {
  Scene scene = builtin_scene("ball");
  scene.cloth.pins = {NamedPin::top_left};
  scene.deformation->rate = 0.01;
  scene.integrator = {.method = "implicit-euler", .time_step = 0.01};
  Simulation simulation(scene);
  const Vec3Field start = simulation.state().position;
  int touched = 0;
  for (int n = 0; n < 60; ++n) {
    ASSERT_FALSE(simulation.step());
    touched = std::max(touched, simulation.last_contact().contacts);
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (simulation.system().pinned[i]) {
        ASSERT_EQ(Vec3(simulation.state().position[i]), Vec3(start[i]));
        continue;
      }
      for (const Obstacle& obstacle : scene.obstacles) {
        const auto out = penetration(obstacle, simulation.state().position[i]);
        ASSERT_TRUE(!out || (out->point - simulation.state().position[i]).norm() < 1e-9);
      }
    }
  }
  EXPECT_GT(touched, 0);
}

}  // namespace
}  // namespace cloth::test::contact_rate_test
