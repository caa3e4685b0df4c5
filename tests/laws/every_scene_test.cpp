// Every built-in scene runs with every method at the step that auto picks; where a method has no stable step,
// auto says so. The first falls and contacts are run; with CLOTHLAB_WHOLE_SCENES set, as `./lab check` does,
// every scene to its end.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "contact/continuous_contact.h"
#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"
#include "support/states.h"
#include "support/test_names.h"

namespace cloth::test::every_scene_test {
namespace {

const bool whole_scenes = std::getenv("CLOTHLAB_WHOLE_SCENES") != nullptr;

using Case = std::tuple<std::string, std::string>;  // scene, method

class EveryScene : public ::testing::TestWithParam<Case> {};

TEST_P(EveryScene, RunsAtTheAutomaticStepOrIsToldThatThereIsNone) {
  const auto& [name, method] = GetParam();
  Scene scene = builtin_scene(name);
  scene.integrator = {method, std::nullopt};
  if (!resolved_time_step(scene)) {
    EXPECT_EQ(method, "explicit-euler");
    EXPECT_NE(no_stable_step_text(scene).find("no stable time step"), std::string::npos);
    return;
  }
  if (!whole_scenes) {
    // Steps that iterate are dear on stiff, limited scenes.
    constexpr double iterated_duration = 0.2;
    constexpr int max_evaluations = 2'500, evaluations_of_a_chosen_step = 6;
    const MethodFacts& facts = facts_of(method);
    if (facts.settings != MethodSettings::none) scene.duration = std::min(scene.duration, iterated_duration);
    const int evaluations =
        facts.evaluations_per_step > 0 ? facts.evaluations_per_step : evaluations_of_a_chosen_step;
    const double max_steps = max_evaluations / evaluations;
    scene.duration = std::min(scene.duration, max_steps * *resolved_time_step(scene));
    // Scenes of continuous contact are run on elsewhere, with the checker of crossings.
    constexpr double steps_of_contact = 150, seconds_of_contact = 0.1;
    if (has_continuous_contact(scene))
      scene.duration =
          std::min({scene.duration, seconds_of_contact, steps_of_contact * *resolved_time_step(scene)});
  }
  const auto start = std::chrono::steady_clock::now();
  const RunResult result = run_scene(scene, {.folder = {}, .progress = {}});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%s with %s: %lld steps, %.2f s\n", name.c_str(), method.c_str(),
              static_cast<long long>(result.summary.count.steps), seconds);
  EXPECT_EQ(result.summary.status, Status::finished);
  if (result.summary.divergence) ADD_FAILURE() << describe(*result.summary.divergence);
  EXPECT_TRUE(all_finite(result.final_state));
  EXPECT_NEAR(result.summary.simulated, scene.duration, 1e-9);
  EXPECT_TRUE(std::isfinite(result.summary.energy.largest_error()));
}

class EveryBuiltInScene : public ::testing::TestWithParam<std::string> {};

/// With its own method and step: what it shows can be relied on.
TEST_P(EveryBuiltInScene, AccountsForItsEnergyToTwoPercentOfWhatWasExchanged) {
  Scene scene = builtin_scene(GetParam());
  constexpr double seconds_of_contact = 0.5;  // its steps are dear; the first touches are in this
  if (!whole_scenes && has_continuous_contact(scene))
    scene.duration = std::min(scene.duration, seconds_of_contact);
  const RunResult result = run_scene(scene, {.folder = {}, .progress = {}});
  EXPECT_EQ(result.summary.status, Status::finished);
  EXPECT_GT(result.summary.energy.exchanged(), 1e-4);
  EXPECT_LE(result.summary.energy.share(), 0.02);
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  return names;
}

std::string name_of_case(const ::testing::TestParamInfo<Case>& info) {
  return test_word(std::get<0>(info.param) + "_with_" + std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene,
                         ::testing::Combine(::testing::ValuesIn(scene_names()),
                                            ::testing::ValuesIn(integrator_names())),
                         name_of_case);

INSTANTIATE_TEST_SUITE_P(Scenes, EveryBuiltInScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace cloth::test::every_scene_test
