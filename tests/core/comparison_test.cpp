// A comparison as a value, and its file.
#include "compare/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "compare/builtin_comparisons.h"
#include "compare/comparison_json.h"
#include "compare/comparison_log.h"
#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "simulation/time_step.h"
#include "study/reference_solution.h"
#include "support/files.h"
#include "support/scenes.h"

namespace cloth::test::comparison_test {
namespace {

using Texts = std::vector<std::string>;

Comparison two_panes() {
  Comparison comparison;
  comparison.title = "Two";
  comparison.scene = smooth_scene(4, 5);
  comparison.panes = panes_for({"verlet", "rk4"});
  return comparison;
}

TEST(Comparison, GivesEachPaneTheSharedSceneWithItsOwnValues) {
  Comparison comparison = two_panes();
  set_own(comparison.panes[1], "springs.shear", 5.0);
  set_shared_value(comparison, "springs.structural", 61.0);
  const Scene left = scene_of(comparison, 0), right = scene_of(comparison, 1);
  EXPECT_EQ(left.integrator.method, "verlet");
  EXPECT_EQ(right.integrator.method, "rk4");
  EXPECT_EQ(left.springs->shear, comparison.scene.springs->shear);
  EXPECT_EQ(right.springs->shear, 5.0);
  EXPECT_EQ(left.springs->structural, 61.0);
  EXPECT_EQ(right.springs->structural, 61.0);
  EXPECT_EQ(own_paths(comparison), Texts({"integrator.method", "springs.shear"}));
  set_shared(comparison.panes[1], "springs.shear");
  EXPECT_EQ(scene_of(comparison, 1).springs->shear, comparison.scene.springs->shear);
  EXPECT_EQ(own_value(comparison.panes[1], "springs.shear"), nullptr);
}

TEST(AComparisonsFile, IsRefusedWhereAPanesClothStartsInAnObstacle) {
  for (const bool continuous : {false, true}) {
    Comparison comparison = two_panes();
    comparison.scene.obstacles = {Obstacle{.shape = &sphere_shape(), .center = {0, -5, 0}, .radius = 0.2}};
    if (continuous) comparison.scene.contact = ContactSettings{};
    ASSERT_TRUE(read_comparison(write_comparison(comparison), "two").comparison);
    set_own(comparison.panes[1], "obstacles.0.center", Vec3(0.2, -0.2, 0));
    const ComparisonReading reading = read_comparison(write_comparison(comparison), "two");
    EXPECT_FALSE(reading.comparison);
    ASSERT_EQ(reading.problems.size(), 1u);
    EXPECT_EQ(reading.problems[0].path, "panes.1.obstacles.0");
    EXPECT_NE(reading.problems[0].rule.find("the cloth starts in this obstacle"), std::string::npos);
    ASSERT_EQ(find_start_problems(comparison).size(), 1u);

    comparison = two_panes();
    comparison.scene.obstacles = {
        Obstacle{.shape = &sphere_shape(), .center = {0.2, -0.2, 0}, .radius = 0.2}};
    if (continuous) comparison.scene.contact = ContactSettings{};
    ASSERT_EQ(find_start_problems(comparison).size(), 1u) << "said once of what all share";
    EXPECT_EQ(find_start_problems(comparison)[0].path, "scene.obstacles.0");
  }
}

TEST(Comparison, LetsAPaneHaveSettingsThatOnlyItsMethodHas) {
  Comparison comparison = two_panes();
  comparison.panes[1].own = {{"integrator.tolerance", 1e-4}, {"integrator.method", "dormand-prince"}};
  EXPECT_EQ(find_problems(comparison).size(), 0u);
  EXPECT_EQ(scene_of(comparison, 1).integrator.tolerance, 1e-4);
}

TEST(Comparison, PanesKeepTheirNamesWhenOthersComeAndGo) {
  Comparison comparison = two_panes();
  EXPECT_EQ(duplicate_pane(comparison, 0), 1u);
  EXPECT_EQ(comparison.panes[1].name, "C");
  EXPECT_EQ(scene_of(comparison, 1), scene_of(comparison, 0));
  comparison.reference = "A";
  remove_pane(comparison, 0);
  EXPECT_EQ(comparison.panes[0].name, "C");
  EXPECT_EQ(style_of(comparison.panes[0]), 2);
  EXPECT_EQ(comparison.reference, controlled_reference);
  EXPECT_EQ(duplicate_pane(comparison, 1), 2u);
  EXPECT_EQ(comparison.panes[2].name, "A");
}

/// The problems' texts, without a place.
Texts texts_of(const Comparison& comparison) {
  Texts texts;
  for (const Problem& problem : find_problems(comparison)) texts.push_back(problem.text());
  return texts;
}

TEST(Comparison, RefusesWhatWouldMakeParticlesOrTimesDiffer) {
  for (const char* path : {"cloth.rows", "cloth.columns", "cloth.pins", "duration", "record.interval"}) {
    Comparison comparison = two_panes();
    comparison.panes[1].own.push_back({path, 3.0});
    if (std::string(path).rfind("cloth.", 0) == 0) comparison.panes[1].own.back().value = std::int64_t{3};
    const Texts texts = texts_of(comparison);
    ASSERT_FALSE(texts.empty()) << path;
    EXPECT_EQ(texts[0].rfind(std::string("panes.1.own.") + path + ": must be shared", 0), 0u) << texts[0];
  }
}

TEST(Comparison, NamesThePaneWhoseValueBreaksARule) {
  Comparison comparison = two_panes();
  set_own(comparison.panes[1], "springs.shear", -3.0);
  comparison.reference = "D";
  EXPECT_EQ(texts_of(comparison),
            Texts({"reference = \"D\": must be the name of a pane, \"controlled\" or \"none\"",
                   "panes.1.own.springs.shear = -3 N/m: must be >= 0"}));
  comparison = two_panes();
  comparison.panes[1].name = "A";
  EXPECT_EQ(texts_of(comparison), Texts({"panes.1.name = \"A\": is another pane's name too"}));
  comparison.panes.pop_back();
  EXPECT_EQ(texts_of(comparison), Texts({"panes = 1 panes: must be 2 to 4"}));
}

TEST(Comparison, SaysASharedProblemOnce) {
  Comparison comparison = two_panes();
  comparison.scene.springs->shear = -3;
  EXPECT_EQ(texts_of(comparison), Texts({"scene.springs.shear = -3 N/m: must be >= 0"}));
}

TEST(Comparison, RefusesAutoForAMethodThatHasNoStableStep) {
  Comparison comparison = two_panes();
  comparison.scene.damping.reset();
  comparison.scene.air.reset();
  set_own(comparison.panes[1], "integrator.method", std::string("explicit-euler"));
  const Texts texts = texts_of(comparison);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].rfind("panes.1: integrator.time_step = \"auto\": explicit-euler has no stable", 0), 0u);
}

