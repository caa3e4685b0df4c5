// Panes in the worker: what they show is what LockStep computes, and nothing that is sent is lost.
#include "bridge/run_worker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/run_comparison.h"
#include "io/csv.h"
#include "worker_helpers.h"

namespace clothlab::test::panes_run_test {
namespace {

constexpr double fastest = std::numeric_limits<double>::infinity();

cloth::Comparison small_comparison(const std::vector<std::string>& methods = {"verlet", "rk4", "bdf2"}) {
  cloth::Comparison comparison;
  comparison.scene = small_scene();
  comparison.scene.duration = 0.2;
  comparison.panes = cloth::panes_for(methods);
  comparison.reference = "A";
  return comparison;
}

/// To the end of the duration.
WorkerStatus play_to_the_end(RunWorker& worker) {
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  worker.wait_until_idle();
  EXPECT_TRUE(eventually([&] { return !worker.status().playing; }));
  return worker.status();
}

void expect_shows(const ClothFrame& frame, const cloth::ClothState& state) {
  ASSERT_EQ(frame.positions.size(), 3 * state.position.size());
  EXPECT_EQ(frame.step, state.step);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    ASSERT_EQ(frame.positions[3 * i], static_cast<float>(state.position.x()[i]));
    ASSERT_EQ(frame.positions[3 * i + 1], static_cast<float>(state.position.y()[i]));
    ASSERT_EQ(frame.positions[3 * i + 2], static_cast<float>(state.position.z()[i]));
  }
}

std::vector<std::vector<std::string>> timeless_rows(const std::filesystem::path& path) {
  cloth::CsvTable table = cloth::parse_csv(text_of(path));
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c)
      if (table.header[c].find("step_time_us") == std::string::npos) rows.back().push_back(row[c]);
  }
  return rows;
}

TEST(PanesRun, ShowsWhatLockStepComputesToTheBitOnAnyNumberOfThreads) {
  for (const int threads : {1, 3}) {
    cloth::LockStep expected(small_comparison());
    for (std::int64_t k = 1; k <= expected.last_index(); ++k) ASSERT_TRUE(expected.advance(k));
    RunWorker worker(threads);
    worker.send(command::Load{small_comparison()});
    const WorkerStatus end = play_to_the_end(worker);
    EXPECT_EQ(end.time, expected.time_of(expected.last_index()));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto frame = worker.take_frame(i);
      ASSERT_TRUE(frame);
      expect_shows(*frame, expected.lane(i).state);
      if (i > 0) {
        EXPECT_EQ(*end.panes[i].rms, expected.difference(i)->rms);
      }
    }
  }
}

TEST(PanesRun, GivesASampleOfEveryCommonTimeInOrder) {
  RunWorker worker;
  worker.send(command::Load{small_comparison()});
  play_to_the_end(worker);
  const auto samples = worker.take_pane_samples();
  ASSERT_EQ(samples.size(), 21u);
  EXPECT_TRUE(samples.front().is_start);
  for (std::size_t k = 1; k < samples.size(); ++k) {
    EXPECT_NEAR(samples[k].time_s, 0.01 * static_cast<double>(k), 1e-12);
    EXPECT_FALSE(samples[k].is_start);
    EXPECT_TRUE(std::isfinite(samples[k].panes[1].rms_m));
    EXPECT_TRUE(std::isnan(samples[k].panes[0].rms_m)) << "the reference has none";
    EXPECT_TRUE(std::isnan(samples[k].panes[3].total_J)) << "there is no fourth pane";
  }
}

TEST(PanesRun, ASingleStepIsOneCommonTime) {
  RunWorker worker;
  worker.send(command::Load{small_comparison()});
  worker.send(command::SingleStep{});
  worker.send(command::SingleStep{});
  worker.wait_until_idle();
  EXPECT_NEAR(worker.status().time, 0.02, 1e-12);
  EXPECT_FALSE(worker.status().playing);
}

TEST(PanesRun, APaneThatDivergesStopsWithItsCauseAndTheOthersGoOn) {
  cloth::Comparison comparison = small_comparison({"rk4", "explicit-euler"});
  comparison.scene.deformation.reset();  // a limited cloth cannot diverge
  cloth::set_own(comparison.panes[1], "integrator.time_step", 0.005);
  RunWorker worker;
  worker.send(command::Load{comparison});
  const WorkerStatus end = play_to_the_end(worker);
  EXPECT_FALSE(end.panes[0].divergence);
  ASSERT_TRUE(end.panes[1].divergence);
  EXPECT_FALSE(end.panes[1].divergence->cause.empty());
  EXPECT_EQ(end.panes[0].simulated, end.duration);
  const auto samples = worker.take_pane_samples();
  EXPECT_TRUE(std::isnan(samples.back().panes[1].total_J));
  EXPECT_TRUE(std::isfinite(samples.back().panes[0].total_J));
}

