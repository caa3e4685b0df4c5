// A sweep's folder: filled by any threads, shards and attempts it has the same rows.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "kernels/instruction_set.h"
#include "simulation/recorder.h"
#include "support/files.h"
#include "sweep/merge_sweep.h"
#include "sweep/run_point.h"
#include "sweep/run_sweep.h"

namespace cloth::test::sweep_run_test {
namespace {

namespace fs = std::filesystem;

/// 12 points of a cloth of 5 x 5 particles; the largest step of the axis diverges.
SweepPlan small_plan(const std::string& more = "") {
  SweepReading reading = read_sweep(R"({ "scene": "corners-free",
    "set": { "cloth.rows": 5, "cloth.columns": 5, "duration": 0.1, "integrator.time_step": 0.001 },
    "vary": [ { "path": "springs.structural", "from": 50, "to": 200, "count": 3 },
              { "path": "damping", "values": [0.001, 0.002, 0.004, 0.008] } ],
    "outputs": [ { "name": "peak", "of": "max_strain", "reduce": "max" },
                 { "name": "low", "of": "lowest_point" } ])" +
                                        more + "}",
                                    "small.sweep.json");
  for (const Problem& problem : reading.problems) ADD_FAILURE() << problem.text();
  return reading.plan.value_or(SweepPlan{});
}

SweepFolder folder_for(const fs::path& path, const SweepPlan& plan) {
  SweepFolderReading taken = take_sweep_folder(path, plan);
  EXPECT_TRUE(taken.folder) << (taken.error ? taken.error->text() : "");
  return taken.folder.value_or(SweepFolder{});
}

SweepResults results_of(const SweepFolder& folder) {
  const ShardFiles files = read_shard_files(folder);
  EXPECT_FALSE(files.error);
  return sweep_results(folder, files.files);
}

/// sweep.csv without what is of the machine.
std::string table_of(const SweepFolder& folder) {
  CsvTable table = sweep_table(folder.plan, results_of(folder));
  return csv_text(without_column(without_column(table, "wall_s"), "host"), "\n");
}

std::string whole_table(const TemporaryFolder& place) {
  const SweepFolder folder = folder_for(place / "whole", small_plan());
  EXPECT_TRUE(run_sweep(folder, {}).is_complete());
  return table_of(folder);
}

TEST(Sweep, HasTheOutputsThatTheRunsRecordHas) {
  const TemporaryFolder place;
  const SweepPlan plan = small_plan();
  const SweepPoints points(plan);
  const auto row = run_point(plan, points, 6, {});
  ASSERT_TRUE(row);
  EXPECT_EQ(row->status, PointStatus::finished);
  EXPECT_EQ(row->steps, 100);
  const Scene scene = *points.scene(6).scene;
  EXPECT_EQ(row->scene, scene_hash(scene));
  RunOptions in_folder;
  in_folder.folder = place / "run";
  run_scene(scene, in_folder);
  const std::vector<double> strain = column_of(parse_csv(content_of(place / "run/record.csv")), "max_strain");
  EXPECT_EQ(row->outputs[0], *std::max_element(strain.begin(), strain.end()));
  const std::vector<double> y = column_of(parse_csv(content_of(place / "run/final_state.csv")), "y_m");
  EXPECT_EQ(row->outputs[1], *std::min_element(y.begin(), y.end()));
}

TEST(Sweep, HasTheSameRowsWhateverThreadsAndShardsMakeIt) {
  const TemporaryFolder place;
  const std::string whole = whole_table(place);
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 13);
  const SweepFolder threads = folder_for(place / "threads", small_plan());
  EXPECT_TRUE(run_sweep(threads, {.jobs = 4}).is_complete());
  EXPECT_EQ(table_of(threads), whole);
  const SweepFolder shards = folder_for(place / "shards", small_plan());
  for (const std::int64_t index : {3, 1, 5, 2, 4}) {
    const SweepRun run = run_sweep(shards, {.jobs = 2, .shard = {index, 5}});
    EXPECT_TRUE(run.is_complete());
    EXPECT_EQ(run.points, index <= 2 ? 3 : 2);
  }
  EXPECT_EQ(table_of(shards), whole);
}

TEST(Sweep, GoesOnWhereItWasStoppedWhateverItsShardsWere) {
  const TemporaryFolder place;
  const std::string whole = whole_table(place);
  const SweepFolder folder = folder_for(place / "parts", small_plan());
  int rows = 0;
  SweepRunOptions options{.shard = {1, 2}, .stop = [&] { return rows >= 2; }};
  options.row = [&](const PointRow&) { ++rows; };
  const SweepRun stopped = run_sweep(folder, options);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.made, 2);
  EXPECT_EQ(results_of(folder).missing(), 10);
  EXPECT_EQ(run_sweep(folder, {.shard = {1, 3}}).made, 3) << "of the points 0, 3, 6 and 9 the first is there";
  const SweepRun rest = run_sweep(folder, {.jobs = 3});
  EXPECT_TRUE(rest.is_complete());
  EXPECT_EQ(rest.earlier + rest.made, 12);
  EXPECT_EQ(table_of(folder), whole);
  EXPECT_EQ(results_of(folder).twice, 0);
  EXPECT_EQ(run_sweep(folder, {}).made, 0);
}

