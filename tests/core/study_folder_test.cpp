// A study as a folder comes back as it was written, and grows run by run to what is returned.
#include "study/study_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "study/extremes_report.h"
#include "study/iterations_report.h"
#include "study/stability_report.h"
#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "study/work_precision_report.h"
#include "support/files.h"
#include "support/small_studies.h"

namespace cloth::test::study_folder_test {
namespace {

void write_file(const std::filesystem::path& path, const std::string& text) {
  ASSERT_FALSE(write_text_file(path, text));
}

WorkPrecisionOptions few_runs() {
  WorkPrecisionOptions options;
  options.methods = {"verlet", "dormand-prince"};
  options.horizon = 0.2;
  options.repeats = 2;
  options.steps_per_method = 3;
  return options;
}

Scene small_cloth() {
  Scene scene = builtin_scene("corners-free");
  scene.cloth.rows = scene.cloth.columns = 5;
  return scene;
}

ExtremesOptions few_cases() {
  return {.methods = {"verlet", "explicit-euler"}, .cases = {"cloth-2x2", "step-1s"}};
}

Study read_back(const TemporaryFolder& folder, const StudyTable& table) {
  const auto error = StudyRecorder::write(folder.path(), table, "the command", 1.25);
  EXPECT_FALSE(error) << error->text();
  StudyReading reading = read_study(folder.path());
  EXPECT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(reading.study->command, "the command");
  EXPECT_EQ(reading.study->wall, 1.25);
  return std::move(*reading.study);
}

TEST(StudyFolder, WorkPrecisionComesBackAsItWasWritten) {
  const WorkPrecision study = study_work_precision(builtin_scene("pendulum"), few_runs());
  const TemporaryFolder folder;
  const auto back = std::get<WorkPrecision>(read_back(folder, study).table);
  EXPECT_EQ(study_csv(back), study_csv(study));
  EXPECT_EQ(sample_table(back).rows, sample_table(study).rows);
  for (const PlotAgainst against : {PlotAgainst::run_time, PlotAgainst::step, PlotAgainst::force_evaluations})
    EXPECT_EQ(to_svg(study_plot(back, against)), to_svg(study_plot(study, against)));
}

TEST(StudyFolder, AStabilityMapComesBackAsItWasWritten) {
  const Scene scene = small_cloth();
  const StabilityMap map = run_stability_map(scene, small_map(scene));
  const TemporaryFolder folder;
  const auto back = std::get<StabilityMap>(read_back(folder, map).table);
  EXPECT_EQ(study_csv(back), study_csv(map));
  EXPECT_EQ(study_json(back), study_json(map));
  EXPECT_EQ(to_svg(study_plot(back)), to_svg(study_plot(map)));
}

TEST(StudyFolder, ExtremesComeBackAsTheyWereWritten) {
  const ExtremesTable table = run_extremes(few_cases());
  const TemporaryFolder folder;
  const auto back = std::get<ExtremesTable>(read_back(folder, table).table);
  EXPECT_EQ(study_csv(back), study_csv(table));
  EXPECT_EQ(study_text(back), study_text(table));
  EXPECT_EQ(to_svg(study_plot(back)), to_svg(study_plot(table)));
}

IterationsOptions few_iterations() {
  IterationsOptions options;
  options.methods = {"implicit-euler", "projective", "vbd"};
  options.step = 0.005, options.time = 0.05, options.repeats = 1, options.most = 8;
  return options;
}

TEST(StudyFolder, IterationsComeBackAsTheyWereWritten) {
  const IterationsStudy study = run_iterations_study(small_cloth(), few_iterations());
  ASSERT_TRUE(study.is_complete());
  const TemporaryFolder folder;
  const auto back = std::get<IterationsStudy>(read_back(folder, study).table);
  EXPECT_TRUE(back.is_complete());
  EXPECT_EQ(study_csv(back), study_csv(study));
  EXPECT_EQ(study_json(back), study_json(study));
  for (const IterationsAgainst against : {IterationsAgainst::iterations, IterationsAgainst::time})
    EXPECT_EQ(to_svg(study_plot(back, against)), to_svg(study_plot(study, against)));
  std::string text = content_of(folder / "iterations.csv");
  text.replace(text.find("projective"), 10, "verlet");
  write_file(folder / "iterations.csv", text);
  const StudyReading reading = read_study(folder.path());
  EXPECT_NE(reading.problem.find("iterations.csv"), std::string::npos) << reading.problem;
}

TEST(StudyFolder, IterationsThatWereStoppedGoOnWithTheMethodsThatAreFinished) {
  const Scene scene = small_cloth();
  IterationsOptions options = few_iterations();
  const TemporaryFolder folder;
  IterationsStudy stopped;
  {
    StudyRecorder recorder;
    ASSERT_FALSE(recorder.begin(folder.path(), plan_iterations_study(scene, options), {}));
    IterationsOptions cut = options;
    bool is_over = false;
    cut.stop = [&is_over] { return is_over; };
    cut.partial = [&](const IterationsStudy& so_far) {
      EXPECT_FALSE(recorder.keep(so_far));
      is_over = so_far.methods.size() == 2 && so_far.methods[1].steps.size() == 2;
    };
    stopped = run_iterations_study(scene, cut);  // and is killed: there is no end()
  }
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(finished_runs(stopped), static_cast<int>(stopped.methods[0].steps.size()) + 2);
  const StudyReading killed = read_study(folder.path());
  ASSERT_TRUE(killed.study) << killed.problem;
  EXPECT_FALSE(is_complete(killed.study->table));
  EXPECT_EQ(study_csv(killed.study->table), study_csv(stopped));
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), plan_iterations_study(scene, options), {}));
  ASSERT_TRUE(recorder.earlier());
  options.earlier = &std::get<IterationsStudy>(*recorder.earlier());
  ASSERT_EQ(options.earlier->methods.size(), 1u);  // the second was under way
  options.partial = [&](const IterationsStudy& so_far) { EXPECT_FALSE(recorder.keep(so_far)); };
  const IterationsStudy whole = run_iterations_study(scene, options);
  EXPECT_TRUE(whole.is_complete());
  ASSERT_EQ(whole.methods.size(), 3u);
  for (std::size_t k = 0; k < whole.methods[0].steps.size(); ++k)
    EXPECT_EQ(whole.methods[0].steps[k].seconds, stopped.methods[0].steps[k].seconds);
  ASSERT_FALSE(recorder.end(whole, 0));
  EXPECT_EQ(study_csv(read_study(folder.path()).study->table), study_csv(whole));
}

