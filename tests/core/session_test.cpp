// Sessions as values and as files.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "simulation/session_json.h"
#include "support/files.h"
#include "support/scenes.h"

namespace cloth::test::session_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

BrushGust odd_gust() {
  BrushGust gust;
  gust.velocity = {1.0 / 3, -0.0, 1e-300};
  for (int k = 0; k < 16; ++k) gust.world_to_screen(k / 4, k % 4) = std::sqrt(k + 2.0) * (k % 3 - 1);
  gust.cursor = {std::sqrt(5.0), 1e17 / 3};
  gust.radius = 0.1 + 0.2;
  return gust;
}

Session short_session() {
  Session session;
  session.scene = smooth_scene(4, 4);
  session.scene.integrator.time_step = 0.001;
  session.commands = {{0, 0, std::optional(Pull{15, {0.1 + 0.2, -1.0 / 3, 1e-17}})},
                      {5, 0.005, std::optional(odd_gust())},
                      {5, 0.005, Edits{{"springs.shear", "7.25"}, {"damping", "null"}}},
                      {9, 0.009, Edits{{"integrator.method", "\"rk4\""}, {"integrator.time_step", "0.0005"}}},
                      {12, 0.0105, std::optional<BrushGust>()},
                      {20, 0.0145, std::optional<Pull>()}};
  session.steps = 20;
  session.time = 0.0145;
  session.version = "0.1.0";
  return session;
}

std::string messages(const std::string& text) {
  std::string all;
  for (const Problem& problem : read_session(text, "x.session.json").problems) all += problem.text() + "\n";
  return all;
}

/// The text of short_session with one thing changed.
std::string changed(const std::function<void(nlohmann::ordered_json&)>& change) {
  auto document = nlohmann::ordered_json::parse(write_session(short_session()));
  change(document);
  return document.dump();
}

TEST(ASession, ReadsBackToTheSameBits) {
  const Session session = short_session();
  const std::string text = write_session(session);
  const SessionReading reading = read_session(text, "x");
  ASSERT_TRUE(reading.session) << messages(text);
  EXPECT_EQ(write_session(*reading.session), text);
  EXPECT_EQ(reading.session->scene, session.scene);
  const auto gust = std::get<std::optional<BrushGust>>(reading.session->commands[1].action);
  EXPECT_EQ(gust->world_to_screen, odd_gust().world_to_screen);
  EXPECT_EQ(gust->cursor, odd_gust().cursor);
  EXPECT_EQ(gust->radius, odd_gust().radius);
  EXPECT_TRUE(std::signbit(gust->velocity.y()));
  EXPECT_EQ(std::get<std::optional<Pull>>(reading.session->commands[0].action)->target,
            Vec3(0.1 + 0.2, -1.0 / 3, 1e-17));
}

TEST(ASession, HasALineForEachCommand) {
  const std::string text = write_session(short_session());
  EXPECT_TRUE(
      has(text, "\n    {\"step\":5,\"time_s\":0.005,\"set\":{\"springs.shear\":7.25,\"damping\":null}},\n"))
      << text;
}

TEST(ASession, ReplaysTheSameWithAndWithoutAFile) {
  const Session session = short_session();
  const SessionReading reading = read_session(write_session(session), "x");
  EXPECT_EQ(replay(session, {}).run.final_state, replay(*reading.session, {}).run.final_state);
}

TEST(ASession, DoesWhatItsCommandsSayAtTheirSteps) {
  const Session session = short_session();
  Simulation simulation(session.scene);
  std::size_t next = 0;
  for (int step = 0;; ++step) {
    for (; next < session.commands.size() && session.commands[next].step == step; ++next)
      ASSERT_TRUE(carry_out(session.commands[next].action, simulation).empty());
    if (step == session.steps) break;
    simulation.step();
  }
  EXPECT_EQ(replay(session, {}).run.final_state, simulation.state());
  EXPECT_EQ(simulation.scene().integrator.method, "rk4");
  EXPECT_EQ(simulation.time(), 9 * 0.001 + 11 * 0.0005);
  EXPECT_FALSE(simulation.scene().damping);
}

TEST(ASession, WithoutCommandsIsTheRunOfItsScene) {
  Session session{.scene = smooth_scene(4, 4)};
  session.scene.duration = 0.1;
  session.scene.integrator.time_step = 0.001;
  session.steps = 100;
  EXPECT_EQ(replay(session, {}).run.final_state, run_scene(session.scene, {}).final_state);
}

TEST(ASession, OfAnotherEndIsSaidToDiffer) {
  Session session = short_session();
  EXPECT_FALSE(replay(session, {}).agrees.has_value());
  session.final_state_hash = state_hash(replay(session, {}).run.final_state);
  EXPECT_EQ(replay(session, {}).agrees, true);
  session.commands.erase(session.commands.begin());
  EXPECT_EQ(replay(session, {}).agrees, false);
  EXPECT_FALSE(replay(session, {.folder = {}, .until = 0.004, .progress = {}}).agrees.has_value());
}

TEST(AReplay, EndsAtTheStepNearestToATime) {
  const Session session = short_session();
  EXPECT_EQ(replay(session, {.folder = {}, .until = 0.0034, .progress = {}}).run.final_state.step, 3);
  EXPECT_EQ(replay(session, {.folder = {}, .until = 0, .progress = {}}).run.final_state.step, 0);
  EXPECT_EQ(replay(session, {.folder = {}, .until = 9, .progress = {}}).run.final_state.step, 20);
}

