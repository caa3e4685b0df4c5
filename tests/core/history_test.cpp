// Back and forth in a run, and on from anywhere.
#include "simulation/history.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>

#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test::history_test {
namespace {

Scene swinging() {
  Scene scene = smooth_scene(6, 6);
  scene.integrator.time_step = 0.001;
  return scene;
}

Scene with(Scene scene, const std::function<void(Scene&)>& change) {
  change(scene);
  return scene;
}

BrushGust gust(double strength) {
  BrushGust brush;
  brush.velocity = {0, 0.1 * strength, strength};
  brush.radius = 3;  // the identity as matrix: one pixel is one metre
  return brush;
}

/// A run with a history, and what the state was at every step of it.
class RecordedRun {
 public:
  explicit RecordedRun(std::size_t max_bytes, const Scene& scene = swinging())
      : simulation(scene), history(max_bytes) {
    history.begin(simulation);
    note();
  }

  void advance(int steps) {
    for (int n = 0; n < steps; ++n) {
      const auto divergence = simulation.step();
      ASSERT_FALSE(divergence) << describe(*divergence);
      history.extend(simulation);
      if (simulation.state().step % 5 == 0) history.keep(simulation);
      note();
    }
  }

  void perform(const SessionAction& action) {
    ASSERT_TRUE(carry_out(action, simulation).empty());
    history.log(action, simulation);
    note();
  }

  void edit(const std::function<void(Scene&)>& change) {
    perform(edits_between(simulation.scene(), with(simulation.scene(), change)));
  }

  void note() { hash[simulation.state().step] = state_hash(simulation.state()); }

  void go_to(std::int64_t step) { EXPECT_TRUE(history.go_to(simulation, {.step = step}, {}).arrived); }

  Simulation simulation;
  History history;
  std::map<std::int64_t, std::string> hash;
};

/// Everything that a person can do, at odd steps.
void do_everything(RecordedRun& run) {
  run.perform(std::optional(Pull{35, {0.9, -0.8, 0.4}}));
  run.advance(23);
  run.edit([](Scene& scene) { scene.springs->structural = 60, scene.gravity = Vec3(0.5, -9, 0); });
  run.advance(11);
  run.perform(std::optional(gust(5)));
  run.perform(std::optional<Pull>());
  run.edit([](Scene& scene) { scene.integrator = {"bdf2", 0.0025}; });
  run.advance(18);
  run.perform(std::optional(gust(-3)));
  run.edit([](Scene& scene) { scene.cloth.pins.emplace_back(PinnedParticle{5, 0}); });
  run.edit([](Scene& scene) { scene.integrator = {"dormand-prince", 0.01}; });
  run.advance(13);
  run.perform(std::optional<BrushGust>());
  run.edit([](Scene& scene) { scene.air.reset(), scene.obstacles.emplace_back(); });
  run.edit([](Scene& scene) { scene.integrator = {"verlet", 0.0005}; });
  run.advance(40);
}

constexpr std::size_t few_states = 30000;

TEST(AHistory, LeadsBackToEveryStepToTheBit) {
  Random random;
  for (const std::size_t max_bytes : {few_states, std::size_t{1}, History::default_max_bytes}) {
    RecordedRun run(max_bytes);
    do_everything(run);
    std::vector<std::int64_t> steps(static_cast<std::size_t>(run.history.last_step() + 1));
    std::iota(steps.begin(), steps.end(), 0);
    for (int n = static_cast<int>(steps.size()) - 1; n > 0; --n)
      std::swap(steps[static_cast<std::size_t>(n)], steps[static_cast<std::size_t>(random.integer(0, n))]);
    for (const std::int64_t step : steps) {
      run.go_to(step);
      ASSERT_EQ(run.simulation.state().step, step);
      ASSERT_EQ(state_hash(run.simulation.state()), run.hash[step]) << "step " << step;
    }
  }
}

TEST(AHistory, GoesOnFromItsEndAsIfNobodyHadGoneBack) {
  RecordedRun run(few_states), plain(few_states);
  do_everything(run);
  do_everything(plain);
  run.go_to(7);
  run.go_to(run.history.last_step());
  run.advance(50);
  plain.advance(50);
  EXPECT_EQ(run.simulation.state(), plain.simulation.state());
  EXPECT_EQ(run.simulation.measure().ledger.entered(), plain.simulation.measure().ledger.entered());
}

TEST(AHistory, HasInForceWhatWasLoggedUpToTheStep) {
  RecordedRun run(few_states);
  run.advance(10);
  run.edit([](Scene& scene) { scene.springs->shear = 5; });
  run.perform(std::optional(Pull{20, {0, 0, 0}}));
  run.advance(10);
  run.go_to(9);
  EXPECT_NE(run.simulation.scene().springs->shear, 5);
  EXPECT_FALSE(run.simulation.pull());
  run.go_to(10);
  EXPECT_EQ(run.simulation.scene().springs->shear, 5);
  EXPECT_TRUE(run.simulation.pull());
}

TEST(AHistory, ThatIsCutForgetsWhatCameLater) {
  RecordedRun run(History::default_max_bytes);
  run.advance(10);
  run.edit([](Scene& scene) { scene.springs->shear = 5; });
  run.advance(20);
  run.perform(std::optional(Pull{20, {0, 0, 0}}));
  run.advance(10);
  EXPECT_FALSE(run.history.cut(run.simulation)) << "nothing comes after the end";
  run.go_to(25);
  EXPECT_TRUE(run.history.cut(run.simulation));
  EXPECT_EQ(run.history.last_step(), 25);
  EXPECT_EQ(run.history.last_time(), 0.025);
  ASSERT_EQ(run.history.commands().size(), 1u);
  for (const double time : run.history.state_times()) EXPECT_LE(time, 0.025);
}

TEST(AHistory, HasANewBranchAfterACut) {
  RecordedRun run(few_states);
  do_everything(run);
  run.go_to(30);
  run.history.cut(run.simulation);
  run.edit([](Scene& scene) { scene.gravity = Vec3(3, 0, 0); });
  run.advance(30);
  for (const std::int64_t step : {45, 12, 60, 30, 31}) {
    run.go_to(step);
    EXPECT_EQ(state_hash(run.simulation.state()), run.hash[step]) << "step " << step;
  }
}

TEST(AHistory, StaysWithinItsMemoryAndKeepsItsStatesEvenly) {
  RecordedRun run(few_states);
  for (int n = 0; n < 40; ++n) {
    run.advance(25);
    EXPECT_LE(run.history.bytes(), few_states);
  }
  const std::vector<double> times = run.history.state_times();
  ASSERT_GT(times.size(), 4u);
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), run.simulation.time());
  const double interval = times[1] - times[0];
  for (std::size_t n = 1; n + 1 < times.size(); ++n)
    EXPECT_NEAR(times[n] - times[n - 1], interval, 1e-12) << "state " << n;
}

