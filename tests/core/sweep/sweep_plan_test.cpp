// The plan of a sweep: what is read, what is wrong with it and where, and the numbering of points.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/builtin_scenes.h"
#include "support/files.h"
#include "sweep/sweep_points.h"

namespace cloth::test::sweep_plan_test {
namespace {

/// A plan with these members beside scene and outputs.
std::string plan_text(const std::string& members) {
  return R"({ "scene": "corners-free", "outputs": [ { "of": "max_strain" } ],)" + members + "}";
}

SweepPlan plan_of(const std::string& members) {
  SweepReading reading = read_sweep(plan_text(members), "test.sweep.json");
  for (const Problem& problem : reading.problems) ADD_FAILURE() << problem.text();
  return reading.plan.value_or(SweepPlan{});
}

std::string problems_of(const std::string& text, const std::filesystem::path& folder = {}) {
  std::string all;
  for (const Problem& problem : read_sweep(text, "test.sweep.json", folder).problems)
    all += problem.text() + "\n";
  return all;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double number(const ParameterValue& value) {
  return std::get<double>(value);
}

const char* const whole_plan =
    R"({ "format": "clothlab/sweep/1", "title": "All of it", "scene": "corners-free",
  "set": { "duration": 0.2 },
  "vary": [ { "path": "springs.structural", "from": 50, "to": 200, "count": 4, "scale": "log" },
            { "paths": ["springs.shear", "springs.flexion"], "values": [[10, 1], [20, 2]] },
            { "path": "integrator.method", "values": ["verlet", "rk4"] },
            { "path": "gravity", "values": [[0, -9.81, 0], [0, -1.62, 0]] } ],
  "design": "grid", "seed": 7,
  "outputs": [ { "name": "peak", "of": "max_strain", "reduce": "max", "window": [0.05, 0.1] },
               { "name": "when", "of": "kinetic_J", "reduce": "first-above", "bound": 0.01 },
               { "name": "off", "of": "lowest_point", "reduce": "rms",
                 "measured": { "times": [0, 0.1], "values": [0.5, 0.4] } } ],
  "limits": { "steps": 100000, "wall_s": 60 } })";

TEST(SweepPlan, ReadsBackToItselfWithTheSameHash) {
  const SweepReading first = read_sweep(whole_plan, "test.sweep.json");
  ASSERT_TRUE(first.plan) << problems_of(whole_plan);
  const std::string text = write_sweep(*first.plan);
  const SweepReading second = read_sweep(text, "test.sweep.json");
  ASSERT_TRUE(second.plan) << problems_of(text);
  EXPECT_EQ(write_sweep(*second.plan), text);
  EXPECT_EQ(plan_hash(*second.plan), plan_hash(*first.plan));
  EXPECT_EQ(point_count(*second.plan), 4 * 2 * 2 * 2);
  EXPECT_EQ(first.plan->scene.duration, 0.2);
}

TEST(SweepPlan, HasAnotherHashWhereAnythingOfItIsAnother) {
  std::set<std::string> hashes{plan_hash(plan_of(R"("vary": [{"path": "damping", "values": [1, 2]}])"))};
  for (const char* other : {R"("vary": [{"path": "damping", "values": [1, 3]}])",
                            R"("vary": [{"path": "damping", "values": [2, 1]}])",
                            R"("vary": [{"path": "damping", "values": [1, 2]}], "seed": 2)",
                            R"("vary": [{"path": "damping", "values": [1, 2]}], "set": {"duration": 1})",
                            R"("vary": [{"path": "damping", "values": [1, 2]}], "limits": {"steps": 7})"})
    EXPECT_TRUE(hashes.insert(plan_hash(plan_of(other))).second) << other;
}

TEST(SweepPlan, NamesEveryProblemWithItsLine) {
  const std::string problems = problems_of(R"({ "format": "clothlab/sweep/2",
  "scene": "corners-free",
  "set": { "springs.structural": -3 },
  "vary": [],
  "outputs": [ { "of": "max_strain", "reduce": "most" },
               { "of": "max_strain", "reduce": "first-above" } ],
  "limits": { "wall": 3 },
  "sed": 1 })");
  for (const char* part :
       {"test.sweep.json:1:", "format", "test.sweep.json:3:", "set.springs.structural = -3 N/m: must be >= 0",
        "test.sweep.json:5:", "outputs.0.reduce = \"most\": must be one of final, max",
        "test.sweep.json:6:", "outputs.1.bound: must be given", "outputs.1: has a name that is taken",
        "test.sweep.json:7:", "limits.wall: is not a known key",
        "test.sweep.json:8:", "sed: is not a known key"})
    EXPECT_TRUE(has(problems, part)) << part << " in\n" << problems;
}

