// clothlab-cli sweep: what it leaves, and that kills, full disks and shards change nothing of it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::sweep_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// 60 points, about 20 ms for each s that they simulate.
void write_plan(const std::filesystem::path& file, const std::string& more = "",
                const std::string& duration = "0.5") {
  std::ofstream(file) << R"({ "format": "clothlab/sweep/1", "scene": "corners-free",
  "set": { "cloth.rows": 12, "cloth.columns": 12, "integrator.time_step": 0.0005,
    "duration": )" << duration
                      << R"( },
  "vary": [ { "path": "springs.structural", "from": 50, "to": 200, "count": 6, "scale": "log" },
            { "path": "damping", "from": 0.001, "to": 0.01, "count": 10 } ],
  "outputs": [ { "name": "peak", "of": "max_strain", "reduce": "max" }, { "of": "sag" } ])"
                      << more << " }\n";
}

/// A folder with a plan, in which commands are run.
class Place {
 public:
  Place() { write_plan(folder_ / "p.sweep.json"); }

  CommandResult sh(const std::string& command) const {
    return shell("cd '" + folder_.path().string() + "'\n" + command);
  }
  CommandResult run(const std::string& arguments) const { return sh("exec \"$CLI\" sweep " + arguments); }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  /// sweep.csv of a folder without what is of the machine.
  std::string table(const std::string& name) const {
    const CsvTable table = parse_csv(content_of(folder_ / (name + "/sweep.csv")));
    return csv_text(without_column(without_column(table, "wall_s"), "host"), "\n");
  }

 private:
  TemporaryFolder folder_;
};

