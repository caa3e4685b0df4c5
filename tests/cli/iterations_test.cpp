// clothlab-cli iterations: its files, its answers to bad usage, its exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::iterations_command_test {
namespace {

const std::string few =
    "iterations corners-free --set cloth.rows=7 --set cloth.columns=7 --step 0.005 --time 0.05 --most 8 ";

TEST(Iterations, LeavesItsFilesAndPrintsATable) {
  const TemporaryFolder folder;
  const CommandResult result = cli(few + "--out '" + (folder / "i").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  for (const char* part : {"Newton's method", "Projective dynamics", "XPBD", "VBD", "The objective falls by"})
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "i"))
    files.insert(entry.path().filename().string());
  const std::set<std::string> expected{"iterations.csv", "iterations.svg", "iterations_time.svg",
                                       "report.html", "study.json"};
  EXPECT_EQ(files, expected);
  const auto index = nlohmann::json::parse(content_of(folder / "i" / "study.json"));
  EXPECT_TRUE(index.at("is_minimum").get<bool>());
  const CsvTable table = parse_csv(content_of(folder / "i" / "iterations.csv"));
  const CommandResult printed = cli("study '" + (folder / "i").string() + "' --json");
  ASSERT_EQ(printed.exit_code, 0) << printed.errors;
  std::size_t steps = 0;
  for (const auto& method : nlohmann::json::parse(printed.output).at("methods"))
    steps += method.at("steps").size();
  EXPECT_EQ(table.rows.size(), steps);
  EXPECT_EQ(index.at("files").size(), 4u);
  const CommandResult again = cli(few + "--methods vbd --out '" + (folder / "i").string() + "'");
  EXPECT_EQ(again.exit_code, 0) << again.errors << ": its own folder is made anew";
  EXPECT_EQ(cli("extremes --cases cloth-2x2 --out '" + (folder / "i").string() + "'").exit_code, 2);
}

TEST(Iterations, TakesMethodsAndRefusesOthers) {
  const CommandResult result = cli(few + "--methods vbd --json");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto document = nlohmann::json::parse(result.output);
  ASSERT_EQ(document.at("methods").size(), 1u);
  EXPECT_EQ(document.at("methods")[0].at("method"), "vbd");
  EXPECT_EQ(cli(few + "--methods verlet").exit_code, 2);
  EXPECT_EQ(cli("iterations corners-free --step 0").exit_code, 2);
  EXPECT_EQ(cli("iterations corners-free --set springs=null").exit_code, 2);
}

}  // namespace
}  // namespace cloth::test::iterations_command_test
