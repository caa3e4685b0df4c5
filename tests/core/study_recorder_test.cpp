// A study that is stopped or killed goes on, and ends as if it had not been.
#include "study/study_recorder.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "study/extremes_report.h"
#include "study/reference_solution.h"
#include "study/stability_report.h"
#include "study/study_runs.h"
#include "study/work_precision_report.h"
#include "support/files.h"
#include "support/small_studies.h"

namespace cloth::test::study_recorder_test {
namespace {

Scene small_cloth() {
  Scene scene = builtin_scene("corners-free");
  scene.cloth.rows = scene.cloth.columns = 4;
  return scene;
}

/// Makes the map in a folder until `cells` more cells are there, as if it were killed then: nothing is ended.
void make_some_cells(const std::filesystem::path& folder, int cells) {
  const Scene scene = small_cloth();
  StabilityOptions options = small_map(scene);
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder, plan_stability_map(scene, options), {.command = "a test"}));
  if (recorder.earlier()) options.earlier = &std::get<StabilityMap>(*recorder.earlier());
  const int before = recorder.earlier() ? finished_runs(*recorder.earlier()) : 0;
  int calls = 0;
  std::stop_source stop;
  options.stop = [&stop] { return stop.stop_requested(); };
  options.partial = [&](const StabilityMap& map) {
    if (calls++ > 1000 || finished_runs(map) >= before + cells) stop.request_stop();
    EXPECT_FALSE(recorder.keep(map));
  };
  run_stability_map(scene, options);
}

TEST(StudyRecorder, OfAMapThatIsKilledAgainAndAgainEndsWithTheSameMap) {
  const Scene scene = small_cloth();
  const StabilityMap whole = run_stability_map(scene, small_map(scene));
  const TemporaryFolder folder;
  for (int kill = 1; kill <= 5; ++kill) {
    make_some_cells(folder.path(), 4);
    const StudyReading reading = read_study(folder.path());
    ASSERT_TRUE(reading.study) << reading.problem;
    EXPECT_FALSE(is_complete(reading.study->table));
    EXPECT_GE(finished_runs(reading.study->table), 4 * kill);
  }
  StabilityOptions options = small_map(scene);
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), plan_stability_map(scene, options), {.command = "a test"}));
  ASSERT_TRUE(recorder.earlier());
  options.earlier = &std::get<StabilityMap>(*recorder.earlier());
  int run = 0;
  options.partial = [&](const StabilityMap& map) {
    run = finished_runs(map) - finished_runs(*recorder.earlier());
    EXPECT_FALSE(recorder.keep(map));
  };
  const StabilityMap map = run_stability_map(scene, options);
  EXPECT_LE(run, 4);
  EXPECT_EQ(study_csv(map), study_csv(whole));
  EXPECT_EQ(study_json(map), study_json(whole));
  ASSERT_FALSE(recorder.end(map, 1));
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(study_json(std::get<StabilityMap>(reading.study->table)), study_json(whole));
  EXPECT_FALSE(std::filesystem::exists(folder / ".clothlab"));
}

TEST(StudyRecorder, RefusesToGoOnWithOtherInputsUnlessItMayOverwrite) {
  const TemporaryFolder folder;
  make_some_cells(folder.path(), 4);
  const Scene scene = small_cloth();
  StabilityOptions options = small_map(scene);
  options.criterion.periods = 21;
  Scene other = scene;
  other.cloth.mass *= 2;
  StudyRecorder recorder;
  const auto of_options = recorder.begin(folder.path(), plan_stability_map(scene, options), {});
  ASSERT_TRUE(of_options);
  EXPECT_TRUE(of_options->refused);
  EXPECT_NE(of_options->text().find("criterion"), std::string::npos) << of_options->text();
  const auto of_scene = recorder.begin(folder.path(), plan_stability_map(other, small_map(scene)), {});
  ASSERT_TRUE(of_scene);
  EXPECT_NE(of_scene->text().find("the scene"), std::string::npos) << of_scene->text();
  EXPECT_GE(finished_runs(read_study(folder.path()).study->table), 4) << "nothing was touched";
  ASSERT_FALSE(recorder.begin(folder.path(), plan_stability_map(other, options), {.overwrite = true}));
  EXPECT_FALSE(recorder.earlier());
}

TEST(StudyRecorder, MakesAFinishedStudyAnew) {
  const TemporaryFolder folder;
  const ExtremesOptions options{.methods = {"verlet"}, .cases = {"cloth-2x2"}};
  ASSERT_FALSE(StudyRecorder::write(folder.path(), run_extremes(options), "a test", 1));
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), empty_table(options), {}));
  EXPECT_FALSE(recorder.earlier());
}

