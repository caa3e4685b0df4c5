#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "scene/builtin_scenes.h"
#include "simulation/session_json.h"
#include "support/files.h"

namespace cloth::test::replay_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A pull, a change of method and a pin, with the hash of where they lead.
Session session() {
  Session session{.scene = builtin_scene("wind")};
  session.scene.cloth.columns = session.scene.cloth.rows = 9;
  session.commands = {{0, 0, std::optional(Pull{80, {0.4, 0.3, 0.5}})},
                      {31, 0, Edits{{"integrator.method", "\"bdf2\""}, {"integrator.time_step", "0.004"}}},
                      {44, 0, Edits{{"cloth.pins", "[\"top-left\", [8, 8]]"}}},
                      {60, 0, std::optional<Pull>()}};
  session.steps = 90;
  session.version = "0.1.0";
  session.final_state_hash = state_hash(replay(session, {}).run.final_state);
  return session;
}

class Replay : public testing::Test {
 protected:
  CommandResult run(const Session& session, const std::string& options = "") {
    return run(write_session(session), options);
  }
  CommandResult run(const std::string& text, const std::string& options) {
    EXPECT_FALSE(write_text_file(folder_ / "x.session.json", text));
    return shell("cd '" + folder_.path().string() + "'\n\"$CLI\" replay x.session.json " + options);
  }
  TemporaryFolder folder_;
};

TEST_F(Replay, EndsInTheSessionsStateAndSaysSo) {
  const CommandResult result = run(session(), "--out r");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(has(result.output, "the final state is the session's, to the bit")) << result.output;
  EXPECT_TRUE(has(result.output, "4 of 4 commands carried out")) << result.output;
  EXPECT_EQ(content_of(folder_ / "r/final_state.csv"), state_csv(replay(session(), {}).run.final_state));
  for (const char* file : {"r/scene.json", "r/record.csv", "r/record-2.csv", "r/summary.json"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
}

TEST_F(Replay, WithAnotherEndExitsWithFive) {
  Session other = session();
  other.commands[0].step = 1;
  const CommandResult result = run(other, "--out r");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(has(result.errors, "the final state is not the session's: its hash is ")) << result.errors;
  EXPECT_TRUE(has(result.errors, other.final_state_hash)) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/final_state.csv"));
}

TEST_F(Replay, GivesItsResultAsJson) {
  const auto result = nlohmann::json::parse(run(session(), "--json").output);
  EXPECT_EQ(result["status"], "finished");
  EXPECT_EQ(result["session"]["agrees"], true);
  EXPECT_EQ(result["session"]["state_hash"], session().final_state_hash);
  const CommandResult part = run(session(), "--json --until 0.01");
  EXPECT_EQ(part.exit_code, 0);
  EXPECT_TRUE(nlohmann::json::parse(part.output)["session"]["agrees"].is_null());
}

TEST_F(Replay, UntilATimeComparesNothing) {
  const CommandResult result = run(session(), "--until 0.01");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(has(result.output, "not compared: the replay ended at step")) << result.output;
}

TEST_F(Replay, OfBadJsonExitsWithTwoAndSaysWhere) {
  const std::string text = write_session(session());
  const CommandResult result = run(text.substr(0, text.find("\"steps\"")) + "oops", "");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(has(result.errors, "x.session.json:")) << result.errors;
  EXPECT_TRUE(has(result.errors, "is not JSON from here on")) << result.errors;
}

TEST_F(Replay, OfAPullOnNoParticleExitsWithTwoAndSaysWhere) {
  Session bad = session();
  bad.commands[0].action = std::optional(Pull{81, {0, 0, 0}});
  const CommandResult result = run(bad);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "x.session.json:")) << result.errors;
  EXPECT_TRUE(
      has(result.errors, "commands.0.pull.particle = 81: there is no such particle: this cloth has 81"))
      << result.errors;
}

TEST_F(Replay, OfACommandBeyondTheEndExitsWithTwo) {
  Session bad = session();
  bad.commands.back().step = 91;
  const CommandResult result = run(bad);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "commands.3.step = 91: must be <= steps, 90")) << result.errors;
}

TEST_F(Replay, ThatDivergesExitsWithThree) {
  Session wild = session();
  wild.scene.deformation.reset();  // a limited cloth cannot diverge
  wild.commands[1].action = Edits{{"integrator.method", "\"verlet\""}, {"integrator.time_step", "0.5"}};
  const CommandResult result = run(wild, "--out r");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(has(result.errors, "diverged in step")) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/final_state.csv"));
}

TEST_F(Replay, OfAFileThatIsNotThereExitsWithFour) {
  EXPECT_EQ(cli("replay /no/such.session.json").exit_code, 4);
}

}  // namespace
}  // namespace cloth::test::replay_test
