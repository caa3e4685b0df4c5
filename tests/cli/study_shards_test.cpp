// clothlab-cli with --shard: a study by several processes and a merge.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/csv.h"
#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test::study_shards_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string few =
    "extremes --methods verlet,rk4,implicit-euler --cases cloth-2x2,step-1s,stiffness-1e0";
const std::string map =
    "stability corners-free --x integrator.time_step=5e-4:4e-3:4:log --y springs.*=50:200:3:log --methods "
    "verlet,rk4";
const std::string precision = "work-precision pendulum --horizon 0.1 --methods verlet,rk4,implicit-euler";
const std::string grids =
    "convergence corners-free --set cloth.rows=4 --set cloth.columns=4 --cells 3,6,9 --time 0.1";
const std::string strips = "validate --only self-buckling,picture-frame";

/// A folder, and the command in it.
class Place {
 public:
  CommandResult sh(const std::string& script) const {
    return shell("cd '" + folder_.path().string() + "' || exit 9\n" + script);
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  /// A study's table without what is measured on the clock.
  std::string table(const std::string& file) const {
    CsvTable table = parse_csv(content_of(folder_ / file));
    for (const char* time : {"wall_s", "wall_median_s", "wall_lower_quartile_s", "wall_upper_quartile_s"})
      if (std::find(table.header.begin(), table.header.end(), time) != table.header.end())
        table = without_column(table, time);
    return csv_text(table, "\n");
  }

 private:
  TemporaryFolder folder_;
};

/// Three processes at once, then the merge, and one process in another folder.
void expect_parts_to_be_the_whole(const std::string& study, const std::string& csv) {
  const Place place;
  const CommandResult result = place.sh("for i in 1 2 3; do \"$CLI\" " + study +
                                        " --out parts --shard $i/3 & pids=\"$pids $!\"; done\n"
                                        "for pid in $pids; do wait $pid || exit 7; done\n"
                                        "\"$CLI\" " +
                                        study +
                                        " --out parts > merged.txt || exit 8\n"
                                        "exec \"$CLI\" " +
                                        study + " --out whole > whole.txt");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(has(result.output, "runs of shard 2/3; in parts/shards/2-of-3")) << result.output;
  EXPECT_TRUE(has(result.errors, "going on with what 3 parts of the study have")) << result.errors;
  const std::string part = place.sh("exec \"$CLI\" study parts/shards/2-of-3").output;
  EXPECT_TRUE(has(part.substr(0, part.find('\n')), " (shard 2/3)")) << part;
  EXPECT_EQ(place.table("parts/" + csv), place.table("whole/" + csv)) << study;
  for (const char* name : {"study.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(place / (std::string("parts/") + name))) << name;
}

TEST(StudyShards, OfExtremesMergedAreTheSingleRun) {
  expect_parts_to_be_the_whole(few, "extremes.csv");
}

TEST(StudyShards, OfAStabilityMapMergedAreTheSingleRun) {
  expect_parts_to_be_the_whole(map, "stability.csv");
}

TEST(StudyShards, OfWorkAndPrecisionMergedAreTheSingleRunButForTimes) {
  expect_parts_to_be_the_whole(precision, "work_precision.csv");
}

TEST(StudyShards, OfGridConvergenceMergedAreTheSingleRun) {
  expect_parts_to_be_the_whole(grids, "convergence.csv");
}

TEST(StudyShards, OfAValidationMergedAreTheSingleRun) {
  expect_parts_to_be_the_whole(strips, "validation.csv");
}

TEST(StudyShards, KilledGoOnAndToldToEndExitWith130) {
  const Place place;
  const CommandResult result = place.sh(R"sh(
    study="extremes --methods verlet,rk4,implicit-euler --out"
    rows() { grep -c , parts/shards/1-of-2/extremes.csv 2> /dev/null || echo 0; }
    more() { until [ "$(rows)" -gt $1 ]; do :; done; }
    "$CLI" $study parts --shard 1/2 & more 2; kill -9 $!; wait $!; [ $? -eq 137 ] || exit 7
    before=$(rows)
    "$CLI" $study parts --shard 1/2 & more $before; kill -TERM $!; wait $!; [ $? -eq 130 ] || exit 6
    "$CLI" $study parts --shard 1/2 || exit 5
    SLURM_ARRAY_TASK_ID=2 "$CLI" $study parts --shard auto/2 || exit 4
    "$CLI" $study parts && "$CLI" $study whole)sh");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(has(result.errors, "the same command goes on")) << result.errors;
  EXPECT_EQ(place.table("parts/extremes.csv"), place.table("whole/extremes.csv"));
}

TEST(StudyShards, OfOtherOptionsExitWithTwoAndAreNamed) {
  const Place place;
  const CommandResult result = place.sh("\"$CLI\" " + map + " --out parts --shard 1/2 || exit 7\n\"$CLI\" " +
                                        map + " --periods 50 --out parts");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "parts/shards/1-of-2: ")) << result.errors;
  EXPECT_TRUE(has(result.errors, "not the same: criterion")) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(place / "parts/study.json"));
}

TEST(StudyShards, ThatDoNotAgreeExitWithFiveAndAreNamed) {
  const Place place;
  ASSERT_EQ(place.sh("exec \"$CLI\" " + few + " --out parts --shard 1/3").exit_code, 0);
  // As of a process that came to something else and was killed: a finished table has a digest.
  std::filesystem::copy(place / "parts/shards/1-of-3", place / "parts/shards/4-of-9");
  auto index = nlohmann::ordered_json::parse(content_of(place / "parts/shards/4-of-9/study.json"));
  index.erase("files");
  ASSERT_FALSE(write_text_file(place / "parts/shards/4-of-9/study.json", index.dump()));
  std::string rows = content_of(place / "parts/shards/4-of-9/extremes.csv");
  ASSERT_TRUE(has(rows, ",stable,"));
  rows.replace(rows.find(",stable,"), 8, ",diverged,");
  ASSERT_FALSE(write_text_file(place / "parts/shards/4-of-9/extremes.csv", rows));
  const CommandResult result = place.sh("exec \"$CLI\" " + few + " --out parts");
  EXPECT_EQ(result.exit_code, 5) << result.errors;
  for (const char* said : {"was made twice, and status is stable and diverged", "parts/shards/1-of-3",
                           "parts/shards/4-of-9", "nothing is made"})
    EXPECT_TRUE(has(result.errors, said)) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(place / "parts/study.json"));
}

TEST(StudyShards, ThatAreBadUsageSayWhy) {
  const std::pair<std::string, const char*> cases[] = {
      {few + " --shard 1/2", "--out"},
      {few + " --out x --shard 3/2", "--shard: the index 3 must be 1 to 2"},
      {few + " --out x --shard two", "--shard: "},
      {few + " --out x --shard auto", "SLURM_ARRAY_TASK_ID"},
      {"validate --scene corners-free --out x --shard 1/2", "--shard"}};
  const Place place;
  for (const auto& [arguments, said] : cases) {
    const CommandResult result = place.sh("exec \"$CLI\" " + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_TRUE(has(result.errors, said)) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(place / "x")) << arguments;
  }
}

}  // namespace
}  // namespace cloth::test::study_shards_test
