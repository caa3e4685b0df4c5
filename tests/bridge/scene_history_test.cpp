// The worker's way through its history, and its sessions.
#include <gtest/gtest.h>

#include <limits>

#include "simulation/session_json.h"
#include "worker_helpers.h"

namespace clothlab::test::scene_history_test {
namespace {

constexpr double fastest = std::numeric_limits<double>::infinity();

class SceneHistory : public testing::Test {
 protected:
  void load(const cloth::Scene& scene) {
    scene_ = scene;
    worker_.send(command::Load{scene});
    worker_.send(command::Speed{fastest});
  }
  void steps(int count) {
    for (int n = 0; n < count; ++n) worker_.send(command::SingleStep{});
  }
  void edit(const std::function<void(cloth::Scene&)>& change) {
    change(scene_);
    worker_.send(command::Edit{scene_});
  }
  void go_to(std::int64_t step) { worker_.send(command::GoTo{{.step = step}}); }

  /// A pull, gusts, and edits of stiffness, method and step.
  void do_everything() {
    load(small_scene());
    steps(7);
    worker_.send(command::Pull{cloth::Pull{.particle = 80, .target = {0.4, 0.5, 0.3}}});
    steps(11);
    edit([](cloth::Scene& scene) { scene.springs->structural = 80; });
    cloth::BrushGust gust;
    gust.velocity = {0.3, 0, 7};
    gust.world_to_screen(0, 3) = 1.0 / 3;
    gust.radius = 5;
    worker_.send(command::Brush{gust});
    steps(9);
    edit([](cloth::Scene& scene) { scene.integrator = {"bdf2", 0.003}; });
    worker_.send(command::Pull{});
    steps(8);
    worker_.send(command::Brush{});
    edit([](cloth::Scene& scene) { scene.cloth.pins.emplace_back(cloth::PinnedParticle{8, 0}); });
    steps(10);
  }

  std::vector<float> positions() {
    worker_.wait_until_idle();
    if (const auto frame = worker_.take_frame()) shown_ = frame->positions;
    return shown_;
  }
  WorkerStatus status() {
    worker_.wait_until_idle();
    return worker_.status();
  }
  cloth::Session saved() {
    worker_.send(command::SaveSession{folder_ / "x.session.json"});
    EXPECT_EQ(status().session_error, "");
    auto reading = cloth::read_session(text_of(folder_ / "x.session.json"), "x");
    EXPECT_TRUE(reading.session);
    return reading.session.value_or(cloth::Session{});
  }

  ScratchFolder folder_;
  RunWorker worker_;
  cloth::Scene scene_;
  std::vector<float> shown_;
};

TEST_F(SceneHistory, IsShownWithItsEndsAndItsMemory) {
  load(small_scene());
  steps(30);
  const HistoryStatus history = status().history;
  EXPECT_EQ(history.last_step, 30);
  EXPECT_EQ(history.last_time, status().time);
  EXPECT_GT(history.states, 1u);
  EXPECT_GT(history.bytes, 3 * 2 * 81 * sizeof(double));
  EXPECT_LT(history.bytes, history.max_bytes);
}

TEST_F(SceneHistory, MarksWhatWasDoneUntilItIsCutOff) {
  do_everything();
  using Kind = HistoryMark::Kind;
  const auto marks = [&] {
    const auto all = status().history.marks;
    return all ? *all : std::vector<HistoryMark>{};
  };
  const auto done = marks();
  ASSERT_EQ(done.size(), 5u);
  EXPECT_EQ(done[0].kind, Kind::pull);
  EXPECT_LT(done[0].from, done[0].to);
  EXPECT_EQ(done[1].kind, Kind::edit);
  EXPECT_NE(done[1].what.find("tructural"), std::string::npos) << done[1].what;
  EXPECT_EQ(done[2].kind, Kind::gust);
  EXPECT_EQ(done[3].kind, Kind::edit);
  EXPECT_EQ(done[4].kind, Kind::pins);
  go_to(18);
  EXPECT_EQ(marks().size(), 5u);
  steps(1);
  EXPECT_EQ(marks().size(), 3u);  // those of step 18 stay
  worker_.send(command::Restart{});
  EXPECT_TRUE(marks().empty());
}

TEST_F(SceneHistory, ShowsAStepOfThePastAndPauses) {
  load(small_scene());
  steps(13);
  const auto then = positions();
  worker_.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker_.status().step > 100; }));
  go_to(13);
  EXPECT_EQ(positions(), then);
  EXPECT_EQ(status().step, 13);
  EXPECT_FALSE(status().playing);
  EXPECT_GT(status().history.last_step, 100);
}

