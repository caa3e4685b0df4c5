// clothlab-cli convergence: its files, its answers to bad usage, its exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::convergence_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string few = "convergence corners-free --cells 4,8,16 --time 0.1 ";

TEST(Convergence, LeavesItsFilesAndPrintsATable) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli(few + "--output elastic_J,max_strain:max --out '" + (folder / "c").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* part : {"Cells", "Cell (m)", "Value", "Difference", "Order", "16 x 16", "elastic (J)",
                           "max strain, largest", "springs.flexion"})
    EXPECT_TRUE(has(result.output, part)) << result.output;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "c"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, std::set<std::string>({"convergence.csv", "convergence.svg", "convergence_error.svg",
                                          "study.json", "report.html"}));
  const std::string page = content_of(folder / "c/report.html");
  for (const char* part : {"<svg", "Grid convergence", "--cells 4,8,16 --output elastic_J,max_strain:max"})
    EXPECT_TRUE(has(page, part)) << part;
  const CommandResult read = cli("study '" + (folder / "c").string() + "'");
  EXPECT_EQ(read.exit_code, 0) << read.errors;
  EXPECT_TRUE(has(read.output, "convergence: Hung by two corners")) << read.output;
}

TEST(Convergence, HasTheNumbersOfSingleRuns) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(few + "--output kinetic_J,max_strain --threads 2 --set integrator.time_step=0.0005 --out '" +
                (folder / "c").string() + "'")
                .exit_code,
            0);
  const CsvTable grids = parse_csv(content_of(folder / "c/convergence.csv"));
  ASSERT_EQ(grids.rows.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string particles = std::to_string(static_cast<int>(column_of(grids, "columns")[k]));
    const std::string out = (folder / ("r" + particles)).string();
    ASSERT_EQ(cli("run corners-free --set duration=0.1 --set integrator.time_step=0.0005 --set cloth.rows=" +
                  particles + " --set cloth.columns=" + particles + " --out '" + out + "'")
                  .exit_code,
              0);
    const CsvTable record = parse_csv(content_of(out + "/record.csv"));
    for (const char* column : {"kinetic_J", "max_strain"})
      EXPECT_EQ(column_of(grids, column)[k], column_of(record, column).back()) << particles << column;
  }
}

TEST(Convergence, GivesItsResultAsJson) {
  const CommandResult result = cli(few + "--output kinetic_J --json");
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["grids"].size(), 3u);
  EXPECT_EQ(json["outputs"][0]["output"], "kinetic_J");
  EXPECT_EQ(json["outputs"][0]["values"].size(), 3u);
}

TEST(Convergence, OfBadOptionsExitsWithTwoAndOneMessage) {
  const TemporaryFolder folder;
  const std::string out = " --out '" + (folder / "c").string() + "'";
  const std::pair<const char*, const char*> cases[] = {
      {"convergence", "scene"},
      {"convergence corners-free --cells 8,x", "--cells"},
      {"convergence corners-free --cells 8", "--cells: must be two grids or more"},
      {"convergence corners-free --cells 16,8", "--cells: 8: must be more than 16"},
      {"convergence flag --cells 8,16", "--cells: 8: must be a multiple of 13"},
      {"convergence corners-free --output speed", "--output: speed: must be one of time_s, step"},
      {"convergence corners-free --output max_strain:median", "--output: max_strain:median: must be one of"},
      {"convergence corners-free --time -1", "--time"},
      {"convergence corners-free --threads 0", "--threads"},
      {"convergence disc", "cloth.mesh"},
      {"convergence corners-free --set 'cloth.pins=[[0,0],[0,1],[1,1]]'", "cloth.pins = [0, 0]: "}};
  for (const auto& [arguments, rule] : cases) {
    const CommandResult result = cli(arguments + out);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_TRUE(has(result.errors, rule)) << arguments << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "c"));
}

TEST(Convergence, OfRunsThatAllFailExitsWithThreeAndKeepsTheReasons) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli("convergence corners-free --cells 16,32 --set integrator.time_step=0.05 --set springs.structural=10000 "
          "--time 1 --out '" +
          (folder / "c").string() + "'");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(has(result.errors, "no two grids have a value")) << result.errors;
  EXPECT_TRUE(has(result.output, "16 cells: diverged: ")) << result.output;
  EXPECT_EQ(parse_csv(content_of(folder / "c/convergence.csv")).rows.size(), 2u);
}

TEST(Convergence, ThatIsInterruptedExitsWith130AndGoesOn) {
  const TemporaryFolder folder;
  const std::string out = (folder / "c").string();
  // The last grid would take hours.
  const std::string slow =
      "convergence corners-free --cells 4,8,512 --set integrator.time_step=0.00001 --output ";
  const std::string rest = " --time 5 --out '" + out + "'";
  const CommandResult result =
      shell("\"$CLI\" " + slow + "elastic_J" + rest + " &\nstudy=$!\nuntil [ \"$(wc -l < '" + out +
            "/convergence.csv' 2> /dev/null || echo 0)\" -gt 2 ]; do sleep 0.05; done\n" +
            "kill -INT $study\nwait $study");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_EQ(parse_csv(content_of(out + "/convergence.csv")).rows.size(), 2u);
  EXPECT_TRUE(has(content_of(out + "/report.html"), "stopped before its end"));
  const CommandResult other = cli(slow + "kinetic_J" + rest);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(has(other.errors, "unfinished study of other inputs (not the same: outputs)")) << other.errors;
  const CommandResult again = shell("timeout -s INT 2 \"$CLI\" " + slow + "elastic_J" + rest);
  EXPECT_TRUE(has(again.errors, "going on with the unfinished study in the folder: 2 runs are there"))
      << again.errors;
}

}  // namespace
}  // namespace cloth::test::convergence_test
