// Panes go back and forth in their history, and a run becomes panes or a scene with its own.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <thread>

#include "bridge/run_worker.h"
#include "worker_helpers.h"

namespace clothlab::test::panes_history_test {
namespace {

cloth::Comparison endless_comparison() {
  cloth::Comparison comparison;
  comparison.scene = small_scene();
  comparison.scene.duration = 1000;
  comparison.panes = cloth::panes_for({"verlet", "rk4"});
  comparison.reference = "A";
  return comparison;
}

/// As a scene and its copy.
cloth::Comparison with_copy(const cloth::Scene& scene) {
  cloth::Comparison comparison = cloth::comparison_of_one(scene, "A");
  cloth::duplicate_pane(comparison, 0);
  return comparison;
}

void steps(RunWorker& worker, int count) {
  for (int n = 0; n < count; ++n) worker.send(command::SingleStep{});
  worker.wait_until_idle();
}

TEST(PanesHistory, IsGoneThroughWhilePanesPlayAndHandsPull) {
  RunWorker worker(2);
  worker.send(command::Load{endless_comparison()});
  worker.send(command::Speed{std::numeric_limits<double>::infinity()});
  worker.send(command::Play{});
  for (int round = 0; round < 30; ++round) {
    worker.send(command::Pull{cloth::Pull{.particle = 40, .target = {0.1 * round, 0, 0}}});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (round % 3 == 0) worker.send(command::GoTo{{.step = {}, .time = 0.01 * round}});
    worker.send(command::Play{});
    worker.take_pane_samples();
    worker.take_frame(1);
    if (round % 5 == 4) worker.wait_until_idle();  // at least one common time further
  }
  worker.send(command::Pause{});
  worker.wait_until_idle();
  worker.send(command::GoTo{{.step = 0, .time = 0}});
  worker.wait_until_idle();
  const WorkerStatus status = worker.status();
  EXPECT_EQ(status.time, 0);
  EXPECT_EQ(status.refusal, "");
  EXPECT_GT(status.history.last_step, 0);
  EXPECT_GT(status.history.states, 2u);
}

TEST(PanesHistory, IsPlayedAgainToItsEndAndNoFurther) {
  RunWorker worker(1);
  worker.send(command::Load{endless_comparison()});
  steps(worker, 12);
  const auto end = worker.take_frame(1)->positions;
  worker.take_pane_samples();
  worker.send(command::GoTo{{.step = 4, .time = 0}});
  worker.send(command::Speed{std::numeric_limits<double>::infinity()});
  worker.send(command::PlayAgain{});
  worker.wait_until_idle();
  ASSERT_TRUE(eventually([&] { return worker.status().step == 12 && !worker.status().playing; }));
  worker.wait_until_idle();
  EXPECT_EQ(worker.take_frame(1)->positions, end);
  EXPECT_TRUE(worker.take_pane_samples().empty());  // the charts have them
  worker.send(command::GoTo{{.step = 4, .time = 0}});
  worker.send(command::Play{});  // a new branch
  worker.send(command::Pause{});
  worker.wait_until_idle();
  const auto samples = worker.take_pane_samples();
  ASSERT_FALSE(samples.empty());
  EXPECT_TRUE(samples.front().is_cut);
}

TEST(ARunPassedOn, GoesOnInPanesAndComesBackToTheBit) {
  RunWorker worker, alone;
  const std::array<RunWorker*, 2> both{&worker, &alone};
  const cloth::Scene scene = small_scene();
  for (RunWorker* one : both) {
    one->send(command::Load{scene});
    one->send(command::Pull{cloth::Pull{.particle = 40, .target = {0.2, 0.1, 0}}});
    steps(*one, 2 * static_cast<int>(0.01 / 0.0005));
    one->send(command::Pull{});
  }
  worker.send(command::Edit{with_copy(scene)});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.status().is_comparison());
  alone.wait_until_idle();
  EXPECT_EQ(worker.status().time, alone.status().time);
  steps(worker, 3);
  EXPECT_EQ(worker.take_frame(0)->positions, worker.take_frame(1)->positions);
  const double time = worker.status().time;
  worker.send(command::Edit{scene});
  worker.wait_until_idle();
  EXPECT_FALSE(worker.status().is_comparison());
  EXPECT_EQ(worker.status().time, time);
  while (alone.status().time < time - 1e-9) steps(alone, 1);
  EXPECT_EQ(worker.take_frame()->positions, alone.take_frame()->positions);
  for (RunWorker* one : both) one->send(command::GoTo{{.step = 7, .time = 0}});
  for (RunWorker* one : both) one->wait_until_idle();
  EXPECT_EQ(worker.take_frame()->positions, alone.take_frame()->positions);
}

TEST(ARunPassedOn, StartsFromTheBeginningWhereThereIsNone) {
  RunWorker worker;
  worker.send(command::Edit{with_copy(small_scene())});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.status().is_comparison());
  EXPECT_EQ(worker.status().time, 0);
  steps(worker, 2);
  EXPECT_GT(worker.status().time, 0);
  cloth::Scene other = small_scene();
  other.springs->structural *= 2;
  worker.send(command::Edit{other});  // no pane runs it
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().time, 0);
  EXPECT_EQ(worker.status().comparison->scene, other);
}

TEST(ARunPassedOn, StartsFromTheBeginningWherePanesCannotGoOnWithIt) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  steps(worker, 5);
  cloth::Comparison smaller = with_copy(small_scene());
  smaller.scene.cloth.columns = smaller.scene.cloth.rows = 7;
  worker.send(command::Edit{smaller});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().refusal, "");
  EXPECT_TRUE(worker.status().is_comparison());
  EXPECT_EQ(worker.status().time, 0);
  EXPECT_EQ(worker.take_frame(1)->positions.size(), 3u * 49);
}

TEST(ARunPassedOn, LeavesNothingOfTheOtherKindBehind) {
  RunWorker worker;
  worker.send(command::Load{endless_comparison()});
  steps(worker, 3);  // frames and samples that nobody fetches
  worker.send(command::Edit{small_scene()});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.take_frame(0));
  EXPECT_FALSE(worker.take_frame(1));
  EXPECT_TRUE(worker.take_pane_samples().empty());
  worker.send(command::Edit{endless_comparison()});
  worker.wait_until_idle();
  EXPECT_TRUE(worker.take_frame(1));
  EXPECT_TRUE(worker.take_samples().empty());
}

}  // namespace
}  // namespace clothlab::test::panes_history_test
