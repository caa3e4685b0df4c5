#include "bridge/live_recording.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scene_json.h"
#include "simulation/recorder.h"
#include "worker_helpers.h"

namespace clothlab::test::live_recording_test {
namespace {

using nlohmann::json;

/// The rows of a record without step_time_us, which depends on the machine.
std::vector<std::vector<std::string>> timeless_rows(const std::filesystem::path& path) {
  cloth::CsvTable table = cloth::parse_csv(text_of(path));
  EXPECT_EQ(table.header.back(), "step_time_us");
  for (auto& row : table.rows) row.pop_back();
  return table.rows;
}

void steps(RunWorker& worker, int count) {
  for (int n = 0; n < count; ++n) worker.send(command::SingleStep{});
  worker.wait_until_idle();
}

TEST(LiveRecording, HasTheSameRowsAsARunOfTheCommandLine) {
  const ScratchFolder folder;
  const cloth::Scene scene = small_scene();
  const cloth::RunResult run = cloth::run_scene(scene, {.folder = folder / "cli", .progress = {}});
  ASSERT_FALSE(run.io_error);
  {
    RunWorker worker;
    worker.send(command::Load{scene});
    worker.send(command::Speed{std::numeric_limits<double>::infinity()});
    worker.send(command::StartRecording{folder / "window"});
    worker.send(command::Play{});
    ASSERT_TRUE(eventually([&] { return worker.status().time > scene.duration; }));
  }
  auto expected = timeless_rows(folder / "cli" / "record.csv");
  auto recorded = timeless_rows(folder / "window" / "record.csv");
  ASSERT_GE(recorded.size(), expected.size());
  recorded.resize(expected.size());
  EXPECT_EQ(recorded, expected);
  EXPECT_EQ(text_of(folder / "window" / "scene.json"), text_of(folder / "cli" / "scene.json"));
}

TEST(LiveRecording, LogsEveryEditWithItsStep) {
  const ScratchFolder folder;
  cloth::Scene scene = small_scene();
  RunWorker worker;
  worker.send(command::Load{scene});
  worker.send(command::StartRecording{folder / "r"});
  steps(worker, 3);
  scene.springs->structural = 123;
  worker.send(command::Edit{scene});
  worker.send(command::Pull{cloth::Pull{.particle = 40, .target = {0, 0, 1}}});
  worker.send(command::StopRecording{});
  worker.wait_until_idle();

  std::istringstream lines(text_of(folder / "r" / "edits.jsonl"));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const json edit = json::parse(line);
  EXPECT_EQ(edit["step"], 3);
  EXPECT_EQ(edit["path"], "springs.structural");
  EXPECT_EQ(edit["value"], 123.0);
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(json::parse(line)["value"]["particle"], 40);
}

TEST(LiveRecording, GoesOnInANewFileWhenTheStagesChange) {
  const ScratchFolder folder;
  cloth::Scene scene = small_scene();
  RunWorker worker;
  worker.send(command::Load{scene});
  worker.send(command::StartRecording{folder / "r"});
  worker.wait_until_idle();
  scene.air.reset();
  worker.send(command::Edit{scene});
  steps(worker, 60);
  worker.send(command::StopRecording{});
  worker.wait_until_idle();
  EXPECT_NE(text_of(folder / "r" / "record.csv").find("air_work_J"), std::string::npos);
  const std::string second = text_of(folder / "r" / "record-2.csv");
  EXPECT_NE(second.find("time_s"), std::string::npos);
  EXPECT_EQ(second.find("air_work_J"), std::string::npos);
}

TEST(LiveRecording, ThatBeginsLaterKeepsTheStateItBeganFrom) {
  const ScratchFolder folder;
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  steps(worker, 5);
  worker.send(command::StartRecording{folder / "r"});
  worker.send(command::StopRecording{});
  worker.wait_until_idle();
  const auto start = cloth::parse_csv(text_of(folder / "r" / "start_state.csv"));
  EXPECT_EQ(start.rows.size(), 81u);
  EXPECT_EQ(start.rows, cloth::parse_csv(text_of(folder / "r" / "final_state.csv")).rows);
}

TEST(LiveRecording, IntoAFolderThatCannotBeMadeIsAnErrorAndTheRunGoesOn) {
  const ScratchFolder folder;
  cloth::write_text_file(folder / "file", "not a folder");
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  worker.send(command::StartRecording{folder / "file/inside"});
  steps(worker, 2);
  EXPECT_TRUE(eventually([&] { return worker.status().step == 2; }));
  EXPECT_FALSE(worker.status().recording);
  EXPECT_NE(worker.status().recording_error.find("file/inside"), std::string::npos);
}

TEST(LiveRecording, IsWholeWhenTheWorkerIsDestroyedInMidRun) {
  const ScratchFolder folder;
  {
    RunWorker worker;
    worker.send(command::Load{small_scene()});
    worker.send(command::Speed{std::numeric_limits<double>::infinity()});
    worker.send(command::StartRecording{folder / "r"});
    worker.send(command::Play{});
    ASSERT_TRUE(eventually([&] { return worker.status().recorded_rows > 3; }));
  }
  const auto table = cloth::parse_csv(text_of(folder / "r" / "record.csv"));
  ASSERT_GT(table.rows.size(), 3u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  EXPECT_EQ(json::parse(text_of(folder / "r" / "summary.json"))["status"], "stopped");
}

}  // namespace
}  // namespace clothlab::test::live_recording_test
