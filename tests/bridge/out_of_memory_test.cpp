// An allocation that fails in a worker becomes a message, and the worker goes on. Refused are those whose
// size depends on the cloth: the JSON library does not survive the refusal of a small one.
#include <gtest/gtest.h>

#include <functional>

#include "bridge/run_worker.h"
#include "bridge/study_runner.h"
#include "support/count_allocations.h"
#include "worker_helpers.h"

namespace clothlab::test::out_of_memory_test {
namespace {

using Work = std::function<void(RunWorker&)>;

constexpr int sides = 33;
constexpr std::size_t field_bytes = sizeof(double) * sides * sides;  ///< one number a particle

cloth::Scene scene_of_this_size() {
  cloth::Scene scene = small_scene();
  scene.cloth.columns = scene.cloth.rows = sides;
  return scene;
}

/// Does the work again and again, and each time a later allocation of the worker fails, at last none.
void expect_survives(const cloth::Comparison& content, const Work& work) {
  long failures = 0, messages = 0;
  for (long number = 1;; number += 1 + number / 16) {
    SCOPED_TRACE(number);
    RunWorker worker(2);
    worker.wait_until_idle();
    bool has_failed = false;
    {
      const RefusedAllocation refused(number, field_bytes);
      work(worker);
      worker.wait_until_idle();
      has_failed = refused.has_happened();
    }
    failures += has_failed ? 1 : 0;
    if (const WorkerStatus status = worker.status();
        !status.refusal.empty() || !status.recording_error.empty() || !status.session_error.empty())
      ++messages;
    worker.send(command::Load{content});
    worker.send(command::SingleStep{});
    worker.wait_until_idle();
    ASSERT_EQ(worker.status().refusal, "");
    ASSERT_GT(worker.status().time, 0);
    ASSERT_TRUE(worker.take_frame());
    if (!has_failed) break;
  }
  EXPECT_GT(failures, 20);
  EXPECT_GT(messages, failures / 4);  // elsewhere a later command has started anew, or a thread less was had
}

void steps(RunWorker& worker, int count) {
  for (int n = 0; n < count; ++n) worker.send(command::SingleStep{});
}

cloth::Comparison two_panes() {
  cloth::Comparison comparison;
  comparison.scene = scene_of_this_size();
  comparison.panes = cloth::panes_for({"verlet", "rk4"});
  comparison.reference = "A";
  return comparison;
}

TEST(OutOfMemory, ASceneThatIsLoadedSteppedAndEdited) {
  expect_survives(cloth::comparison_of_one(scene_of_this_size()), [](RunWorker& worker) {
    cloth::Scene scene = scene_of_this_size();
    worker.send(command::Load{scene});
    steps(worker, 8);
    worker.send(command::Pull{cloth::Pull{.particle = 40, .target = {0.2, 0.1, 0}}});
    steps(worker, 2);
    scene.springs->structural *= 0.5;
    worker.send(command::Edit{scene});
    steps(worker, 2);
    worker.send(command::GoTo{{.step = 3, .time = 0}});
    worker.send(command::ShowContact{{.marks = true}});
  });
}

TEST(OutOfMemory, ARecordingAndASession) {
  const ScratchFolder folder;
  int n = 0;
  expect_survives(cloth::comparison_of_one(scene_of_this_size()), [&](RunWorker& worker) {
    worker.send(command::Load{scene_of_this_size()});
    worker.send(command::StartRecording{folder / std::to_string(++n).c_str()});
    steps(worker, 25);
    worker.send(command::StopRecording{});
    worker.send(command::SaveSession{folder / "x.session.json"});
    worker.send(command::OpenSession{folder / "x.session.json"});
  });
}

TEST(OutOfMemory, PanesThatAreLoadedSteppedAndRecorded) {
  const ScratchFolder folder;
  int n = 0;
  expect_survives(two_panes(), [&](RunWorker& worker) {
    worker.send(command::Load{two_panes()});
    worker.send(command::StartRecording{folder / std::to_string(++n).c_str()});
    steps(worker, 2);
    worker.send(command::Brush{cloth::BrushGust{.velocity = {0, 0, 5}}});
    steps(worker, 1);
    worker.send(command::StopRecording{});
    worker.send(command::GoTo{{.step = 1, .time = 0}});
  });
}

TEST(OutOfMemory, ASceneThatBecomesPanesAndAPaneThatBecomesAScene) {
  expect_survives(two_panes(), [](RunWorker& worker) {
    cloth::Comparison copies = cloth::comparison_of_one(scene_of_this_size(), "A");
    cloth::duplicate_pane(copies, 0);
    worker.send(command::Load{scene_of_this_size()});
    steps(worker, 2);
    worker.send(command::Edit{copies});
    steps(worker, 1);
    worker.send(command::Edit{scene_of_this_size()});
    steps(worker, 1);
  });
}

/// A cell that has no memory may be a result of its own; the thread ends and the next study runs.
TEST(OutOfMemory, AStudy) {
  const ScratchFolder folder;
  StudyOrder order;
  order.scene = scene_of_this_size();
  order.scene.deformation.reset();
  cloth::StabilityOptions options;
  options.methods = {"verlet"};
  options.x = cloth::default_time_axis(order.scene, options.methods);
  options.y = cloth::default_stiffness_axis(order.scene);
  options.x.count = options.y.count = 2;
  options.criterion.periods = 1;
  order.options = options;
  long failures = 0, messages = 0;
  bool has_failed = true;
  for (long number = 1; has_failed; number *= 4) {
    SCOPED_TRACE(number);
    order.folder = folder / std::to_string(number).c_str();
    StudyRunner runner;
    {
      const RefusedAllocation refused(number, field_bytes);
      runner.start(order);
      runner.wait();
      has_failed = refused.has_happened();
    }
    EXPECT_FALSE(runner.is_running());
    failures += has_failed ? 1 : 0;
    messages += runner.status().problem.empty() ? 0 : 1;
    if (number > 1) continue;
    order.folder = folder / "next";
    runner.start(order);
    runner.wait();
    EXPECT_EQ(runner.status().problem, "");
    EXPECT_EQ(runner.status().fraction, 1);
  }
  EXPECT_GT(failures, 2);
  EXPECT_GT(messages, 0);
}

}  // namespace
}  // namespace clothlab::test::out_of_memory_test