TEST(AControlledReference, IsUnderErrorControlWhereTheSceneIsSmooth) {
  const Scene scene = controlled_scenes(two_panes()).reference;
  EXPECT_EQ(scene.integrator.method, "dormand-prince");
  EXPECT_LE(scene.integrator.tolerance, 1e-11);
}

TEST(AControlledReference, ProjectsAsThePanesDoWhereTheSceneIsNot) {
  Comparison comparison = two_panes();
  comparison.scene = builtin_scene("corners-shear");
  ASSERT_FALSE(is_smooth(comparison.scene));
  const Scene scene = controlled_scenes(comparison).reference;
  EXPECT_EQ(scene.integrator.method, "verlet");
  EXPECT_EQ(scene.deformation->rate, comparison.scene.deformation->rate);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LE(8 * *scene.integrator.time_step, (1 + 1e-9) * *resolved_time_step(scene_of(comparison, i)));
}

TEST(AnEditOfAComparison, StartsAnewOnlyForWhatCannotActAtOnce) {
  const Comparison before = two_panes();
  const auto acts = [&](auto change) {
    Comparison after = before;
    change(after);
    return acts_at_once(before, after);
  };
  EXPECT_TRUE(acts([](Comparison& c) { c.scene.springs->shear = 30; }));
  EXPECT_TRUE(acts([](Comparison& c) { c.scene.cloth.pins.clear(); }));
  EXPECT_TRUE(acts([](Comparison& c) { set_own(c.panes[0], "integrator.time_step", 0.002); }));
  EXPECT_TRUE(acts([](Comparison& c) { c.reference = "A"; }));
  EXPECT_FALSE(acts([](Comparison& c) { c.scene.cloth.rows = 7; }));
  EXPECT_FALSE(acts([](Comparison& c) { c.scene.record.interval = 0.02; }));
  EXPECT_TRUE(acts([](Comparison& c) { duplicate_pane(c, 0); }));
  EXPECT_FALSE(acts([](Comparison& c) {
    duplicate_pane(c, 0);
    set_own(c.panes[1], "damping", 0.5);
  })) << "a pane whose past nobody has run";
  EXPECT_FALSE(acts([](Comparison& c) { set_own(c.panes[0], "cloth.width", 2.0); }));
  Comparison without = before;
  without.reference = "A";
  EXPECT_FALSE(acts_at_once(without, before)) << "a reference that did not run from the start";
}