void expect_done(const CommandResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST(SweepCommand, LeavesTableMapsAndPageAndGoesOnWithoutARun) {
  const Place place;
  const CommandResult result = place.run("p.sweep.json --out whole");
  expect_done(result);
  EXPECT_TRUE(has(result.output, "60 points: 60 finished, 0 missing")) << result.output;
  for (const char* name : {"sweep.json", "sweep.csv", "sweep-peak.svg", "sweep-sag.svg", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(place / (std::string("whole/") + name))) << name;
  const std::string before = content_of(place / "whole/sweep.csv");
  EXPECT_TRUE(has(place.run("--out whole").output, "60 of them made before"));
  EXPECT_EQ(content_of(place / "whole/sweep.csv"), before);
  const auto json = nlohmann::json::parse(place.run("status whole --json").output);
  EXPECT_EQ(json["status"]["finished"], 60);
  EXPECT_EQ(json["attempts"], 1);
}

TEST(SweepCommand, KilledThreeTimesAndResumedIsTheSingleRun) {
  const Place place;
  write_plan(place / "p.sweep.json", "", "2");  // long enough to be killed in time
  expect_done(place.run("p.sweep.json --out whole"));
  // Killed when a row of its own is there; the next one was under way.
  const CommandResult killed = place.sh(R"sh(
    rows() { cat parts/shards/*.jsonl 2>/dev/null | grep -c '"point"'; }
    for attempt in 1 2 3; do
      before=$(rows)
      "$CLI" sweep p.sweep.json --out parts --jobs 2 &
      until [ "$(rows)" -gt "$before" ]; do sleep 0.01; done
      kill -9 $!
      wait $!
      [ $? -eq 137 ] || exit 7
    done
    "$CLI" sweep status parts
    exec "$CLI" sweep --out parts)sh");
  expect_done(killed);
  EXPECT_EQ(place.table("parts"), place.table("whole"));
  EXPECT_TRUE(has(place.run("status parts").output, "4 attempts")) << place.run("status parts").output;
}

TEST(SweepCommand, ByShardsWhoseNumberChangesHalfWayIsTheSingleRun) {
  const Place place;
  expect_done(place.run("p.sweep.json --out whole"));
  const CommandResult result = place.sh(R"sh(
    "$CLI" sweep p.sweep.json --out parts --shard 2/3 &&
    [ "$("$CLI" sweep status parts --missing)" = 1,3 ] &&
    "$CLI" sweep p.sweep.json --out parts --shard 1/7 &&
    [ "$("$CLI" sweep status parts --missing --shards 3)" = 1,3 ] &&
    SLURM_ARRAY_TASK_ID=4 "$CLI" sweep --out parts --shard auto/7 &&
    "$CLI" sweep merge parts && grep -c . parts/sweep.csv
    for i in 1 2 3 4 5; do "$CLI" sweep --out parts --shard $i/5 & done
    wait
    [ -z "$("$CLI" sweep status parts --missing --shards 3)" ] &&
    exec "$CLI" sweep merge parts)sh");
  expect_done(result);
  EXPECT_TRUE(has(result.errors, "of 60 points are missing")) << result.errors;
  EXPECT_EQ(place.table("parts"), place.table("whole"));
}

TEST(SweepCommand, MayRunTwiceAtOnce) {
  const Place place;
  expect_done(place.run("p.sweep.json --out whole"));
  const CommandResult result = place.sh(R"sh(
    "$CLI" sweep p.sweep.json --out parts --shard 1/1 > first.txt & first=$!
    "$CLI" sweep p.sweep.json --out parts --shard 1/1 > second.txt & second=$!
    wait $first && wait $second && exec "$CLI" sweep merge parts)sh");
  expect_done(result);
  EXPECT_EQ(place.table("parts"), place.table("whole"));
}

TEST(SweepCommand, ThatIsTerminatedHasItsRowsAndAnExitCodeOfItsOwn) {
  const Place place;
  write_plan(place / "p.sweep.json", "", "2");
  for (const auto& [option, code] : {std::pair("", 130), std::pair("--stopped-exit-code 99", 99)}) {
    const CommandResult result = place.sh(std::string(R"sh(
      rm -rf parts
      "$CLI" sweep p.sweep.json --out parts --jobs 1 )sh") +
                                          option + R"sh( &
      until [ "$(cat parts/shards/*.jsonl 2>/dev/null | wc -l)" -ge 5 ]; do sleep 0.01; done
      kill -TERM $!
      wait $!)sh");
    EXPECT_EQ(result.exit_code, code) << result.errors;
    EXPECT_TRUE(has(result.errors, "the same command goes on")) << result.errors;
    const auto json = nlohmann::json::parse(place.run("status parts --json").output);
    EXPECT_GE(json["status"]["finished"], 4);
    EXPECT_EQ(json["damaged_lines"], 0);
  }
}

TEST(SweepCommand, OnAFullDiskExitsWithFourKeepsWholeLinesAndGoesOn) {
  const Place place;
  expect_done(place.run("p.sweep.json --out whole"));
  expect_done(place.run("p.sweep.json --out parts --shard 60/60"));  // sweep.json is there
  const CommandResult full = place.sh("ulimit -f 4\nexec \"$CLI\" sweep --out parts --shard 1/1");
  EXPECT_EQ(full.exit_code, 4) << full.errors;
  EXPECT_TRUE(has(full.errors, ".jsonl")) << full.errors;
  const auto json = nlohmann::json::parse(place.run("status parts --json").output);
  EXPECT_GT(json["status"]["finished"], 1);
  EXPECT_GT(json["missing"], 0);
  EXPECT_EQ(json["damaged_lines"], 0);
  expect_done(place.run("--out parts"));
  EXPECT_EQ(place.table("parts"), place.table("whole"));
}

TEST(SweepCommand, MergesNothingWhereAPointDoesNotAgreeAndNamesBothMachines) {
  const Place place;
  expect_done(place.run("p.sweep.json --out parts --jobs 1"));
  const CommandResult result = place.sh(R"sh(
    rm parts/sweep.csv
    cd parts/shards
    sed -e '1s/"host":"[^"]*"/"host":"node8"/' -e '1s/"processor":"[^"]*"/"processor":"Other 9000"/' \
      -e '3s/"steps":[0-9]*/"steps":7/' *.jsonl > 1-of-1.node8.1.jsonl
    cd ../..
    exec "$CLI" sweep merge parts)sh");
  EXPECT_EQ(result.exit_code, 5) << result.errors;
  for (const char* part : {"point 1 was made twice, and it took", " steps: by ", "node8 (Other 9000, "})
    EXPECT_TRUE(has(result.errors, part)) << part << ": " << result.errors;
  EXPECT_FALSE(std::filesystem::exists(place / "parts/sweep.csv"));
}

TEST(SweepCommand, OfABadPlanOrFolderExitsWithTwo) {
  const Place place;
  write_plan(place / "bad.sweep.json", R"(, "sed": 1)");
  write_plan(place / "other.sweep.json", R"(, "seed": 2)");
  expect_done(place.run("p.sweep.json --out there"));
  const std::pair<const char*, const char*> cases[] = {
      {"bad.sweep.json --out none", "bad.sweep.json:6:"},
      {"p.sweep.json", "--out"},
      {"other.sweep.json --out there", "holds a sweep of another plan"},
      {"p.sweep.json --out none --shard 5/4", "--shard"},
      {"p.sweep.json --out none --shard auto/4", "which is not set"},
      {"p.sweep.json --out none --jobs 0", "--jobs"},
      {"emit there --for pbs", "--for"}};
  for (const auto& [arguments, rule] : cases) {
    const CommandResult result = place.run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << ": " << result.errors;
    EXPECT_TRUE(has(result.errors, rule)) << arguments << ": " << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(place / "none"));
  EXPECT_EQ(place.run("none.sweep.json --out none").exit_code, 4);
  EXPECT_EQ(place.run("status none").exit_code, 4);
}

TEST(SweepCommand, EmitsScriptsThatAShellReads) {
  const Place place;
  const CommandResult timed = place.run("emit \"it's here\" --plan p.sweep.json --for slurm --minutes 0.02");
  expect_done(timed);
  EXPECT_TRUE(has(timed.errors, "a point takes")) << timed.errors;
  for (const char* target : {"slurm", "parallel", "snakemake"}) {
    const CommandResult result =
        place.run(std::string("emit \"it's here\" --shards 2500 --at-once 40 --jobs 2 --for ") + target);
    expect_done(result);
  }
  for (const char* script : {"slurm/submit.sh", "slurm/task.sh", "slurm/merge.sh", "parallel/run.sh"})
    expect_done(place.sh(std::string("sh -n \"it's here/") + script + "\""));
  const std::string task = content_of(place / "it's here/slurm/task.sh");
  for (const char* part :
       {"#SBATCH --requeue", "#SBATCH --open-mode=append", "#SBATCH --signal=B:TERM@60", "--cpus-per-task=2",
        "trap 'kill -TERM", "auto+$1/$shards", "CLOTHLAB_INSTRUCTION_SET=", "--jobs 2"})
    EXPECT_TRUE(has(task, part)) << part;
  EXPECT_TRUE(has(content_of(place / "it's here/slurm/submit.sh"), "afterany"));
}

}  // namespace
}  // namespace cloth::test::sweep_test