TEST(PanesRun, AnEditWhileItPlaysActsAtACommonTime) {
  RunWorker worker;
  cloth::Comparison comparison = small_comparison();
  comparison.scene.duration = 1000;
  worker.send(command::Load{comparison});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().time > 0.05; }));
  comparison.scene.springs->structural *= 2;
  cloth::set_own(comparison.panes[1], "integrator.time_step", 0.0005);
  worker.send(command::Edit{comparison});
  worker.wait_until_idle();
  const WorkerStatus status = worker.status();
  EXPECT_TRUE(status.playing);
  EXPECT_GT(status.time, 0.05);
  EXPECT_EQ(*status.comparison, comparison);
  EXPECT_EQ(status.panes[1].time_step, 0.0005);
}

TEST(PanesRun, ACopiedPaneJoinsTheRunAndARemovedOneLeavesIt) {
  RunWorker worker;
  cloth::Comparison comparison = small_comparison({"verlet", "rk4"});
  comparison.scene.duration = 1000;
  worker.send(command::Load{comparison});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().time > 0.05; }));
  cloth::duplicate_pane(comparison, 0);
  worker.send(command::Edit{comparison});
  cloth::set_own(comparison.panes[1], "integrator.method", std::string("rk4"));
  worker.send(command::Edit{comparison});  // on the heels of it: the copy is made before it becomes another
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().panes.size(), 3u);
  cloth::remove_pane(comparison, 2);
  worker.send(command::Edit{comparison});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.status().playing);
  EXPECT_EQ(worker.status().new_starts, 0);
  worker.send(command::Pause{});
  worker.wait_until_idle();
  const auto samples = worker.take_pane_samples();
  ASSERT_FALSE(samples.empty());
  EXPECT_EQ(samples.front().time_s, 0) << "the run goes on";
  EXPECT_GT(samples.back().time_s, 0.05);
  EXPECT_TRUE(std::isfinite(samples.back().panes[2].total_J)) << "C's column, wherever C stands";
  EXPECT_TRUE(std::isnan(samples.back().panes[1].total_J)) << "B is gone";
  EXPECT_EQ(std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.is_start; }), 1);
}

TEST(PanesRun, APaneWithoutAPastStartsAllAnewAndGoesOnPlaying) {
  RunWorker worker;
  cloth::Comparison comparison = small_comparison({"verlet", "rk4"});
  comparison.scene.duration = 1000;
  worker.send(command::Load{comparison});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().time > 0.05; }));
  cloth::duplicate_pane(comparison, 0);
  cloth::set_own(comparison.panes[1], "integrator.method", std::string("bdf2"));
  worker.send(command::Edit{comparison});
  ASSERT_TRUE(eventually([&] { return worker.status().panes.size() == 3; }));
  EXPECT_TRUE(worker.status().playing);
  EXPECT_EQ(worker.status().new_starts, 1);
  worker.send(command::Pause{});
  worker.wait_until_idle();
  const auto samples = worker.take_pane_samples();
  ASSERT_FALSE(samples.empty());
  EXPECT_TRUE(samples.front().is_start) << "samples of the run before are gone";
}

TEST(PanesRun, PausedShowsTheTimeAtWhichItPauses) {
  RunWorker worker;
  cloth::Comparison comparison = small_comparison();
  comparison.scene.duration = 1000;
  worker.send(command::Load{comparison});
  worker.send(command::Speed{fastest});
  for (int again = 0; again < 20; ++again) {  // frames are rarer than common times: one would do by luck
    worker.send(command::Play{});
    const double before = worker.status().time;
    ASSERT_TRUE(eventually([&] { return worker.status().time > before; }));
    worker.send(command::Pause{});
    worker.wait_until_idle();
    for (std::size_t pane = 0; pane < 3; ++pane) {
      const auto frame = worker.take_frame(pane);
      ASSERT_TRUE(frame);
      EXPECT_NEAR(frame->time, worker.status().time, 1e-9);
    }
  }
}