TEST(Sweep, MakesThePointAgainWhoseLineWasCut) {
  const TemporaryFolder place;
  const std::string whole = whole_table(place);
  const SweepFolder folder = folder_for(place / "torn", small_plan());
  run_sweep(folder, {});
  const fs::path file = fs::directory_iterator(folder.shards())->path();
  fs::resize_file(file, fs::file_size(file) - 20);
  EXPECT_EQ(results_of(folder).missing(), 1);
  EXPECT_EQ(run_sweep(folder, {}).made, 1);
  EXPECT_EQ(table_of(folder), whole);
}

TEST(Sweep, MayHaveTwoAttemptsOfOneShardAtOnce) {
  const TemporaryFolder place;
  const std::string whole = whole_table(place);
  const SweepFolder folder = folder_for(place / "two", small_plan());
  // The second begins when the first has made two rows and not yet looked at again.
  int rows = 0;
  SweepRunOptions first;
  first.row = [&](const PointRow&) {
    if (++rows != 2) return;
    EXPECT_EQ(run_sweep(folder, {}).made, 10);
  };
  EXPECT_TRUE(run_sweep(folder, first).is_complete());
  const SweepResults results = results_of(folder);
  EXPECT_EQ(results.attempts, 2u);
  EXPECT_EQ(results.twice, 10);
  EXPECT_TRUE(results.disagreements.empty());
  EXPECT_EQ(table_of(folder), whole);
}

TEST(Sweep, KeepsAPointThatFailsAsARow) {
  const TemporaryFolder place;
  SweepReading reading = read_sweep(R"({ "scene": "corners-free",
    "set": { "cloth.rows": 5, "cloth.columns": 5, "duration": 0.5, "cloth.pins": [[4, 4]] },
    "vary": [ { "paths": ["integrator.time_step", "cloth.rows", "duration"],
                "values": [[0.001, 5, 0.5], [0.2, 5, 4.0], [0.001, 4, 0.5], [0.001, 5, 2.0]] } ],
    "outputs": [ { "of": "max_strain" } ], "limits": { "steps": 1000 } })",
                                    "small.sweep.json");
  ASSERT_TRUE(reading.plan);
  const SweepFolder folder = folder_for(place / "failing", *reading.plan);
  EXPECT_TRUE(run_sweep(folder, {}).is_complete());
  const SweepResults results = results_of(folder);
  ASSERT_EQ(results.rows.size(), 4u);
  const PointStatus expected[] = {PointStatus::finished, PointStatus::diverged, PointStatus::refused,
                                  PointStatus::limit_steps};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(results.rows[k].status, expected[k]) << results.rows[k].cause;
    EXPECT_EQ(results.rows[k].cause.empty(), k == 0) << results.rows[k].cause;
    EXPECT_EQ(std::isnan(results.rows[k].outputs[0]), k != 0);
  }
}

TEST(Sweep, EndsAPointAtItsWallTime) {
  SweepPlan plan = small_plan();
  plan.limits.wall = 0.05;
  plan.scene.duration = 1e5;
  const SweepPoints points(plan);
  const auto row = run_point(plan, points, 0, {});
  ASSERT_TRUE(row);
  EXPECT_EQ(row->status, PointStatus::limit_wall);
}

TEST(SweepFolder, OfAnotherPlanOrOfOtherResultsIsRefused) {
  const TemporaryFolder place;
  folder_for(place / "sweep", small_plan());
  const SweepFolderReading other = take_sweep_folder(place / "sweep", small_plan(R"(, "seed": 2)"));
  ASSERT_TRUE(other.error);
  EXPECT_TRUE(other.error->refused);
  EXPECT_NE(other.error->text().find("another plan"), std::string::npos) << other.error->text();
  RunOptions in_folder;
  in_folder.folder = place / "run";
  run_scene(small_plan().scene, in_folder);
  const SweepFolderReading run = take_sweep_folder(place / "run", small_plan());
  ASSERT_TRUE(run.error);
  EXPECT_TRUE(run.error->refused);
  EXPECT_FALSE(fs::exists(place / "run/sweep.json"));
}

TEST(SweepFolder, OfAnotherInstructionSetIsRefused) {
  const TemporaryFolder place;
  const auto& sets = supported_instruction_sets();
  if (sets.size() < 2) GTEST_SKIP() << "this processor has one instruction set";
  set_instruction_set(sets[0]);
  folder_for(place / "sweep", small_plan());
  set_instruction_set(sets[1]);
  const SweepFolderReading other = take_sweep_folder(place / "sweep", small_plan());
  set_instruction_set(std::nullopt);
  ASSERT_TRUE(other.error);
  EXPECT_NE(other.error->text().find(instruction_set_variable), std::string::npos) << other.error->text();
}

