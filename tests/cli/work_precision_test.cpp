#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "integrators/registry.h"
#include "support/files.h"
#include "support/xml.h"

namespace cloth::test::work_precision_test {
namespace {

const std::string quick = "work-precision pendulum --methods verlet,rk4 --horizon 0.5 ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string out(const TemporaryFolder& folder) {
  return "--out '" + (folder / "study").string() + "' ";
}

TEST(WorkPrecision, LeavesItsFilesInTheFolder) {
  const TemporaryFolder folder;
  const CommandResult result = cli(quick + out(folder));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "") << "no progress bar where there is no terminal";
  const CsvTable runs = parse_csv(content_of(folder / "study/work_precision.csv"));
  EXPECT_GE(runs.rows.size(), 10u);
  for (const char* column : {"wall_median_s", "wall_lower_quartile_s", "wall_upper_quartile_s", "repeats"})
    EXPECT_FALSE(column_of(runs, column).empty());
  const CsvTable samples = parse_csv(content_of(folder / "study/work_precision_samples.csv"));
  EXPECT_GE(samples.rows.size(), 5 * runs.rows.size());
  EXPECT_EQ(read_xml(content_of(folder / "study/work_precision.svg")).error, "");
  const std::string page = content_of(folder / "study/report.html");
  EXPECT_TRUE(has(page, "--methods verlet,rk4 --horizon 0.5"));
  EXPECT_FALSE(has(page, folder.path().string())) << "a report names no folder of this machine";
}

TEST(WorkPrecision, GivesItsResultAsJson) {
  const auto study = nlohmann::json::parse(cli(quick + "--json").output);
  EXPECT_EQ(study["status"], "finished");
  EXPECT_EQ(study["horizon_s"], 0.5);
  ASSERT_EQ(study["methods"].size(), 2u);
  EXPECT_EQ(study["methods"][1]["name"], "rk4");
  EXPECT_GE(study["methods"][1]["runs"].size(), 5u);
  EXPECT_LT(study["floor_rms_m"], 1e-11);
}

TEST(WorkPrecision, KnowsWhichMethodsThereAre) {
  const CommandResult result = cli("work-precision pendulum --methods verlet,leapfrog");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(has(result.errors, "leapfrog: must be one of")) << result.errors;
  for (const std::string& name : integrator_names()) EXPECT_TRUE(has(result.errors, name));
  for (const char* arguments : {"--repeats 4", "--horizon 0", "--horizon -1", "--horizon soon"})
    EXPECT_EQ(cli("work-precision pendulum " + std::string(arguments)).exit_code, 2) << arguments;
}

TEST(WorkPrecision, InterruptedLeavesValidFiles) {
  const TemporaryFolder folder;
  const CommandResult result =
      shell("timeout --preserve-status -s INT 1.5 \"$CLI\" work-precision corners-free " + out(folder));
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  const CsvTable runs = parse_csv(content_of(folder / "study/work_precision.csv"));
  for (const auto& row : runs.rows) EXPECT_EQ(row.size(), runs.header.size());
  EXPECT_EQ(read_xml(content_of(folder / "study/work_precision.svg")).error, "");
  EXPECT_TRUE(has(content_of(folder / "study/report.html"), "stopped"));
}

TEST(WorkPrecision, SaysWhichFolderCannotBeMadeBeforeItWorks) {
  const CommandResult result = cli("work-precision pendulum --out /proc/nowhere");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "/proc/nowhere")) << result.errors;
}

}  // namespace
}  // namespace cloth::test::work_precision_test
