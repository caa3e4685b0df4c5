#include "bridge/run_worker.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulation/time_step.h"
#include "support/slow_disk.h"
#include "worker_helpers.h"

namespace clothlab::test::scene_run_test {
namespace {

constexpr double fastest = std::numeric_limits<double>::infinity();

TEST(SceneRun, ShowsTheStartOfASceneAndWaits) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  worker.wait_until_idle();
  const auto frame = worker.take_frame();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->positions.size(), 3u * 81u);
  EXPECT_EQ(frame->pinned[0], 1);
  EXPECT_EQ(frame->pinned[1], 0);
  EXPECT_EQ(frame->step, 0);
  EXPECT_FALSE(worker.status().playing);
}

TEST(SceneRun, IsAsleepWhilePaused) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  worker.wait_until_idle();
  EXPECT_FALSE(worker.is_busy());
}

TEST(SceneRun, ASingleStepIsOneStep) {
  RunWorker worker;
  const cloth::Scene scene = small_scene();
  worker.send(command::Load{scene});
  worker.send(command::SingleStep{});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().step, 1);
  EXPECT_EQ(worker.status().time, cloth::resolved_time_step(scene).value());
}

TEST(SceneRun, DoesNotRunAheadOfTheClock) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  const auto start = std::chrono::steady_clock::now();
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().time > 0.05; }));
  const double simulated = worker.status().time;
  const double clock = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LE(simulated, clock);
}

TEST(SceneRun, GivesOneSampleForEveryRecordInterval) {
  RunWorker worker;
  const cloth::Scene scene = small_scene();
  worker.send(command::Load{scene});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().time > 0.3; }));
  worker.send(command::Pause{});
  worker.wait_until_idle();
  const auto samples = worker.take_samples();
  ASSERT_GT(samples.size(), 30u);
  for (std::size_t n = 1; n < samples.size(); ++n)
    EXPECT_NEAR(samples[n].time_s - samples[n - 1].time_s, scene.record.interval, 1e-12);
  EXPECT_EQ(worker.status().lost_samples, 0);
}

TEST(SceneRun, AnEditActsOnTheRunningSimulationWithoutARestart) {
  RunWorker worker;
  cloth::Scene scene = small_scene();
  worker.send(command::Load{scene});
  worker.send(command::SingleStep{});
  scene.gravity = cloth::Vec3(0, 9.81, 0);
  scene.air.reset();
  worker.send(command::Edit{scene});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().step, 1);
  const float before = worker.take_frame()->positions[3 * 80 + 1];
  for (int n = 0; n < 60; ++n) worker.send(command::SingleStep{});
  worker.wait_until_idle();
  EXPECT_GT(worker.take_frame()->positions[3 * 80 + 1], before);  // now it falls upwards
}

TEST(SceneRun, RefusesASceneWithoutAStableStepAndSaysWhy) {
  RunWorker worker;
  cloth::Scene scene = small_scene();
  scene.damping.reset();
  scene.integrator = {"explicit-euler", std::nullopt};
  worker.send(command::Load{scene});
  worker.send(command::Play{});
  worker.wait_until_idle();
  EXPECT_NE(worker.status().refusal.find("no stable time step"), std::string::npos);
  EXPECT_FALSE(worker.status().playing);
}

TEST(SceneRun, ADivergingRunStopsShowsTheLastGoodStateAndCanGoOnAfterAnEdit) {
  RunWorker worker;
  cloth::Scene scene = small_scene();
  scene.deformation.reset();  // it would hold the cloth together at any step
  scene.integrator = {"semi-implicit-euler", 3 * cloth::resolved_time_step(scene).value()};
  worker.send(command::Load{scene});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker.status().divergence.has_value(); }));
  worker.wait_until_idle();
  EXPECT_FALSE(worker.status().playing);
  for (const float x : worker.take_frame()->positions) EXPECT_TRUE(std::isfinite(x));
  const double stopped_at = worker.status().time;

  scene.integrator.time_step.reset();
  worker.send(command::Edit{scene});
  worker.send(command::Play{});
  EXPECT_TRUE(eventually([&] { return worker.status().time > stopped_at + 0.2; }));
}

TEST(SceneRun, RestartGoesBackToTheFirstFrame) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  worker.wait_until_idle();
  const auto first = worker.take_frame()->positions;
  for (int n = 0; n < 20; ++n) worker.send(command::SingleStep{});
  worker.send(command::Restart{});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().step, 0);
  EXPECT_EQ(worker.take_frame()->positions, first);
}

TEST(SceneRun, IsDestroyedInMidRunWithoutWaiting) {
  const auto start = std::chrono::steady_clock::now();
  for (int round = 0; round < 20; ++round) {
    RunWorker worker;
    worker.send(command::Load{small_scene()});
    worker.send(command::Speed{fastest});
    worker.send(command::Play{});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(SceneRun, TakesCommandsFromTheWindowWhileItRuns) {
  RunWorker worker;
  cloth::Scene scene = small_scene();
  worker.send(command::Load{scene});
  worker.send(command::Speed{fastest});
  worker.send(command::Play{});
  for (int n = 0; n < 300; ++n) {
    scene.springs->structural = 100 + n;
    worker.send(command::Edit{scene});
    worker.send(command::Pull{cloth::Pull{.particle = n % 81, .target = {0, 1, 0.2}}});
    if (const auto frame = worker.take_frame()) {
      ASSERT_EQ(frame->positions.size(), 243u);
    }
    worker.take_samples();
  }
  worker.send(command::Pull{});
  worker.send(command::Pause{});
  worker.wait_until_idle();
  EXPECT_FALSE(worker.status().divergence);
}

TEST(SceneRun, AHandOutsideTheClothIsIgnored) {
  RunWorker worker;
  worker.send(command::Load{small_scene()});
  worker.send(command::Pull{cloth::Pull{.particle = 81, .target = {0, 0, 0}}});
  worker.send(command::Pull{cloth::Pull{.particle = -1, .target = {0, 0, 0}}});
  worker.send(command::SingleStep{});
  worker.wait_until_idle();
  EXPECT_EQ(worker.status().step, 1);
}

TEST(SceneRun, CarriesOutWhatWaitsWhenItEnds) {
  const ScratchFolder folder;
  SlowDisk disk("first.session.json");
  std::thread letting_go;
  {
    RunWorker worker;
    worker.send(command::Load{small_scene()});
    worker.send(command::SaveSession{folder / "first.session.json"});
    ASSERT_TRUE(eventually([&] { return disk.is_waited_for(); }));
    worker.send(command::SingleStep{});
    worker.send(command::SaveSession{folder / "second.session.json"});
    letting_go = std::thread([&disk] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      disk.let_go();
    });
  }
  letting_go.join();
  EXPECT_FALSE(text_of(folder / "first.session.json").empty());
  EXPECT_FALSE(text_of(folder / "second.session.json").empty());
}

}  // namespace
}  // namespace clothlab::test::scene_run_test