TEST(SweepFolder, WhosePlanWasChangedIsNotRead) {
  const TemporaryFolder place;
  const SweepFolder folder = folder_for(place / "sweep", small_plan());
  std::string text = content_of(folder.path / sweep_index_name);
  text.replace(text.find("\"to\":200"), 8, "\"to\":300");
  std::ofstream(folder.path / sweep_index_name) << text;
  const SweepFolderReading again = read_sweep_folder(folder.path);
  ASSERT_TRUE(again.error);
  EXPECT_NE(again.error->text().find("changed"), std::string::npos);
}

TEST(Merge, NamesBothMakersOfAPointThatDoesNotAgree) {
  const TemporaryFolder place;
  const SweepFolder folder = folder_for(place / "sweep", small_plan());
  run_sweep(folder, {.shard = {2, 2}});
  PointRow changed = results_of(folder).rows.front();
  changed.outputs[1] = std::nextafter(changed.outputs[1], 1.0);
  Attempt other{.plan = folder.hash,
                .version = "1",
                .instruction_set = "another set",
                .processor = "Another One",
                .host = "elsewhere"};
  std::ofstream(folder.shards() / "1-of-1.elsewhere.7.jsonl") << line_of(other) << "\n"
                                                              << line_of(changed) << "\n";
  const SweepResults results = results_of(folder);
  ASSERT_EQ(results.disagreements.size(), 1u);
  EXPECT_EQ(results.disagreements[0].point, 1);
  for (const char* part : {"point 1", "low is", "elsewhere (Another One, another set)",
                           "1-of-1.elsewhere.7.jsonl", name_of(active_instruction_set())})
    EXPECT_NE(results.disagreements[0].text.find(part), std::string::npos) << results.disagreements[0].text;
}

TEST(Merge, TakesAResultBeforeATimeLimitOfASlowerMachine) {
  const TemporaryFolder place;
  const SweepFolder folder = folder_for(place / "sweep", small_plan());
  run_sweep(folder, {});
  PointRow slow = results_of(folder).rows[3];
  slow.status = PointStatus::limit_wall;
  slow.outputs.assign(2, std::nan(""));
  const Attempt other{.plan = folder.hash, .host = "a"};
  std::ofstream(folder.shards() / "1-of-1.a.1.jsonl") << line_of(other) << "\n" << line_of(slow) << "\n";
  const SweepResults results = results_of(folder);
  EXPECT_TRUE(results.disagreements.empty());
  EXPECT_EQ(results.rows[3].status, PointStatus::finished);
}

TEST(Merge, RefusesRowsOfAnotherPlan) {
  const TemporaryFolder place;
  const SweepFolder folder = folder_for(place / "sweep", small_plan());
  std::ofstream(folder.shards() / "1-of-1.a.1.jsonl") << line_of(Attempt{.plan = "another"}) << "\n";
  EXPECT_TRUE(read_shard_files(folder).error);
}

TEST(Merge, LeavesTableMapsAndPage) {
  const TemporaryFolder place;
  const SweepFolder folder = folder_for(place / "sweep", small_plan());
  run_sweep(folder, {});
  ASSERT_FALSE(write_merged(folder, results_of(folder)));
  for (const char* name : {"sweep.csv", "sweep-peak.svg", "sweep-low.svg", "report.html"})
    EXPECT_TRUE(fs::exists(folder.path / name)) << name;
  const CsvTable table = parse_csv(content_of(folder.path / "sweep.csv"));
  const std::vector<std::string> header{
      "point", "springs.structural", "damping", "peak", "low", "status", "cause", "steps", "wall_s", "host"};
  EXPECT_EQ(table.header, header);
  EXPECT_EQ(table.rows.size(), 12u);
  EXPECT_NE(content_of(folder.path / "report.html").find("<svg"), std::string::npos);
}

TEST(MissingShards, AreAnArraysIndices) {
  SweepResults results{.points = 20};
  const auto add = [&](std::int64_t point) { results.rows.push_back({.point = point}); };
  for (std::int64_t point = 0; point < 20; ++point)
    if (point % 10 != 2 && point % 10 != 6 && point % 10 != 7 && point != 18) add(point);
  EXPECT_EQ(missing_shards(results, 10), "3,7-9");
  EXPECT_EQ(missing_shards(results, 10, 5), "2-4");
  EXPECT_EQ(missing_shards(results, 10, 5, 2), "2");
  EXPECT_EQ(missing_shards(results, 10, 9), "");
  EXPECT_EQ(missing_shards(results, 1), "1");
}

}  // namespace
}  // namespace cloth::test::sweep_run_test
