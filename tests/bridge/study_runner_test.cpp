// The thread of a study: what the window may rely on while it runs.
#include "bridge/study_runner.h"

#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"
#include "study/study_runs.h"
#include "support/files.h"
#include "support/slow_disk.h"

namespace clothlab::test::study_runner_test {
namespace {

using cloth::test::TemporaryFolder;

StudyOrder small_map(const TemporaryFolder& folder, int count, double periods) {
  StudyOrder order;
  order.scene = cloth::builtin_scene("corners-free");
  order.scene.cloth.rows = order.scene.cloth.columns = 4;
  cloth::StabilityOptions options;
  options.methods = {"verlet", "rk4"};
  options.x = cloth::default_time_axis(order.scene, options.methods);
  options.x.count = count;
  options.y = cloth::default_stiffness_axis(order.scene);
  options.y.count = count;
  options.criterion.periods = periods;
  order.options = options;
  order.folder = folder / "map";
  order.command = "a test";
  return order;
}

TEST(StudyRunner, EndsWithTheTableThatADirectCallGives) {
  const TemporaryFolder folder;
  const StudyOrder order = small_map(folder, 3, 10);
  StudyRunner runner;
  runner.start(order);
  runner.wait();
  EXPECT_FALSE(runner.is_running());
  EXPECT_EQ(runner.status().fraction, 1);
  const auto table = runner.take();
  ASSERT_TRUE(table);
  const auto direct = cloth::run_stability_map(order.scene, std::get<cloth::StabilityOptions>(order.options));
  EXPECT_EQ(cloth::study_csv(*table), cloth::study_csv(direct));
  EXPECT_FALSE(runner.take()) << "a table is given once";
  const cloth::StudyReading reading = cloth::read_study(order.folder);
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(cloth::study_csv(reading.study->table), cloth::study_csv(direct));
}

TEST(StudyRunner, IsCancelledAtTheNextStepAndKeepsWhatIsFinished) {
  const TemporaryFolder folder;
  StudyRunner runner;
  runner.start(small_map(folder, 30, 2000));
  std::shared_ptr<const cloth::StudyTable> table;
  while (!table || cloth::finished_runs(*table) == 0) {
    if (auto next = runner.take()) table = std::move(next);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  runner.cancel();
  runner.wait();
  if (auto next = runner.take()) table = std::move(next);
  EXPECT_FALSE(cloth::is_complete(*table));
  const cloth::StudyReading reading = cloth::read_study(folder / "map");
  ASSERT_TRUE(reading.study) << reading.problem;
  EXPECT_EQ(cloth::study_csv(reading.study->table), cloth::study_csv(*table));
}

TEST(StudyRunner, SaysWhereItCouldNotWriteAndGoesOn) {
  const TemporaryFolder folder;
  StudyOrder order = small_map(folder, 2, 10);
  order.folder = "/dev/null/nowhere";
  StudyRunner runner;
  runner.start(order);
  runner.wait();
  EXPECT_NE(runner.status().problem.find("/dev/null/nowhere"), std::string::npos) << runner.status().problem;
  const auto table = runner.take();
  ASSERT_TRUE(table);
  EXPECT_TRUE(cloth::is_complete(*table));
}

TEST(StudyRunner, RunsOneStudyAfterAnother) {
  const TemporaryFolder folder;
  StudyRunner runner;
  for (int turn = 0; turn < 3; ++turn) {
    StudyOrder order = small_map(folder, 2, 10);
    if (turn == 1) {
      cloth::ExtremesOptions options;
      options.scene = order.scene;
      options.methods = {"verlet"};
      options.cases = {"as-it-is", "step-x2"};
      order.options = options;
    } else if (turn == 2) {
      cloth::WorkPrecisionOptions options;
      options.methods = {"verlet"};
      options.horizon = 0.05;
      options.repeats = 2;
      options.steps_per_method = 2;
      order.options = options;
    }
    order.folder = folder / std::to_string(turn);
    runner.start(order);
    runner.wait();
    const auto table = runner.take();
    ASSERT_TRUE(table);
    EXPECT_TRUE(cloth::is_complete(*table)) << cloth::kind_of(*table);
    EXPECT_TRUE(cloth::read_study(order.folder).study) << cloth::read_study(order.folder).problem;
  }
}

TEST(StudyRunner, TheNextStudyDoesNotWaitForASlowDisk) {
  const TemporaryFolder folder;
  StudyOrder slow = small_map(folder, 2, 10), next = small_map(folder, 2, 10);
  slow.folder = folder / "slow";
  next.folder = folder / "next";
  SlowDisk disk("slow/report.html");
  StudyRunner runner;
  runner.start(slow);
  while (!disk.is_waited_for()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_TRUE(runner.status().writing);
  const auto table = runner.take();
  ASSERT_TRUE(table);
  EXPECT_TRUE(cloth::is_complete(*table)) << "it is seen before it is written";
  runner.start(next);
  while (runner.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_TRUE(cloth::read_study(next.folder).study);
  EXPECT_TRUE(disk.is_waited_for());
  disk.let_go();
  runner.wait();
  EXPECT_TRUE(cloth::read_study(slow.folder).study);
  EXPECT_EQ(runner.status().earlier_problem, "");
}

}  // namespace
}  // namespace clothlab::test::study_runner_test
