// Bad scenes are answered with every problem at once, each with its place, value and rule.
#include <gtest/gtest.h>

#include <algorithm>

#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "support/scenes.h"

namespace cloth::test::scene_reader_test {
namespace {

std::vector<std::string> problems_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const SceneReading reading = read_scene(text, "name", overrides);
  EXPECT_NE(reading.scene.has_value(), !reading.problems.empty());
  std::vector<std::string> texts;
  for (const Problem& problem : reading.problems) texts.push_back(problem.text());
  return texts;
}

using Texts = std::vector<std::string>;

std::string quoted(const Texts& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "\"" : ", \"") + word + "\"";
  return list;
}

TEST(SceneReader, GivesFileLineColumnKeyValueAndRule) {
  EXPECT_EQ(problems_of("{\n"
                        "  \"cloth\": {},\n"
                        "\n\n\n"
                        "  \"springs\": {\n"
                        "    \"structural\":  -3\n"
                        "  }\n"
                        "}\n"),
            Texts({"name:7:20: springs.structural = -3 N/m: must be >= 0"}));
}

TEST(SceneReader, ReportsAllProblemsAtOnceInTheOrderOfTheFile) {
  EXPECT_EQ(
      problems_of("{ \"cloth\": { \"columns\": 1,\n"
                  "             \"rows\": 1,\n"
                  "             \"mass\": -0.25 },\n"
                  "  \"sprigns\": {},\n"
                  "  \"damping\": \"much\",\n"
                  "  \"duration\": 0 }"),
      Texts({"name:1:25: cloth.columns = 1: must be >= 2 and <= 4096",
             "name:2:22: cloth.rows = 1: must be >= 2 and <= 4096",
             "name:3:22: cloth.mass = -0.25 kg: must be > 0",
             "name:4:3: sprigns: is not a known key; known here: air, cloth, contact, damping, deformation, "
             "duration, "
             "format, gravity, integrator, material, measured, obstacles, probes, record, self_contact, springs, title",
             "name:5:14: damping = \"much\": must be a number", "name:6:15: duration = 0 s: must be > 0"}));
}

/// The one problem of a text.
std::string problem_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const Texts texts = problems_of(text, overrides);
  EXPECT_EQ(texts.size(), 1u) << text;
  return texts.empty() ? "" : texts.front();
}

void expect_refused(const std::string& text, const std::string& start, const std::string& within = "") {
  const std::string problem = problem_of(text);
  EXPECT_EQ(problem.rfind(start, 0), 0u) << problem;
  EXPECT_NE(problem.find(within), std::string::npos) << problem;
}

TEST(SceneReader, NamesUnknownKeysInEveryBlock) {
  expect_refused("{\"cloth\": {}, \"gravitiy\": 1}", "name:1:15: gravitiy: is not a known key");
  expect_refused("{\"cloth\": {\"widht\": 1}}", "name:1:12: cloth.widht: is not a known key", "width");
  expect_refused("{\"cloth\": {}, \"springs\": {\"bend\": 1}}",
                 "name:1:27: springs.bend: is not a known key");
  expect_refused("{\"cloth\": {}, \"air\": {\"density\": 1}}", "name:1:23: air.density: is not a known key",
                 "gust");
  expect_refused("{\"cloth\": {}, \"air\": {\"gust\": {\"f\": 1}}}",
                 "name:1:32: air.gust.f: is not a known key");
  expect_refused("{\"cloth\": {}, \"deformation\": {\"x\": 1}}",
                 "name:1:31: deformation.x: is not a known key");
  expect_refused("{\"cloth\": {}, \"integrator\": {\"x\": 1}}",
                 "name:1:30: integrator.x: is not a known key");
  expect_refused("{\"cloth\": {}, \"record\": {\"x\": 1}}", "name:1:26: record.x: is not a known key");
  expect_refused("{\"cloth\": {}, \"obstacles\": [{\"shape\": \"sphere\", \"size\": [1, 1, 1]}]}",
                 "name:1:49: obstacles.0.size: is not a known key", "radius");
}