TEST_F(SceneHistory, GivesTheSameBitsWhenItPlaysAgain) {
  do_everything();
  const auto end = positions();
  const cloth::Session session = saved();
  go_to(5);
  worker_.send(command::PlayAgain{});
  ASSERT_TRUE(eventually([&] { return !worker_.is_busy(); }));
  EXPECT_EQ(status().step, session.steps);
  EXPECT_FALSE(status().playing);
  EXPECT_EQ(positions(), end);
  EXPECT_EQ(saved().final_state_hash, session.final_state_hash);
}

TEST_F(SceneHistory, OfASessionSavedIsReplayedToTheBit) {
  do_everything();
  const cloth::Session session = saved();
  EXPECT_EQ(session.steps, 45);
  EXPECT_EQ(session.commands.size(), 7u);
  const cloth::ReplayResult result = cloth::replay(session, {});
  EXPECT_TRUE(result.problems.empty());
  EXPECT_EQ(result.agrees, true);
}

TEST_F(SceneHistory, OfASessionSavedAfterGoingBackIsTheWholeOne) {
  do_everything();
  const std::string whole = cloth::write_session(saved());
  go_to(20);
  EXPECT_EQ(cloth::write_session(saved()), whole);
}

TEST_F(SceneHistory, IsCutWhereSomethingNewBegins) {
  do_everything();
  go_to(20);
  EXPECT_EQ(status().history.last_step, 45);
  steps(4);
  EXPECT_EQ(status().history.last_step, 24);
  const cloth::Session session = saved();
  EXPECT_EQ(session.steps, 24);
  EXPECT_EQ(session.commands.size(), 3u) << "pull, stiffness, gust";
  EXPECT_EQ(cloth::replay(session, {}).agrees, true);
}

TEST_F(SceneHistory, IsCutByAHandAndByAnEditButNotByLettingGoOfNothing) {
  load(small_scene());
  steps(30);
  go_to(10);
  worker_.send(command::Pull{});
  worker_.send(command::Brush{});
  worker_.send(command::Edit{scene_});
  EXPECT_EQ(status().history.last_step, 30);
  worker_.send(command::Pull{cloth::Pull{.particle = 80, .target = {0.4, 0.5, 0.3}}});
  EXPECT_EQ(status().history.last_step, 10);
  EXPECT_EQ(cloth::replay(saved(), {}).agrees, true);
}

TEST_F(SceneHistory, TellsTheSceneThatIsInForceAgain) {
  load(small_scene());
  steps(10);
  const double before = scene_.springs->structural;
  edit([](cloth::Scene& scene) { scene.springs->structural = 80; });
  steps(10);
  EXPECT_EQ(status().comparison->scene.springs->structural, 80);
  const std::int64_t jumps = status().jumps;
  go_to(9);
  EXPECT_EQ(status().comparison->scene.springs->structural, before);
  EXPECT_GT(status().jumps, jumps);
}

TEST_F(SceneHistory, TellsTheChartsWhatIsGoneOnlyWhenItIs) {
  load(small_scene());
  worker_.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker_.status().time > 0.2; }));
  worker_.send(command::GoTo{{.step = {}, .time = 0.1}});
  worker_.wait_until_idle();
  auto samples = worker_.take_samples();
  const auto is_cut = [](const ChartSample& sample) { return sample.is_cut; };
  EXPECT_TRUE(std::none_of(samples.begin(), samples.end(), is_cut));
  const double here = status().time;
  worker_.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker_.status().time > 0.15; }));
  worker_.send(command::Pause{});
  worker_.wait_until_idle();
  samples = worker_.take_samples();
  ASSERT_GT(samples.size(), 2u);
  EXPECT_TRUE(samples.front().is_cut);
  EXPECT_EQ(samples.front().time_s, here);
  EXPECT_EQ(std::count_if(samples.begin(), samples.end(), is_cut), 1);
  for (std::size_t n = 1; n < samples.size(); ++n) EXPECT_GT(samples[n].time_s, samples[n - 1].time_s);
}

TEST_F(SceneHistory, GivesNoSampleTwice) {
  load(small_scene());
  steps(60);
  go_to(10);
  worker_.send(command::PlayAgain{});
  ASSERT_TRUE(eventually([&] { return !worker_.is_busy(); }));
  const auto samples = worker_.take_samples();
  ASSERT_GT(samples.size(), 2u);
  for (std::size_t n = 1; n < samples.size(); ++n) EXPECT_GT(samples[n].time_s, samples[n - 1].time_s);
}

