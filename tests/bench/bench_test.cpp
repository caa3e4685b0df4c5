// clothlab-bench: its tables, its file, its exit codes. Never how fast anything is.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "support/files.h"

namespace cloth::test::bench_test {
namespace {

const std::string few =
    "--quick --sizes 8,12,16 --methods verlet,rk4 --features air --threads 1 --repeats 3 ";

const std::string program = "BENCH='" CLOTHLAB_BENCH "'\n";

/// clothlab-bench with these arguments.
CommandResult bench(const std::string& arguments) {
  return shell(program + "\"$BENCH\" " + arguments);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Bench, AsJsonHasEveryRowWithItsRatios) {
  const CommandResult result = bench(few + "--only steps --json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["complete"], true);
  EXPECT_LT(json["reference_disagreement_m"], 1e-9) << "the reference kernel computes the same motion";
  ASSERT_EQ(json["rows"].size(), 3u * 5u) << "the reference, two methods bare and with air";
  for (const auto& row : json["rows"]) {
    const std::string name = row.dump();
    EXPECT_GT(row["ns_per_particle_step"]["median"], 0) << name;
    EXPECT_GT(row["ratio_to_reference"]["median"], 0) << name;
    if (row["method"] == "reference") continue;
    EXPECT_GT(row["ratio_to_bare"]["median"], 0) << name;
    EXPECT_GT(row["ratio_to_divider_floor"], 0) << name;
    EXPECT_GT(row["ratio_to_memory_floor"], 0) << name;
    EXPECT_GE(row["force_evaluations_per_step"], row["method"] == "rk4" ? 4 : 1) << name;
  }
  ASSERT_EQ(json["growth"].size(), 5u);
  EXPECT_TRUE(json["growth"][0]["standard_error"].is_number());
  EXPECT_GT(json["yardsticks"]["vector_root_and_division_ns"]["median"], 0);
  EXPECT_GT(json["yardsticks"]["update_GB_per_s"], 0);
}

TEST(Bench, MeasuresScenesMemoryAndStart) {
  const CommandResult result = bench("--quick --only scenes,memory,start --methods verlet --json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_TRUE(json["rows"].empty());
  EXPECT_GE(json["scenes"].size(), 10u);
  for (const auto& scene : json["scenes"]) {
    EXPECT_GT(scene["simulated_per_stepping"], 0) << scene.dump();
    EXPECT_GT(scene["ratio_to_bare"], 0) << scene.dump();
    EXPECT_TRUE(scene["size"].is_null()) << scene.dump();
  }
  EXPECT_TRUE(json["scene_growth"].empty());
  EXPECT_EQ(json["memory"].size(), 9u) << "bare, and with each thing that a scene may have";
  for (const auto& row : json["memory"])
    EXPECT_TRUE(row["held_bytes_per_particle"].is_null() || row["held_bytes_per_particle"] > 48)
        << row.dump();
  ASSERT_EQ(json["start"].size(), 3u);
  for (const auto& start : json["start"]) EXPECT_GT(start["ms"]["median"], 0) << start.dump();
}

TEST(Bench, RefinesScenesToTheSizesAndSaysWhichItCannot) {
  const std::string some = "--quick --only scenes --scenes free-fall,flag,disc --sizes 9,13,17 ";
  const CommandResult result = bench(some + "--json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  ASSERT_EQ(json["scenes"].size(), 3u + 3u + 1u) << "the disc is a mesh: once";
  for (const auto& scene : json["scenes"]) {
    EXPECT_GT(scene["ratio_to_bare"], 0) << scene.dump();
    if (scene["name"] != "disc") {
      EXPECT_EQ(std::max(scene["rows"].get<int>(), scene["columns"].get<int>()), scene["size"].get<int>());
      EXPECT_TRUE(scene["remark"].is_null()) << scene.dump();
      continue;
    }
    EXPECT_TRUE(scene["size"].is_null());
    EXPECT_TRUE(has(scene["remark"], "mesh")) << scene.dump();
  }
  ASSERT_EQ(json["scene_growth"].size(), 2u);
  EXPECT_EQ(json["scene_growth"][0]["scene"], "free-fall");
  EXPECT_TRUE(json["scene_growth"][0]["exponent"].is_number());
  const std::string text = bench(some + "--markdown").output;
  for (const char* part :
       {"/ bare", "17 particles along the longer side", "not refined", "Growth of the scenes"})
    EXPECT_TRUE(has(text, part)) << part << "\n" << text;
}

TEST(Bench, SaysWhatContactAddsToAStep) {
  const CommandResult result = bench("--quick --only contact --repeats 3 --json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["complete"], true);
  EXPECT_TRUE(json["rows"].empty());
  ASSERT_EQ(json["contact"].size(), 6u);
  for (const auto& row : json["contact"]) {
    const std::string name = row.dump();
    EXPECT_TRUE(row["remark"].is_null()) << name;
    EXPECT_GT(row["ns_per_particle_step"]["median"], 0) << name;
    EXPECT_GT(row["ns_per_particle_step_without"]["median"], 0) << name;
    EXPECT_GT(row["ratio_to_without"]["median"], 0) << name;
    if (row["scene"] == "fold") continue;  // of so few particles it may have bounced off
    EXPECT_GT(row["touched_particles"], 0) << name << ": nothing was touched while it was timed";
    EXPECT_GT(row["pairs"], 0) << name;
  }
  EXPECT_EQ(json["contact"][5]["scene"], "bunny");
  EXPECT_GE(json["contact"][5]["obstacle_triangles"], 50000);
  const std::string text = bench("--quick --only contact --repeats 3").output;
  for (const char* part : {"\nContact\n", "With / without", "fold", " triangles", "itself"})
    EXPECT_TRUE(has(text, part)) << part << "\n" << text;
}

TEST(Bench, PrintsTablesAndLeavesTheFile) {
  const TemporaryFolder folder;
  const CommandResult result = bench(few + "--only steps --out '" + (folder / "result").string() + "'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* part : {"\n16 x 16\n", "reference kernel", "wind and normals", "/ divider", "Growth"})
    EXPECT_TRUE(has(result.output, part)) << part << "\n" << result.output;
  EXPECT_FALSE(has(result.output, " \n")) << "blanks at the end of a line";
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "result/bench.json"))["complete"], true);
}

#ifdef CLOTHLAB_BULLET
TEST(Bench, OfPeersHasOursBesideBulletWithTheSameErrors) {
  const TemporaryFolder folder;
  const CommandResult result =
      bench("--peers --quick --sizes 5 --methods semi-implicit-euler --json --out '" +
            (folder / "result").string() + "'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "result/bench.json")), json);
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["peers"].size(), 1u);
  EXPECT_LT(json["peers"][0]["reference_floor_rms_m"], 1e-10);
  std::vector<double> ours, theirs;
  for (const auto& series : json["peers"][0]["series"])
    for (const auto& run : series["runs"]) {
      EXPECT_TRUE(run["failure"].is_null()) << run.dump();
      EXPECT_GT(run["processor_ms_per_simulated_s"], 0) << run.dump();
      if (series["method"] == "semi-implicit-euler") ours.push_back(run["error_rms_m"]);
      if (series["method"] == "springs-explicit" && series["program"] == "Bullet double")
        theirs.push_back(run["error_rms_m"]);
    }
  ASSERT_EQ(ours.size(), theirs.size());
  ASSERT_FALSE(ours.empty());
  for (std::size_t k = 0; k < ours.size(); ++k)
    EXPECT_NEAR(theirs[k] / ours[k], 1, 1e-6) << "the same method on the same cloth";
}

TEST(Bench, OfPeersWithMethodsOrPartsThatItHasNotIsBadUsage) {
  for (const char* arguments : {"--peers --methods bdf2", "--peers --only steps"}) {
    const CommandResult result = bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_NE(result.errors, "") << arguments;
  }
}
#else
TEST(Bench, OfPeersWithoutThemSaysWhatToInstall) {
  const CommandResult result = bench("--peers");
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(has(result.errors, "libbullet-dev")) << result.errors;
}
#endif

TEST(Bench, AsMarkdownIsTables) {
  const std::string text = bench(few + "--only steps --markdown").output;
  EXPECT_TRUE(has(text, "\n| Method | With | Threads |")) << text;
  EXPECT_TRUE(has(text, "\n## 16 x 16\n")) << text;
}

TEST(Bench, OfWhatDoesNotExistIsBadUsage) {
  for (const char* arguments : {"--methods heun", "--features rain", "--only colours", "--sizes 3",
                                "--sizes many", "--threads 0", "--repeats 1", "--json --markdown"}) {
    const CommandResult result = bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_NE(result.errors, "") << arguments;
  }
  EXPECT_TRUE(has(bench("--features rain").errors, "spring-damping"));
}

TEST(Bench, ThatCannotBeWrittenExitsWithFour) {
  EXPECT_EQ(bench(few + "--out /dev/null/x").exit_code, 4);
}

TEST(Bench, HasItsFolderForItself) {
  const TemporaryFolder folder;
  const std::string out = "--out '" + (folder / "result").string() + "'";
  const CommandResult two = shell(program + "\"$BENCH\" --quick --only steps " + out +
                                  " > /dev/null &\n"
                                  "run=$!\n"
                                  "until [ -s '" +
                                  (folder / "result/.clothlab").string() +
                                  "' ]; do :; done\n"
                                  "\"$BENCH\" " +
                                  few + "--only steps " + out +
                                  "\n"
                                  "echo \"second $?\"\n"
                                  "kill -TERM $run\n"
                                  "wait $run");
  EXPECT_EQ(two.exit_code, 130) << two.errors;
  EXPECT_TRUE(has(two.output, "second 4")) << two.output;
  EXPECT_TRUE(has(two.errors, "is writing to this folder")) << two.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "result/.clothlab"));
  const CommandResult again = bench(few + "--only steps " + out);
  EXPECT_EQ(again.exit_code, 0) << "its own file is replaced: " << again.errors;
  const CommandResult run = cli("run pendulum --set duration=0.01 " + out);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(has(run.errors, "holds a bench")) << run.errors;
}

TEST(Bench, ThatIsInterruptedLeavesAValidFile) {
  const TemporaryFolder folder;
  const std::string out = (folder / "result").string();
  const CommandResult result = shell(program + "\"$BENCH\" --quick --only steps --out '" + out +
                                     "' &\n"
                                     "run=$!\n"
                                     "until [ -d '" +
                                     out +
                                     "' ]; do :; done\n"
                                     "sleep 0.2\n"
                                     "kill -INT $run\n"
                                     "kill -TERM $run\n"
                                     "wait $run");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "result/bench.json"))["complete"], false);
  EXPECT_TRUE(has(result.output, "Interrupted"));
}

}  // namespace
}  // namespace cloth::test::bench_test
