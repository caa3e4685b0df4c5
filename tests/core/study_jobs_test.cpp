// A study made with several jobs is the study that one makes: the same tables to the bit, whichever cell ends
// first, after a kill, a stop or an exception.
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <thread>

#include "io/csv.h"
#include "scene/builtin_scenes.h"
#include "simulation/in_threads.h"
#include "simulation/memory_estimate.h"
#include "study/extremes_report.h"
#include "study/stability_report.h"
#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "study/study_team.h"
#include "study/validation/validation_report.h"
#include "support/files.h"
#include "support/small_studies.h"

namespace cloth::test::study_jobs_test {
namespace {

TEST(InThreads, DoesEachPieceOnceWithAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7, 1000}) {
    std::vector<int> calls(100);
    in_threads(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(100, 1)) << threads;
  }
  in_threads(0, 4, [](std::size_t) { FAIL() << "there is nothing to do"; });
}

TEST(InThreads, PassesAnExceptionOnOnceAllHaveEndedAndBeginsNoMore) {
  constexpr std::size_t endless = std::size_t{1} << 62;
  std::atomic<int> within = 0;
  const auto work = [&](std::size_t i) {
    ++within;
    if (i != 5) std::this_thread::yield();
    --within;
    if (i == 5) throw std::bad_alloc();
  };
  EXPECT_THROW(in_threads(endless, 3, work), std::bad_alloc);
  EXPECT_EQ(within, 0);
}

TEST(StudyTeam, GivesACellTheThreadsOfThoseThatAreNotThereAnyMore) {
  StudyTeam team({.jobs = 4});
  std::vector<int> threads;
  std::atomic<int> waiting = 4;
  EXPECT_TRUE(team.run(6, [&](std::size_t cell) {
    if (cell < 4) {  // one on each of four threads, all begun before any ends
      EXPECT_EQ(team.threads(), 1);
      --waiting;
      while (waiting > 0) std::this_thread::yield();
    }
    return true;
  }));
  StudyTeam alone({.jobs = 4, .at_once = 1});
  EXPECT_TRUE(alone.run(2, [&](std::size_t) {
    threads.push_back(alone.threads());
    return true;
  }));
  EXPECT_EQ(threads, (std::vector<int>{4, 4})) << "one at a time, for its memory, has all of them";
  StudyTeam few({.jobs = 6});
  few.run(1, [&](std::size_t) {
    EXPECT_EQ(few.threads(), 6);
    return true;
  });
}

TEST(StudyTeam, StopsAllCellsWhereProgressSaysNoOrOneThrows) {
  StudyTeam told({.jobs = 3, .progress = [](const StudyProgress&) { return false; }});
  EXPECT_FALSE(told.run(100, [&](std::size_t cell) {
    if (cell == 2) {
      const auto lock = told.alone();
      told.report({});
    }
    while (!told.is_stopped()) std::this_thread::yield();
    return false;
  }));
  StudyTeam failed({.jobs = 3});
  EXPECT_THROW(failed.run(100,
                          [&](std::size_t cell) -> bool {
                            if (cell == 2) throw std::bad_alloc();
                            while (!failed.is_stopped()) std::this_thread::yield();
                            return false;
                          }),
               std::bad_alloc);
}

TEST(Memory, LetsAsManyRunsBeginAtOnceAsFitAndAlwaysOne) {
  Scene scene = builtin_scene("corners-free");
  EXPECT_EQ(runs_that_fit({scene, scene}, 3), 3);
  EXPECT_EQ(runs_that_fit({}, 5), 5);
  scene.cloth.rows = scene.cloth.columns = 1 << 20;  // a hundred terabytes
  EXPECT_EQ(runs_that_fit({builtin_scene("corners-free"), scene}, 4), 1);
}

/// A kind of study with its options: how it is planned and run.
template <class Options, class Plan, class Run>
struct JobsKind {
  Options options;
  Plan plan;
  Run run;
  auto with(int jobs) const {
    Options asked = options;
    asked.jobs = jobs;
    return run(asked);
  }
};
template <class Options, class Plan, class Run>
JobsKind(Options, Plan, Run) -> JobsKind<Options, Plan, Run>;

auto map_of(const StabilityOptions& options) {
  const Scene scene = small_cloth();
  return JobsKind{options, [scene](const StabilityOptions& of) { return plan_stability_map(scene, of); },
                  [scene](const StabilityOptions& of) { return run_stability_map(scene, of); }};
}

StabilityOptions other_axis_first() {
  StabilityOptions options = small_map(small_cloth());
  std::swap(options.x, options.y);
  return options;
}

StabilityOptions without_steps() {
  StabilityOptions options = small_map(small_cloth());
  options.x = {.path = "damping", .low = 0.001, .high = 0.01, .count = 2};
  return options;
}

auto some_extremes() {
  return JobsKind{ExtremesOptions{.methods = {"verlet", "rk4", "implicit-euler"},
                                  .cases = {"cloth-2x2", "step-1s", "stiffness-1e0"}},
                  empty_table, run_extremes};
}

auto some_strips() {
  return JobsKind{ValidationOptions{.protocols = {"catenary", "picture-frame"}}, plan_validation,
                  run_validation};
}

std::string without_times(const std::string& csv) {
  CsvTable table = parse_csv(csv);
  if (std::find(table.header.begin(), table.header.end(), "wall_s") != table.header.end())
    table = without_column(table, "wall_s");
  return csv_text(table, "\n");
}

