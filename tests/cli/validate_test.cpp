// clothlab-cli validate: its files, its answers to bad usage, its exit codes.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::validate_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string in(const TemporaryFolder& folder, const std::string& name) {
  return " '" + (folder / name).string() + "' ";
}

TEST(Validate, PrintsEveryRowWithItsErrorsOrderAndVerdict) {
  const CommandResult result = cli("validate --only catenary,astm-d1388");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  for (const char* part : {"Protocol", "80 cells", "Order", "catenary", "span 0.8", "astm-d1388", "holds"})
    EXPECT_TRUE(has(result.output, part)) << result.output;
}

TEST(Validate, LeavesATableAPageAndAnIndexAndReplacesItsOwnAlone) {
  const TemporaryFolder folder;
  for (int time = 0; time < 2; ++time) {
    const CommandResult result =
        cli("validate --json --only self-buckling,pear-loop --out" + in(folder, "v"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json["rows"].size(), 5u);
    EXPECT_NEAR(json["rows"][0]["exact"].get<double>(), 7.837347, 1e-6) << "in the order of the options";
    EXPECT_EQ(json["rows"][1]["grids"].size(), 4u);
    EXPECT_EQ(json["rows"][1]["holds"], true);
  }
  const CsvTable table = parse_csv(content_of(folder / "v/validation.csv"));
  EXPECT_EQ(table.rows.size(), 20u);
  const CommandResult read = cli("study" + in(folder, "v"));
  EXPECT_EQ(read.exit_code, 0) << read.errors;
  for (const char* part : {"validation: self-buckling, pear-loop", "--only self-buckling,pear-loop", "holds"})
    EXPECT_TRUE(has(read.output, part)) << read.output;
  EXPECT_EQ(parse_csv(content_of(folder / "v/validation_points.csv")).rows.size(), 4 * 21u);
  EXPECT_TRUE(has(content_of(folder / "v/validation.svg"), "self-buckling"));
  const std::string page = content_of(folder / "v/report.html");
  for (const char* part : {"<svg", "Greenhill 1881", "pear-loop", "validate --only self-buckling,pear-loop"})
    EXPECT_TRUE(has(page, part)) << part;
  EXPECT_EQ(cli("validate --strips" + in(folder, "v")).exit_code, 2) << "a folder holds one thing";
}

TEST(Validate, RefusesProtocolsThatItDoesNotKnow) {
  const CommandResult result = cli("validate --only cantilevers");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "cantilevers")) << result.errors;
  EXPECT_EQ(cli("validate --score x --strips y").exit_code, 2);
}

TEST(Validate, HandsOutStripsWhoseStartsScoreAsExact) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli("validate --strips" + in(folder, "strips")).exit_code, 0);
  const CsvTable strips = parse_csv(content_of(folder / "strips/strips.csv"));
  ASSERT_GE(strips.rows.size(), 30u);
  std::filesystem::create_directory(folder / "mine");
  for (const auto& strip : strips.rows) {
    const std::string text = content_of(folder / ("strips/" + strip[0] + ".start.obj"));
    std::ofstream(folder / ("mine/" + strip[0] + ".obj")) << text;
  }
  const CommandResult result = cli("validate --json --score" + in(folder, "mine"));
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  const auto scores = nlohmann::json::parse(result.output)["strips"];
  ASSERT_EQ(scores.size(), strips.rows.size());
  for (const auto& score : scores) EXPECT_LT(score["largest_distance"], 1e-9) << score.dump();
}

TEST(Validate, SaysWhatIsWrongWithAFileThatIsToBeScored) {
  const TemporaryFolder folder;
  EXPECT_EQ(cli("validate --score" + in(folder, "none")).exit_code, 2);
  EXPECT_EQ(cli("validate --score '" + folder.path().string() + "'").exit_code, 2) << "no strips";
  std::ofstream(folder / "pear-loop-1.csv") << "x,y\n0,0\n0.01,abc\n";
  std::ofstream(folder / "heart-loop-5.csv") << "a,b\n0,0\n";
  std::ofstream(folder / "cantilever-5.csv") << "x,y\n0,0\n0.001,0\n";
  const CommandResult result = cli("validate --score '" + folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 2);
  for (const char* part : {"line 3: \"abc\" is not a number", "has no column \"x\"", "without a point"})
    EXPECT_TRUE(has(result.output, part)) << result.output;
}

}  // namespace
}  // namespace cloth::test::validate_test