TEST(PanesRun, LogsBesideTheRowsWhatWasDoneMeanwhile) {
  const ScratchFolder folder;
  RunWorker worker;
  cloth::Comparison comparison = small_comparison({"verlet", "rk4"});
  worker.send(command::Load{comparison});
  worker.send(command::StartRecording{folder / "recording"});
  worker.send(command::SingleStep{});
  cloth::duplicate_pane(comparison, 1);
  worker.send(command::Edit{comparison});
  worker.send(command::Pull{cloth::Pull{.particle = 3, .target = {0, 0, 1}}});
  worker.send(command::SingleStep{});
  worker.send(command::StopRecording{});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().recording_error, "");
  const std::string log = text_of(folder / "recording" / "edits.jsonl");
  EXPECT_EQ(log.find(R"({"time_s":0.01,"pane":"C","copy_of":"B"})"), 0u) << log;
  EXPECT_NE(log.find(R"({"time_s":0.01,"path":"pull","value":{"particle":3)"), std::string::npos) << log;
  EXPECT_EQ(timeless_rows(folder / "recording" / "A.csv").size(), 2u);
  EXPECT_EQ(timeless_rows(folder / "recording" / "C-2.csv").size(), 1u) << "more panes: the next part";
}

TEST(PanesRun, WithoutEditsARecordingHasNoLogOfThem) {
  const ScratchFolder folder;
  RunWorker worker;
  worker.send(command::Load{small_comparison()});
  worker.send(command::StartRecording{folder / "recording"});
  play_to_the_end(worker);
  EXPECT_FALSE(std::filesystem::exists(folder / "recording" / "edits.jsonl"));
}

TEST(PanesRun, RefusesWhatHasProblemsAndKeepsWhatRuns) {
  RunWorker worker;
  worker.send(command::Load{small_comparison()});
  cloth::Comparison broken = small_comparison();
  broken.scene.springs->structural = -1;
  worker.send(command::Edit{broken});
  worker.wait_until_idle();
  EXPECT_NE(worker.status().refusal.find("structural"), std::string::npos);
  EXPECT_EQ(*worker.status().comparison, small_comparison());
  worker.send(command::Edit{small_comparison()});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.status().refusal.empty());
}

TEST(PanesRun, RecordsTheRowsOfTheCommandLine) {
  const ScratchFolder folder;
  RunWorker worker(2);
  worker.send(command::Load{small_comparison()});
  worker.send(command::StartRecording{folder / "window"});
  const WorkerStatus end = play_to_the_end(worker);
  EXPECT_FALSE(end.recording) << "the duration ends it";
  EXPECT_EQ(end.recorded_rows, 21);
  EXPECT_EQ(end.recording_error, "");
  cloth::run_comparison(small_comparison(), {.folder = folder / "alone", .progress = {}, .may_go_on = {}});
  for (const char* file : {"A.csv", "B.csv", "C.csv", "compare.csv"}) {
    const auto rows = timeless_rows(folder / "window" / file);
    EXPECT_EQ(rows.size(), 21u);
    EXPECT_EQ(rows, timeless_rows(folder / "alone" / file)) << file;
  }
  EXPECT_EQ(text_of(folder / "window" / "comparison.json"), text_of(folder / "alone" / "comparison.json"));
}

TEST(PanesRun, ColoursByTheDistanceFromTheReferenceOnRequest) {
  RunWorker worker;
  worker.send(command::Load{small_comparison()});
  worker.send(command::Colour{Colouring::difference});
  play_to_the_end(worker);
  const auto reference = worker.take_frame(0), other = worker.take_frame(1);
  ASSERT_TRUE(reference && other);
  EXPECT_TRUE(other->shows_difference);
  EXPECT_EQ(*std::max_element(reference->strain.begin(), reference->strain.end()), 0);
  EXPECT_FLOAT_EQ(*std::max_element(other->strain.begin(), other->strain.end()),
                  static_cast<float>(*worker.status().panes[1].largest));
}

TEST(PanesRun, EndsWithinAStepHoweverLongTheIntervalIs) {
  cloth::Comparison comparison = small_comparison();
  comparison.scene.record.interval = 1000;
  comparison.scene.duration = 1000;
  comparison.scene.integrator.time_step = 0.001;
  auto worker = std::make_unique<RunWorker>();
  worker->send(command::Load{comparison});
  worker->send(command::Speed{fastest});
  worker->send(command::Play{});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const auto start = std::chrono::steady_clock::now();
  worker.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace clothlab::test::panes_run_test
