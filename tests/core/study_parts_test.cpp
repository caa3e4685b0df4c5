// A study that several processes make in parts is the study that one makes.
#include "study/study_parts.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "study/extremes_report.h"
#include "study/reference_solution.h"
#include "study/stability_report.h"
#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"
#include "support/files.h"
#include "support/small_studies.h"

namespace cloth::test::study_parts_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A kind of study with its options: how it is planned and run.
template <class Options, class Plan, class Run>
struct Kind {
  Options options;
  Plan plan;
  Run run;
  auto whole() const { return run(options); }
};
template <class Options, class Plan, class Run>
Kind(Options, Plan, Run) -> Kind<Options, Plan, Run>;

struct Made {
  std::optional<StudyTable> table{};  ///< none: it was refused
  std::string error{};
  std::vector<std::string> disagreements{};
  int runs = 0;                    ///< that were made
  std::vector<std::string> did{};  ///< what it said that it does
};

/// As the command does it: a part, or without `shard` the whole study. With `killed_after` it is killed after
/// so many runs, which leaves the folder as it is then.
template <class OfKind>
Made make(const OfKind& kind, const std::filesystem::path& folder, std::optional<Shard> shard,
          std::optional<int> killed_after = {}) {
  Made made;
  auto options = kind.options;
  if (shard) options.shard = *shard;
  StudyRecorder recorder;
  const auto plan = kind.plan(options);
  if (const auto error = recorder.begin(folder, plan, {.command = "a test", .shard = shard})) {
    made.error = error->text();
    made.disagreements = recorder.disagreements();
    return made;
  }
  using Table = std::remove_const_t<decltype(plan)>;
  if (recorder.earlier()) options.earlier = &std::get<Table>(*recorder.earlier());
  const int before = recorder.earlier() ? finished_runs(*recorder.earlier()) : 0;
  bool stopped = killed_after == 0;
  options.partial = [&](const Table& so_far) {
    EXPECT_FALSE(recorder.keep(so_far));
    if (killed_after && finished_runs(so_far) >= before + *killed_after) stopped = true;
  };
  options.progress = [&](const StudyProgress& now) {
    made.did.push_back(now.text);
    return true;
  };
  options.stop = [&] { return stopped; };
  const Table table = kind.run(options);
  made.table = table;
  made.runs = finished_runs(table) - before;
  if (!killed_after) {
    const auto error = recorder.end(table, 1);
    EXPECT_FALSE(error) << error->text();
  }
  return made;
}

/// The tables of a folder without what is measured on the clock.
CsvTable without_times(CsvTable table) {
  for (const char* time : {"wall_s", "wall_median_s", "wall_lower_quartile_s", "wall_upper_quartile_s"})
    if (std::find(table.header.begin(), table.header.end(), time) != table.header.end())
      table = without_column(table, time);
  return table;
}

std::vector<std::vector<std::string>> rows_in(const std::filesystem::path& folder, const StudyTable& plan) {
  return without_times(parse_csv(content_of(folder / csv_name(plan)))).rows;
}

std::vector<std::vector<std::string>> rows_of(const StudyTable& table) {
  return without_times(parse_csv(study_csv(table))).rows;
}

auto few_extremes() {
  return Kind{ExtremesOptions{.methods = {"verlet", "rk4", "implicit-euler"},
                              .cases = {"cloth-2x2", "step-1s", "stiffness-1e0"}},
              empty_table, run_extremes};
}

auto map_kind(const StabilityOptions& options) {
  const Scene scene = small_cloth();
  return Kind{options, [scene](const StabilityOptions& of) { return plan_stability_map(scene, of); },
              [scene](const StabilityOptions& of) { return run_stability_map(scene, of); }};
}

auto few_grids() {
  Scene scene = small_cloth();
  const GridConvergenceOptions options{.cells = {3, 6, 9, 12}, .time = 0.2};
  return Kind{options, [scene](const GridConvergenceOptions& of) { return plan_grid_convergence(scene, of); },
              [scene](const GridConvergenceOptions& of) { return run_grid_convergence(scene, of); }};
}

