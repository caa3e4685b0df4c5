// clothlab-cli compare, as a person would use it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/text_file.h"
#include "support/files.h"
#include "support/xml.h"

namespace cloth::test::compare_test {
namespace {

const std::string quick = "compare --scene pendulum --methods semi-implicit-euler,verlet,rk4 --duration 0.5 ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string out(const TemporaryFolder& folder, const std::string& name = "results") {
  return "--out '" + (folder / name).string() + "' ";
}

TEST(Compare, LeavesARecordingOfEachPaneAndTheComparisonInTheFolder) {
  const TemporaryFolder folder;
  const CommandResult result = cli(quick + out(folder));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "") << "no progress bar where there is no terminal";
  const CsvTable compare = parse_csv(content_of(folder / "results/compare.csv"));
  for (const char* pane : {"A", "B", "C"}) {
    const CsvTable rows = parse_csv(content_of(folder / ("results/" + std::string(pane) + ".csv")));
    EXPECT_EQ(rows.rows.size(), compare.rows.size());
    EXPECT_EQ(column_of(rows, "total_J"), column_of(compare, std::string(pane) + "_total_J"));
  }
  EXPECT_EQ(read_xml(content_of(folder / "results/compare.svg")).error, "");
  const auto summary = nlohmann::json::parse(content_of(folder / "results/summary.json"));
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_EQ(summary["ranking"], nlohmann::json({"C", "B", "A"}));
  const std::string page = content_of(folder / "results/report.html");
  EXPECT_TRUE(has(page, "--methods semi-implicit-euler,verlet,rk4"));
  EXPECT_FALSE(has(page, folder.path().string())) << "a report names no folder of this machine";
}

TEST(Compare, PrintsTheRankedTable) {
  const CommandResult result = cli(quick);
  const auto best = result.output.find("\nC "), worst = result.output.find("\nA ");
  ASSERT_NE(best, std::string::npos) << result.output;
  ASSERT_NE(worst, std::string::npos);
  EXPECT_LT(best, worst);
  EXPECT_TRUE(has(result.output, "tolerance 1e-11")) << result.output;
}

TEST(Compare, RecordsWhereItsMeshesAre) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  ASSERT_FALSE(
      write_text_file(folder / "in/sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"));
  ASSERT_FALSE(write_text_file(folder / "in/x.compare.json",
                               R"({"scene": {"cloth": {"mesh": "sheet.obj"}, "duration": 0.1},
                                   "panes": [{}, {"own": {"integrator.method": "rk4"}}]})"));
  const CommandResult first = shell("cd '" + (folder / "in").string() +
                                    "' && \"$CLI\" compare x.compare.json " + out(folder, "a/results"));
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const CommandResult again = cli("compare '" + (folder / "a/results/comparison.json").string() + "'");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
}

TEST(Compare, RunsItsOwnFolderAgain) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(quick + out(folder)).exit_code, 0);
  const std::string file = "'" + (folder / "results/comparison.json").string() + "' ";
  ASSERT_EQ(cli("compare " + file + out(folder, "again")).exit_code, 0);
  EXPECT_EQ(content_of(folder / "results/comparison.json"), content_of(folder / "again/comparison.json"));
  EXPECT_EQ(without_column(parse_csv(content_of(folder / "results/B.csv")), "step_time_us").rows,
            without_column(parse_csv(content_of(folder / "again/B.csv")), "step_time_us").rows);
}

TEST(Compare, MeasuresFromThePaneThatIsAskedFor) {
  const auto summary = nlohmann::json::parse(cli(quick + "--reference B --json").output);
  EXPECT_EQ(summary["reference"], "B");
  EXPECT_TRUE(summary["panes"][1]["is_reference"]);
  EXPECT_TRUE(summary["panes"][1]["rms_difference_m"].is_null());
  EXPECT_GT(summary["panes"][0]["rms_difference_m"], 0);
  const auto none = nlohmann::json::parse(cli(quick + "--reference none --json").output);
  EXPECT_TRUE(none["panes"][0]["rms_difference_m"].is_null());
  const CommandResult wrong = cli(quick + "--reference D");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(has(wrong.errors, "--reference: reference = \"D\": must be the name of a pane"))
      << wrong.errors;
}

TEST(Compare, GoesOnWithoutAPaneThatDiverges) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli("compare explicit-implicit --set cloth.rows=9 --set cloth.columns=9 --set cloth.mass=0.02 "
          "--duration 0.1 " +
          out(folder));
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  const auto summary = nlohmann::json::parse(content_of(folder / "results/summary.json"));
  EXPECT_EQ(summary["panes"][1]["status"], "diverged");
  EXPECT_EQ(summary["panes"][2]["status"], "finished");
  EXPECT_EQ(summary["ranking"].back(), "B");
  EXPECT_TRUE(has(result.output, "B: diverged in step")) << result.output;
}

TEST(Compare, EndsWithThreeWhereNothingIsLeft) {
  const CommandResult result =
      cli("compare --scene corners-free --methods verlet,semi-implicit-euler --duration 0.5 "
          "--set integrator.time_step=0.005 --reference none");
  EXPECT_EQ(result.exit_code, 3) << result.output;
}

