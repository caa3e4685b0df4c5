#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"

namespace cloth::test::explain_test {
namespace {

using Json = nlohmann::json;

Json explained(const std::string& arguments) {
  const CommandResult result = cli("explain " + arguments + " --json");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return Json::parse(result.output);
}

TEST(Explain, SaysWhichStagesAreInAndWhyTheRestIsLeftOut) {
  std::map<std::string, std::string> left_out;
  const auto explanation = explained("free-fall");
  for (const auto& stage : explanation["stages"])
    if (!stage["in"].get<bool>()) left_out[stage["name"]] = stage["reason"];
  EXPECT_EQ(left_out,
            (std::map<std::string, std::string>{{"viscous damping", "the scene has no \"damping\""},
                                                {"air drag", "the scene has no \"air\""},
                                                {"skin friction", "the scene has no \"air\""},
                                                {"wind", "there is no air to blow"},
                                                {"deformation rate", "the scene has no \"deformation\""},
                                                {"contact", "the scene has no \"obstacles\""},
                                                {"self-contact", "the scene has no \"self_contact\""}}));
  const std::string text = cli("explain free-fall").output;
  for (const auto& [name, reason] : left_out) {
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_NE(text.find(reason), std::string::npos) << text;
  }
}

TEST(Explain, CountsTheSpringsOfEveryFamily) {
  const auto springs = explained("free-fall")["springs"];  // 17 x 17
  EXPECT_EQ(springs["structural"], 2 * 17 * 16);
  EXPECT_EQ(springs["shear"], 2 * 16 * 16);
  EXPECT_EQ(springs["flexion"], 2 * 17 * 15);
}

TEST(Explain, GivesTheFrequencyItsBoundAndEveryMethodsStep) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin_scene(builtin.name);
    const auto json = explained(builtin.name);
    EXPECT_EQ(json["largest_frequency_per_s"], largest_frequency(scene));
    EXPECT_EQ(json["guaranteed_frequency_per_s"], guaranteed_frequency(scene));
    ASSERT_EQ(json["methods"].size(), integrator_names().size());
    for (const auto& method : json["methods"]) {
      const auto limit = stable_step(method["name"].get<std::string>(), scene);
      const auto guaranteed = guaranteed_step(method["name"].get<std::string>(), scene);
      ASSERT_EQ(limit.has_value(), guaranteed.has_value());
      if (guaranteed) {
        EXPECT_EQ(method["guaranteed_step_s"],
                  std::isfinite(*guaranteed) ? Json(*guaranteed) : Json("infinity"))
            << builtin.name;
      }
      if (limit)
        EXPECT_EQ(method["stable_step_s"], std::isfinite(*limit) ? Json(*limit) : Json("infinity"))
            << builtin.name;
      else
        EXPECT_TRUE(method["stable_step_s"].is_null() && method["auto_step_s"].is_null()) << builtin.name;
      const int evaluations = facts_of(method["name"].get<std::string>()).evaluations_per_step;
      EXPECT_EQ(method["evaluations_per_step"], evaluations > 0 ? Json(evaluations) : Json()) << builtin.name;
    }
  }
}

TEST(Explain, SaysThatExplicitEulerHasNoStepWithoutDamping) {
  const CommandResult result = cli("explain free-fall --set integrator.method=explicit-euler");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("no stable time step"), std::string::npos) << result.output;
}

TEST(Explain, TakesSettings) {
  EXPECT_EQ(explained("free-fall --set integrator.time_step=0.0001")["time_step_s"], 0.0001);
  EXPECT_EQ(explained("free-fall --set springs.flexion=0")["springs"]["flexion"], 0);
}

TEST(Explain, SaysThatAStepOfTheSceneIsBeyondTheStableOne) {
  const std::string flag = "flag --set cloth.rows=129 --set cloth.columns=129";
  EXPECT_TRUE(explained(flag)["time_step_notice"].get<std::string>().find("beyond") != std::string::npos);
  EXPECT_FALSE(explained(flag + " --set integrator.time_step=0.00018").contains("time_step_notice"));
  EXPECT_FALSE(explained("flag").contains("time_step_notice"));
}

TEST(Explain, SaysHowEveryImplicitMethodWouldSolveItsLinearSystemsAndWhatEachWayCosts) {
  std::set<std::string> chosen;
  for (const std::string scene : {"corners-free", "corners-free --set springs.structural=1",
                                  "corners-free --set springs.structural=1e8", "disc", "free-fall"}) {
    const auto json = explained(scene);
    ASSERT_EQ(json["linear_solves"].size(), 3u);  // implicit-euler, implicit-midpoint, bdf2
    const std::string text = cli("explain " + scene).output;
    for (const auto& solve : json["linear_solves"]) {
      const double factors = solve["factors_s"], gradients = solve["conjugate_gradients_s"];
      const double multigrid = solve["multigrid_s"].is_null() ? infinity : double(solve["multigrid_s"]);
      EXPECT_GT(std::min({factors, gradients, multigrid}), 0);
      std::string cheapest = gradients < factors ? "conjugate gradients" : "factors";
      if (multigrid < std::min(factors, gradients)) cheapest = "multigrid";
      EXPECT_EQ(solve["solver"], cheapest) << scene;
      EXPECT_NE(text.find(solve["method"].get<std::string>()), std::string::npos);
      chosen.insert(cheapest);
    }
    EXPECT_NE(text.find("Linear solves"), std::string::npos);
  }
  EXPECT_EQ(chosen.size(), 3u);  // each is the cheapest of some scene
}

TEST(Explain, SaysHowProjectiveDynamicsSolvesAndWhy) {
  const std::string projective = " --set integrator.method=projective --set integrator.time_step=0.005";
  const auto solve = [&](const std::string& scene) {
    return explained(scene + projective)["global_solve"].get<std::string>();
  };
  EXPECT_NE(solve("corners-shear").find("one cycle of multigrid an iteration, which leaves 0."),
            std::string::npos);
  EXPECT_NE(solve("free-fall").find("Cholesky factors: multigrid is for grids of 400"), std::string::npos);
  EXPECT_NE(solve("corners-shear --set springs.structural=1 --set springs.shear=800 --set springs.flexion=0")
                .find("Cholesky factors: a cycle of multigrid would leave 0."),
            std::string::npos);
  EXPECT_FALSE(explained("corners-shear").contains("global_solve"));
}

}  // namespace
}  // namespace cloth::test::explain_test