auto few_rows() {
  return Kind{ValidationOptions{.protocols = {"catenary", "self-buckling", "picture-frame"}}, plan_validation,
              run_validation};
}

auto precision_of(const Scene& scene, double budget) {
  WorkPrecisionOptions options;
  options.methods = {"verlet", "rk4", "dormand-prince", "implicit-euler"};
  options.horizon = 0.2;
  options.repeats = 2;
  options.steps_per_method = 4;
  options.budget = budget;
  return Kind{options, [scene](const WorkPrecisionOptions& of) { return plan_work_precision(scene, of); },
              [scene](const WorkPrecisionOptions& of) { return study_work_precision(scene, of); }};
}

/// Three parts, the second first, then the whole: it makes nothing itself, and is the study of one process.
template <class OfKind>
void expect_parts_to_be_the_whole(const OfKind& kind) {
  const StudyTable whole = kind.whole();
  const TemporaryFolder folder;
  int runs = 0;
  for (const std::int64_t index : {2, 3, 1}) {
    const Made part = make(kind, folder.path(), Shard{index, 3});
    ASSERT_TRUE(part.table) << part.error;
    runs += part.runs;
    EXPECT_FALSE(std::filesystem::exists(folder / "study.json"));
    EXPECT_FALSE(std::filesystem::exists(part_folder(folder.path(), {index, 3}) / ".clothlab"));
  }
  EXPECT_EQ(runs, finished_runs(whole)) << "none twice";
  const Made merged = make(kind, folder.path(), {});
  ASSERT_TRUE(merged.table) << merged.error;
  EXPECT_EQ(merged.runs, 0);
  EXPECT_TRUE(is_complete(*merged.table));
  EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(reading.study->wall, 4) << "s of all parts";
  for (const std::string& name : study_files(whole))
    EXPECT_EQ(std::filesystem::exists(folder / name), name != reference_states_name) << name;
}

TEST(StudyParts, OfExtremesAreTheWholeTable) {
  expect_parts_to_be_the_whole(few_extremes());
}

TEST(StudyParts, OfAMapAreTheWholeMapWithItsLimitsWhicheverAxisIsTheStep) {
  StabilityOptions options = small_map(small_cloth());
  expect_parts_to_be_the_whole(map_kind(options));
  std::swap(options.x, options.y);
  expect_parts_to_be_the_whole(map_kind(options));
  options.y = {.path = "damping", .low = 0.001, .high = 0.01, .count = 2};
  expect_parts_to_be_the_whole(map_kind(options));
}

TEST(StudyParts, OfGridConvergenceAreTheWholeStudy) {
  expect_parts_to_be_the_whole(few_grids());
}

TEST(StudyParts, OfAValidationAreTheWholeStudy) {
  expect_parts_to_be_the_whole(few_rows());
}

TEST(StudyParts, OfAMapMeasureTheLimitsOfTheirLines) {
  const auto kind = map_kind(small_map(small_cloth()));
  const TemporaryFolder folder;
  for (const std::int64_t index : {1, 2}) make(kind, folder.path(), Shard{index, 2});
  const Made merged = make(kind, folder.path(), {});
  ASSERT_TRUE(merged.table);
  for (const std::string& text : merged.did) EXPECT_FALSE(has(text, "cell")) << text;
  EXPECT_EQ(study_json(*merged.table), study_json(kind.whole()));
}

