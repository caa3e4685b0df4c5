#include "simulation/automatic_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "simulation/session.h"
#include "simulation/session_json.h"
#include "simulation/time_step.h"
#include "support/violent_scenes.h"

namespace cloth::test::automatic_step_test {
namespace {

constexpr std::uint64_t seed = 1;

/// Hung by its upper edge, its weight stretches it fivefold: stretched, the waves across the cloth are faster
/// than any is flat.
Scene soft_curtain(const std::string& method) {
  Scene scene = builtin_scene("corners-free");
  scene.cloth.columns = scene.cloth.rows = 20;
  scene.cloth.mass = 1;
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = SpringMaterial{.structural = 3, .shear = 0, .flexion = 0, .damping = 0};
  scene.integrator = {.method = method};
  scene.record.interval = 0.0461;
  scene.duration = 20;
  return scene;
}

TEST(AutomaticStep, OfAClothThatStretchesFivefoldDoesNotDiverge) {
  for (const char* method : {"verlet", "semi-implicit-euler", "rk4"}) {
    const RunResult result = run_scene(soft_curtain(method), {.folder = {}, .progress = {}});
    EXPECT_EQ(result.summary.status, Status::finished) << method;
    EXPECT_GT(result.summary.max_strain, 3) << method;
  }
}

TEST(AutomaticStep, OfASoftDampedFlagPulledByAHandDoesNotDiverge) {
  Scene scene = builtin_scene("flag");
  scene.cloth.mass = 0.0512;
  scene.cloth.rows = scene.cloth.columns = 16;
  scene.springs = SpringMaterial{.structural = 38, .shear = 15.2, .flexion = 1.52, .damping = 0.1818};
  scene.air->drag = 0.003;
  scene.integrator = {.method = "verlet"};
  Simulation simulation(scene);
  std::optional<Divergence> divergence;
  for (int n = 0; n < 3000 && !divergence; ++n) {
    const double phase = 3 * simulation.time();
    if (n % 10 == 0)
      simulation.set_pull(Pull{255, Vec3(std::sin(phase), -1 - std::cos(phase), std::sin(2 * phase))});
    divergence = simulation.step();
  }
  EXPECT_FALSE(divergence) << describe(*divergence);
}

/// What a hand could give at once counts as long as its work may be in the cloth, not only until the particle
/// has come to where it is pulled to.
TEST(AutomaticStep, OfARestingClothThatAHandGrabsFromAfarIsNotStoppedForIt) {
  const ViolentScene grabbed = violent_scene(7, 550);
  const ViolentRun run = run_violent(grabbed, grabbed.steps);
  EXPECT_FALSE(run.divergence) << describe(*run.divergence);
}

TEST(AutomaticStep, OfRandomViolentScenesDoesNotDiverge) {
  for (std::uint64_t number = 0; number < 60; ++number) {
    const ViolentRun run = run_violent(violent_scene(seed, number), 400);
    EXPECT_FALSE(run.divergence && !run.divergence->pinched)
        << "seed " << seed << ", scene " << number << ": " << describe(*run.divergence);
  }
}

/// One whose step is shortened, without its hand, so that its start and its steps alone decide it.
ViolentScene found_heating_scene(const std::string& method) {
  for (std::uint64_t number = 0; number < 400; ++number) {
    ViolentScene violent = violent_scene(seed, number);
    if (violent.family != "plain" || violent.scene.deformation || violent.scene.integrator.method != method)
      continue;
    violent.before_step = [](Simulation&) {};
    if (run_violent(violent, 800).shortened > 0) return violent;
  }
  throw std::runtime_error("no such scene");
}

const ViolentScene& heating_scene(const std::string& method) {
  static std::map<std::string, ViolentScene> scenes;
  if (!scenes.count(method)) scenes.emplace(method, found_heating_scene(method));
  return scenes.at(method);
}

class AShortenedStep : public ::testing::TestWithParam<const char*> {};

TEST_P(AShortenedStep, DividesTheRecordIntervalAndNeverGrowsAgain) {
  const ViolentScene& violent = heating_scene(GetParam());
  const double interval = violent.scene.record.interval;
  Simulation simulation(violent.scene, violent.start);
  const double first = simulation.time_step();
  double shortest = first;
  for (int n = 0; n < 1500; ++n) {
    ASSERT_FALSE(simulation.step());
    EXPECT_LE(simulation.time_step(),
              shortest * (1 + 1e-9) * (simulation.is_within_interval() ? 1 : std::sqrt(2)));
    shortest = std::min(shortest, simulation.time_step());
  }
  ASSERT_FALSE(simulation.step_changes().empty());
  ASSERT_LE(simulation.step_changes().size(), 4u);
  double longest = first;
  for (const StepChange& change : simulation.step_changes()) {
    longest /= std::sqrt(2);
    EXPECT_LE(change.time_step, longest * (1 + 1e-9));
    EXPECT_NEAR(interval / change.time_step, std::round(interval / change.time_step),
                1e-9 * interval / change.time_step);
  }
}

TEST_P(AShortenedStep, LeavesTheRowsWhereTheyAre) {
  const ViolentScene& violent = heating_scene(GetParam());
  const double interval = violent.scene.record.interval;
  Simulation simulation(violent.scene, violent.start);
  RowClock rows = RowClock::of(simulation);
  int row = 0;
  for (int n = 0; n < 1500; ++n) {
    ASSERT_FALSE(simulation.step());
    rows.follow(simulation);
    if (!rows.due(simulation.state().step)) continue;
    ++row;
    EXPECT_NEAR(simulation.time(), row * interval, 1e-9 * interval) << row;
  }
  EXPECT_GE(simulation.time() + simulation.time_step(), row * interval);
  EXPECT_LT(simulation.time(), (row + 1) * interval);
  EXPECT_FALSE(simulation.step_changes().empty());
}

TEST_P(AShortenedStep, IsTheSameToTheBitInSeveralStepsAtOnce) {
  const ViolentScene& violent = heating_scene(GetParam());
  Simulation one(violent.scene, violent.start), other(violent.scene, violent.start);
  for (int n = 0; n < 1400; ++n) ASSERT_FALSE(one.step());
  for (int n = 0; n < 20; ++n) ASSERT_FALSE(other.advance(70));
  EXPECT_EQ(one.state(), other.state());
  EXPECT_EQ(one.step_changes(), other.step_changes());
  EXPECT_FALSE(one.step_changes().empty());
}

TEST_P(AShortenedStep, IsPartOfACheckpoint) {
  const ViolentScene& violent = heating_scene(GetParam());
  Simulation whole(violent.scene, violent.start);
  std::vector<Checkpoint> checkpoints;
  for (int n = 0; n < 1400; ++n) {
    if (n % 97 == 0) checkpoints.push_back(whole.checkpoint());
    ASSERT_FALSE(whole.step());
  }
  ASSERT_FALSE(whole.step_changes().empty());
  for (const Checkpoint& checkpoint : checkpoints) {
    Simulation again(violent.scene, violent.start);
    again.restore(checkpoint);
    while (again.state().step < 1400) ASSERT_FALSE(again.step());
    EXPECT_EQ(again.state(), whole.state()) << checkpoint.state.step;
    EXPECT_EQ(again.step_changes(), whole.step_changes()) << checkpoint.state.step;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, AShortenedStep, ::testing::Values("verlet", "semi-implicit-euler"));

TEST(AGivenStep, IsNeverShortened) {
  ViolentScene violent = heating_scene("verlet");
  violent.scene.integrator.time_step = resolved_time_step(violent.scene);
  EXPECT_EQ(run_violent(violent, 800).shortened, 0u);
}

TEST(ASession, KeepsWhereAutoShortenedTheStep) {
  Session session{.scene = soft_curtain("verlet"), .steps = 100, .time = 1};
  session.step_changes = {{16, 0.25, 0.1 / 3}, {32, 0.4, 0.025}};
  const SessionReading reading = read_session(write_session(session), "a.session.json");
  ASSERT_TRUE(reading.session) << reading.problems.front().text();
  EXPECT_EQ(reading.session->step_changes, session.step_changes);
}

TEST(EnergyThatNothingExplains, AsksFourTimesForAShorterStep) {
  AutomaticStep automatic;
  EXPECT_FALSE(asks_for_shorter(automatic, 0.09));
  EXPECT_FALSE(asks_for_shorter(automatic, -0.05));
  EXPECT_TRUE(asks_for_shorter(automatic, 0.06)) << "from the lowest so far";
  EXPECT_FALSE(asks_for_shorter(automatic, 0.15));
  for (int k = 2; k <= 4; ++k) EXPECT_TRUE(asks_for_shorter(automatic, k));
  EXPECT_FALSE(asks_for_shorter(automatic, 100));
  EXPECT_EQ(steps_after_shortening(1, 0.1, 0), 10);
  EXPECT_EQ(steps_after_shortening(1, 0.1, 1), 15);
  EXPECT_EQ(steps_after_shortening(1, 0.1, 2), 20);
  EXPECT_EQ(steps_after_shortening(1, 0.1, 4), 40);
}

}  // namespace
}  // namespace cloth::test::automatic_step_test
