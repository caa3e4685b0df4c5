// clothlab-cli study: prints what a study's folder holds.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test::study_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Study, PrintsTheTableThatItsCommandPrinted) {
  const TemporaryFolder folder;
  const std::string out = " --out '" + (folder / "result").string() + "'";
  const CommandResult made = cli("extremes --methods verlet,explicit-euler --cases cloth-2x2,step-1s" + out);
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const std::string name = "study '" + (folder / "result").string() + "'";
  const CommandResult read = cli(name);
  EXPECT_EQ(read.exit_code, 0) << read.errors;
  EXPECT_TRUE(has(read.output, made.output)) << read.output;
  EXPECT_TRUE(has(read.output, "clothlab-cli extremes --methods verlet")) << read.output;
  EXPECT_EQ(cli(name + " --csv").output, content_of(folder / "result/extremes.csv"));
  EXPECT_EQ(nlohmann::json::parse(cli(name + " --json").output)["cells"].size(), 4u);
}

TEST(Study, ReadsStabilityMapsAndWorkPrecision) {
  const TemporaryFolder folder;
  const std::string map = (folder / "map").string(), precision = (folder / "precision").string();
  ASSERT_EQ(
      cli("stability corners-free --methods verlet --set cloth.rows=4 --set cloth.columns=4 --periods 20 "
          "--x integrator.time_step=0.001:0.1:4:log --y springs.structural=50:500:2 --out '" +
          map + "'")
          .exit_code,
      0);
  ASSERT_EQ(cli("work-precision pendulum --methods verlet --horizon 0.1 --out '" + precision + "'").exit_code,
            0);
  EXPECT_TRUE(has(cli("study '" + map + "'").output, "stability: Hung by two corners"));
  EXPECT_EQ(cli("study '" + map + "' --csv").output, content_of(folder / "map/stability.csv"));
  EXPECT_TRUE(has(cli("study '" + precision + "'").output, "Cheapest for an RMS position error"));
}

TEST(Study, SaysWhatAFolderLacks) {
  const TemporaryFolder folder;
  const CommandResult none = cli("study '" + folder.path().string() + "'");
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_TRUE(has(none.errors, "study.json")) << none.errors;
  ASSERT_FALSE(write_text_file(folder / "study.json", "{}"));
  EXPECT_EQ(cli("study '" + folder.path().string() + "'").exit_code, 2);
}

TEST(Study, ExtremesOfASceneNameTheSceneInTheirFolder) {
  const TemporaryFolder folder;
  const std::string out = (folder / "result").string();
  const CommandResult made =
      cli("extremes pendulum --methods verlet --cases as-it-is,step-x2 --out '" + out + "'");
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(has(cli("study '" + out + "'").output, made.output));
}

}  // namespace
}  // namespace cloth::test::study_test