TEST(SceneReader, RefusesTextsThatAreNotJson) {
  expect_refused("", "name:1:1: is not JSON", "ends too early");
  expect_refused("   \n ", "name:2:2: is not JSON", "ends too early");
  expect_refused("{\"cloth\": {}", "name:1:13: is not JSON", "ends too early");
  expect_refused("{\"cloth\": {\"mass\": NaN}}", "name:1:20: is not JSON");
  expect_refused("{\n  \"cloth\": {},\n}", "name:3:1: is not JSON");
  expect_refused("{'cloth': {}}", "name:1:2: is not JSON");
  expect_refused("\x89PNG\r\n", "name:1:1: is not JSON");
  expect_refused("{\"cloth\": {\"mass\": 1e999}}", "name:1:", "the number 1e999 is too large");
  expect_refused("{\"cloth\": {\"mass\": Infinity}}", "name:1:20: is not JSON");
}

TEST(SceneReader, RefusesTextsOfAnyDepth) {
  const std::string nest(1000000, '[');
  expect_refused(nest, "name:1:", "nested too deeply");
  expect_refused("{\"cloth\": " + nest, "name:1:", "nested too deeply");
}

TEST(SceneReader, RefusesOtherJsonThanAnObject) {
  expect_refused("[1, 2]", "name:1:1: must be an object in braces", "");
}

TEST(SceneReader, NeedsACloth) {
  expect_refused("{\n}", "name:1:1: cloth: must be given");
}

TEST(SceneReader, TakesACommaFreeLineOfEveryAbsentBlock) {
  const SceneReading reading = read_scene("{\"cloth\": {}}", "name");
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(*reading.scene, Scene{});
}

TEST(SceneReader, NamesKeysGivenTwice) {
  expect_refused("{\"cloth\": {},\n \"damping\": 1,\n \"damping\": 2}",
                 "name:3:2: damping: is given more than once");
  expect_refused("{\"cloth\": {\"mass\": 1, \"mass\": 1}}", "name:1:23: cloth.mass: is given more than once");
}

TEST(SceneReader, NamesValuesOfTheWrongType) {
  const auto refused = [](const std::string& member, const std::string& expected) {
    EXPECT_EQ(problem_of("{\"cloth\": {},\n" + member + "}"), "name:2:" + expected);
  };
  refused("\"springs\": 5", "12: springs = 5: must be an object in braces");
  refused("\"springs\": {\"shear\": \"5\"}", "22: springs.shear = \"5\": must be a number");
  refused("\"springs\": {\"shear\": null}", "22: springs.shear = null: must be a number");
  refused("\"gravity\": -9.81", "12: gravity = -9.81: must be three numbers [x, y, z]");
  refused("\"gravity\": [0, 1]", "12: gravity = [0,1]: must be three numbers [x, y, z]");
  refused("\"title\": 3", "10: title = 3: must be a text in quotes");
  refused("\"obstacles\": {}", "14: obstacles = {}: must be a list");
  refused("\"obstacles\": [7]", "15: obstacles.0 = 7: must be an object in braces");
  refused("\"integrator\": {\"time_step\": \"quick\"}",
          "29: integrator.time_step = \"quick\": must be a number or \"auto\"");
  refused("\"integrator\": {\"time_step\": 0}", "29: integrator.time_step = 0 s: must be > 0");
  refused("\"integrator\": {\"method\": \"euler\"}",
          "26: integrator.method = \"euler\": must be one of " + quoted(integrator_names()));
  refused("\"deformation\": {\"springs\": [\"flexion\"]}",
          "28: deformation.springs = [\"flexion\"]: must be one of [], [\"structural\"], [\"structural\", "
          "\"shear\"]");
  refused("\"deformation\": {\"max_sweeps\": 2.5}",
          "31: deformation.max_sweeps = 2.5: must be a whole number, >= 1 and <= 1000000");
  refused("\"record\": {\"interval\": -1}", "24: record.interval = -1 s: must be > 0");
  refused("\"format\": \"clothlab/scene/9\"",
          "11: format = \"clothlab/scene/9\": must be \"clothlab/scene/1\"");
}