TEST(ALogOfEdits, SaysWhatChangedWhenAndWhere) {
  const Comparison before = two_panes();
  Comparison after = before;
  set_shared_value(after, "gravity", Vec3(0, -3, 0));
  set_own(after.panes[1], "integrator.time_step", 0.0005);
  after.reference = "A";
  duplicate_pane(after, 0);
  ASSERT_TRUE(acts_at_once(before, after));
  EXPECT_EQ(
      comparison_log_lines(before, after, 0.3),
      (std::vector<std::string>{R"({"time_s":0.3,"path":"gravity","value":[0.0,-3.0,0.0]})",
                                R"({"time_s":0.3,"pane":"C","copy_of":"A"})",
                                R"({"time_s":0.3,"pane":"B","path":"integrator.time_step","value":0.0005})",
                                R"({"time_s":0.3,"reference":"A"})"}));
  Comparison fewer = after;
  remove_pane(fewer, 2);
  EXPECT_EQ(comparison_log_lines(after, fewer, 0.4),
            std::vector<std::string>{R"({"time_s":0.4,"pane":"B","removed":true})"});
  EXPECT_TRUE(comparison_log_lines(after, after, 0.3).empty());
}

TEST(ALogOfEdits, SaysThatAValueIsSharedAgainAndThatTheHandLetsGo) {
  Comparison before = two_panes();
  set_own(before.panes[0], "damping", 0.5);
  Comparison after = before;
  set_shared(after.panes[0], "damping");
  EXPECT_EQ(comparison_log_lines(before, after, 0),
            std::vector<std::string>{R"({"time_s":0.0,"pane":"A","path":"damping","value":null})"});
  EXPECT_EQ(comparison_log_lines(std::optional<Pull>(), 0.5),
            std::vector<std::string>{R"({"time_s":0.5,"path":"pull","value":null})"});
}

// --- The file ---

TEST(AComparisonFile, ReadsBackToTheSameComparison) {
  Comparison comparison = two_panes();
  comparison.panes[0].title = "Left, with \"quotes\"\nand lines";
  comparison.scene.obstacles.emplace_back().center = {0, -5, 0};
  set_own(comparison.panes[1], "integrator.time_step", 1.0 / 3e3);
  set_own(comparison.panes[1], "air.wind", Vec3(0.1, -2, 1e-7));
  set_own(comparison.panes[1], "obstacles.0.friction", 0.1);
  duplicate_pane(comparison, 0);
  set_own(comparison.panes[1], "integrator.time_step", std::string("auto"));
  comparison.panes[0].own.clear();
  for (const char* reference : {"controlled", "none", "B"}) {
    comparison.reference = reference;
    const std::string text = write_comparison(comparison);
    const ComparisonReading reading = read_comparison(text, "name");
    ASSERT_TRUE(reading.comparison) << reading.problems.front().text() << "\n" << text;
    EXPECT_TRUE(*reading.comparison == comparison);
    EXPECT_EQ(write_comparison(*reading.comparison), text);
  }
}

TEST(AComparisonFile, BuiltInIsReadWithoutProblems) {
  ASSERT_GE(builtin_comparisons().size(), 2u);
  for (const BuiltinComparison& builtin : builtin_comparisons()) {
    const ComparisonReading reading = read_comparison(builtin.text, builtin.name);
    EXPECT_TRUE(reading.comparison) << builtin.name;
    EXPECT_FALSE(builtin_comparison(builtin.name).title.empty());
  }
}

