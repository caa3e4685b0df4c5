// clothlab-cli stability: its files, its answers to bad usage, its exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::stability_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string small_map(const TemporaryFolder& folder) {
  return "stability corners-free --x integrator.time_step=5e-4:4e-3:3:log --y springs.*=50:200:2:log "
         "--methods verlet --out '" +
         (folder / "map").string() + "' ";
}

TEST(Stability, LeavesItsFilesAndSaysTheLimits) {
  const TemporaryFolder folder;
  const CommandResult result = cli(small_map(folder));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(has(result.output, "verlet")) << result.output;
  EXPECT_TRUE(has(result.output, "at worst")) << result.output;
  EXPECT_EQ(result.errors, "");
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "map"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, std::set<std::string>({"stability.csv", "stability.svg", "study.json", "report.html"}));
  EXPECT_EQ(parse_csv(content_of(folder / "map/stability.csv")).rows.size(), 6u);
  const std::string page = content_of(folder / "map/report.html");
  for (const char* part : {"<svg", "The criterion", "clothlab-cli stability corners-free", "Predicted"})
    EXPECT_TRUE(has(page, part)) << part;
}

TEST(Stability, GivesItsLimitsAsJson) {
  const TemporaryFolder folder;
  const CommandResult result = cli(small_map(folder) + "--json");
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["methods"].size(), 1u);
  ASSERT_EQ(json["methods"][0]["limits"].size(), 2u);
  for (const auto& limit : json["methods"][0]["limits"])
    EXPECT_NEAR(limit["measured_s"].get<double>() / limit["predicted_s"].get<double>(), 1, 0.05);
}

TEST(Stability, OfBadOptionsExitsWithTwoAndNamesTheRule) {
  const TemporaryFolder folder;
  const std::string out = " --out '" + (folder / "map").string() + "'";
  const std::pair<const char*, const char*> cases[] = {
      {"stability corners-free", "--out"},
      {"stability corners-free --x springs.shear", "--x: springs.shear: must be PATH=LOW:HIGH:COUNT"},
      {"stability corners-free --y springs.shear=-3:1:4", "--y: springs.shear = -3 N/m: must be >= 0"},
      {"stability corners-free --y springs.bend=1:2:4", "--y: springs.bend: is not a parameter"},
      {"stability corners-free --y cloth.mass=0:1:3:log", "must begin above 0"},
      {"stability corners-free --y integrator.time_step=0.1:1:3", "is on both axes"},
      {"stability corners-free --methods verlet,leap", "--methods: leap: must be one of"},
      {"stability corners-free --periods 0", "--periods"}};
  for (const auto& [arguments, rule] : cases) {
    const std::string folder_option = std::string(rule) == "--out" ? "" : out;
    const CommandResult result = cli(arguments + folder_option);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_TRUE(has(result.errors, rule)) << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "map"));
}

TEST(Stability, ThatIsInterruptedExitsWith130AndLeavesValidFiles) {
  const TemporaryFolder folder;
  // A map that would take days; the folder is there once the study has begun.
  const std::string map = (folder / "map").string();
  const CommandResult result =
      shell("\"$CLI\" stability corners-free --methods verlet --periods 1e6 --most-steps 100000000 --out '" +
            map + "' &\nstudy=$!\nuntil [ -d '" + map +
            "' ]; do sleep 0.05; done\nsleep 0.2\nkill -INT $study\nkill -TERM $study\n" + "wait $study");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  const CsvTable table = parse_csv(content_of(folder / "map/stability.csv"));
  EXPECT_GT(table.rows.size(), 10u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  EXPECT_TRUE(has(content_of(folder / "map/report.html"), "interrupted"));
}

}  // namespace
}  // namespace cloth::test::stability_test
