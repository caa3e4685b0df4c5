// clothlab-cli validate --scene: scenes against measured points. The points are made of exact solutions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "exact/heavy_strip.h"
#include "io/csv.h"
#include "scene/scene_json.h"
#include "study/validation/strip.h"
#include "support/files.h"

namespace cloth::test::validate_scenes_test {
namespace {

using Json = nlohmann::json;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ValidateScene : public testing::Test {
 protected:
  /// A scene with measured points in the folder; `validate` with these options.
  CommandResult validate(const Scene& scene, const std::string& csv, const std::string& options = "") {
    std::ofstream(folder_ / "points.csv") << csv;
    std::ofstream(folder_ / "cloth.scene.json") << write_scene(scene);
    return cli("validate --scene '" + scene_file() + "' " + options);
  }
  std::string scene_file() const { return (folder_ / "cloth.scene.json").string(); }
  Json json_of(const CommandResult& result) const { return Json::parse(result.output)["scenes"][0]; }

  TemporaryFolder folder_;
};

constexpr double load = 5;  // Gamma

Scene cantilever() {
  Scene scene = strip_scene({.load = load, .cells = 20},
                            {exact::heavy_cantilever(load).points, StripEnd::clamped, StripEnd::free});
  scene.measured = MeasuredPoints{.file = "points.csv", .tolerance = 0.005};
  return scene;
}

/// The exact curve in m, every tenth point, moved by `aside`.
std::string exact_points(double aside = 0) {
  std::string csv = "x,y\n";
  const auto points = exact::heavy_cantilever(load).points;
  for (std::size_t k = 0; k < points.size(); k += 10)
    csv += fmt::format("{},{}\n", strip_length * points[k].x, strip_length * points[k].y - aside);
  return csv;
}

/// A cloth that nothing holds.
Scene falling_cloth() {
  Scene scene;
  scene.title = "Free fall";
  scene.cloth.rows = scene.cloth.columns = 5;
  scene.springs.emplace().structural = 50;
  scene.gravity = Vec3(0, -10, 0);
  scene.integrator.time_step = 0.001;
  scene.duration = 0.5;
  scene.measured =
      MeasuredPoints{.file = "points.csv", .output = "lowest_point", .state = "end", .tolerance = 1e-6};
  return scene;
}

std::string fall(double acceleration) {
  std::string csv = "time,value\n";
  for (const double time : {0.1, 0.2, 0.35, 0.5})
    csv += fmt::format("{},{}\n", time, -acceleration * time * time / 2);
  return csv;
}

TEST_F(ValidateScene, AtRestApproachesTheExactCurveOfItsFileWithSecondOrder) {
  const CommandResult result = validate(cantilever(), exact_points(), "--json");
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  const Json scene = json_of(result);
  ASSERT_EQ(scene["grids"].size(), 4u);
  EXPECT_EQ(scene["grids"][0]["cells"], 21) << "half of its cells have no place for the clamp";
  EXPECT_EQ(scene["grids"][3]["cells"], 168);
  for (std::size_t k = 1; k < 4; ++k)
    EXPECT_LT(scene["grids"][k]["relative_error"], scene["grids"][k - 1]["relative_error"].get<double>() / 2);
  EXPECT_GT(scene["order"], 1.8);
  EXPECT_LT(scene["order"], 2.2);
  EXPECT_EQ(scene["holds"], true);
}

TEST_F(ValidateScene, IsNotWithinItsToleranceOfACurveMovedAside) {
  const CommandResult result = validate(cantilever(), exact_points(0.005), "--cells 21,42");
  EXPECT_EQ(result.exit_code, 5) << result.errors;
  EXPECT_TRUE(has(result.output, "not within 0.5 %")) << result.output;
}

TEST_F(ValidateScene, LeavesATableAPageWithTheMeasuredPointsAndAnIndex) {
  const std::string out = (folder_ / "out").string();
  ASSERT_EQ(validate(cantilever(), exact_points(), "--cells 21,42,84 --out '" + out + "'").exit_code, 0);
  const CsvTable table = parse_csv(content_of(folder_ / "out/measured.csv"));
  EXPECT_EQ(table.rows.size(), 3u);
  const std::string page = content_of(folder_ / "out/report.html");
  for (const char* part : {"<svg", "measured", "42 x 4 cells", "--cells 21,42,84"})
    EXPECT_TRUE(has(page, part)) << part;
  EXPECT_EQ(Json::parse(content_of(folder_ / "out/measured.json"))["kind"], "measured");
  EXPECT_EQ(cli("validate --only catenary --out '" + out + "'").exit_code, 2) << "a folder holds one thing";
  const std::string input = folder_.path().string();
  EXPECT_EQ(validate(cantilever(), exact_points(), "--cells 21,42 --out '" + input + "'").exit_code, 0)
      << "beside its inputs";
  EXPECT_TRUE(has(content_of(folder_ / "points.csv"), "x,y"));
}

TEST_F(ValidateScene, FallsAsTheHistoryOfItsFileSaysOnEveryGrid) {
  const CommandResult result = validate(falling_cloth(), fall(10), "--json");
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  const Json scene = json_of(result);
  ASSERT_EQ(scene["grids"].size(), 4u);
  EXPECT_EQ(scene["grids"][0]["cells"], 2);
  for (const Json& grid : scene["grids"]) {
    EXPECT_LT(grid["relative_error"], 1e-6);
    EXPECT_EQ(grid["method"], "verlet");
    EXPECT_NEAR(grid["time_step_s"], 0.001, 1e-9);
  }
  EXPECT_EQ(validate(falling_cloth(), fall(9)).exit_code, 5);
}

TEST_F(ValidateScene, HoldsASingleValueAgainstItsNumber) {
  Scene scene = cantilever();
  scene.measured->output = "droop_ratio";
  const double exact = exact::heavy_cantilever(load).droop_over_width;
  const CommandResult found = validate(scene, fmt::format("value\n{}\n", exact), "--json --cells 21,42,84");
  const Json grids = json_of(found)["grids"];
  EXPECT_NEAR(grids[2]["value"], exact, 0.05 * exact);
  EXPECT_NEAR(grids[2]["relative_error"], grids[2]["value"].get<double>() / exact - 1, 1e-12);
  EXPECT_EQ(validate(scene, fmt::format("value\n{}\n", 2 * exact), "--cells 21,42").exit_code, 5);
}

TEST_F(ValidateScene, RefusesAFileWithPlaceValueAndRule) {
  const Scene strip = cantilever(), falling = falling_cloth();
  const std::string file = (folder_ / "points.csv").string();
  const struct {
    const Scene& scene;
    std::string csv, message;
  } cases[] = {
      {strip, "x,y\n0,0\n0.01,abc\n", file + ":3:2: y = \"abc\": must be a number"},
      {strip, "x,y\n0,0\n0.01\n", file + ":3:1: has 1 fields, and the first line 2"},
      {strip, "x,y\n0,0\n0,01,0,02\n", file + ":3:1: has 4 fields, and the first line 2"},
      {strip, "x\n0\n", "must have two of the columns x, y and z"},
      {strip, "", "must have a line of column names"},
      {falling, "x,y\n0,0\n", "must have a column value"},
      {falling, "value\n1\n2\n", file + ":3:1: value: must be one number"},
      {falling, "value\n0\n", "value = 0: must not be 0"},
      {falling, "time,value\n0.1,0\n", "must not be 0 throughout"},
      {falling, "time,value\n0.1,1\n0.6,2\n",
       file + ":3:1: time = 0.6 s: must be from 0 to the scene's duration, 0.5 s"},
      {falling, "time,value\n0.2,1\n0.1,2\n", "time = 0.1 s: must be after the one before"},
  };
  for (const auto& one : cases) {
    const CommandResult result = validate(one.scene, one.csv);
    EXPECT_EQ(result.exit_code, 2) << one.message;
    EXPECT_TRUE(has(result.errors, one.message)) << one.message << "\n" << result.errors;
  }
}

TEST_F(ValidateScene, RefusesWhatTheSceneDoesNotHave) {
  const struct {
    std::string setting, message;
  } cases[] = {
      {"measured.file=none.csv",
       "measured.file = \"none.csv\": must be a CSV file, as seen from the scene's folder"},
      {"measured.output=middle", "measured.output = middle: must be top-row, middle-row"},
      {"measured.state=rest", "measured.state = rest: must be end: the scene has wind"},
      {"measured.state=soon", "must be"},
      {"measured.tolerance=0", "must be > 0"},
      {"measured=null", "measured: must be given"},
  };
  Scene scene = falling_cloth();
  scene.air.emplace().wind = Vec3(0, 0, 1);
  for (const auto& one : cases) {
    const CommandResult result = validate(scene, fall(10), "--set " + one.setting);
    EXPECT_EQ(result.exit_code, 2) << one.setting;
    EXPECT_TRUE(has(result.errors, one.message)) << one.message << "\n" << result.errors;
  }
  EXPECT_EQ(cli("validate --scene nowhere").exit_code, 4) << "as of every command";
  EXPECT_EQ(cli("validate --scene flag").exit_code, 2) << "it names no points";
  EXPECT_EQ(cli("validate --cells 10,20").exit_code, 2) << "of no scene";
  EXPECT_EQ(validate(scene, fall(10), "--only catenary").exit_code, 2);
  EXPECT_EQ(validate(scene, fall(10), "--jobs 2").exit_code, 2) << "its steps use the cores";
  EXPECT_EQ(validate(scene, fall(10), "--cells 4,3").exit_code, 2);
}

TEST_F(ValidateScene, RunsAsIfTheBlockWereNotThere) {
  Scene scene = falling_cloth();
  std::ofstream(folder_ / "with.scene.json") << write_scene(scene);
  scene.measured.reset();
  std::ofstream(folder_ / "without.scene.json") << write_scene(scene);
  for (const char* name : {"with", "without"}) {
    const CommandResult result =
        cli(fmt::format("run '{}' --out '{}'", (folder_ / (std::string(name) + ".scene.json")).string(),
                        (folder_ / name).string()));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  EXPECT_EQ(content_of(folder_ / "with/final_state.csv"), content_of(folder_ / "without/final_state.csv"));
  const Json saved = Json::parse(content_of(folder_ / "with/scene.json"));
  EXPECT_EQ(saved["measured"]["file"], "../points.csv") << "as seen from the folder of the run";
}

}  // namespace
}  // namespace cloth::test::validate_scenes_test