TEST(StudyFolder, SaysWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  EXPECT_NE(read_study(folder.path()).problem.find("study.json"), std::string::npos);
  ASSERT_FALSE(StudyRecorder::write(folder.path(), run_extremes(few_cases()), "", 0));
  const auto path = folder / "extremes.csv";
  std::string text = content_of(path);
  text.replace(text.find("diverged"), 8, "exploded");
  write_file(path, text);
  const StudyReading reading = read_study(folder.path());
  EXPECT_FALSE(reading.study);
  EXPECT_NE(reading.problem.find("extremes.csv, line 2, status: \"exploded\" is not a status"),
            std::string::npos)
      << reading.problem;
  write_file(folder / "study.json", "{");
  EXPECT_FALSE(read_study(folder.path()).study);
  write_file(folder / "study.json", "{\"format\": \"clothlab/study/1\", \"kind\": 3}");
  EXPECT_FALSE(read_study(folder.path()).study);
}

/// A part of a study has gaps: a row is placed by what it says.
TEST(StudyFolder, NamesTheRowThatIsNoneOfItsCellsOrIsThereTwice) {
  const Scene scene = small_cloth();
  const TemporaryFolder folder;
  const StabilityMap map = run_stability_map(scene, small_map(scene));
  ASSERT_FALSE(StudyRecorder::write(folder.path(), map, "", 0));
  auto index = nlohmann::ordered_json::parse(content_of(folder / "study.json"));
  index.erase("files");  // no digests: the study is being made
  index["complete"] = false;
  write_file(folder / "study.json", index.dump());
  const CsvTable table = table_of(map);
  for (const auto& [x, rule] : {std::pair<std::string, std::string>{table.rows[3][1], "are there already"},
                                {"infinity", "is not on its axis"},
                                {"1e-30", "is not on its axis"}}) {
    CsvTable changed = table;
    changed.rows[2][1] = x;
    std::swap(changed.rows.front(), changed.rows.back());
    write_file(folder / "stability.csv", csv_text(changed, "\n"));
    const StudyReading reading = read_study(folder.path());
    EXPECT_FALSE(reading.study) << x;
    EXPECT_NE(reading.problem.find("stability.csv, line "), std::string::npos) << reading.problem;
    EXPECT_NE(reading.problem.find(rule), std::string::npos) << reading.problem;
  }
  CsvTable turned = table;
  std::reverse(turned.rows.begin(), turned.rows.end());
  write_file(folder / "stability.csv", csv_text(turned, "\n"));
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(study_csv(reading.study->table), study_csv(map));
}

/// A study that goes on writes its index before its table, and another part may read both in between.
TEST(StudyFolder, OfAMapThatIsBeingMadeMayHaveLimitsOfCellsThatAreToCome) {
  const Scene scene = small_cloth();
  const TemporaryFolder folder;
  const StabilityMap map = run_stability_map(scene, small_map(scene));
  ASSERT_FALSE(map.methods.front().measured.empty());
  ASSERT_FALSE(StudyRecorder::write(folder.path(), map, "", 0));
  auto index = nlohmann::ordered_json::parse(content_of(folder / "study.json"));
  index.erase("files");
  CsvTable table = table_of(map);
  while (!table.rows.empty()) {
    table.rows.pop_back();
    write_file(folder / "stability.csv", csv_text(table, "\n"));
    index["complete"] = false;
    write_file(folder / "study.json", index.dump());
    const StudyReading reading = read_study(folder.path());
    ASSERT_TRUE(reading.study) << table.rows.size() << " rows: " << reading.problem;
    for (const MethodMap& method : std::get<StabilityMap>(reading.study->table).methods)
      for (const MeasuredLimit& limit : method.measured)
        EXPECT_GT(limit.limits.predicted, 0) << "a limit of cells that are not there";
    index["complete"] = true;
    write_file(folder / "study.json", index.dump());
    EXPECT_FALSE(read_study(folder.path()).study) << table.rows.size() << " rows";
  }
}