TEST(AComparisonFile, NamesItsPanesInOrderWhereItDoesNot) {
  const ComparisonReading reading =
      read_comparison(R"({"scene": "flag", "panes": [{}, {"own": {"integrator.method": "rk4"}}]})", "name");
  ASSERT_TRUE(reading.comparison);
  EXPECT_EQ(reading.comparison->panes[0].name, "A");
  EXPECT_EQ(reading.comparison->panes[1].name, "B");
  EXPECT_EQ(reading.comparison->reference, controlled_reference);
  EXPECT_EQ(reading.comparison->scene, builtin_scene("flag"));
}

TEST(AComparisonFile, NamesItsMeshesAsSeenFromWhereItIsWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"meshes", "elsewhere/deep"}) std::filesystem::create_directories(folder / name);
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  ASSERT_FALSE(write_text_file(folder / "meshes/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces));
  ASSERT_FALSE(write_text_file(folder / "meshes/b.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n" + faces));
  const ComparisonReading reading = read_comparison(
      R"({"scene": {"cloth": {}, "obstacles": [
                     {"shape": "mesh", "file": "meshes/a.obj", "translate": [0, -9, 0]}]},
          "panes": [{}, {"own": {"obstacles.0.file": "meshes/b.obj"}}]})",
      "x.compare.json", {}, SceneFolder{folder.path().string()});
  ASSERT_TRUE(reading.comparison) << reading.problems.front().text();
  EXPECT_EQ(mesh_files(*reading.comparison), Texts({folder / "meshes/a.obj", folder / "meshes/b.obj"}));

  const std::filesystem::path file = folder / "elsewhere/deep/y.compare.json";
  const Comparison moved = moved_to_folder(*reading.comparison, file.parent_path().string());
  EXPECT_EQ(moved.scene.obstacles.front().mesh.file, "../../meshes/a.obj");
  EXPECT_EQ(std::get<std::string>(*own_value(moved.panes[1], "obstacles.0.file")), "../../meshes/b.obj");
  const ComparisonReading again = read_comparison(write_comparison(moved), file.string());
  ASSERT_TRUE(again.comparison) << again.problems.front().text();
  EXPECT_EQ(*again.comparison, moved);
  for (std::size_t pane = 0; pane < 2; ++pane)
    EXPECT_EQ(scene_of(*again.comparison, pane).obstacles.front().mesh.loaded->hash,
              scene_of(*reading.comparison, pane).obstacles.front().mesh.loaded->hash);
}

TEST(AComparisonFile, TakesOverridesOfTheSharedSceneAlone) {
  const char* text = R"({"scene": "flag", "panes": [{}, {"own": {"springs.shear": 3}}]})";
  const ComparisonReading reading = read_comparison(text, "name", {{"springs.shear", "7"}});
  ASSERT_TRUE(reading.comparison);
  EXPECT_EQ(scene_of(*reading.comparison, 0).springs->shear, 7);
  EXPECT_EQ(scene_of(*reading.comparison, 1).springs->shear, 3);
  const ComparisonReading wrong = read_comparison(text, "name", {{"springs.structural", "-7"}});
  ASSERT_FALSE(wrong.problems.empty());
  EXPECT_EQ(wrong.problems[0].text(), "--set: scene.springs.structural = -7 N/m: must be >= 0");
}

Texts problems_of(const std::string& text) {
  const ComparisonReading reading = read_comparison(text, "name");
  EXPECT_NE(reading.comparison.has_value(), !reading.problems.empty()) << text;
  Texts texts;
  for (const Problem& problem : reading.problems) texts.push_back(problem.text());
  return texts;
}

/// The text with `panes` after a scene that has no faults.
std::string with_panes(const std::string& panes) {
  return "{\"scene\": \"flag\",\n\"panes\": " + panes + "}";
}

void expect_problem(const std::string& text, const std::string& start) {
  const Texts texts = problems_of(text);
  ASSERT_EQ(texts.size(), 1u) << text << (texts.empty() ? "" : "\n" + texts.back());
  EXPECT_EQ(texts[0].rfind(start, 0), 0u) << texts[0];
}

