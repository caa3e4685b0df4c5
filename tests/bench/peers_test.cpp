// What clothlab-bench --peers puts together: answers of another program, times to an error, its scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/peers/peer_program.h"
#include "bench/peers/peer_tables.h"
#include "bench/peers/spring_list.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "study/reference_solution.h"

namespace cloth::peers::peers_test {
namespace {

PeerRun run_of(double error, double seconds) {
  PeerRun run;
  run.error.rms_position = error;
  run.seconds = {seconds};
  return run;
}

PeerSeries series_of(const std::string& program, const std::vector<PeerRun>& runs) {
  return {.program = program, .method = "a method", .iterations = 0, .runs = runs};
}

TEST(Peers, TimeToAnErrorIsInterpolatedInLogarithms) {
  const PeerSeries series = series_of("Clothlab", {run_of(1e-2, 0.1), run_of(1e-4, 1.6)});
  const auto time = time_to_error(series, 1e-3, 2);
  ASSERT_TRUE(time);
  EXPECT_NEAR(time->milliseconds, 1e3 * 0.4 / 2, 1e-9) << "half way in both logarithms";
  EXPECT_FALSE(time->is_bound);
}

TEST(Peers, TimeToAnErrorIsNeverExtrapolated) {
  const PeerSeries series = series_of("Clothlab", {run_of(1e-2, 0.1), run_of(1e-4, 1.6)});
  EXPECT_FALSE(time_to_error(series, 0.9e-4, 1)) << "no run is that exact";
  const auto coarse = time_to_error(series, 1e-1, 1);
  ASSERT_TRUE(coarse);
  EXPECT_TRUE(coarse->is_bound) << "what a longer step costs was not measured";
  EXPECT_NEAR(coarse->milliseconds, 100, 1e-9);
}

TEST(Peers, RunsThatFailedReachNothing) {
  PeerRun failed = run_of(1e-6, 0.01);
  failed.failure = "diverged";
  EXPECT_FALSE(time_to_error(series_of("Clothlab", {failed, run_of(1e-2, 1)}), 1e-3, 1));
}

TEST(Peers, AnErrorThatLevelsOffIsNotReached) {
  const PeerSeries series =
      series_of("Bullet double", {run_of(3e-3, 0.1), run_of(2e-3, 0.2), run_of(2.5e-3, 0.4)});
  EXPECT_TRUE(time_to_error(series, 2e-3, 1));
  EXPECT_FALSE(time_to_error(series, 1e-3, 1));
}

TEST(Peers, TheFirstOfAProgramIsItsCheapest) {
  PeerScene scene;
  scene.horizon = 1;
  scene.series = {series_of("Clothlab", {run_of(1e-3, 0.3)}), series_of("Clothlab", {run_of(1e-3, 0.2)}),
                  series_of("Bullet double", {run_of(1e-3, 0.1)})};
  EXPECT_EQ(first_there(scene, "Clothlab", 1e-2)->series, &scene.series[1]);
  EXPECT_EQ(first_there(scene, "Bullet", 1e-2)->series, &scene.series[2]);
  EXPECT_FALSE(first_there(scene, "Clothlab", 1e-4));
}

TEST(Peers, DecadesAreThoseBetweenTheErrorsThatWereFound) {
  PeerScene scene;
  scene.series = {series_of("Clothlab", {run_of(3e-2, 1), run_of(2e-5, 1)})};
  const std::vector<double> decades = error_decades(scene);
  ASSERT_EQ(decades.size(), 3u);
  EXPECT_NEAR(decades.front(), 1e-2, 1e-12);
  EXPECT_NEAR(decades.back(), 1e-4, 1e-12);
  scene.reference.floor.rms_position = 5e-4;
  EXPECT_NEAR(error_decades(scene).back(), 1e-3, 1e-12) << "the reference is not known further";
}

TEST(Peers, AnswersAreReadToTheBitAndThoseCutOffAreSaidToBe) {
  const PeerTask task{.model = "m", .time_step = 0.5, .steps = 2, .samples = 1, .iterations = 1};
  std::vector<ClothState> states(2, {.position = Vec3Field(2), .velocity = Vec3Field(2)});
  states[1].position.set(1, {0.1, 0.2, 0.3});
  const std::vector<double> masses{0, 0.25};
  std::string output = "3.24\n0.125\n";
  output.append(reinterpret_cast<const char*>(masses.data()), 2 * sizeof(double));
  output += bytes_of(states);
  const PeerAnswer answer = read_answer(output, 2, task);
  EXPECT_EQ(answer.failure, "");
  EXPECT_EQ(answer.version, "3.24");
  EXPECT_EQ(answer.seconds, 0.125);
  EXPECT_EQ(answer.masses, masses);
  ASSERT_EQ(answer.states.size(), 2u);
  EXPECT_EQ(answer.states[1].position, states[1].position);
  EXPECT_NE(read_answer(output.substr(0, output.size() - 1), 2, task).failure, "");
  EXPECT_NE(read_answer("3.24\n", 2, task).failure, "");
  EXPECT_NE(read_answer("", 2, task).failure, "");
}

TEST(Peers, AStateThatIsNotFiniteHasDiverged) {
  const PeerTask task{.model = "m", .time_step = 0.5, .steps = 2, .samples = 1, .iterations = 1};
  std::vector<ClothState> states(2, {.position = Vec3Field(1), .velocity = Vec3Field(1)});
  states[1].position.set(0, {std::nan(""), 0, 0});
  const PeerAnswer answer =
      read_answer("3.24\n0.125\n" + std::string(sizeof(double), '\0') + bytes_of(states), 1, task);
  EXPECT_EQ(answer.failure, "diverged");
}

TEST(Peers, AProgramThatIsNotThereIsAFailureInWords) {
  const PeerAnswer answer = run_peer("/no/such/program", peer_scenes(3)[0].scene, 9, {.model = "m"});
  EXPECT_NE(answer.failure.find("/no/such/program"), std::string::npos) << answer.failure;
}

TEST(Peers, ScenesHaveNothingButSpringsPinsAndGravity) {
  for (const NamedScene& named : peer_scenes(9)) {
    Scene scene = named.scene;
    scene.integrator.time_step = 1e-3;
    EXPECT_TRUE(find_problems(scene).empty()) << named.name;
    EXPECT_TRUE(is_smooth(scene)) << named.name;
    const ClothSystem system = make_cloth(scene);
    const SpringList list = spring_list(system, gravity_of(scene));
    EXPECT_EQ(list.position, system.start);
    for (std::size_t i = 0; i < list.mass.size(); ++i)
      EXPECT_EQ(list.mass[i], system.pinned[i] ? 0 : system.mass[i]);
  }
}

TEST(Peers, WithoutBulletOneMessageSaysWhatToInstall) {
  const std::string message = missing_library_message();
  EXPECT_NE(message.find("libbullet-dev"), std::string::npos);
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace cloth::peers::peers_test
