// Nothing comes through: scenes of contact are looked at by the checker of crossings with every method, at
// steps from a tenth of a millisecond to a sixtieth of a second, until the end or until an explicit method
// has diverged; and a thousand random drops after every step. clothlab-contact-check runs the same scenes as
// long and as large as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "contact/continuous_contact.h"
#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "simulation/time_step.h"
#include "support/contact_check.h"
#include "support/random.h"
#include "support/test_names.h"

namespace cloth::test::contact_crossings_test {
namespace {

/// Written out, because every test of this program asks for them as it starts, and scenes with meshes take
/// long to read.
const std::vector<std::string> scenes_of_contact{
    "bunny", "bunny-knit", "corner", "corner-wool", "fast-ball", "fast-ball-denim", "fold", "fold-ribbon",
    "slope", "slope-wool", "spikes", "spikes-swim", "twist",     "twist-ponte"};

TEST(ScenesOfContact, AreAllThatAreBuiltIn) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes())
    if (has_continuous_contact(builtin_scene(scene.name))) names.push_back(scene.name);
  EXPECT_EQ(names, scenes_of_contact);
}

/// A step, how long to go on with it, and how often to look.
struct Pace {
  double time_step, duration, interval;  // s
};

std::string describe(const CheckedRun& run) {
  std::string text = "first at " + std::to_string(run.crossed_at) + " s: " + run.crossings.first;
  if (run.stop) text += "; the run: " + describe(*run.stop);
  return text;
}

class EveryMethod : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryMethod, LetsNothingThroughAtAnyStep) {
  for (const std::string& name : contact_scene_names())
    for (const Pace& pace :
         {Pace{1e-4, 0.012, 1e-3}, Pace{1e-3, 0.08, 5e-3}, Pace{1.0 / 60, 0.2, 1.0 / 60}}) {
      Scene scene = contact_scene(name);
      scene.integrator.method = GetParam();
      scene.integrator.time_step = pace.time_step;
      const CheckedRun run = check_run(
          scene, {.duration = pace.duration, .interval = pace.interval, .prepare = thrown({0, -2, 0})});
      EXPECT_EQ(run.crossings.number, 0) << name << ", step " << pace.time_step << " s: " << describe(run);
      EXPECT_GT(run.frames, 0) << name << ": " << describe(run);
    }
}

INSTANTIATE_TEST_SUITE_P(Contact, EveryMethod, ::testing::ValuesIn(integrator_names()), test_name);

/// s to go on at a step of a sixtieth of a second. Methods that such a step is too long for diverge within
/// some steps, which then take long: the first one says whether it lets something through.
double sixtieths(const Scene& scene) {
  constexpr double sixtieth = 1.0 / 60;
  return stable_step(scene.integrator.method, scene).value_or(0) < sixtieth ? sixtieth : 12 * sixtieth;
}

/// A built-in scene with fewer particles.
class ASceneOfContact : public ::testing::TestWithParam<std::string> {};

TEST_P(ASceneOfContact, LetsNothingThroughAsItTouchesWithAnyMethodAndStep) {
  constexpr double part = 1.0 / 3, lead = 0.002;
  Scene scene = coarser(builtin_scene(GetParam()), part);
  const Checkpoint before_touch = state_before_touch(scene, lead);
  for (const std::string& method : integrator_names()) {
    scene.integrator.method = method;
    for (const Pace& pace :
         {Pace{1e-4, 0.01, 1e-3}, Pace{1e-3, 0.05, 5e-3}, Pace{1.0 / 60, sixtieths(scene), 1.0 / 60}}) {
      scene.integrator.time_step = pace.time_step;
      const CheckedRun run =
          check_run(scene, {.duration = pace.duration, .interval = pace.interval, .start = &before_touch});
      const std::string name = method + ", step " + std::to_string(pace.time_step) + " s";
      EXPECT_EQ(run.crossings.number, 0) << name << ": " << describe(run);
      EXPECT_GT(run.frames, 0) << name << ": " << describe(run);
      EXPECT_GT(run.touched, 0) << name << ": nothing was touched; " << describe(run);
    }
  }
}

TEST_P(ASceneOfContact, LetsNothingThroughFromItsStartToItsEnd) {
  const std::map<std::string, double> parts_of_dear{
      {"bunny", 0.25}, {"bunny-knit", 0.25}, {"fold-ribbon", 0.375}};
  const auto dear = parts_of_dear.find(GetParam());
  Scene scene = coarser(builtin_scene(GetParam()), dear != parts_of_dear.end() ? dear->second : 0.5);
  scene.duration = std::min(scene.duration, 1.0);
  scene.integrator.time_step = resolved_time_step(scene).value();
  const CheckedRun run = check_run(scene, {.duration = scene.duration});
  EXPECT_EQ(run.crossings.number, 0) << describe(run);
  EXPECT_FALSE(run.stop) << describe(run);
  EXPECT_GE(run.frames, std::lround(60 * scene.duration));
  EXPECT_GT(run.touched, 0) << "nothing was touched: the scene shows no contact";
}

INSTANTIATE_TEST_SUITE_P(Contact, ASceneOfContact, ::testing::ValuesIn(scenes_of_contact), test_name);

TEST(AStepWhoseEquationsAreNotSolved, LetsNothingThroughEither) {
  Scene scene = contact_scene("itself");
  scene.integrator = {.method = "implicit-euler", .time_step = 1.0 / 30};
  scene.integrator.newton_iterations = 2;
  const CheckedRun run =
      check_run(scene, {.duration = 1, .interval = 1.0 / 30, .prepare = thrown({0, -8, 0})});
  ASSERT_TRUE(run.stop && run.stop->solver_failed) << describe(run);
  EXPECT_GT(run.touched, 0) << describe(run);
  EXPECT_EQ(run.crossings.number, 0) << describe(run);
}

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
  if (obstacle.shape == &plane_shape()) obstacle.spin *= 0.05;
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
    const double step = *scene.integrator.time_step;
    const CheckedRun run =
        check_run(scene, {.duration = 25 * step, .interval = step, .prepare = thrown(velocity)});
    ASSERT_EQ(run.crossings.number, 0) << "drop " << drop << ", " << describe(run);
  }
}

}  // namespace
}  // namespace cloth::test::contact_crossings_test