TEST_F(SceneHistory, IsLeftOnALongWayForANewerGoal) {
  cloth::Scene scene = small_scene();
  scene.cloth.columns = scene.cloth.rows = 40;
  cloth::Session session{.scene = scene};
  session.steps = 1000000000;  // years
  worker_.send(command::OpenSession{session});
  go_to(session.steps);
  ASSERT_TRUE(eventually([&] { return worker_.status().step > 0; }));
  go_to(12);
  EXPECT_EQ(status().step, 12);
  go_to(session.steps);
  ASSERT_TRUE(eventually([&] { return worker_.status().step > 12; }));
}  // and the worker ends in mid-way

TEST_F(SceneHistory, OfAnOpenedSessionIsGoneThrough) {
  do_everything();
  const auto end = positions();
  saved();
  go_to(26);
  const auto middle = positions();
  load(small_scene());
  worker_.send(command::OpenSession{folder_ / "x.session.json"});
  EXPECT_EQ(status().step, 0);
  EXPECT_EQ(status().history.last_step, 45);
  go_to(26);
  EXPECT_EQ(positions(), middle);
  EXPECT_FALSE(status().session_agrees);
  worker_.send(command::PlayAgain{});
  ASSERT_TRUE(eventually([&] { return !worker_.is_busy(); }));
  EXPECT_EQ(positions(), end);
  EXPECT_EQ(status().session_agrees, true);
}

TEST_F(SceneHistory, OfASessionThatComesOutOtherwiseSaysSo) {
  do_everything();
  cloth::Session session = saved();
  session.commands.front().step = 6;
  worker_.send(command::OpenSession{session});
  go_to(session.steps);
  EXPECT_EQ(status().session_agrees, false);
}

TEST_F(SceneHistory, OfASessionWithErrorsLeavesTheRunAsItIs) {
  load(small_scene());
  steps(5);
  cloth::write_text_file(folder_ / "bad.session.json", "{\n  \"steps\": x");
  worker_.send(command::OpenSession{folder_ / "bad.session.json"});
  EXPECT_TRUE(status().session_error.find("bad.session.json:2:12: is not JSON") == 0)
      << status().session_error;
  EXPECT_EQ(status().step, 5);
  worker_.send(command::OpenSession{folder_ / "no.session.json"});
  EXPECT_NE(status().session_error.find("No such file"), std::string::npos);
  cloth::Session session{.scene = small_scene()};
  session.commands = {{4, 0, std::optional(cloth::Pull{.particle = 81, .target = {0, 0, 0}})}};
  session.steps = 9;
  worker_.send(command::OpenSession{session});
  go_to(9);
  EXPECT_NE(status().session_error.find("there is no such particle"), std::string::npos);
  EXPECT_EQ(status().history.last_step, 4);
}

TEST_F(SceneHistory, KeepsTheLastGoodStatesOfADivergence) {
  cloth::Scene scene = small_scene();
  scene.deformation.reset();
  load(scene);
  steps(40);
  edit([&](cloth::Scene& edited) { edited.integrator = {"semi-implicit-euler", 3 * status().time_step}; });
  worker_.send(command::Play{});
  ASSERT_TRUE(eventually([&] { return worker_.status().divergence.has_value(); }));
  EXPECT_GE(status().history.last_step, 40);
  EXPECT_EQ(status().history.last_step, status().step);
  EXPECT_EQ(cloth::replay(saved(), {}).agrees, true);
  go_to(20);
  EXPECT_FALSE(status().divergence);
  EXPECT_EQ(status().step, 20);
  worker_.send(command::Play{});
  EXPECT_TRUE(eventually([&] { return worker_.status().step > 60; }));
}

TEST_F(SceneHistory, EndsARecordingWhenItGoesBack) {
  load(small_scene());
  worker_.send(command::StartRecording{folder_ / "r"});
  steps(40);
  go_to(5);
  EXPECT_FALSE(status().recording);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r" / "summary.json"));
}

TEST_F(SceneHistory, BeginsAnewWithARestart) {
  do_everything();
  worker_.send(command::Restart{});
  EXPECT_EQ(status().history.last_step, 0);
  steps(5);
  const cloth::Session session = saved();
  EXPECT_TRUE(session.commands.empty());
  EXPECT_EQ(session.scene.springs->structural, 80);
  EXPECT_EQ(cloth::replay(session, {}).agrees, true);
}

}  // namespace
}  // namespace clothlab::test::scene_history_test