TEST(StudyRecorder, OfExtremesGoesOnAfterTheLastCell) {
  const TemporaryFolder folder;
  ExtremesOptions options{.methods = {"verlet", "rk4"}, .cases = {"cloth-2x2", "step-1s"}};
  const ExtremesTable whole = run_extremes(options);
  {
    StudyRecorder recorder;
    ASSERT_FALSE(recorder.begin(folder.path(), empty_table(options), {}));
    ExtremesTable three = whole;
    three.cells.resize(3);
    ASSERT_FALSE(recorder.keep(three));
  }
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), empty_table(options), {}));
  ASSERT_TRUE(recorder.earlier());
  options.earlier = &std::get<ExtremesTable>(*recorder.earlier());
  int calls = 0;
  options.partial = [&](const ExtremesTable& table) {
    ++calls;
    EXPECT_FALSE(recorder.keep(table));
  };
  const ExtremesTable table = run_extremes(options);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(study_text(table), study_text(whole));
  ASSERT_FALSE(recorder.end(table, 0));
  EXPECT_EQ(study_csv(read_study(folder.path()).study->table), study_csv(table));
}

WorkPrecisionOptions precision_options() {
  WorkPrecisionOptions options;
  options.methods = {"verlet", "dormand-prince"};
  options.horizon = 0.2;
  options.repeats = 2;
  options.steps_per_method = 3;
  return options;
}

/// All columns but those of measured times.
std::vector<std::vector<std::string>> without_times(const WorkPrecision& study) {
  CsvTable table = table_of(study);
  for (const char* time : {"wall_s", "wall_median_s", "wall_lower_quartile_s", "wall_upper_quartile_s"})
    table = without_column(table, time);
  return table.rows;
}

TEST(StudyRecorder, OfWorkPrecisionKeepsRunsAndTimings) {
  const Scene scene = builtin_scene("pendulum");
  const WorkPrecision whole = study_work_precision(scene, precision_options());
  const TemporaryFolder folder;
  const int runs = finished_runs(whole);
  std::size_t timed = 0;
  for (const int last : {1, 3, runs, runs}) {  // killed among the runs, then twice among the timings
    WorkPrecisionOptions options = precision_options();
    StudyRecorder recorder;
    ASSERT_FALSE(recorder.begin(folder.path(), plan_work_precision(scene, options), {}));
    if (recorder.earlier()) options.earlier = &std::get<WorkPrecision>(*recorder.earlier());
    std::stop_source stop;
    options.stop = [&stop] { return stop.stop_requested(); };
    std::size_t now = 0;
    options.partial = [&](const WorkPrecision& so_far) {
      now = sample_table(so_far).rows.size();
      if (finished_runs(so_far) >= last && now >= timed + (last == runs ? 3 : 0)) stop.request_stop();
      EXPECT_FALSE(recorder.keep(so_far));
    };
    study_work_precision(scene, options);
    timed = now;
  }
  WorkPrecisionOptions options = precision_options();
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), plan_work_precision(scene, options), {}));
  ASSERT_TRUE(recorder.earlier());
  const auto& earlier = std::get<WorkPrecision>(*recorder.earlier());
  const auto kept = sample_table(earlier).rows;
  EXPECT_GE(kept.size(), 6u);
  options.earlier = &earlier;
  options.partial = [&](const WorkPrecision& so_far) { EXPECT_FALSE(recorder.keep(so_far)); };
  const WorkPrecision study = study_work_precision(scene, options);
  EXPECT_FALSE(study.stopped);
  EXPECT_EQ(without_times(study), without_times(whole));
  const auto samples = sample_table(study).rows;
  EXPECT_EQ(samples.size(), sample_table(whole).rows.size());
  for (const auto& row : kept) EXPECT_NE(std::find(samples.begin(), samples.end(), row), samples.end());
  ASSERT_FALSE(recorder.end(study, 0));
  EXPECT_EQ(study_csv(read_study(folder.path()).study->table), study_csv(study));
}

/// Makes the study in the folder until it has `last` runs, as if it were killed then; all of it without
/// `last`. Says whether the reference was solved.
struct Part {
  WorkPrecision study;
  bool solved_reference = false;
};
Part make_part(const Scene& scene, const std::filesystem::path& folder, std::optional<int> last) {
  Part part;
  WorkPrecisionOptions options = precision_options();
  StudyRecorder recorder;
  EXPECT_FALSE(recorder.begin(folder, plan_work_precision(scene, options), {}));
  if (recorder.earlier()) options.earlier = &std::get<WorkPrecision>(*recorder.earlier());
  std::stop_source stop;
  options.stop = [&stop] { return stop.stop_requested(); };
  options.partial = [&](const WorkPrecision& so_far) {
    EXPECT_FALSE(recorder.keep(so_far));
    if (last && finished_runs(so_far) >= *last) stop.request_stop();
  };
  options.progress = [&](const StudyProgress& progress) {
    part.solved_reference |= progress.text == "solving the reference";
    return true;
  };
  part.study = study_work_precision(scene, options);
  if (!last) {
    EXPECT_FALSE(recorder.end(part.study, 0));
  }
  return part;
}