TEST(AHistory, GoesToTheStepNearestToATime) {
  RecordedRun run(few_states);
  run.advance(50);
  for (const auto& [time, step] : {std::pair{0.0123, 12}, {0.0127, 13}, {-1.0, 0}, {7.0, 50}, {0.0, 0}}) {
    EXPECT_TRUE(run.history.go_to(run.simulation, {.step = {}, .time = time}, {}).arrived);
    EXPECT_EQ(run.simulation.state().step, step) << time;
  }
}

TEST(AHistory, CanBeLeftOnTheWay) {
  RecordedRun run(1);  // nothing but the first state and the newest
  run.advance(50);
  int left = 10;
  EXPECT_FALSE(run.history.go_to(run.simulation, {.step = 40}, [&] { return --left > 0; }).arrived);
  EXPECT_EQ(run.simulation.state().step, 10);
  EXPECT_EQ(state_hash(run.simulation.state()), run.hash[10]);
  run.go_to(45);
  EXPECT_EQ(state_hash(run.simulation.state()), run.hash[45]);
}

TEST(AHistory, LeadsBackFromADivergence) {
  RecordedRun run(few_states);
  run.advance(22);
  run.edit([](Scene& scene) { scene.integrator = {"semi-implicit-euler", 0.5}; });
  std::optional<Divergence> divergence;
  for (int n = 0; n < 10000 && !divergence; ++n) {
    divergence = run.simulation.step();
    if (!divergence) run.history.extend(run.simulation);
  }
  ASSERT_TRUE(divergence);
  run.history.return_from(*divergence, run.simulation);
  EXPECT_EQ(state_hash(run.simulation.state()), run.hash[22]);
  EXPECT_EQ(run.history.last_step(), 22);
}

TEST(AHistory, AsASessionReplaysToTheSameBits) {
  RecordedRun run(few_states);
  do_everything(run);
  for (const std::int64_t at : {run.history.last_step(), std::int64_t{17}}) {
    run.go_to(at);
    const Session session = run.history.session(run.simulation);
    EXPECT_EQ(session.final_state_hash, run.hash[session.steps]);
    const ReplayResult result = replay(session, {});
    EXPECT_TRUE(result.problems.empty());
    EXPECT_EQ(result.agrees, true);
    EXPECT_EQ(result.commands, session.commands.size());
  }
}

TEST(AHistory, OfASessionLeadsToEveryStepOfIt) {
  RecordedRun run(few_states);
  do_everything(run);
  const Session session = run.history.session(run.simulation);
  Simulation simulation(session.scene);
  History history(few_states);
  EXPECT_TRUE(history.begin(simulation, session).empty());
  for (const std::int64_t step : {std::int64_t{0}, std::int64_t{50}, std::int64_t{33}, session.steps}) {
    EXPECT_TRUE(history.go_to(simulation, {.step = step}, {}).arrived);
    EXPECT_EQ(state_hash(simulation.state()), run.hash[step]) << "step " << step;
  }
}

}  // namespace
}  // namespace cloth::test::history_test