TEST(SweepPlan, NamesWhatIsWrongWithAnAxis) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("vary": [])", "vary = []: must vary something"},
      {R"("vary": [{"path": "springs.bend", "values": [1]}])", "is not a parameter that this scene has"},
      {R"("vary": [{"path": "damping", "values": [1, -1]}])", "vary.0.values.1 = -1: must be >= 0"},
      {R"("vary": [{"path": "damping", "values": ["much"]}])",
       "vary.0.values.0 = \"much\": must be a number"},
      {R"("vary": [{"path": "cloth.rows", "values": [4.5]}])", "must be a whole number"},
      {R"("vary": [{"path": "damping", "values": [1], "from": 0}])",
       "must have either values or from and to"},
      {R"("vary": [{"path": "damping", "from": 1, "to": 2}])", "vary.0.count: must be given"},
      {R"("vary": [{"path": "damping", "from": 1, "to": 1, "count": 2}])",
       "must not be where the range begins"},
      {R"("vary": [{"path": "damping", "from": 0, "to": 1, "count": 2, "scale": "log"}])", "must be > 0"},
      {R"("vary": [{"path": "integrator.method", "from": 0, "to": 1, "count": 2}])",
       "is no number: give values"},
      {R"("vary": [{"paths": ["damping", "duration"], "values": [[1]]}])", "a value for each of the 2 paths"},
      {R"("vary": [{"path": "damping", "values": [1]}, {"path": "damping", "values": [2]}])",
       "is varied already"},
      {R"("vary": [{"path": "damping", "values": [1]}], "design": "spiral")", "must be one of grid, points"},
      {R"("vary": [{"path": "damping", "values": [1]}], "samples": 7)", "is not for the design grid"},
      {R"("points": "no.csv", "design": "points")", "No such file"}};
  for (const auto& [members, rule] : cases) {
    const std::string problems = problems_of(plan_text(members));
    EXPECT_TRUE(has(problems, rule)) << members << ":\n" << problems;
    EXPECT_TRUE(has(problems, "test.sweep.json:1:")) << problems;
  }
}

TEST(SweepPlan, NamesTheLineOfATableOfPoints) {
  const TemporaryFolder folder;
  std::ofstream(folder / "points.csv") << "damping,integrator.method\n0.1,verlet\n-1,verlet\n0.2,leap\n0.3\n";
  const std::string text = plan_text(R"("points": "points.csv", "design": "points")");
  const std::string problems = problems_of(text, folder.path());
  for (const char* part : {"points.csv:3: damping = -1: must be >= 0",
                           "points.csv:4: integrator.method = leap", "points.csv:5: must have 2 fields"})
    EXPECT_TRUE(has(problems, part)) << part << " in\n" << problems;
  std::ofstream(folder / "points.csv") << "damping,integrator.method\n0.1,verlet\n0.2,rk4\n";
  const SweepReading reading = read_sweep(text, "test.sweep.json", folder.path());
  ASSERT_TRUE(reading.plan);
  const SweepPoints points(*reading.plan);
  ASSERT_EQ(points.count(), 2);
  EXPECT_EQ(number(points.values(1)[0]), 0.2);
  EXPECT_EQ(std::get<std::string>(points.values(1)[1]), "rk4");
  const SweepReading again = read_sweep(write_sweep(*reading.plan), "test.sweep.json");
  ASSERT_TRUE(again.plan);
  EXPECT_EQ(plan_hash(*again.plan), plan_hash(*reading.plan));
}

TEST(SweepPoints, OfAGridGoFastestAlongTheLastAxisAndMeetBothEndsExactly) {
  const SweepPlan plan =
      plan_of(R"("vary": [ { "path": "springs.structural", "from": 50, "to": 200, "count": 3,
    "scale": "log" }, { "paths": ["springs.shear", "springs.flexion"], "values": [[10, 1], [20, 2]] } ])");
  const SweepPoints points(plan);
  ASSERT_EQ(points.count(), 6);
  for (std::int64_t p = 0; p < 6; ++p) {
    const auto values = points.values(p);
    ASSERT_EQ(values.size(), 3u);
    EXPECT_DOUBLE_EQ(number(values[0]), 50 * std::pow(2.0, static_cast<double>(p / 2)));
    EXPECT_EQ(number(values[1]), p % 2 == 0 ? 10 : 20);
    EXPECT_EQ(number(values[2]), p % 2 == 0 ? 1 : 2);
  }
  EXPECT_EQ(number(points.values(0)[0]), 50);
  EXPECT_EQ(number(points.values(5)[0]), 200);
}