TEST(SceneReader, NamesProblemsOfObstacles) {
  const auto refused = [](const std::string& obstacle, const std::string& expected) {
    EXPECT_EQ(problem_of("{\"cloth\": {}, \"obstacles\": [\n" + obstacle + "]}"), "name:2:" + expected);
  };
  refused("{}", "1: obstacles.0.shape: must be given: \"sphere\", \"box\", \"plane\" or \"mesh\"");
  refused("{\"shape\": \"torus\"}",
          "11: obstacles.0.shape = \"torus\": must be \"sphere\", \"box\", \"plane\" or \"mesh\"");
  refused("{\"shape\": \"mesh\", \"radius\": 1, \"file\": \"disc.obj\"}",
          "19: obstacles.0.radius: is not a known key; known here: file, friction, keyframes, response, "
          "restitution, "
          "rotate, "
          "scale, shape, spin, translate, velocity");
  refused("{\"shape\": \"sphere\", \"radius\": 0}", "31: obstacles.0.radius = 0 m: must be > 0");
  refused("{\"shape\": \"box\", \"size\": [1, -1, 1]}", "26: obstacles.0.size = [1, -1, 1] m: must be > 0");
  refused("{\"shape\": \"plane\", \"normal\": [0, 0, 0]}",
          "30: obstacles.0.normal = [0, 0, 0]: must not be zero: it is a direction");
  refused("{\"shape\": \"plane\", \"restitution\": 1.5}",
          "35: obstacles.0.restitution = 1.5: must be >= 0 and <= 1");
}

TEST(SceneReader, NamesProblemsOfPins) {
  const auto refused = [](const std::string& pins, const std::string& expected) {
    EXPECT_EQ(problem_of("{\"cloth\": {\"columns\": 4, \"rows\": 3,\n\"pins\": " + pins + "}}"),
              "name:2:" + expected);
  };
  refused("[[3, 0]]", "10: cloth.pins.0 = [3, 0]: must lie in the grid: row 0 to 2, column 0 to 3");
  refused("[\"top-left\", [0, -1]]",
          "22: cloth.pins.1 = [0, -1]: must lie in the grid: row 0 to 2, column 0 to 3");
  refused("[[0, 1.5]]",
          "10: cloth.pins.0 = [0,1.5]: must be a name, [row, column] in whole numbers or {\"disc\": radius "
          "in m}");
  refused(
      "[[0]]",
      "10: cloth.pins.0 = [0]: must be a name, [row, column] in whole numbers or {\"disc\": radius in m}");
  refused("[[99999999999, 0]]",
          "10: cloth.pins.0 = [99999999999,0]: must be a name, [row, column] in whole numbers or {\"disc\": "
          "radius in m}");
  refused("\"all\"", "9: cloth.pins = \"all\": must be a list");
  EXPECT_EQ(problem_of("{\"cloth\": {\"pins\": [\"middle\"]}}")
                .rfind("name:1:21: cloth.pins.0 = \"middle\": must be", 0),
            0u);
}

TEST(SceneReader, NamesASheetWithoutArea) {
  EXPECT_EQ(problem_of("{\"cloth\": {\"across\": [1, 0, 0],\n \"down\": [-2, 0, 0]}}"),
            "name:2:10: cloth.down = [-2, 0, 0]: must not be parallel to cloth.across");
  EXPECT_EQ(problem_of("{\"cloth\": {\"across\": [0, 0, 0]}}"),
            "name:1:22: cloth.across = [0, 0, 0]: must not be zero: it is a direction");
  EXPECT_EQ(problem_of("{\"cloth\": {\"width\": 0}}"), "name:1:21: cloth.width = 0 m: must be > 0");
}

