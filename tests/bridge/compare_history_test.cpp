// Panes in the worker go back and forth in their history, and a run passes between the workers with its own.
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "bridge/compare_worker.h"
#include "bridge/simulation_worker.h"
#include "worker_helpers.h"

namespace clothlab::test::compare_history_test {
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

template <class Worker>
void steps(Worker& worker, int count) {
  for (int n = 0; n < count; ++n) worker.send(command::SingleStep{});
  worker.wait_until_idle();
}

template <class From, class To, class Content>
void pass_on(From& from, To& to, const Content& content, const cloth::Scene& scene) {
  auto run = std::make_shared<std::promise<cloth::RunWithHistory>>();
  auto taken = std::make_shared<std::future<cloth::RunWithHistory>>(run->get_future());
  from.send(command::GiveRun{scene, run});
  to.send(command::TakeRun<Content>{content, taken});
  to.wait_until_idle();
}

TEST(CompareHistory, IsGoneThroughWhilePanesPlayAndHandsPull) {
  CompareWorker worker(2);
  worker.send(command::Load{endless_comparison()});
  worker.send(command::Speed{std::numeric_limits<double>::infinity()});
  worker.send(command::Play{});
  for (int round = 0; round < 30; ++round) {
    worker.send(command::Pull{cloth::Pull{.particle = 40, .target = {0.1 * round, 0, 0}}});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (round % 3 == 0) worker.send(command::GoTo{{.step = {}, .time = 0.01 * round}});
    worker.send(command::Play{});
    worker.take_samples();
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

TEST(CompareHistory, IsPlayedAgainToItsEndAndNoFurther) {
  CompareWorker worker(1);
  worker.send(command::Load{endless_comparison()});
  steps(worker, 12);
  const auto end = worker.take_frame(1)->positions;
  worker.take_samples();
  worker.send(command::GoTo{{.step = 4, .time = 0}});
  worker.send(command::Speed{std::numeric_limits<double>::infinity()});
  worker.send(command::PlayAgain{});
  worker.wait_until_idle();
  ASSERT_TRUE(eventually([&] { return worker.status().step == 12 && !worker.status().playing; }));
  worker.wait_until_idle();
  EXPECT_EQ(worker.take_frame(1)->positions, end);
  EXPECT_TRUE(worker.take_samples().empty());  // the charts have them
  worker.send(command::GoTo{{.step = 4, .time = 0}});
  worker.send(command::Play{});  // a new branch
  worker.send(command::Pause{});
  worker.wait_until_idle();
  const auto samples = worker.take_samples();
  ASSERT_FALSE(samples.empty());
  EXPECT_TRUE(samples.front().is_cut);
}

TEST(ARunPassedOn, GoesOnInPanesAndComesBackToTheBit) {
  SimulationWorker scene_worker;
  SimulationWorker alone;
  CompareWorker panes(2);
  const cloth::Scene scene = small_scene();
  for (SimulationWorker* worker : {&scene_worker, &alone}) {
    worker->send(command::Load{scene});
    worker->send(command::Pull{cloth::Pull{.particle = 40, .target = {0.2, 0.1, 0}}});
    steps(*worker, 2 * static_cast<int>(0.01 / 0.0005));
    worker->send(command::Pull{});
  }
  pass_on(scene_worker, panes, with_copy(scene), scene);
  EXPECT_TRUE(panes.status().is_comparison());
  EXPECT_EQ(panes.status().time, alone.status().time);
  steps(panes, 3);
  EXPECT_EQ(panes.take_frame(0)->positions, panes.take_frame(1)->positions);
  const double time = panes.status().time;
  pass_on(panes, scene_worker, scene, scene);
  EXPECT_EQ(scene_worker.status().time, time);
  while (alone.status().time < time - 1e-9) steps(alone, 1);
  scene_worker.send(command::ShowContact{});
  scene_worker.wait_until_idle();
  EXPECT_EQ(scene_worker.take_frame()->positions, alone.take_frame()->positions);
  for (SimulationWorker* worker : {&scene_worker, &alone})
    worker->send(command::GoTo{{.step = 7, .time = 0}});
  for (SimulationWorker* worker : {&scene_worker, &alone}) worker->wait_until_idle();
  EXPECT_EQ(scene_worker.take_frame()->positions, alone.take_frame()->positions);
}

TEST(ARunPassedOn, StartsFromTheBeginningWhereThereIsNone) {
  SimulationWorker empty;
  CompareWorker panes(1);
  pass_on(empty, panes, with_copy(small_scene()), small_scene());
  EXPECT_TRUE(panes.status().is_comparison());
  EXPECT_EQ(panes.status().time, 0);
  cloth::Scene other = small_scene();
  other.springs->structural *= 2;
  SimulationWorker scene_worker;
  steps(panes, 2);
  pass_on(panes, scene_worker, other, other);  // no pane runs it
  EXPECT_EQ(scene_worker.status().time, 0);
  EXPECT_EQ(scene_worker.status().comparison->scene, other);
}

}  // namespace
}  // namespace clothlab::test::compare_history_test
