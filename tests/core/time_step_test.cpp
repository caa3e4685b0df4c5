#include "simulation/time_step.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "contact/continuous_contact.h"
#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_checks.h"
#include "simulation/predicted_damping.h"
#include "support/scenes.h"

namespace cloth::test::time_step_test {
namespace {

TEST(AutomaticTimeStep, DividesTheRecordIntervalAndStaysWithinBothLimits) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    for (const std::string& method : integrator_names()) {
      Scene scene = builtin_scene(builtin.name);
      scene.integrator = {method, std::nullopt};
      const auto step = resolved_time_step(scene);
      const auto limit = stable_step(method, scene);
      ASSERT_EQ(step.has_value(), limit.has_value());
      if (!step) continue;
      // the rate and contact particle by particle act at the ends of steps: error control does not make those
      // long
      const bool ends_count =
          scene.deformation || (!scene.obstacles.empty() && !has_continuous_contact(scene));
      if (ends_count) scene.integrator.tolerance = 0;
      const double parts = scene.record.interval / *step;
      EXPECT_NEAR(parts, std::round(parts), 1e-9 * parts);
      const double longest =
          std::min(0.8 * *stable_step(method, scene), 0.95 * guaranteed_step(method, scene).value());
      EXPECT_LE(*step, longest * (1 + 1e-12));
      // and no longer step does both, or those that do are too long to predict the damping
      const double fewest = std::max(1.0, std::ceil(scene.record.interval / longest * (1 - 1e-12)));
      if (parts < fewest + 0.5) continue;
      EXPECT_TRUE(facts_of(method).predicts_damping) << builtin.name;
      EXPECT_LE(predicted_damping_load(scene, *step), allowed_damping_load(scene)) << builtin.name;
      EXPECT_LE(parts, std::max(fewest + 1, 8 * fewest) + 1e-6) << builtin.name;
      for (double fewer = fewest; fewer < parts - 0.5; ++fewer)
        EXPECT_GT(predicted_damping_load(scene, scene.record.interval / fewer), allowed_damping_load(scene));
    }
  }
}

TEST(AutomaticTimeStep, OfVerletHasMoreStepsToARowWhereThatLetsItPredictItsDamping) {
  const Scene scene = builtin_scene("tablecloth");
  const double step = *resolved_time_step(scene), parts = scene.record.interval / step;
  EXPECT_LE(predicted_damping_load(scene, step), allowed_damping_load(scene));
  EXPECT_GT(predicted_damping_load(scene, scene.record.interval / (parts - 1)), allowed_damping_load(scene));
  Scene stiff = scene, undamped = scene, bare = scene;
  stiff.springs->damping *= 200;
  undamped.springs->damping = 0;
  const double fewest = scene.record.interval / *resolved_time_step(undamped);
  EXPECT_LT(fewest, parts - 0.5) << "nothing to predict";
  EXPECT_NEAR(scene.record.interval / *resolved_time_step(stiff), fewest, 1e-9) << "out of reach";
  bare.obstacles.clear();
  EXPECT_LE(scene.record.interval / *resolved_time_step(bare), std::max(fewest + 1, 1.25 * fewest) + 1e-9);
  EXPECT_LT(allowed_damping_load(scene), allowed_damping_load(bare));
}

/// Whose steps a pass computes too.
TEST(AutomaticTimeStep, OfVerletPredictsDampingWithHysteresisAsWithout) {
  Scene scene = builtin_scene("wind-denim");
  const auto parts = [&] { return scene.record.interval / *resolved_time_step(scene); };
  scene.material->stretch_damping = scene.material->bending_damping = 0;
  const double fewest = parts();
  scene = builtin_scene("wind-denim");
  scene.material->hysteresis_warp = scene.material->hysteresis_weft = 1e-9;
  EXPECT_GT(parts(), std::floor(1.25 * fewest) + 0.5) << "nothing to predict";
  EXPECT_LE(predicted_damping_load(scene, *resolved_time_step(scene)), allowed_damping_load(scene));
}

TEST(AutomaticTimeStep, IsTheRecordIntervalWhereEveryStepIsStable) {
  Scene scene = bare_sheet(3, 3);
  scene.gravity = Vec3(0, -9.81, 0);
  scene.record.interval = 0.02;
  for (const std::string& method : integrator_names()) {
    scene.integrator.method = method;
    EXPECT_EQ(resolved_time_step(scene), 0.02);
  }
}

TEST(AutomaticTimeStep, IsBelowTheLimitOfTheClothStretchedWithoutEnd) {
  // Structural springs alone: stretched, the waves across the cloth oscillate sqrt(2) times as fast as any
  // does flat.
  Scene scene = bare_sheet(20, 20);
  scene.springs = only(SpringFamily::structural, 3);
  for (const char* method : {"verlet", "semi-implicit-euler", "rk4"}) {
    scene.integrator.method = method;
    EXPECT_LT(*resolved_time_step(scene), 0.8 * *stable_step(method, scene) / 1.1) << method;
    EXPECT_LE(*resolved_time_step(scene), 0.95 * *guaranteed_step(method, scene) * (1 + 1e-12)) << method;
  }
}