TEST(StudyParts, ThatAreKilledGoOn) {
  const auto test = [](const auto& kind) {
    const StudyTable whole = kind.whole();
    const TemporaryFolder folder;
    const Made first = make(kind, folder.path(), Shard{1, 2}, 1);
    ASSERT_TRUE(first.table) << first.error;
    EXPECT_EQ(first.runs, 1);
    const Made rest = make(kind, folder.path(), Shard{1, 2});
    ASSERT_TRUE(rest.table) << rest.error;
    const Made again = make(kind, folder.path(), Shard{1, 2});
    ASSERT_TRUE(again.table) << again.error;
    EXPECT_EQ(again.runs, 0);
    EXPECT_EQ(finished_runs(*again.table), first.runs + rest.runs);
    // What is missing is made by whoever makes the whole, who may be killed too.
    ASSERT_TRUE(make(kind, folder.path(), {}, 1).table);
    const Made end = make(kind, folder.path(), {});
    ASSERT_TRUE(end.table) << end.error;
    EXPECT_EQ(first.runs + rest.runs + 1 + end.runs, finished_runs(whole));
    EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
    EXPECT_EQ(read_study(folder.path()).study->wall, 3)
        << "s of the part, which went on twice, and of the end";
  };
  test(few_extremes());
  test(map_kind(small_map(small_cloth())));
  test(few_grids());
  test(few_rows());
}

TEST(StudyParts, OfAnotherNumberTakeWhatIsThere) {
  const auto kind = few_extremes();
  const TemporaryFolder folder;
  int runs = make(kind, folder.path(), Shard{2, 3}).runs;
  runs += make(kind, folder.path(), Shard{3, 3}, 1).runs;
  for (const std::int64_t index : {2, 1}) {
    const Made part = make(kind, folder.path(), Shard{index, 2});
    ASSERT_TRUE(part.table) << part.error;
    runs += part.runs;
  }
  const StudyTable whole = kind.whole();
  EXPECT_EQ(runs, finished_runs(whole)) << "none twice";
  EXPECT_EQ(make(kind, folder.path(), {}).runs, 0);
  EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
}

TEST(StudyParts, TakeWhatAWholeStudyHadMadeWhenItWasKilled) {
  const auto kind = few_extremes();
  const TemporaryFolder folder;
  int runs = make(kind, folder.path(), {}, 4).runs;
  for (const std::int64_t index : {1, 2}) runs += make(kind, folder.path(), Shard{index, 2}).runs;
  const StudyTable whole = kind.whole();
  EXPECT_EQ(runs, finished_runs(whole)) << "none twice";
  EXPECT_EQ(make(kind, folder.path(), {}).runs, 0);
  EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
}

TEST(StudyParts, OfAFinishedStudyWithOtherOptionsLeaveNothingOfIt) {
  const auto kind = few_extremes();
  auto other = kind;
  other.options.methods = {"verlet"};
  const TemporaryFolder folder;
  ASSERT_TRUE(make(other, folder.path(), {}).table);
  make(kind, folder.path(), Shard{1, 2});
  ASSERT_TRUE(make(kind, folder.path(), {}, 1).table);
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html")) << "of the finished one";
  const StudyTable whole = kind.whole();
  EXPECT_TRUE(make(kind, folder.path(), {}).table);
  EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
}

TEST(StudyParts, OfOtherInputsAreRefusedByNameAndLeftAlone) {
  const auto kind = map_kind(small_map(small_cloth()));
  const TemporaryFolder folder;
  make(kind, folder.path(), Shard{1, 2});
  auto other = kind;
  other.options.criterion.periods = 21;
  const std::string part = part_folder(folder.path(), {1, 2}).string();
  for (const std::optional<Shard> shard : {std::optional<Shard>(), std::optional(Shard{2, 2})}) {
    const Made refused = make(other, folder.path(), shard);
    EXPECT_FALSE(refused.table);
    EXPECT_TRUE(has(refused.error, part + ": ")) << refused.error;
    EXPECT_TRUE(has(refused.error, "criterion")) << refused.error;
  }
  const Made of_kind = make(few_extremes(), folder.path(), {});
  EXPECT_TRUE(has(of_kind.error, "another kind")) << of_kind.error;
  EXPECT_TRUE(read_study(part).study);
  EXPECT_FALSE(std::filesystem::exists(folder / "study.json"));
}