/// What a study says, with a map's measured limits.
std::string results_of(const StudyTable& table) {
  std::string text = without_times(study_csv(table));
  if (const auto* map = std::get_if<StabilityMap>(&table)) text += study_json(*map);
  return text;
}

/// Every study of several jobs.
template <class Test>
void for_each_kind(const Test& test) {
  test(map_of(small_map(small_cloth())));
  test(map_of(other_axis_first()));
  test(map_of(without_steps()));
  test(some_extremes());
  test(some_strips());
}

TEST(StudyJobs, DoNotChangeABitOfAnyStudy) {
  for_each_kind([](const auto& kind) {
    const std::string one = results_of(kind.with(1));
    for (const int jobs : {2, 4}) EXPECT_EQ(results_of(kind.with(jobs)), one) << jobs;
  });
}

/// Makes the study or a part of it in a folder; with `killed_after` it is killed after so many runs.
template <class OfKind>
StudyTable make_in(const std::filesystem::path& folder, const OfKind& kind, int jobs,
                   std::optional<Shard> shard, std::optional<int> killed_after = {}) {
  auto options = kind.options;
  options.jobs = jobs;
  if (shard) options.shard = *shard;
  StudyRecorder recorder;
  const auto plan = kind.plan(options);
  using Table = std::remove_const_t<decltype(plan)>;
  const auto refused = recorder.begin(folder, plan, {.command = "a test", .shard = shard});
  EXPECT_FALSE(refused) << refused->text();
  if (recorder.earlier()) options.earlier = &std::get<Table>(*recorder.earlier());
  const int before = recorder.earlier() ? finished_runs(*recorder.earlier()) : 0;
  std::atomic<bool> stopped = false;
  std::atomic<int> within = 0;
  options.partial = [&](const Table& so_far) {
    EXPECT_EQ(++within, 1) << "one thread at a time";
    EXPECT_FALSE(recorder.keep(so_far));
    if (killed_after && finished_runs(so_far) >= before + *killed_after) stopped = true;
    --within;
  };
  options.stop = [&] { return stopped.load(); };
  const Table table = kind.run(options);
  if (!killed_after) {
    const auto error = recorder.end(table, 1);
    EXPECT_FALSE(error) << error->text();
  }
  return table;
}

/// The tables of a folder, which have no times but this column.
std::string tables_in(const std::filesystem::path& folder, const StudyTable& study) {
  std::string text;
  for (const std::string& name : study_files(study))
    if (name.ends_with(".csv")) text += without_times(content_of(folder / name));
  return text;
}

TEST(StudyJobs, LeaveTheSameFilesOfTheStudyAndOfItsParts) {
  for_each_kind([](const auto& kind) {
    const TemporaryFolder one, several;
    for (const std::optional<Shard>& shard : {std::optional(Shard{2, 3}), std::optional<Shard>()}) {
      const StudyTable table = make_in(one.path(), kind, 1, shard);
      make_in(several.path(), kind, 4, shard);
      const auto place = [&](const TemporaryFolder& folder) {
        return shard ? part_folder(folder.path(), *shard) : folder.path();
      };
      EXPECT_EQ(tables_in(place(several), table), tables_in(place(one), table)) << kind_of(table);
    }
  });
}

TEST(StudyJobs, ThatAreKilledAgainAndAgainLoseNoCellThatEndedAndEndWithTheSameStudy) {
  for_each_kind([](const auto& kind) {
    const StudyTable whole = kind.with(1);
    const TemporaryFolder folder;
    int there = 0;
    for (int kill = 0; kill < 3; ++kill) {
      const StudyTable killed = make_in(folder.path(), kind, 3, {}, 1);
      const StudyReading reading = read_study(folder.path());
      ASSERT_TRUE(reading.study) << reading.problem;
      EXPECT_EQ(finished_runs(reading.study->table), finished_runs(killed));
      EXPECT_GE(finished_runs(killed), std::min(there + 1, finished_runs(whole)));
      there = finished_runs(killed);
    }
    const StudyTable table = make_in(folder.path(), kind, 3, {});
    EXPECT_TRUE(is_complete(table));
    EXPECT_EQ(results_of(table), results_of(whole));
    const StudyReading reading = read_study(folder.path());
    ASSERT_TRUE(reading.study) << reading.problem;
    EXPECT_EQ(results_of(reading.study->table), results_of(whole));
  });
}

TEST(StudyJobs, EndWithTheExceptionThatOneOfThemThrows) {
  for_each_kind([](const auto& kind) {
    auto options = kind.options;
    options.jobs = 3;
    std::atomic<int> calls = 0;
    options.partial = [&](const auto&) {
      if (++calls == 2) throw std::bad_alloc();
    };
    EXPECT_THROW(kind.run(options), std::bad_alloc);
  });
}

TEST(StudyJobs, AreAllStoppedWithinCellsThatWouldTakeDays) {
  StabilityOptions options = small_map(small_cloth());
  options.criterion = {.periods = 1e6, .max_steps = 100'000'000};
  options.jobs = 3;
  std::atomic<int> asked = 0;
  options.stop = [&] { return ++asked > 1000; };
  const StabilityMap map = run_stability_map(small_cloth(), options);
  EXPECT_FALSE(map.is_complete());
}

}  // namespace
}  // namespace cloth::test::study_jobs_test
