// The same run gives the same bits.
#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "support/files.h"

namespace cloth::test::repeat_test {
namespace {

class Repeated : public ::testing::TestWithParam<const char*> {};

TEST_P(Repeated, RunsGiveTheSameRecordAndFinalStateToTheBit) {
  Scene scene = builtin_scene(GetParam());
  scene.duration = 0.5;
  const TemporaryFolder first, second;
  const RunResult one = run_scene(scene, {.folder = first.path(), .progress = {}});
  const RunResult two = run_scene(scene, {.folder = second.path(), .progress = {}});
  ASSERT_EQ(one.summary.status, Status::finished);
  EXPECT_EQ(one.final_state, two.final_state);
  EXPECT_EQ(content_of(first / "final_state.csv"), content_of(second / "final_state.csv"));
  EXPECT_EQ(content_of(first / "scene.json"), content_of(second / "scene.json"));
  const CsvTable a = without_column(parse_csv(content_of(first / "record.csv")), "step_time_us");
  const CsvTable b = without_column(parse_csv(content_of(second / "record.csv")), "step_time_us");
  EXPECT_EQ(a.header, b.header);
  EXPECT_EQ(a.rows, b.rows);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Repeated,
                         ::testing::Values("pendulum", "ball", "curtain", "flag", "rectangle"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(ARecordedScene, RunAgainFromItsFolderGivesTheSameRecord) {
  Scene scene = builtin_scene("flag");
  scene.duration = 0.2;
  const TemporaryFolder first, second;
  run_scene(scene, {.folder = first.path(), .progress = {}});
  const SceneReading reading = read_scene(content_of(first / "scene.json"), "scene.json");
  ASSERT_TRUE(reading.scene);
  run_scene(*reading.scene, {.folder = second.path(), .progress = {}});
  EXPECT_EQ(without_column(parse_csv(content_of(first / "record.csv")), "step_time_us").rows,
            without_column(parse_csv(content_of(second / "record.csv")), "step_time_us").rows);
}

}  // namespace
}  // namespace cloth::test::repeat_test
