// What the program says of itself, and what it answers to bad usage and bad scenes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/machine.h"
#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_parameters.h"
#include "support/files.h"

namespace cloth::test::usage_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Help, IsGivenOnStandardOutputForTheProgramAndEveryCommand) {
  for (const char* command : {"", "run", "scenes", "explain", "work-precision", "stability", "extremes",
                              "convergence", "iterations", "replay", "reproduce", "schema", "parameters"}) {
    const CommandResult result = cli(std::string(command) + " --help");
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_TRUE(has(result.output, command)) << result.output;
    EXPECT_EQ(result.errors, "") << command;
  }
  for (const char* word : {"run", "scenes", "explain", "schema", "Exit codes", "--version"})
    EXPECT_TRUE(has(cli("--help").output, word)) << word;
  for (const char* word : {"--set", "--out", "--threads", "--json"})
    EXPECT_TRUE(has(cli("run --help").output, word)) << word;
}

TEST(Version, IsThatOfTheEngine) {
  EXPECT_EQ(cli("--version").output, version() + "\n");
}

TEST(BadUsage, ExitsWithTwoAndWritesToStandardErrorOnly) {
  for (const char* arguments :
       {"", "fly", "run", "run pendulum --fast", "run pendulum --threads 0", "run pendulum --set",
        "run pendulum --set springs.shear", "explain", "run pendulum extra", "scenes no-such-scene"}) {
    const CommandResult result = cli(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_NE(result.errors, "") << arguments;
  }
}

TEST(AnUnknownScene, ExitsWithFourAndSaysWhereTheNamesAre) {
  for (const char* command : {"run", "explain"}) {
    const CommandResult result = cli(std::string(command) + " no-such-scene");
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(has(result.errors, "no-such-scene")) << result.errors;
    EXPECT_TRUE(has(result.errors, "clothlab-cli scenes")) << result.errors;
  }
}

TEST(AFolderAsScene, ExitsWithFour) {
  const CommandResult result = cli("run /tmp");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "/tmp: is a folder")) << result.errors;
}

TEST(ABadScene, ExitsWithTwoAndNamesEveryProblemWithItsPlace) {
  const TemporaryFolder folder;
  const auto file = folder / "bad.scene.json";
  ASSERT_FALSE(write_text_file(file,
                               "{ \"cloth\": { \"columns\": 1 },\n  \"springs\": { \"structural\": -3 },\n"
                               "  \"windy\": true }\n"));
  for (const char* command : {"run", "explain"}) {
    const CommandResult result = cli(std::string(command) + " '" + file.string() + "'");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(has(result.errors, file.string() + ":1:25: cloth.columns = 1: must be >= 2"))
        << result.errors;
    EXPECT_TRUE(has(result.errors, file.string() + ":2:30: springs.structural = -3 N/m: must be >= 0"));
    EXPECT_TRUE(has(result.errors, file.string() + ":3:3: windy: is not a known key"));
  }
}

TEST(AFileThatIsNotJson, ExitsWithTwo) {
  const TemporaryFolder folder;
  for (const char* text : {"", "not json", "{\"cloth\": {\"mass\": NaN}}", "{\"cloth\": {}"}) {
    ASSERT_FALSE(write_text_file(folder / "bad.json", text));
    const CommandResult result = cli("run '" + (folder / "bad.json").string() + "'");
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_TRUE(has(result.errors, "bad.json:1:")) << result.errors;
  }
}

TEST(ABadSetting, ExitsWithTwoAndNamesTheOption) {
  const CommandResult result = cli("run pendulum --set springs.structural=-3 --set springs.bend=1");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "--set: springs.structural = -3 N/m: must be >= 0")) << result.errors;
  EXPECT_TRUE(has(result.errors, "--set: springs.bend: is not a known key")) << result.errors;
}

TEST(Scenes, ListsEveryBuiltinSceneWithItsTitle) {
  const CommandResult result = cli("scenes");
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(cli("scenes --json").output);
  ASSERT_EQ(json["scenes"].size(), builtin_scenes().size());
  for (std::size_t k = 0; k < builtin_scenes().size(); ++k) {
    EXPECT_EQ(json["scenes"][k]["name"], builtin_scenes()[k].name);
    EXPECT_TRUE(has(result.output, builtin_scenes()[k].name));
    EXPECT_TRUE(has(result.output, builtin_scene(builtin_scenes()[k].name).title));
  }
}

TEST(Scenes, PrintsOneAsItsFile) {
  for (const BuiltinScene& scene : builtin_scenes())
    EXPECT_EQ(cli("scenes " + scene.name).output, scene.text);
}

TEST(Schema, IsJsonOfDraftSeven) {
  const CommandResult result = cli("schema");
  EXPECT_EQ(result.exit_code, 0);
  const auto schema = nlohmann::json::parse(result.output);
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(cli("schema --json").output, result.output);
}

TEST(Parameters, PrintsTheReferencePage) {
  EXPECT_EQ(cli("parameters").output, reference_page());
}

TEST(AFullStandardOutput, ExitsWithFour) {
  for (const char* command :
       {"schema", "scenes", "parameters", "explain pendulum", "run pendulum --set duration=0.1"}) {
    const CommandResult result = shell("\"$CLI\" " + std::string(command) + " > /dev/full");
    EXPECT_EQ(result.exit_code, 4) << command;
    EXPECT_TRUE(has(result.errors, "No space left on device")) << result.errors;
  }
}

}  // namespace
}  // namespace cloth::test::usage_test
