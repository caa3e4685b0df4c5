// The built-in scenes of contact, with half as many particles along an edge, from beginning to end: nothing
// comes through in any state that a recording would show.
#include "support/contact_scenes.h"

#include <gtest/gtest.h>

#include "contact/continuous_contact.h"
#include "scene/builtin_scenes.h"
#include "simulation/time_step.h"

namespace cloth::test {
namespace {

std::vector<std::string> scenes_of_contact() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes())
    if (has_continuous_contact(builtin_scene(scene.name))) names.push_back(scene.name);
  return names;
}

class ASceneOfContact : public ::testing::TestWithParam<std::string> {};

TEST_P(ASceneOfContact, LetsNothingThrough) {
  Scene scene = builtin_scene(GetParam());
  scene.cloth.rows = (scene.cloth.rows + 1) / 2;
  scene.cloth.columns = (scene.cloth.columns + 1) / 2;
  scene.duration = std::min(scene.duration, 1.0);
  scene.integrator.time_step = resolved_time_step(scene).value();
  constexpr int shown = 20;
  const auto steps = static_cast<int>(std::lround(scene.duration / *scene.integrator.time_step));
  const int stride = std::max(1, steps / shown);

  Simulation simulation(scene);
  int touched = 0;
  for (int step = 1; step <= steps; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
    touched = std::max(touched, simulation.last_contact().contacts);
    if (step % stride != 0 && step != steps) continue;
    const Count crossings = all_crossings(simulation);
    ASSERT_EQ(crossings.number, 0) << "step " << step << ": " << crossings.first;
  }
  EXPECT_GT(touched, 0) << "nothing was touched: the scene shows no contact";
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Contact, ASceneOfContact, ::testing::ValuesIn(scenes_of_contact()), test_name);

}  // namespace
}  // namespace cloth::test