TEST(AComparisonFile, WithErrorsIsAnsweredWithPlaceValueAndRule) {
  expect_problem("{\"scene\": ", "name:1:11: is not JSON");
  expect_problem("[]", "name:1:1: must be an object");
  expect_problem(R"({"panes": [{}, {}]})", "name:1:1: scene: must be given");
  expect_problem(R"({"scene": "flag"})", "name:1:1: panes: must be given");
  expect_problem(
      R"({"scene": "flagg", "panes": [{}, {}]})",
      "name:1:11: scene = \"flagg\": must be a scene in braces or the name of a built-in one: ball");
  expect_problem(R"({"scene": 3, "panes": [{}, {}]})", "name:1:11: scene = 3: must be a scene");
  expect_problem(R"({"scene": "flag", "format": "clothlab/scene/1", "panes": [{}, {}]})",
                 "name:1:29: format = \"clothlab/scene/1\": must be \"clothlab/comparison/1\"");
  expect_problem(R"({"scene": "flag", "pains": 1, "panes": [{}, {}]})",
                 "name:1:19: pains: is not a known key");
  expect_problem(R"({"scene": {"cloth": {"rows": 1}}, "panes": [{}, {}]})",
                 "name:1:30: scene.cloth.rows = 1: must be >= 2");
  expect_problem(R"({"scene": {"cloth": {}, "cloth": {}}, "panes": [{}, {}]})",
                 "name:1:25: scene.cloth: is given more than once");
  expect_problem(R"({"scene": "flag", "panes": [{}, {}], "reference": "C"})",
                 "name:1:51: reference = \"C\": must be the name of a pane");
  expect_problem(R"({"scene": "flag", "panes": [{}, {}], "reference": 1})",
                 "name:1:51: reference = 1: must be a text in quotes");
  expect_problem(with_panes("[{}]"), "name:2:10: panes = 1 panes: must be 2 to 4");
  expect_problem(with_panes("[{}, {}, {}, {}, {}]"), "name:2:10: panes = 5 panes");
  expect_problem(with_panes("3"), "name:2:10: panes = 3: must be a list");
  expect_problem(with_panes("[{}, 3]"), "name:2:15: panes.1 = 3: must be an object");
  expect_problem(with_panes("[{}, {\"nam\": \"B\"}]"), "name:2:16: panes.1.nam: is not a known key");
  expect_problem(with_panes("[{}, {\"name\": \"b\"}]"),
                 "name:2:24: panes.1.name = \"b\": must be one of A, B");
  expect_problem(with_panes("[{}, {\"name\": \"A\"}]"), "name:2:24: panes.1.name = \"A\": is another");
  expect_problem(with_panes("[{}, {\"own\": 3}]"), "name:2:23: panes.1.own = 3: must be an object");
}

TEST(AComparisonFile, WithABadOwnValueSaysWhereItStands) {
  const auto own = [](const std::string& values) { return with_panes("[{}, {\"own\": {" + values + "}}]"); };
  const std::string at = "name:2:";
  expect_problem(own("\"integrator.method\": \"euler\""),
                 at + "45: panes.1.own.integrator.method = \"euler\": must be one of");
  expect_problem(own("\"springs.shear\": -1"), at + "41: panes.1.own.springs.shear = -1 N/m: must be >= 0");
  expect_problem(own("\"springs.shear\": \"much\""),
                 at + "41: panes.1.own.springs.shear = \"much\": must be a number");
  expect_problem(own("\"springs.strength\": 1"), at + "24: panes.1.own.springs.strength: is not a known key");
  expect_problem(own("\"cloth.rows\": 5"),
                 at + "38: panes.1.own.cloth.rows = 5: must be shared: each particle");
  expect_problem(own("\"duration\": 5"), at + "36: panes.1.own.duration = 5: must be shared");
  expect_problem(own("\"air\": null"), at + "31: panes.1.own.air = null: must be a value");
  expect_problem(own("\"air\": {}"), at + "24: panes.1.own.air: is not a parameter of the shared scene");
  expect_problem(R"({"scene": "pendulum", "panes": [{}, {"own": {"deformation.rate": 0.1}}]})",
                 "name:1:46: panes.1.own.deformation.rate: is not a parameter of the shared scene");
}

}  // namespace
}  // namespace cloth::test::comparison_test