TEST(AutomaticTimeStep, IsNoneWhereTheMethodHasNoStableStep) {
  Scene scene = bare_sheet(3, 3);
  scene.springs = only(SpringFamily::structural, 10);
  scene.integrator.method = "explicit-euler";
  EXPECT_EQ(resolved_time_step(scene), std::nullopt);
  const std::string text = no_stable_step_text(scene);
  for (const char* word : {"explicit-euler", "no stable time step", "damping"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
}

TEST(GivenTimeStep, IsTakenAsItIs) {
  Scene scene = smooth_scene(4, 4);
  scene.integrator.time_step = 0.123;
  EXPECT_EQ(resolved_time_step(scene), 0.123);
}

TEST(StepsToCover, RoundsQuotientsThatAreWholeButForRounding) {
  EXPECT_EQ(steps_to_cover(0.1, 0.001), 100);  // 0.1 / 0.001 is 100.00000000000001 or less
  EXPECT_EQ(steps_to_cover(0.3, 0.1), 3);
  EXPECT_EQ(steps_to_cover(1, 0.3), 4);
  EXPECT_EQ(steps_to_cover(1e-9, 1), 1);
  for (int n = 1; n < 5000; ++n) EXPECT_EQ(steps_to_cover(n * 0.001, 0.001), n);
}

TEST(Steps, AreCountedWithoutLeavingWholeNumbers) {
  for (const double huge : {1e20, 1e300, infinity}) {
    EXPECT_EQ(steps_to_cover(huge, 1e-3), 1'000'000'000'000);
    EXPECT_EQ(steps_per_row(huge, 1e-3), 1'000'000'000'000);
    EXPECT_EQ(steps_to_cover(1, 1 / huge), 1'000'000'000'000);
  }
  EXPECT_EQ(too_many_steps(1e9, 1e-3), std::nullopt);
  EXPECT_NE(too_many_steps(1e9, 0.9e-3), std::nullopt);
  EXPECT_NE(too_many_steps(1, 1e-300), std::nullopt);
}

TEST(ADurationThatIsNoWholeNumberOfSteps, IsSaid) {
  for (int n = 1; n < 5000; ++n) EXPECT_EQ(uneven_duration_text(n * 0.001, 0.001), "");
  EXPECT_EQ(uneven_duration_text(0.105, 0.01),
            "duration = 0.105 s is no whole number of steps of 0.01 s: it takes 11 steps, 0.11 s");
  EXPECT_EQ(uneven_duration_text(0.001, 0.01),
            "duration = 0.001 s is no whole number of steps of 0.01 s: it takes 1 step, 0.01 s");
}

TEST(AStepOfTheSceneThatIsNotStable, IsSaidWithTheLimitOfItsMethod) {
  Scene scene = builtin_scene("flag");
  scene.cloth.rows = scene.cloth.columns = 129;
  scene.integrator = {"verlet", 0.0002};
  const double limit = stable_step("verlet", scene).value();
  ASSERT_LT(limit, 0.0002);
  EXPECT_EQ(too_long_step_text(scene),
            fmt::format("integrator.time_step = 0.0002 s is beyond the {:.6g} s up to "
                        "which verlet is stable for this scene",
                        limit));
  scene.integrator.time_step = limit;
  EXPECT_NE(too_long_step_text(scene), "");
  scene.integrator.time_step = 0.999 * limit;
  EXPECT_EQ(too_long_step_text(scene), "");
  scene.integrator.time_step.reset();
  EXPECT_EQ(too_long_step_text(scene), "");
  scene.integrator = {"implicit-euler", 10.0};
  EXPECT_EQ(too_long_step_text(scene), "");
  Scene undamped = builtin_scene("corners-free");
  undamped.springs->damping = 0, undamped.damping = 0;
  undamped.integrator = {"explicit-euler", 1e-6};
  EXPECT_EQ(too_long_step_text(undamped),
            "integrator.time_step = 1e-06 s: explicit-euler is stable at no step for this scene");
}

/// What a scene says of itself is what it can keep.
TEST(AStepOfTheSceneThatIsNotStable, IsThatOfNoBuiltInScene) {
  for (const BuiltinScene& builtin : builtin_scenes())
    EXPECT_EQ(too_long_step_text(builtin_scene(builtin.name)), "") << builtin.name;
}

TEST(StepsPerRow, IsTheIntervalInWholeStepsAndAtLeastOne) {
  EXPECT_EQ(steps_per_row(0.01, 0.001), 10);
  EXPECT_EQ(steps_per_row(0.01, 0.003), 3);
  EXPECT_EQ(steps_per_row(0.01, 0.5), 1);
}

}  // namespace
}  // namespace cloth::test::time_step_test