TEST(StudyParts, ThatDoNotAgreeAreNamedWithTheirCell) {
  const auto kind = few_extremes();
  const TemporaryFolder folder;
  make(kind, folder.path(), Shard{1, 3}, 2);
  const auto first = part_folder(folder.path(), {1, 3}), second = part_folder(folder.path(), {1, 9});
  std::filesystem::copy(first, second);
  std::string text = content_of(second / "extremes.csv");
  const auto status = text.find("stable");
  ASSERT_NE(status, std::string::npos);
  text.replace(status, 6, "diverged");
  ASSERT_FALSE(write_text_file(second / "extremes.csv", text));
  const Made refused = make(kind, folder.path(), {});
  EXPECT_FALSE(refused.table);
  ASSERT_EQ(refused.disagreements.size(), 1u);
  const std::string said = refused.disagreements.front();
  for (const std::string& part :
       {std::string("stiffness-1e0, "), std::string("status is stable and diverged"), first.string(),
        second.string()})
    EXPECT_TRUE(has(said, part)) << said;
  EXPECT_FALSE(std::filesystem::exists(folder / "study.json"));
  std::filesystem::remove_all(second);
  EXPECT_TRUE(make(kind, folder.path(), {}).table);
}

/// Whether it ran anything, or solved a reference.
bool did_work(const Made& made, const char* what = "") {
  for (const std::string& text : made.did)
    for (const char* work : {"solving", "measuring", "timing"})
      if (text.starts_with(work) && has(text, what)) return true;
  return false;
}

std::size_t refused_runs(const WorkPrecision& study) {
  std::size_t count = 0;
  for (const MethodStudy& method : study.methods)
    for (const WorkPrecisionRun& run : method.runs) count += run.status == RunStatus::refused ? 1 : 0;
  return count;
}

TEST(StudyParts, OfWorkAndPrecisionAreTheWholeStudyWithOneReference) {
  Scene limited = builtin_scene("pendulum");
  limited.deformation = Deformation{.rate = 0.01};
  for (const Scene& scene : {builtin_scene("pendulum"), limited}) {
    const auto kind = precision_of(scene, 200);
    const StudyTable whole = kind.whole();
    const TemporaryFolder folder;
    for (const std::int64_t index : {2, 3, 1}) {
      const Made part = make(kind, folder.path(), Shard{index, 3});
      ASSERT_TRUE(part.table) << part.error;
      EXPECT_EQ(did_work(part, "reference"), index == 2) << "the others take it";
    }
    const Made merged = make(kind, folder.path(), {});
    ASSERT_TRUE(merged.table) << merged.error;
    EXPECT_FALSE(did_work(merged));
    EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
    EXPECT_FALSE(std::filesystem::exists(folder / reference_states_name));
    const auto timed = [](const StudyTable& table) {
      return sample_table(std::get<WorkPrecision>(table)).rows.size();
    };
    EXPECT_EQ(timed(*merged.table), timed(whole));
    const char* said = "3 parts of this study were made and timed by processes of their own";
    EXPECT_TRUE(has(content_of(folder / "report.html"), said));
    EXPECT_EQ(std::get<WorkPrecision>(read_study(folder.path()).study->table).parts, 3);
    EXPECT_FALSE(has(study_page(std::get<WorkPrecision>(whole), "a test"), "parts of this study"));
  }
}

TEST(StudyParts, OfWorkAndPrecisionKeepToTheBudgetOfTheWholeStudy) {
  const Scene scene = builtin_scene("pendulum");
  const double all = precision_of(scene, 200).whole().estimated;
  for (const double part : {0.8, 0.6, 0.4}) {
    const auto kind = precision_of(scene, part * all);
    const WorkPrecision whole = kind.whole();
    EXPECT_GT(refused_runs(whole), 0u) << part;
    const TemporaryFolder folder;
    for (const std::int64_t index : {1, 2, 3, 4}) make(kind, folder.path(), Shard{index, 4});
    const Made merged = make(kind, folder.path(), {});
    ASSERT_TRUE(merged.table) << merged.error;
    EXPECT_FALSE(did_work(merged)) << "parts have at least the runs that the budget holds";
    EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
  }
}