TEST(Compare, SaysWhereAPaneDidNotKeepItsDeformationRate) {
  const TemporaryFolder folder;
  const std::string file = (folder / "rates.compare.json").string();
  ASSERT_FALSE(write_text_file(
      file, R"({"scene": "corners-shear", "reference": "none", "panes": [{"own": {"deformation.rate": 0.5}},
          {"own": {"deformation.rate": 0.001, "deformation.solver": "sweeps", "deformation.max_sweeps": 1}}]})"));
  const CommandResult result = cli("compare '" + file + "' --duration 0.1 " + out(folder));
  EXPECT_EQ(result.exit_code, 3) << result.errors << result.output;
  EXPECT_TRUE(has(result.output, "\nB: rate not kept: in step ")) << result.output;
  EXPECT_FALSE(has(result.output, "\nA: rate not kept")) << result.output;
  const auto summary = nlohmann::json::parse(content_of(folder / "results/summary.json"));
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_FALSE(summary["panes"][0].contains("rate_not_kept"));
  EXPECT_GT(summary["panes"][1]["rate_not_kept"]["largest_excess"], 0);
  EXPECT_TRUE(has(content_of(folder / "results/report.html"), "rate not kept: in step"));
  const CommandResult json = cli("compare '" + file + "' --duration 0.1 --json");
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_TRUE(has(json.errors, "pane B: rate not kept")) << json.errors;
}

TEST(Compare, SaysWhereItsPanesMeetOnlyBeyondTheDuration) {
  const TemporaryFolder folder;
  const CommandResult uneven =
      cli("compare --scene pendulum --methods verlet,rk4 --duration 0.105 --set record.interval=0.01 " +
          out(folder));
  EXPECT_EQ(uneven.exit_code, 0) << uneven.errors;
  const std::string notice =
      "duration = 0.105 s is no whole number of record intervals of 0.01 s: all panes run to 0.11 s";
  EXPECT_TRUE(has(uneven.output, notice)) << uneven.output;
  const auto summary = nlohmann::json::parse(content_of(folder / "results/summary.json"));
  EXPECT_TRUE(has(summary["notice"], notice));
  EXPECT_TRUE(has(content_of(folder / "results/report.html"), notice));
  EXPECT_FALSE(has(
      cli("compare --scene pendulum --methods verlet,rk4 --duration 0.11 --set record.interval=0.01").output,
      "no whole number"));
}

TEST(Compare, EndsWithTheDurationHoweverLongTheRecordInterval) {
  const CommandResult result = shell(
      "timeout -s KILL 20 \"$CLI\" compare --scene pendulum --methods verlet,rk4 --duration 0.5 --set "
      "record.interval=1e9 --json");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(result.output)["simulated_s"], 0.5);
}

TEST(Compare, ListsWhatIsBuiltIn) {
  const CommandResult result = cli("compare --list");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(has(result.output, "report-methods"));
  const auto list = nlohmann::json::parse(cli("compare --list --json").output);
  for (const auto& entry : list["comparisons"]) {
    const std::string name = entry["name"];
    EXPECT_EQ(cli("compare " + name + " --duration 0.01").exit_code, 0) << name;
  }
}

TEST(Compare, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const std::string file = (folder / "bad.compare.json").string();
  ASSERT_FALSE(
      write_text_file(file, "{\"scene\": \"flag\",\n \"panes\": [{}, {\"own\": {\"springs.shear\": -1}}]}"));
  const CommandResult result = cli("compare '" + file + "'");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, ":2:42: panes.1.own.springs.shear = -1 N/m: must be >= 0")) << result.errors;
  EXPECT_EQ(cli("compare nothing-of-this-name").exit_code, 4);
  EXPECT_EQ(cli("compare").exit_code, 2);
  EXPECT_EQ(cli("compare --scene flag").exit_code, 2);
  EXPECT_EQ(cli("compare --scene flag --methods verlet").exit_code, 2);
  EXPECT_EQ(cli("compare --scene flag --methods verlet,leapfrog").exit_code, 2);
  EXPECT_EQ(cli("compare report-methods --scene flag --methods verlet,rk4").exit_code, 2);
  EXPECT_EQ(cli(quick + "--out /proc/nowhere").exit_code, 4);
}

TEST(Compare, InterruptedLeavesValidFiles) {
  const TemporaryFolder folder;
  const CommandResult result = shell(
      "timeout --preserve-status -s INT 1.5 \"$CLI\" compare report-methods --duration 500 " + out(folder));
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  for (const char* file : {"A.csv", "B.csv", "C.csv", "compare.csv"}) {
    const CsvTable table = parse_csv(content_of(folder / ("results/" + std::string(file))));
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << file;
  }
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "results/summary.json"))["status"], "stopped");
  EXPECT_TRUE(has(content_of(folder / "results/report.html"), "stopped"));
}

TEST(Schema, OfTheComparisonIsGivenOnRequest) {
  const auto schema = nlohmann::json::parse(cli("schema --comparison").output);
  EXPECT_TRUE(schema["properties"].contains("panes"));
  EXPECT_FALSE(nlohmann::json::parse(cli("schema").output)["properties"].contains("panes"));
}

}  // namespace
}  // namespace cloth::test::compare_test
