// Nothing comes through: every state of every scene of contact is looked at by the brute-force checker, with
// every method, at steps from a tenth of a millisecond to a sixtieth of a second, until the end or until an
// explicit method has run away.
#include <gtest/gtest.h>

#include "integrators/registry.h"
#include "support/contact_scenes.h"
#include "support/random.h"

namespace cloth::test {
namespace {

struct Outcome {
  int checked = 0;
  Count count;
  std::string stopped;
};

/// Checks the state after every `stride` steps and after the last.
Outcome run(const Scene& scene, double duration, int stride, const Vec3& velocity) {
  Simulation simulation(scene, thrown(velocity));
  Outcome outcome;
  const auto steps = static_cast<int>(std::lround(duration / simulation.time_step()));
  for (int n = 1; n <= steps; ++n) {
    if (const auto stop = simulation.step()) {
      outcome.stopped = describe(*stop);
      break;
    }
    if (n % stride != 0 && n != steps) continue;
    ++outcome.checked;
    outcome.count = all_crossings(simulation);
    if (outcome.count.number > 0) {
      outcome.stopped = "crossing in step " + std::to_string(n);
      break;
    }
  }
  return outcome;
}

class EveryMethod : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryMethod, LetsNothingThroughAtAnyStep) {
  struct Pace {
    double time_step, duration;
    int stride;
  };
  for (const std::string& name : contact_scene_names())
    for (const Pace& pace : {Pace{1e-4, 0.012, 20}, Pace{1e-3, 0.08, 10}, Pace{1.0 / 60, 0.2, 1}}) {
      Scene scene = contact_scene(name);
      scene.integrator.method = GetParam();
      scene.integrator.time_step = pace.time_step;
      const Outcome outcome = run(scene, pace.duration, pace.stride, {0, -2, 0});
      EXPECT_EQ(outcome.count.number, 0)
          << name << ", step " << pace.time_step << " s: " << outcome.count.first << ", " << outcome.stopped;
      EXPECT_GT(outcome.checked, 0) << name << ": " << outcome.stopped;
    }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Contact, EveryMethod, ::testing::ValuesIn(integrator_names()), test_name);

/// An obstacle of any kind, anywhere under or beside the sheet, at rest or not.
Obstacle random_obstacle(Random& random) {
  Obstacle obstacle = contact_scene(random.coin() ? "sphere" : random.coin() ? "box" : "plane").obstacles[0];
  obstacle.center = {random.uniform(-0.1, 0.1), random.uniform(-0.35, -0.25), random.uniform(-0.1, 0.1)};
  obstacle.point = {0, -0.3, 0};
  obstacle.normal = Vec3(random.uniform(-0.5, 0.5), 1, random.uniform(-0.5, 0.5));
  obstacle.radius = random.uniform(0.02, 0.2);
  obstacle.size = {random.uniform(0.01, 0.3), random.uniform(0.01, 0.3), random.uniform(0.01, 0.3)};
  obstacle.friction = random.uniform(0, 1);
  obstacle.restitution = random.coin() ? 0 : random.uniform(0, 1);
  if (random.coin()) obstacle.velocity = random.vector(3);
  if (random.coin()) obstacle.spin = random.vector(10);
  if (obstacle.shape == Shape::plane) obstacle.spin *= 0.05;
  return obstacle;
}

TEST(AThousandRandomDrops, LetNothingThrough) {
  constexpr int drops = 1000;
  Random random;
  for (int drop = 0; drop < drops; ++drop) {
    Scene scene = sheet_over(0, random.integer(3, 6));
    scene.obstacles = {random_obstacle(random)};
    if (random.coin()) scene.obstacles.push_back(random_obstacle(random));
    scene.contact->thickness = random.uniform(0.001, 0.01);
    if (random.coin()) scene.self_contact = SelfContact{.thickness = 0.004, .friction = random.uniform(0, 1)};
    scene.integrator.method = random.coin() ? "semi-implicit-euler" : "implicit-euler";
    scene.integrator.time_step = random.uniform(1e-3, 1.0 / 60);
    const Vec3 velocity = Vec3(0, -random.uniform(0, 20), 0) + random.vector(1);
    const Outcome outcome = run(scene, 25 * *scene.integrator.time_step, 1, velocity);
    ASSERT_EQ(outcome.count.number, 0)
        << "drop " << drop << ": " << outcome.count.first << ", " << outcome.stopped;
  }
}

}  // namespace
}  // namespace cloth::test