TEST(StudyParts, OfWorkAndPrecisionThatAreKilledGoOn) {
  const auto kind = precision_of(builtin_scene("pendulum"), 200);
  const StudyTable whole = kind.whole();
  const TemporaryFolder folder;
  for (const int runs : {0, 1, 2, 3}) ASSERT_TRUE(make(kind, folder.path(), Shard{1, 2}, runs).table);
  const Made end = make(kind, folder.path(), Shard{1, 2});
  EXPECT_FALSE(did_work(end, "reference"));
  ASSERT_TRUE(make(kind, folder.path(), {}, 1).table);
  const Made merged = make(kind, folder.path(), {});
  ASSERT_TRUE(merged.table) << merged.error;
  EXPECT_FALSE(did_work(merged, "verlet"));
  EXPECT_TRUE(did_work(merged, "rk4")) << "of the part that was never made";
  EXPECT_EQ(rows_in(folder.path(), whole), rows_of(whole));
}

TEST(StudyParts, WithTwoReferencesAreRefused) {
  const auto kind = precision_of(builtin_scene("pendulum"), 200);
  const TemporaryFolder folder, other;
  make(kind, folder.path(), Shard{1, 2}, 1);
  const auto index = part_folder(folder.path(), {2, 2}) / "study.json";
  std::filesystem::copy(part_folder(folder.path(), {1, 2}), index.parent_path());
  std::string text = content_of(index);
  const auto at = text.find("\"evaluations\": ");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 15, "1");
  ASSERT_FALSE(write_text_file(index, text));
  const Made refused = make(kind, folder.path(), {});
  ASSERT_EQ(refused.disagreements.size(), 1u) << refused.error;
  EXPECT_TRUE(has(refused.disagreements.front(), "the reference: was made twice, and evaluations is "))
      << refused.disagreements.front();
}

/// The folder's study.json as a process of another machine would have written it.
void change_processor(const std::filesystem::path& part) {
  auto index = nlohmann::ordered_json::parse(content_of(part / "study.json"));
  index["made_by"]["processor"] = "another one";
  ASSERT_FALSE(write_text_file(part / "study.json", index.dump()));
}

TEST(StudyParts, OfAnotherProcessorAreRefusedWhereTimesCountAndTakenWhereTheyDoNot) {
  const TemporaryFolder timed, folder;
  const auto precision = precision_of(builtin_scene("pendulum"), 200);
  make(precision, timed.path(), Shard{1, 4});
  change_processor(part_folder(timed.path(), {1, 4}));
  const Made refused = make(precision, timed.path(), {});
  EXPECT_FALSE(refused.table);
  EXPECT_TRUE(has(refused.error, "not the same: processor")) << refused.error;
  const auto extremes = few_extremes();
  const int runs = make(extremes, folder.path(), Shard{1, 2}).runs;
  change_processor(part_folder(folder.path(), {1, 2}));
  EXPECT_EQ(make(extremes, folder.path(), {}).runs, finished_runs(StudyTable(extremes.whole())) - runs);
}

TEST(StudyParts, KeepTheTimesOfTheRunThatWasTimedMoreOften) {
  const auto kind = precision_of(builtin_scene("pendulum"), 200);
  const WorkPrecision whole = kind.whole();
  WorkPrecision less = whole;
  for (MethodStudy& method : less.methods)
    for (WorkPrecisionRun& run : method.runs) {
      run.samples.resize(1);
      run.samples.front().seconds *= 2;
    }
  for (const bool turned : {false, true}) {
    StudyParts parts(kind.plan(kind.options), {});
    parts.add(turned ? whole : less, "a");
    parts.add(turned ? less : whole, "b");
    EXPECT_TRUE(parts.disagreements().empty()) << "times are no results";
    EXPECT_EQ(sample_table(std::get<WorkPrecision>(parts.table())).rows, sample_table(whole).rows);
  }
}

}  // namespace
}  // namespace cloth::test::study_parts_test