TEST(AReplay, GoesOnInANewRecordWhenTheStagesChange) {
  const TemporaryFolder folder;
  Session session = short_session();
  session.scene.record.interval = 0.001;
  ASSERT_FALSE(replay(session, {.folder = folder / "r", .until = 1, .progress = {}}).run.io_error);
  EXPECT_FALSE(has(content_of(folder / "r/record.csv"), "pull_work_J"));
  EXPECT_TRUE(has(content_of(folder / "r/record-2.csv"), "pull_work_J"));
  EXPECT_TRUE(has(content_of(folder / "r/record-3.csv"), "brush_work_J"));
  const double last = column_of(parse_csv(content_of(folder / "r/record-3.csv")), "step").back();
  EXPECT_EQ(last, 20);
  session.commands.clear();
  replay(session, {.folder = folder / "r", .until = 1, .progress = {}});
  EXPECT_FALSE(std::filesystem::exists(folder / "r/record-2.csv")) << "of the replay before";
}

TEST(AReplay, StopsAtACommandThatDoesNotFit) {
  const auto first_problem = [](const SessionAction& action) {
    Session session = short_session();
    session.commands = {{3, 0, action}};
    const ReplayResult result = replay(session, {});
    EXPECT_EQ(result.commands, 0u);
    EXPECT_EQ(result.problems.size(), 1u);
    return result.problems.empty() ? "" : result.problems.front().text();
  };
  EXPECT_TRUE(has(first_problem(std::optional(Pull{16, {0, 0, 0}})), "pull.particle = 16: there is no such"));
  EXPECT_TRUE(has(first_problem(Edits{{"springs.shear", "-1"}}), "set.springs.shear = -1 N/m: must be >= 0"));
  EXPECT_TRUE(has(first_problem(Edits{{"cloth.rows", "5"}}), "cannot change while a scene runs"));
  EXPECT_TRUE(has(first_problem(Edits{{"cloth.collar", "5"}}), "is not a known key"));
  EXPECT_TRUE(has(first_problem(Edits{{"integrator.method", "\"explicit-euler\""},
                                      {"integrator.time_step", "\"auto\""},
                                      {"damping", "null"},
                                      {"air", "null"}}),
                  "no stable time step"));
}

TEST(ReadingASession, NamesPlaceValueAndRuleOfEveryProblem) {
  const std::string all = messages(changed([](auto& root) {
    root["scene"]["springs"]["shear"] = -2;
    root["commands"][0]["pull"]["particle"] = -1;
    root["commands"][1]["brush"]["world_to_screen"].erase(3);
    root["commands"][2]["step"] = 21;
    root["commands"][3]["pull"] = nullptr;
    root["commands"][4]["step"] = 1;
    root["wings"] = 2;
  }));
  for (const char* part :
       {"x.session.json:1:", "scene.springs.shear = -2 N/m: must be >= 0",
        "commands.0.pull.particle = -1: must be a whole number, >= 0", "commands.1.brush.world_to_screen = [",
        "must be a list of 16 numbers", "commands.2.step = 21: must be <= steps, 20",
        "commands.3: must have one of set, brush, pull",
        "commands.4.step = 1: must not be before the command above it", "wings: is not a known key"})
    EXPECT_TRUE(has(all, part)) << part << "\n" << all;
}

TEST(ReadingASession, FindsWhatIsMissing) {
  const std::string all = messages("{}");
  for (const char* part : {"scene: must be given", "steps: must be given", "commands: must be given"})
    EXPECT_TRUE(has(all, part)) << all;
}

TEST(ReadingASession, SaysWhereTheTextStopsBeingJson) {
  const std::string text = write_session(short_session());
  EXPECT_TRUE(has(messages(text.substr(0, text.size() - 3)), "ends too early"));
  EXPECT_TRUE(has(messages("{\n  \"steps\": 1,\n  scene"), "x.session.json:3:3: is not JSON from here on"));
}

TEST(ReadingASession, PutsAProblemOfACommandAtItsLine) {
  const std::string text = write_session(short_session());
  std::vector<Problem> problems{{"set.springs.shear", "7.25 N/m", "is odd", "", 0, 0}};
  place_in_session(text, "x.session.json", 2, problems);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find("springs.shear")), '\n');
  EXPECT_EQ(problems.front().line, line);
  EXPECT_EQ(problems.front().path, "commands.2.set.springs.shear");
}

TEST(StateHash, ChangesWithEveryBit) {
  ClothState state{.position = Vec3Field(3), .velocity = Vec3Field(3), .time = 1, .step = 4};
  const std::string hash = state_hash(state);
  EXPECT_EQ(hash.size(), 16u);
  const auto expect_other = [&](const std::function<void(ClothState&)>& change) {
    ClothState other = state;
    change(other);
    EXPECT_NE(state_hash(other), hash);
  };
  expect_other([](ClothState& s) { s.position.x()[1] = std::numeric_limits<double>::denorm_min(); });
  expect_other([](ClothState& s) { s.velocity.z()[2] = -0.0; });
  expect_other([](ClothState& s) { s.time = std::nextafter(1.0, 2.0); });
  expect_other([](ClothState& s) { s.step = 5; });
}

}  // namespace
}  // namespace cloth::test::session_test