TEST(SceneReader, KeepsItsPlacesAfterAByteOrderMark) {
  EXPECT_EQ(problem_of("\xEF\xBB\xBF{\"cloth\": {},\n \"damping\": -1}"),
            "name:2:13: damping = -1 N s/m: must be >= 0");
}

TEST(Overrides, SetParametersOfTheScene) {
  const std::string text = builtin_scenes().front().text;
  const auto set = [&](const std::string& path, const std::string& value) {
    const SceneReading reading = read_scene(text, "name", {{path, value}});
    EXPECT_TRUE(reading.scene) << path;
    return reading.scene.value_or(Scene{});
  };
  EXPECT_EQ(set("springs.structural", "777").springs->structural, 777);
  EXPECT_EQ(set("integrator.method", "rk4").integrator.method, "rk4");
  EXPECT_EQ(set("integrator.method", "\"rk4\"").integrator.method, "rk4");
  EXPECT_EQ(set("integrator.time_step", "1e-4").integrator.time_step, 1e-4);
  EXPECT_EQ(set("integrator.time_step", "auto").integrator.time_step, std::nullopt);
  EXPECT_EQ(set("gravity", "[0, 0, -1]").gravity, Vec3(0, 0, -1));
  EXPECT_EQ(set("obstacles.0.friction", "0.125").obstacles.at(0).friction, 0.125);
  EXPECT_EQ(set("cloth.pins", "[\"top-edge\"]").cloth.pins, std::vector<Pin>{NamedPin::top_edge});
}

TEST(Overrides, BringInABlockThatTheSceneDoesNotHave) {
  const SceneReading reading = read_scene("{\"cloth\": {}}", "name", {{"air.gust.amplitude", "0.25"}});
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(reading.scene->air->gust->amplitude, 0.25);
}

TEST(Overrides, AreNamedAsThePlaceOfTheirProblems) {
  const std::string text = "{\"cloth\": {}}";
  const auto refused = [&](const std::string& path, const std::string& value) {
    return problem_of(text, {{path, value}});
  };
  EXPECT_EQ(refused("springs.structural", "-3"), "--set: springs.structural = -3 N/m: must be >= 0");
  EXPECT_EQ(refused("springs.structural", "NaN"), "--set: springs.structural = \"NaN\": must be a number");
  EXPECT_EQ(refused("springs.structural", "1e999"),
            "--set: springs.structural = \"1e999\": must be a number");
  EXPECT_EQ(refused("springs.structural", ""), "--set: springs.structural = \"\": must be a number");
  EXPECT_EQ(refused("springs.bend", "1").rfind("--set: springs.bend: is not a known key", 0), 0u);
  EXPECT_EQ(refused("cloth", "3"), "--set: cloth = 3: must be an object in braces");
  EXPECT_EQ(problem_of("{\"cloth\": {}, \"obstacles\": []}", {{"obstacles.0.friction", "1"}}),
            "--set: obstacles.0.friction = 1: there is no such parameter in this scene");
  EXPECT_EQ(problem_of("{\"cloth\": {}, \"damping\": 1}", {{"damping.x", "1"}}),
            "--set: damping.x = 1: there is no such parameter in this scene");
}

TEST(Overrides, AreSplitAtTheirFirstEqualsSign) {
  EXPECT_EQ(parse_override("a.b=1=2")->path, "a.b");
  EXPECT_EQ(parse_override("a.b=1=2")->value, "1=2");
  EXPECT_EQ(parse_override("a=")->value, "");
  EXPECT_FALSE(parse_override("a.b"));
  EXPECT_FALSE(parse_override("=1"));
}

TEST(SceneChecks, FindWhatAFileCouldNotEvenSay) {
  Scene scene = bare_sheet(3, 3);
  EXPECT_TRUE(find_problems(scene).empty());
  scene.cloth.mass = std::numeric_limits<double>::quiet_NaN();
  scene.duration = infinity;
  EXPECT_EQ(find_problems(scene).size(), 2u);
}

}  // namespace
}  // namespace cloth::test::scene_reader_test
