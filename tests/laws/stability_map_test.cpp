// The stability map: what its criterion says of known series, and that its cells change where the spectrum
// predicts.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "integrators/registry.h"
#include "io/csv.h"
#include "scene/builtin_scenes.h"
#include "study/stability_report.h"
#include "study/study_folder.h"
#include "support/scenes.h"

namespace cloth::test::stability_map_test {
namespace {

// ---- the criterion -------------------------------------------------------------------------------------

/// 400 samples over one second of `error(t)` in J; the scale is 1 J.
RunClass class_of(const std::function<double(double)>& error) {
  std::vector<EnergySample> samples;
  for (int k = 0; k <= 400; ++k) samples.push_back({k / 400.0, error(k / 400.0)});
  return judge_energy(samples, 1, {}).run_class;
}

TEST(EnergyCriterion, CallsAnExponentialGrowthBeyondTheThresholdAnInstability) {
  EXPECT_EQ(class_of([](double t) { return 2e-8 * std::exp(12 * t); }), RunClass::energy_growth);
  EXPECT_EQ(class_of([](double t) { return 1e-8 * std::exp(12 * t) * std::pow(std::sin(300 * t), 2); }),
            RunClass::energy_growth);
}

TEST(EnergyCriterion, LetsAGrowthBelowTheThresholdPass) {
  EXPECT_EQ(class_of([](double t) { return 1e-9 * std::exp(12 * t); }), RunClass::accurate);
}

TEST(EnergyCriterion, TakesABoundedOscillationForNoGrowth) {
  EXPECT_EQ(class_of([](double t) { return 5e-3 * std::sin(200 * t); }), RunClass::accurate);
  EXPECT_EQ(class_of([](double t) { return 0.5 * std::sin(200 * t); }), RunClass::stable_but_inaccurate);
}

TEST(EnergyCriterion, TakesAJumpForNoGrowth) {
  EXPECT_EQ(class_of([](double t) { return t < 0.8 ? 1e-6 : 5e-3; }), RunClass::accurate);
}

TEST(EnergyCriterion, TakesASwingOfTheWholeClothForNoGrowth) {
  EXPECT_EQ(class_of([](double t) { return 5e-3 * t * t; }), RunClass::accurate);
  EXPECT_EQ(class_of([](double t) { return 5e-3 * t * t * t; }), RunClass::accurate);
}

TEST(EnergyCriterion, TakesADecayForInaccurateOnceItIsLarge) {
  EXPECT_EQ(class_of([](double t) { return -0.3 * (1 - std::exp(-5 * t)); }),
            RunClass::stable_but_inaccurate);
  EXPECT_EQ(class_of([](double t) { return -0.003 * (1 - std::exp(-5 * t)); }), RunClass::accurate);
}

TEST(EnergyCriterion, CallsTheWholeScaleCreatedAnInstabilityHoweverItCame) {
  EXPECT_EQ(class_of([](double t) { return t < 0.1 ? 0.0 : 1.1; }), RunClass::energy_growth);
}

TEST(EnergyCriterion, MeasuresTheRateOfGrowth) {
  std::vector<EnergySample> samples;
  for (int k = 0; k <= 400; ++k) samples.push_back({k / 400.0, 1e-8 * std::exp(17 * k / 400.0)});
  EXPECT_NEAR(judge_energy(samples, 1, {}).growth_rate, 17, 0.2);
}

// ---- prediction and measurement ------------------------------------------------------------------------

/// Cells in steps of 1 % around the limit of this very grid: the last stable and the first unstable one.
MeasuredLimit measured_around(int size, const std::string& method) {
  Scene scene = bare_sheet(size, size, 0.1, 0.002);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0};
  scene.integrator.method = method;
  const double limit = predict_limits(scene).spectrum;
  MeasuredLimit found{.limits = predict_limits(scene)};
  for (int percent = -4; percent <= 4; ++percent) {
    if (percent == 0) continue;
    scene.integrator.time_step = limit * std::pow(1.01, percent);
    const StabilityCell cell = run_cell(scene, {});
    EXPECT_EQ(cell.status, CellStatus::run);
    EXPECT_GE(cell.steps, cell.stable() ? cell.wanted_steps : 1);
    if (!cell.stable())
      found.shortest_unstable = std::min(found.shortest_unstable, *scene.integrator.time_step);
    else if (*scene.integrator.time_step < found.shortest_unstable)
      found.longest_stable = *scene.integrator.time_step;
    else
      found.stable_beyond = true;
  }
  return found;
}

class StabilityMapOf : public ::testing::TestWithParam<const char*> {};

TEST_P(StabilityMapOf, PinnedClothsChangesWhereTheSpectrumPredicts) {
  for (const int size : {4, 16, 64}) {
    const MeasuredLimit limit = measured_around(size, GetParam());
    ASSERT_TRUE(limit.bracketed()) << size;
    EXPECT_FALSE(limit.stable_beyond) << size;
    EXPECT_NEAR(limit.middle() / limit.limits.spectrum, 1, 0.03) << size;
    EXPECT_LE(limit.limits.predicted, 1.001 * limit.limits.spectrum) << size;
    EXPECT_LT(limit.limits.guaranteed, limit.limits.predicted) << size;
    EXPECT_GT(limit.limits.provot, 2 * limit.limits.predicted) << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, StabilityMapOf, ::testing::Values("semi-implicit-euler", "verlet"),
                         [](const auto& m) {
                           return std::string(m.param) == "verlet" ? "verlet" : "semi_implicit_euler";
                         });

/// A small map of time step over stiffness.
StabilityOptions small_map() {
  StabilityOptions options;
  options.methods = {"semi-implicit-euler", "verlet"};
  options.x = {time_step_path, 3e-4, 5e-3, 6, AxisScale::logarithmic};
  options.y = {all_stiffnesses_path, 50, 200, 3, AxisScale::logarithmic};
  return options;
}

TEST(StabilityMap, AgreesWithItsPredictionInEveryRow) {
  const StabilityMap map = run_stability_map(builtin_scene("corners-free"), small_map());
  EXPECT_TRUE(map.complete);
  EXPECT_EQ(map.rows, study_grid);
  for (const MethodMap& method : map.methods) {
    ASSERT_EQ(method.measured.size(), 3u);
    for (const MeasuredLimit& limit : method.measured) {
      ASSERT_TRUE(limit.bracketed());
      EXPECT_NEAR(limit.middle() / limit.limits.predicted, 1, 0.03) << method.method << " " << limit.other;
    }
    EXPECT_NEAR(largest_deviation(method), 1, 0.03);
  }
}

TEST(StabilityMap, IsTheSameTwiceAndHasItsColumns) {
  const Scene scene = builtin_scene("corners-free");
  StabilityOptions options = small_map();
  options.methods = {"verlet"};
  const std::string text = study_csv(run_stability_map(scene, options));
  EXPECT_EQ(text, study_csv(run_stability_map(scene, options)));
  const CsvTable table = parse_csv(text);
  const std::vector<std::string> columns{"method",
                                         "x",
                                         "y",
                                         "status",
                                         "energy_ratio",
                                         "predicted_limit_s",
                                         "guaranteed_limit_s",
                                         "provot_s",
                                         "spectrum_limit_s",
                                         "time_step_s",
                                         "growth_rate_per_s",
                                         "steps",
                                         "detail",
                                         "wanted_steps"};
  EXPECT_EQ(table.header, columns);
  EXPECT_EQ(table.rows.size(), 6u * 3);
  std::set<std::string> statuses;
  for (const auto& row : table.rows) {
    ASSERT_EQ(row.size(), columns.size());
    statuses.insert(row[3]);
  }
  EXPECT_TRUE(statuses.contains("accurate"));
  EXPECT_TRUE(statuses.contains("diverged"));
}

TEST(StabilityMap, WithTheTimeStepUprightMeasuresTheSameLimits) {
  StabilityOptions options = small_map();
  options.methods = {"verlet"};
  const auto upright = run_stability_map(builtin_scene("corners-free"), options).methods[0].measured;
  std::swap(options.x, options.y);
  const auto turned = run_stability_map(builtin_scene("corners-free"), options).methods[0].measured;
  ASSERT_EQ(turned.size(), upright.size());
  for (std::size_t k = 0; k < turned.size(); ++k) EXPECT_EQ(turned[k].middle(), upright[k].middle());
}

TEST(StabilityMap, DrawsAPredictedCurveWhereNoAxisIsTheTimeStep) {
  Scene scene = builtin_scene("corners-free");
  scene.integrator.time_step = 1e-3;
  StabilityOptions options{.methods = {"verlet"},
                           .x = {"springs.structural", 10, 1000, 4, AxisScale::logarithmic},
                           .y = {"cloth.mass", 0.1, 0.4, 2, AxisScale::linear}};
  const StabilityMap map = run_stability_map(scene, options);
  EXPECT_TRUE(map.methods[0].measured.empty());
  const HeatMap heat = study_plot(map);
  ASSERT_FALSE(heat.panels[0].curves.empty());
  for (const auto& [stiffness, mass] : heat.panels[0].curves[0].points) {
    EXPECT_GE(stiffness, 10);
    EXPECT_LE(stiffness, 1000);
  }
}

TEST(StabilityMap, ThatIsStoppedKeepsWhatItHas) {
  StabilityOptions options = small_map();
  options.progress = [](const StudyProgress& progress) { return progress.fraction < 0.3; };
  const StabilityMap map = run_stability_map(builtin_scene("corners-free"), options);
  EXPECT_FALSE(map.complete);
  EXPECT_EQ(map.methods[0].cells[0].status, CellStatus::run);
  EXPECT_EQ(map.methods[1].cells.back().status, CellStatus::not_run);
  EXPECT_EQ(parse_csv(study_csv(map)).rows.back()[3], "not-run");
  EXPECT_FALSE(to_svg(study_plot(map)).empty());
}

TEST(StabilityMap, KeepsTheLargestFrequencyOnItsSmallerGrid) {
  const Scene scene = builtin_scene("corners-free");
  StabilityOptions options = small_map();
  const Scene small = cell_scene(scene, options, "verlet", 1e-3, 100);
  options.full_size = true;
  const Scene full = cell_scene(scene, options, "verlet", 1e-3, 100);
  EXPECT_EQ(full.cloth.rows, 33);
  EXPECT_EQ(small.cloth.rows, study_grid);
  EXPECT_NEAR(predict_limits(small).predicted, predict_limits(full).predicted, 1e-15);
}

// ---- axes ----------------------------------------------------------------------------------------------

TEST(StudyAxisOption, GivesItsValuesWithBothEnds) {
  const auto axis = std::get<StudyAxis>(parse_axis("springs.shear=1:100:3:log", "--x"));
  EXPECT_EQ(axis.path, "springs.shear");
  const auto values = values_of(axis);
  ASSERT_EQ(values.size(), 3u);
  EXPECT_EQ(values.front(), 1);
  EXPECT_NEAR(values[1], 10, 1e-12);
  EXPECT_EQ(values.back(), 100);
  EXPECT_EQ(values_of(std::get<StudyAxis>(parse_axis("damping=0:1:5", "--y")))[2], 0.5);
}

TEST(StudyAxisOption, IsRefusedWithItsRule) {
  for (const char* text :
       {"", "damping", "damping=", "=1:2:3", "damping=1:2", "damping=1:2:x", "damping=1:2:3:exp",
        "damping=1:2:3:log:4", "damping=0:1:3:log", "damping=2:1:3", "damping=1:1:3", "damping=1:2:1",
        "damping=1:2:100000", "damping=nan:2:3", "damping=1:inf:3"}) {
    const auto axis = parse_axis(text, "--x");
    ASSERT_TRUE(std::holds_alternative<Problem>(axis)) << text;
    EXPECT_EQ(std::get<Problem>(axis).place, "--x") << text;
  }
}

TEST(StudyAxisOption, MustNameANumberThatTheSceneHasAndAccepts) {
  const Scene scene = builtin_scene("corners-free");
  for (const char* path : {"springs.bend", "cloth.origin", "integrator.method", "air.drag"}) {
    StabilityOptions options = small_map();
    options.y = {path, 1, 2, 2};
    EXPECT_FALSE(find_problems(scene, options).empty()) << path;
  }
  StabilityOptions options = small_map();
  options.y = {"springs.shear", -3, 2, 2};
  ASSERT_FALSE(find_problems(scene, options).empty());
  EXPECT_EQ(find_problems(scene, options)[0].text(), "--y: springs.shear = -3 N/m: must be >= 0");
  options.y = options.x;
  EXPECT_FALSE(find_problems(scene, options).empty());
  EXPECT_TRUE(find_problems(scene, small_map()).empty());
}

TEST(StudyAxisOption, OfAllStiffnessesKeepsTheirRatio) {
  Scene scene = builtin_scene("corners-free");
  ASSERT_FALSE(set_number(scene, all_stiffnesses_path, 300, "--y"));
  EXPECT_EQ(scene.springs->structural, 300);
  EXPECT_DOUBLE_EQ(scene.springs->shear, 150);
  EXPECT_DOUBLE_EQ(scene.springs->flexion, 30);
}

}  // namespace
}  // namespace cloth::test::stability_map_test