TEST(StudyRecorder, OfWorkPrecisionSolvesItsReferenceOnce) {
  Scene limited = builtin_scene("pendulum");
  limited.deformation = Deformation{.rate = 0.01};
  for (const Scene& scene : {builtin_scene("pendulum"), limited}) {
    const WorkPrecision whole = study_work_precision(scene, precision_options());
    const TemporaryFolder folder;
    EXPECT_TRUE(make_part(scene, folder.path(), 0).solved_reference);  // killed before the first run
    EXPECT_FALSE(make_part(scene, folder.path(), 2).solved_reference);
    const Part end = make_part(scene, folder.path(), {});
    EXPECT_FALSE(end.solved_reference);
    ASSERT_EQ(end.study.reference.states.size(), whole.reference.states.size());
    for (std::size_t k = 0; k < whole.reference.states.size(); ++k) {
      EXPECT_EQ(end.study.reference.states[k].position, whole.reference.states[k].position) << "to the bit";
      EXPECT_EQ(end.study.reference.states[k].velocity, whole.reference.states[k].velocity) << "to the bit";
    }
    EXPECT_EQ(without_times(end.study), without_times(whole));
    EXPECT_FALSE(std::filesystem::exists(folder / reference_states_name)) << "of no use to a finished study";
  }
}

TEST(StudyRecorder, OfWorkPrecisionSolvesAReferenceThatWasChangedAgain) {
  const Scene scene = builtin_scene("pendulum");
  const WorkPrecision whole = study_work_precision(scene, precision_options());
  const TemporaryFolder folder;
  make_part(scene, folder.path(), 1);
  std::string bytes = content_of(folder / reference_states_name);
  ASSERT_GT(bytes.size(), 100u);
  bytes[77] ^= 1;
  ASSERT_FALSE(write_text_file(folder / reference_states_name, bytes));
  EXPECT_TRUE(make_part(scene, folder.path(), 2).solved_reference);
  std::filesystem::remove(folder / reference_states_name);
  const Part end = make_part(scene, folder.path(), {});
  EXPECT_TRUE(end.solved_reference);
  EXPECT_EQ(without_times(end.study), without_times(whole));
}

TEST(StudyFolder, ThatDoesNotAgreeWithItsIndexIsLostAndSaysWhatDoesNot) {
  const TemporaryFolder folder;
  const ExtremesTable table = run_extremes({.methods = {"verlet", "rk4"}, .cases = {"cloth-2x2"}});
  ASSERT_FALSE(StudyRecorder::write(folder.path(), table, "a test", 1));
  const std::string text = content_of(folder / "extremes.csv");
  const std::string fewer = text.substr(0, text.find("\r\n", text.find("\r\n") + 2) + 2);
  ASSERT_FALSE(write_text_file(folder / "extremes.csv", fewer));
  StudyReading reading = read_study(folder.path());
  EXPECT_FALSE(reading.study);
  EXPECT_TRUE(reading.is_lost);
  EXPECT_NE(reading.problem.find("extremes.csv has 1 rows, not 2"), std::string::npos) << reading.problem;
  std::filesystem::remove(folder / "extremes.csv");
  reading = read_study(folder.path());
  EXPECT_TRUE(reading.is_lost);
  EXPECT_NE(reading.problem.find("extremes.csv"), std::string::npos) << reading.problem;
}

TEST(StudyFolder, IsTheOldStudyOrNoneWhenItsRewritingFails) {
  const TemporaryFolder folder;
  const ExtremesOptions options{.methods = {"verlet"}, .cases = {"cloth-2x2"}};
  ASSERT_FALSE(StudyRecorder::write(folder.path(), run_extremes(options), "the old one", 1));
  StudyRecorder recorder;
  const ExtremesOptions other{.methods = {"rk4"}, .cases = {"step-1s"}};
  ASSERT_FALSE(recorder.begin(folder.path(), empty_table(other), {.command = "the new one"}));
  // Nothing more could be written: no new words over the old table.
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(finished_runs(reading.study->table), 0);
  EXPECT_FALSE(is_complete(reading.study->table));
}

}  // namespace
}  // namespace cloth::test::study_recorder_test