TEST(StudyFolder, TheLastPartialWorkPrecisionIsTheFinalOne) {
  WorkPrecisionOptions options = few_runs();
  std::string last;
  int previous = 0;
  options.partial = [&](const WorkPrecision& so_far) {
    EXPECT_GE(finished_runs(so_far), previous);
    previous = finished_runs(so_far);
    last = study_csv(so_far);
  };
  const WorkPrecision study = study_work_precision(builtin_scene("pendulum"), options);
  EXPECT_EQ(last, study_csv(study));
  EXPECT_EQ(previous, finished_runs(study));
}

TEST(StudyFolder, TheLastPartialMapIsTheFinalOne) {
  const Scene scene = small_cloth();
  StabilityOptions options = small_map(scene);
  std::string last;
  int calls = 0;
  options.partial = [&](const StabilityMap& so_far) {
    ++calls;
    last = study_csv(so_far) + study_json(so_far);
  };
  const StabilityMap map = run_stability_map(scene, options);
  EXPECT_EQ(last, study_csv(map) + study_json(map));
  EXPECT_GE(calls, 2 * 4 * 3);
}

TEST(StudyFolder, TheLastPartialTableOfExtremesIsTheFinalOne) {
  ExtremesOptions options = few_cases();
  std::string last;
  options.partial = [&](const ExtremesTable& so_far) { last = study_csv(so_far); };
  const ExtremesTable table = run_extremes(options);
  EXPECT_EQ(last, study_csv(table));
}

TEST(StudyStop, EndsEveryStudyAtItsNextStepAndKeepsWhatIsFinished) {
  std::stop_source stop;
  int runs = 0;
  WorkPrecisionOptions precision = few_runs();
  precision.stop = [&stop] { return stop.stop_requested(); };
  precision.partial = [&](const WorkPrecision& so_far) {
    if ((runs = finished_runs(so_far)) == 2) stop.request_stop();
  };
  const WorkPrecision study = study_work_precision(builtin_scene("pendulum"), precision);
  EXPECT_TRUE(study.stopped);
  EXPECT_EQ(finished_runs(study), 2);

  const Scene scene = small_cloth();
  StabilityOptions options = small_map(scene);
  options.stop = [&stop] { return stop.stop_requested(); };  // requested already
  const StabilityMap map = run_stability_map(scene, options);
  EXPECT_FALSE(map.complete);
  EXPECT_EQ(finished_runs(map), 0);

  ExtremesOptions extremes = few_cases();
  extremes.stop = [&stop] { return stop.stop_requested(); };
  EXPECT_TRUE(run_extremes(extremes).cells.empty());
}

TEST(StudyStop, AStoppedStudyComesBackFromItsFolderToo) {
  const Scene scene = small_cloth();
  StabilityOptions options = small_map(scene);
  std::stop_source stop;
  options.stop = [&stop] { return stop.stop_requested(); };
  options.partial = [&](const StabilityMap& so_far) {
    if (finished_runs(so_far) == 5) stop.request_stop();
  };
  const StabilityMap map = run_stability_map(scene, options);
  const TemporaryFolder folder;
  const StudyTable back = read_back(folder, map).table;
  EXPECT_FALSE(is_complete(back));
  EXPECT_EQ(finished_runs(back), 5);
  EXPECT_EQ(study_csv(back), study_csv(map));
}

TEST(StudyRuns, AreTheSceneThatWasRun) {
  const WorkPrecision study = study_work_precision(builtin_scene("pendulum"), few_runs());
  const WorkPrecisionRun& first = study.methods[0].runs[0];
  const auto run = run_of(study, 0);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->scene.integrator.method, "verlet");
  EXPECT_EQ(run->scene.integrator.time_step, first.time_step);
  EXPECT_EQ(run->status, name_of(first.status));
  EXPECT_FALSE(run_of(study, -1));
  EXPECT_FALSE(run_of(study, finished_runs(study)));

  const Scene scene = small_cloth();
  const StabilityMap map = run_stability_map(scene, small_map(scene));
  const auto cell = run_of(map, 4 * 3 + 5);  // of the second method
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->scene.integrator.method, "rk4");
  EXPECT_EQ(cell->scene.springs->structural, map.methods[1].cells[5].y);
  EXPECT_EQ(cell->scene.integrator.time_step, map.methods[1].cells[5].x);
}

TEST(ExtremesOfAScene, BeginWithTheSceneItselfAndAreAllValid) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const auto cases = extreme_cases_of(builtin_scene(builtin.name));
    ASSERT_GT(cases.size(), 5u) << builtin.name;
    EXPECT_EQ(cases.front().name, "as-it-is");
    EXPECT_EQ(cases.front().scene.cloth, builtin_scene(builtin.name).cloth);
  }
}

}  // namespace
}  // namespace cloth::test::study_folder_test