TEST(SweepPoints, AreTheScenesThatSetWouldMake) {
  const SweepPlan plan = plan_of(R"("vary": [ { "path": "springs.structural", "values": [60, 70] },
    { "path": "integrator.method", "values": ["xpbd"] }, { "path": "integrator.substeps", "values": [3, 4] },
    { "path": "gravity", "values": [[0, -1, 0]] } ])");
  const SweepPoints points(plan);
  ASSERT_EQ(points.count(), 4);
  const SweepReading set =
      read_sweep(plan_text(R"("vary": [{"path": "duration", "values": [1]}], "set": {"springs.structural": 70,
        "integrator.method": "xpbd", "integrator.substeps": 3, "gravity": [0, -1, 0]})"),
                 "test.sweep.json");
  ASSERT_TRUE(set.plan);
  const SceneReading scene = points.scene(2);
  ASSERT_TRUE(scene.problems.empty());
  EXPECT_EQ(scene_hash(*scene.scene), scene_hash(set.plan->scene));
}

TEST(SweepPoints, SayWhichRuleBetweenParametersAPointBreaks) {
  const SweepPlan plan = plan_of(R"("set": {"cloth.pins": [[5, 5]]},
    "vary": [ { "path": "cloth.rows", "values": [8, 4] } ])");
  const SweepPoints points(plan);
  EXPECT_TRUE(points.scene(0).problems.empty());
  EXPECT_FALSE(points.scene(1).problems.empty());
}

TEST(SweepPoints, OfASampleLieInTheirRangesAndAreThoseOfTheSeed) {
  for (const auto& [design, count] : {std::pair("latin-hypercube", 8), std::pair("sobol", 8),
                                      std::pair("saltelli", 8 * 4), std::pair("morris", 8 * 3)}) {
    const auto members = [&, name = design](int seed) {
      return R"("vary": [ { "path": "springs.structural", "from": 50, "to": 200, "scale": "log" },
        { "path": "integrator.method", "values": ["verlet", "rk4"] } ], "samples": 8, "design": ")" +
             std::string(name) + "\", \"seed\": " + std::to_string(seed);
    };
    const SweepPlan plan = plan_of(members(1)), same = plan_of(members(1)), other = plan_of(members(2));
    const SweepPoints points(plan), again(same), moved(other);
    ASSERT_EQ(points.count(), count) << design;
    std::set<std::string> methods;
    bool differs = false;
    for (std::int64_t p = 0; p < points.count(); ++p) {
      const auto values = points.values(p);
      EXPECT_GE(number(values[0]), 50);
      EXPECT_LE(number(values[0]), 200);
      methods.insert(std::get<std::string>(values[1]));
      EXPECT_EQ(values, again.values(p));
      differs = differs || values != moved.values(p);
    }
    EXPECT_EQ(methods.size(), 2u) << design;
    EXPECT_TRUE(differs) << design;
  }
}

TEST(SweepPlan, RefusesMorePointsThanCanBeRun) {
  std::string axes;
  for (const char* path : {"damping", "duration", "springs.shear"})
    axes += std::string(axes.empty() ? "" : ",") + R"({"path": ")" + path +
            R"(", "from": 1, "to": 2, "count": 1000})";
  EXPECT_TRUE(has(problems_of(plan_text("\"vary\": [" + axes + "]")), "makes 1000000000 points"));
}

TEST(SweepPlan, KnowsWhichOutputsAScenesRecordHas) {
  SweepPlan plan = plan_of(R"("vary": [{"path": "damping", "values": [1]}])");
  EXPECT_FALSE(unknown_output(plan));
  plan.outputs[0].of = "max_strian";
  const auto problem = unknown_output(plan);
  ASSERT_TRUE(problem);
  EXPECT_TRUE(has(problem->text(), "max_strain")) << problem->text();
  plan.outputs[0].of = "step_time_us";
  EXPECT_TRUE(unknown_output(plan)) << "no two runs agree in it";
}

}  // namespace
}  // namespace cloth::test::sweep_plan_test
