// clothlab-cli extremes: its files, its exit codes, what it says.
#include "study/extremes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "integrators/registry.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::extremes_test {
namespace {

const std::string few = "extremes --methods verlet,explicit-euler --cases cloth-2x2,step-1s ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Extremes, LeaveATableWithTheColumnsOfTheManual) {
  const TemporaryFolder folder;
  const CommandResult result = cli(few + "--out '" + (folder / "result").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << "cells that diverge are the result, not a failure: " << result.errors;
  const CsvTable table = parse_csv(content_of(folder / "result/extremes.csv"));
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"case", "method", "status", "detail", "steps", "max_strain",
                                      "energy_ratio", "wall_s", "time_step_s", "ended_early"}));
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[0][0], "step-1s");  // the list's order, and the methods'
  EXPECT_EQ(table.rows[0][1], "explicit-euler");
  EXPECT_EQ(table.rows[1][2], "diverged");
  EXPECT_EQ(table.rows[3][2], "stable");
  const std::string page = content_of(folder / "result/report.html");
  for (const char* part :
       {"<!DOCTYPE html>", "step-1s", "diverged in step 1", "clothlab-cli extremes --methods"})
    EXPECT_TRUE(has(page, part)) << part;
}

TEST(Extremes, PrintAMatrixAndTheReasons) {
  const CommandResult result = cli(few);
  EXPECT_TRUE(has(result.output, "step-1s    diverged   diverged")) << result.output;
  EXPECT_TRUE(has(result.output, "step-1s, verlet: diverged in step 1 ")) << result.output;
  EXPECT_TRUE(has(result.output, "seed")) << result.output;
  EXPECT_EQ(result.errors, "");
}

TEST(Extremes, AsJsonNameEveryCell) {
  const auto json = nlohmann::json::parse(cli(few + "--json").output);
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["cells"].size(), 4u);
  EXPECT_EQ(json["cells"][1]["method"], "verlet");
  EXPECT_EQ(json["cells"][1]["status"], "diverged");
}

TEST(Extremes, AsMarkdownAreATable) {
  const std::string text = cli(few + "--markdown").output;
  EXPECT_TRUE(has(text, "| case | explicit-euler | verlet |\n|---|---|---|\n")) << text;
  EXPECT_TRUE(has(text, "| step-1s | **diverged** | **diverged** |")) << text;
}

TEST(Extremes, OfAnUnknownMethodOrCaseAreBadUsage) {
  for (const char* arguments :
       {"extremes --methods heun", "extremes --cases calm", "extremes --json --markdown"}) {
    const CommandResult result = cli(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_NE(result.errors, "") << arguments;
  }
  EXPECT_TRUE(has(cli("extremes --cases calm").errors, "step-1s"));
}

TEST(Extremes, ThatCannotBeWrittenExitWithFour) {
  EXPECT_EQ(cli(few + "--out /dev/null/x").exit_code, 4);
}

TEST(Extremes, OfSeveralJobsLeaveTheTableOfOne) {
  const TemporaryFolder folder;
  const auto table_of = [&](const std::string& jobs) {
    const CommandResult result = cli(few + "--jobs " + jobs + " --out '" + (folder / jobs).string() + "'");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return without_column(parse_csv(content_of(folder / jobs / "extremes.csv")), "wall_s").rows;
  };
  const auto one = table_of("1");
  EXPECT_EQ(table_of("2"), one);
  EXPECT_EQ(table_of("100"), one) << "more than there are cells";
  for (const char* bad : {"--jobs 0", "--jobs many", "--jobs 2000"})
    EXPECT_EQ(cli(few + bad).exit_code, 2) << bad;
}

TEST(Extremes, ThatAreInterruptedLeaveValidFiles) {
  const TemporaryFolder folder;
  const std::string csv = (folder / "result/extremes.csv").string();
  const CommandResult result = shell("\"$CLI\" extremes --out '" + (folder / "result").string() +
                                     "' &\n"
                                     "run=$!\n"
                                     "until [ \"$(wc -l < '" +
                                     csv +
                                     "' 2> /dev/null || echo 0)\" -gt 1 ]; do :; done\n"
                                     "kill -TERM $run\n"
                                     "wait $run");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  const CsvTable table = parse_csv(content_of(csv));
  EXPECT_LT(table.rows.size(), extreme_cases().size() * integrator_names().size());
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  EXPECT_TRUE(has(content_of(folder / "result/report.html"), "Interrupted"));
}

}  // namespace
}  // namespace cloth::test::extremes_test
