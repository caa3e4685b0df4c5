// The study of grid convergence: its rows are single runs, its words follow from the values.
#include "study/grid_convergence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "study/grid_convergence_report.h"
#include "study/refined_scene.h"
#include "study/run_output.h"
#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "support/files.h"

namespace cloth::test::grid_convergence_test {
namespace {

Scene hung_by_corners() {
  Scene scene = builtin_scene("corners-free");
  scene.duration = 0.1;
  scene.record.interval = 0.02;
  return scene;
}

GridConvergenceOptions few_grids() {
  return {.cells = {4, 8, 12},
          .outputs = {"max_strain:max", "elastic_J", "lowest_point", "droop_ratio:mean"}};
}

/// A finished study of grids of a sheet 1 m wide, whose only output has these values.
GridConvergence made_up(const std::vector<int>& cells, const std::vector<double>& values) {
  GridConvergence study{.scene = hung_by_corners(), .outputs = {"elastic_J"}, .cells = cells};
  for (std::size_t k = 0; k < cells.size(); ++k)
    study.runs.push_back({.cells = cells[k],
                          .rows = cells[k] + 1,
                          .columns = cells[k] + 1,
                          .cell = 1.0 / cells[k],
                          .time_step = 0.001,
                          .steps = 100,
                          .end_time = 0.1,
                          .values = {values[k]}});
  return study;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(GridConvergence, OfASecondOrderSequenceTellsOrderLimitAndIndex) {
  std::vector<double> values;
  const std::vector<int> cells{8, 16, 32, 64};
  for (const int n : cells) values.push_back(2 + 3.0 / (n * n));
  const GridConvergence study = made_up(cells, values);
  const Richardson found = richardson_of(study, 0);
  EXPECT_NEAR(found.order, 2, 1e-9);
  EXPECT_NEAR(found.extrapolate, 2, 1e-12);
  EXPECT_NEAR(found.index, 1.25 * (values[3] - 2) / values[3], 1e-12);
  EXPECT_EQ(row_of(study, 0, 0).order, "");
  EXPECT_EQ(row_of(study, 0, 1).order, "") << "two grids show none";
  EXPECT_EQ(row_of(study, 0, 1).extrapolate, "") << "and nothing is assumed while more grids come";
  for (const std::size_t run : {2u, 3u}) {
    EXPECT_EQ(row_of(study, 0, run).order, "2.00");
    EXPECT_EQ(row_of(study, 0, run).extrapolate, "2");
  }
  EXPECT_EQ(row_of(study, 0, 3).index, "0.0458 %");
  const std::string text = study_text(study);
  EXPECT_TRUE(has(text, "Order 2.00 from the finest three grids, 2.00 from the three before")) << text;
  EXPECT_TRUE(has(text, "Extrapolated to cells without size: 2. Error of the finest value: 0.00092")) << text;
  const CsvTable table = table_of(study);
  const std::vector<double> orders =
      column_of({table.header, {table.rows[2], table.rows[3]}}, "elastic_J:order");
  for (const double order : orders) EXPECT_NEAR(order, 2, 1e-9);
  const auto json = nlohmann::json::parse(study_json(study))["outputs"][0];
  EXPECT_NEAR(json["order"].get<double>(), 2, 1e-9);
  EXPECT_EQ(json["verdict"], "converging");
  EXPECT_EQ(json["asymptotic"], true);
}

TEST(GridConvergence, SaysInWordsWhereThereIsNoOrder) {
  const std::string oscillates = study_text(made_up({4, 8, 16}, {1, 2, 1.5}));
  EXPECT_TRUE(has(oscillates, "change their sign: no order")) << oscillates;
  const std::string diverges = study_text(made_up({4, 8, 16}, {1, 2, 4}));
  EXPECT_TRUE(has(diverges, "do not shrink with the cells")) << diverges;
  const std::string two = study_text(made_up({4, 8}, {1, 0.75}));
  EXPECT_TRUE(has(two, "Two grids show no order; 2 is assumed.")) << two;
  EXPECT_EQ(row_of(made_up({4, 8}, {1, 0.75}), 0, 1).extrapolate, "0.66666667");
}

TEST(GridConvergence, PlotsErrorsOnlyWhereThereIsAnOrder) {
  const LinePlot none = study_plot(made_up({4, 8, 16}, {1, 2, 1.5}), GridPlot::errors);
  ASSERT_EQ(none.series.size(), 1u);
  EXPECT_TRUE(none.series[0].points.empty());
  EXPECT_EQ(none.series[0].detail, "no order: oscillating");
  const GridConvergence study = made_up({4, 8, 16}, {3, 2, 1.5});
  const LinePlot errors = study_plot(study, GridPlot::errors);
  ASSERT_EQ(errors.series.size(), 1u);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(errors.series[0].points[k].y, std::abs(study.runs[k].values[0] - 1), 1e-12);
  const LinePlot values = study_plot(study);
  EXPECT_EQ(values.series.back().points.front().x, 0);
  EXPECT_NEAR(values.series.back().points.front().y, 1, 1e-12);
}

TEST(GridConvergence, HasTheRowsOfSingleRunsToTheBit) {
  for (const std::optional<double> time_step : {std::optional<double>(0.0005), std::optional<double>()}) {
    Scene scene = hung_by_corners();
    scene.integrator.time_step = time_step;
    const GridConvergence study = run_grid_convergence(scene, few_grids());
    ASSERT_TRUE(study.is_complete());
    for (const GridRun& run : study.runs) {
      Scene alone = scene;
      alone.cloth.rows = alone.cloth.columns = run.cells + 1;
      const TemporaryFolder folder;
      const RunResult result = run_scene(alone, {.folder = folder.path(), .progress = {}});
      const CsvTable record = parse_csv(content_of(folder / "record.csv"));
      EXPECT_EQ(run.values[1], column_of(record, "elastic_J").back());
      const auto strains = column_of(record, "max_strain");
      EXPECT_EQ(run.values[0], *std::max_element(strains.begin(), strains.end()));
      const double* heights = result.final_state.position.y();
      EXPECT_EQ(run.values[2], *std::min_element(heights, heights + result.final_state.position.size()));
      EXPECT_GT(run.values[3], 0);
      EXPECT_EQ(run.time_step, result.summary.time_step);
      EXPECT_EQ(run.steps, result.summary.count.steps);
    }
  }
}

TEST(GridConvergence, OfFreeFallIsUnchangedAndTheFallItself) {
  Scene scene = builtin_scene("free-fall");
  scene.duration = 0.25;
  scene.integrator.time_step = 0.001;
  const GridConvergence study =
      run_grid_convergence(scene, {.cells = {4, 8, 16}, .outputs = {"lowest_point", "lowest_point:max"}});
  const Richardson found = richardson_of(study, 0), highest = richardson_of(study, 1);
  EXPECT_EQ(found.verdict, GridVerdict::unchanged) << found.words;
  EXPECT_EQ(highest.verdict, GridVerdict::unchanged) << highest.words;
  const double fall = 0.5 * gravity_of(scene).norm() * 0.25 * 0.25;
  EXPECT_NEAR(highest.extrapolate - found.extrapolate, fall, 1e-12);
  EXPECT_EQ(row_of(study, 0, 2).order, "unchanged");
}

/// Rows that hang from the top edge by structural springs alone, at rest. A spring carries the particles
/// below it, each m = M/(n + 1)^2: its column is longer by sum j m g/k = M g/(2 k) n/(n + 1).
TEST(GridConvergence, OfAHangingSheetIsThatOfTheClosedForm) {
  Scene scene = hung_by_corners();
  scene.cloth.pins = {NamedPin::top_edge};
  scene.cloth.down = {0, -1, 0};
  scene.springs = SpringMaterial{.structural = 100};
  scene.damping = 0.05;
  scene.duration = 20;
  const GridConvergence study = run_grid_convergence(scene, {.cells = {8, 16, 32, 64}, .outputs = {"sag"}});
  const double longest = scene.cloth.mass * gravity_of(scene).norm() / (2 * 100);
  for (const GridRun& run : study.runs)
    EXPECT_NEAR(run.values[0], 1 + longest * run.cells / (run.cells + 1), 1e-9) << run.cells;
  const Richardson found = richardson_of(study, 0);
  const double expected =  // of n/(n + 1) on 16, 32 and 64 cells
      std::log2((32.0 / 33 - 16.0 / 17) / (64.0 / 65 - 32.0 / 33));
  EXPECT_NEAR(found.order, expected, 1e-4);
  EXPECT_TRUE(found.is_asymptotic) << found.words;
  EXPECT_NEAR(found.extrapolate, 1 + longest, 0.1 * std::abs(study.runs.back().values[0] - 1 - longest));
  EXPECT_LT(std::abs(study.runs.back().values[0] - 1 - longest), found.band);
}

TEST(GridConvergence, KeepsARunThatFailsAsARowWithTheReason) {
  Scene scene = hung_by_corners();
  scene.integrator.time_step = 0.004;
  scene.duration = 1;
  const GridConvergence study = run_grid_convergence(scene, {.cells = {2, 4, 64}});
  ASSERT_TRUE(study.is_complete());
  EXPECT_EQ(study.runs[1].status, GridRunStatus::finished) << study.runs[1].detail;
  EXPECT_EQ(study.runs[2].status, GridRunStatus::diverged);
  EXPECT_TRUE(has(study.runs[2].detail, "diverged in step")) << study.runs[2].detail;
  EXPECT_TRUE(std::isnan(study.runs[2].values[0]));
  EXPECT_EQ(richardson_of(study, 0).verdict, GridVerdict::two_grids);
  EXPECT_TRUE(has(study_text(study), "64 cells: diverged: ")) << study_text(study);
  EXPECT_FALSE(study_plot(study).series.front().failed.empty());
}

TEST(GridConvergence, RefusesAGridOnWhichTheSceneBreaksARule) {
  Scene scene = hung_by_corners();
  scene.self_contact = SelfContact{.thickness = 0.1};
  const GridConvergence study = run_grid_convergence(scene, {.cells = {2, 4, 8}});
  EXPECT_EQ(study.runs[1].status, GridRunStatus::finished) << study.runs[1].detail;
  EXPECT_EQ(study.runs[2].status, GridRunStatus::refused);
  EXPECT_TRUE(has(study.runs[2].detail, "self_contact.thickness")) << study.runs[2].detail;
  EXPECT_EQ(study.runs[2].time_step, 0);
  EXPECT_FALSE(run_of(study, 2));
}

TEST(GridConvergence, FindsEveryProblemOfItsOptions) {
  const Scene scene = hung_by_corners();
  EXPECT_TRUE(find_problems(scene, few_grids()).empty());
  const auto problems =
      find_problems(scene, {.cells = {8, 4}, .outputs = {"speed", "elastic_J"}, .time = 1e30});
  ASSERT_GE(problems.size(), 3u);
  EXPECT_EQ(problems[0].path, "--cells");
  EXPECT_TRUE(has(problems[1].rule, "speed: must be one of time_s")) << problems[1].rule;
  EXPECT_EQ(problems[2].path, "--time");
  EXPECT_TRUE(broken_outputs_rule({"elastic_J", "elastic_J"}, {"elastic_J"}));
  EXPECT_FALSE(broken_outputs_rule({"elastic_J", "elastic_J:max"}, {"elastic_J"}));
  EXPECT_TRUE(broken_outputs_rule({"step_time_us"}, output_sources(scene))) << "is of the machine";
}

TEST(GridConvergence, WarnsOfWhatIsAnotherThingOnAnotherGrid) {
  Scene scene = hung_by_corners();
  scene.air = Air{.drag = 0.01, .gust = {}};
  GridConvergence study = plan_grid_convergence(scene, few_grids());
  std::string all;
  for (const std::string& caution : cautions_of(study)) all += caution + "\n";
  for (const char* part : {"springs.flexion", "damping, air.drag are per particle", "step is auto"})
    EXPECT_TRUE(has(all, part)) << part << all;
  study.scene.springs->flexion = 0;
  study.scene.damping.reset();
  study.scene.air.reset();
  EXPECT_EQ(cautions_of(study).size(), 2u) << "edges, and the step";
}

/// All columns but the measured time.
CsvTable without_time(const GridConvergence& study) {
  return without_column(table_of(study), "wall_s");
}

TEST(GridConvergence, GoesOnWhereItWasStopped) {
  const Scene scene = hung_by_corners();
  const GridConvergence whole = run_grid_convergence(scene, few_grids());
  const TemporaryFolder folder;
  for (int runs = 1; runs <= 3; ++runs) {
    GridConvergenceOptions options = few_grids();
    StudyRecorder recorder;
    ASSERT_FALSE(recorder.begin(folder.path(), plan_grid_convergence(scene, options), {}));
    ASSERT_EQ(recorder.earlier() != nullptr, runs > 1);
    if (recorder.earlier()) options.earlier = &std::get<GridConvergence>(*recorder.earlier());
    std::size_t made = 0;
    options.partial = [&](const GridConvergence& so_far) {
      made = so_far.runs.size();
      EXPECT_FALSE(recorder.keep(so_far));
    };
    options.stop = [&] { return made == static_cast<std::size_t>(runs); };
    const GridConvergence study = run_grid_convergence(scene, options);
    EXPECT_EQ(finished_runs(study), runs);
    if (runs < 3) continue;
    EXPECT_EQ(without_time(study).rows, without_time(whole).rows);
    ASSERT_FALSE(recorder.end(study, 1));
  }
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  const auto& back = std::get<GridConvergence>(reading.study->table);
  EXPECT_EQ(without_time(back).rows, without_time(whole).rows);
  for (const GridPlot what : {GridPlot::values, GridPlot::errors})
    EXPECT_EQ(to_svg(study_plot(back, what)), to_svg(study_plot(whole, what)));
  EXPECT_EQ(nlohmann::json::parse(study_json(back))["outputs"],
            nlohmann::json::parse(study_json(whole))["outputs"]);
}

TEST(GridConvergence, RefusesToGoOnWithOtherOutputs) {
  const Scene scene = hung_by_corners();
  const TemporaryFolder folder;
  GridConvergence study = run_grid_convergence(scene, {.cells = {4, 8}});
  study.runs.pop_back();
  {
    StudyRecorder recorder;
    ASSERT_FALSE(recorder.begin(folder.path(), plan_grid_convergence(scene, {.cells = {4, 8}}), {}));
    ASSERT_FALSE(recorder.keep(study));
  }
  StudyRecorder recorder;
  const auto error = recorder.begin(
      folder.path(), plan_grid_convergence(scene, {.cells = {4, 8}, .outputs = {"kinetic_J"}}), {});
  ASSERT_TRUE(error);
  EXPECT_TRUE(has(error->text(), "outputs")) << error->text();
}

TEST(GridConvergence, OpensARunAsItWasRun) {
  const Scene scene = hung_by_corners();
  const GridConvergence study = run_grid_convergence(scene, few_grids());
  const auto run = run_of(study, 2);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->name, "12 x 12 cells");
  EXPECT_EQ(run->scene.cloth.columns, 13);
  EXPECT_EQ(run->scene.integrator.time_step, study.runs[2].time_step);
  const RunResult again = run_scene(run->scene, {});
  EXPECT_EQ(again.final_state.time, study.runs[2].end_time);
}

TEST(GridConvergence, TakesTheMeanOfTheLinesBetweenRows) {
  Scene scene = builtin_scene("free-fall");
  scene.integrator.time_step = 0.01;
  scene.record.interval = 0.1;
  scene.duration = 0.2;
  const GridConvergence study = run_grid_convergence(
      scene, {.cells = {2, 4}, .outputs = {"time_s:mean", "time_s:max", "time_s:min", "step"}});
  for (const GridRun& run : study.runs) {
    EXPECT_NEAR(run.values[0], 0.1, 1e-15);
    EXPECT_EQ(run.values[1], run.end_time);
    EXPECT_EQ(run.values[2], 0);
    EXPECT_EQ(run.values[3], 20);
  }
}

}  // namespace
}  // namespace cloth::test::grid_convergence_test
