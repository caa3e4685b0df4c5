// What --out names is one run or study; inputs are never replaced; an interrupted study goes on.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/csv.h"
#include "io/file_digest.h"
#include "io/json_entry.h"
#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test::folders_test {
namespace {

const std::string short_run = "run pendulum --set duration=0.1 ";
const std::string small_map =
    "stability corners-free --methods verlet,rk4 --set cloth.rows=4 --set cloth.columns=4 --periods 20 "
    "--x integrator.time_step=0.001:0.1:6:log --y springs.structural=50:500:4 ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string out(const TemporaryFolder& folder, const std::string& name) {
  return "--out '" + (folder / name).string() + "' ";
}

/// With `path` set to the folder.
CommandResult in_folder(const TemporaryFolder& folder, const std::string& commands) {
  return shell("cd '" + folder.path().string() + "'\n" + commands);
}

TEST(Folders, NeverLoseTheSceneThatIsRun) {
  const TemporaryFolder folder;
  const std::string scene = cli("scenes pendulum").output;
  ASSERT_FALSE(write_text_file(folder / "scene.json", scene));
  std::filesystem::create_symlink("scene.json", folder / "link.json");
  const std::string roundabout = "./../" + folder.path().filename().string() + "/scene.json";
  for (const std::string& input : {std::string("scene.json"), std::string("link.json"), roundabout}) {
    const CommandResult result = in_folder(folder, "\"$CLI\" run " + input + " --out .");
    EXPECT_EQ(result.exit_code, 2) << input;
    EXPECT_TRUE(has(result.errors, "would replace it")) << result.errors;
    EXPECT_EQ(content_of(folder / "scene.json"), scene);
    EXPECT_FALSE(std::filesystem::exists(folder / "record.csv"));
  }
  EXPECT_EQ(in_folder(folder, "\"$CLI\" run scene.json --obj link.json").exit_code, 2);
  EXPECT_EQ(in_folder(folder, "\"$CLI\" run wind --set duration=0.01 --out .").exit_code, 2) << "not ours";
  EXPECT_EQ(content_of(folder / "scene.json"), scene);
}

TEST(Folders, NeverLoseAMeshAComparisonOrASession) {
  const TemporaryFolder folder;
  const std::string disc = cli("mesh disc.obj").output;
  ASSERT_FALSE(write_text_file(folder / "record.csv", disc));  // a strange name, but a mesh
  ASSERT_FALSE(write_text_file(folder / "s.json", cli("scenes disc").output));
  const std::string set = " --set duration=0.01 --set 'cloth.mesh.file=\"record.csv\"' ";
  EXPECT_EQ(in_folder(folder, "\"$CLI\" run s.json --out ." + set).exit_code, 2);
  EXPECT_EQ(in_folder(folder, "\"$CLI\" run s.json --obj record.csv" + set).exit_code, 2);
  EXPECT_EQ(content_of(folder / "record.csv"), disc);

  const std::string panes = "compare --scene pendulum --methods verlet,rk4 --duration 0.05 ";
  ASSERT_EQ(cli(panes + out(folder, "c")).exit_code, 0);
  const std::string comparison = content_of(folder / "c/comparison.json");
  const CommandResult result =
      cli("compare '" + (folder / "c/comparison.json").string() + "' " + out(folder, "c"));
  EXPECT_EQ(result.exit_code, 2) << result.errors;
  EXPECT_EQ(content_of(folder / "c/comparison.json"), comparison);

  const std::string session = R"({"format": "clothlab/session/1", "scene": )" +
                              cli("scenes pendulum").output + R"(, "steps": 2, "commands": []})";
  ASSERT_FALSE(write_text_file(folder / "summary.json", session));
  const CommandResult replayed = in_folder(folder, "\"$CLI\" replay summary.json --out .");
  EXPECT_EQ(replayed.exit_code, 2) << replayed.errors;
  EXPECT_EQ(content_of(folder / "summary.json"), session);
}

TEST(Folders, HaveNothingOfTheRunBefore) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(short_run + out(folder, "r")).exit_code, 0);
  // As a recording of the window, or another version, would have left them.
  auto summary = nlohmann::ordered_json::parse(content_of(folder / "r/summary.json"));
  summary["files"]["record-2.csv"] = summary["files"]["edits.jsonl"] = nlohmann::ordered_json::object();
  ASSERT_FALSE(write_text_file(folder / "r/summary.json", summary.dump()));
  for (const char* name : {"r/record-2.csv", "r/edits.jsonl", "r/notes.txt"})
    ASSERT_FALSE(write_text_file(folder / name, "old"));
  ASSERT_EQ(cli(short_run + out(folder, "r")).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "r/record-2.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r/edits.jsonl"));
  EXPECT_EQ(content_of(folder / "r/notes.txt"), "old");
}

TEST(Folders, HoldOneKind) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(short_run + out(folder, "r")).exit_code, 0);
  const CommandResult result = cli("extremes --methods verlet --cases cloth-2x2 " + out(folder, "r"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(has(result.errors, "holds a run")) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "r/study.json"));
}

TEST(Folders, DescribeTheirFiles) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(short_run + out(folder, "r")).exit_code, 0);
  ASSERT_EQ(cli("extremes --methods verlet --cases cloth-2x2 " + out(folder, "e")).exit_code, 0);
  for (const std::string index : {"r/summary.json", "e/study.json"}) {
    const auto root = nlohmann::ordered_json::parse(content_of(folder / index));
    const auto files = digests_of(JsonEntry(root.at("files")));
    EXPECT_EQ(files.size(), 3u) << index;
    for (const FileDigest& file : files) {
      const std::string text = content_of(folder / index.substr(0, 2) / file.name);
      EXPECT_EQ(disagreement(file, digest_of(file.name, text, file.rows.has_value())), "") << file.name;
    }
  }
}

TEST(Folders, TurnASecondWriterAway) {
  const TemporaryFolder folder;
  const CommandResult result =
      in_folder(folder,
                "\"$CLI\" run corners-free --set duration=100000 --out r 2> /dev/null &\n"
                "first=$!\n"
                "until [ -s r/record.csv ]; do sleep 0.05; done\n"
                "\"$CLI\" run pendulum --set duration=0.1 --out r\n"
                "echo \"second $?\"\n"
                "kill -TERM $first\n"
                "wait $first\n"
                "echo \"first $?, $(grep -c '\"process [0-9]*' r/summary.json)\"");
  EXPECT_TRUE(has(result.output, "second 4")) << result.output;
  EXPECT_TRUE(has(result.output, "first 130")) << result.output;
  EXPECT_TRUE(has(result.errors, "r: process ")) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "r/summary.json"))["status"], "stopped");
}

TEST(Folders, WithAPipeInItAreRefusedAndNotWaitedFor) {
  for (const char* name : {"record.csv", "summary.json", "study.json", ".clothlab"}) {
    const TemporaryFolder folder;
    const CommandResult result = in_folder(
        folder, "mkfifo " + std::string(name) + "; timeout -s KILL 20 \"$CLI\" " + short_run + "--out .");
    if (name == std::string("study.json")) {  // no file of a run
      EXPECT_EQ(result.exit_code, 0) << result.errors;
      continue;
    }
    EXPECT_EQ(result.exit_code, 2) << name << result.errors;
    EXPECT_TRUE(has(result.errors, "is not from this program")) << result.errors;
  }
}

TEST(Folders, HaveAName) {
  for (const std::string command :
       {"run pendulum --set duration=0.01 --out ''", "run pendulum --set duration=0.01 --obj ''",
        "extremes --methods verlet --cases cloth-2x2 --out ''"}) {
    const CommandResult result = cli(command);
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_TRUE(has(result.errors, "must be a name")) << result.errors;
  }
}

TEST(Folders, AreFreeAgainWhenTheirWriterIsKilled) {
  const TemporaryFolder folder;
  const CommandResult result =
      in_folder(folder,
                "\"$CLI\" run corners-free --set duration=100000 --out r 2> /dev/null &\n"
                "run=$!\n"
                "until [ -s r/record.csv ]; do sleep 0.05; done\n"
                "kill -KILL $run\n"
                "wait $run 2> /dev/null\n"
                "exec \"$CLI\" " +
                    short_run + "--out r");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST(Folders, AreWholeAfterAHangup) {
  const TemporaryFolder folder;
  const CommandResult result =
      in_folder(folder,
                "\"$CLI\" run corners-free --set duration=100000 --out r 2> /dev/null &\n"
                "run=$!\n"
                "until [ -s r/record.csv ]; do sleep 0.05; done\n"
                "kill -HUP $run\n"
                "wait $run");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "r/summary.json"))["status"], "stopped");
}

TEST(Folders, OfAStudyNeverHaveNewWordsOverAnOldTable) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(small_map + out(folder, "map")).exit_code, 0);
  const std::string old = cli("study '" + (folder / "map").string() + "'").output;
  ASSERT_TRUE(has(old, "verlet"));
  // A disk that fills at any size: whatever could be written, the table is that of the words, or there is
  // none.
  for (const int blocks : {1, 2, 4, 8, 16, 32, 64}) {  // 0: nor could the message be written
    const CommandResult result = shell("ulimit -f " + std::to_string(blocks) + "\nexec \"$CLI\" " +
                                       small_map + " --set cloth.mass=0.7 --overwrite " + out(folder, "map"));
    const CommandResult study = cli("study '" + (folder / "map").string() + "'");
    if (result.exit_code == 0) break;
    EXPECT_EQ(result.exit_code, 4) << result.errors;
    if (study.exit_code == 0) {
      EXPECT_TRUE(has(study.output, "stopped before its end")) << blocks << ": " << study.output;
      EXPECT_TRUE(has(study.output, "cloth.mass=0.7")) << study.output;
    } else {
      EXPECT_EQ(study.exit_code, 4) << study.errors;
    }
  }
}

TEST(Folders, OfAStudyWithAnotherTableSayWhatDoesNotAgree) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(small_map + out(folder, "map")).exit_code, 0);
  const std::string table = content_of(folder / "map/stability.csv");
  ASSERT_FALSE(write_text_file(folder / "map/stability.csv", table.substr(0, table.rfind("rk4"))));
  const CommandResult result = cli("study '" + (folder / "map").string() + "'");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "stability.csv has 47 rows, not 48")) << result.errors;
  EXPECT_EQ(result.output, "");
}

TEST(Studies, ThatAreKilledGoOnToTheSameResult) {
  const TemporaryFolder folder;
  ASSERT_EQ(cli(small_map + out(folder, "whole")).exit_code, 0);
  // Killed whenever some more rows are there; the last start finds it finished or ends it.
  const CommandResult result = in_folder(folder,
                                         "rows() { cat map/stability.csv 2> /dev/null | wc -l; }\n"
                                         "for more in 8 16 24 32 40; do\n"
                                         "  \"$CLI\" " +
                                             small_map +
                                             "--out map > /dev/null 2>> said &\n"
                                             "  study=$!\n"
                                             "  until [ $(rows) -gt $more ]; do :; done\n"
                                             "  kill -KILL $study\n"
                                             "  wait $study 2> /dev/null\n"
                                             "  [ -f map/report.html ] && break\n"
                                             "done\n"
                                             "[ -f map/report.html ] || \"$CLI\" " +
                                             small_map + "--out map");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(content_of(folder / "map/stability.csv"), content_of(folder / "whole/stability.csv"));
  EXPECT_EQ(content_of(folder / "map/stability.svg"), content_of(folder / "whole/stability.svg"));
}

TEST(Studies, ThatAreUnfinishedAreLeftAloneByOtherInputs) {
  const TemporaryFolder folder;
  const CommandResult result =
      in_folder(folder, "\"$CLI\" " + small_map +
                            "--out map > /dev/null &\n"
                            "study=$!\n"
                            "until [ $(cat map/stability.csv 2> /dev/null | wc -l) -gt 3 ]; do :; done\n"
                            "kill -KILL $study\n"
                            "wait $study 2> /dev/null\n"
                            "[ -f map/report.html ] && exit 99\n"
                            "exec \"$CLI\" " +
                            small_map + "--set cloth.mass=2 --out map");
  if (result.exit_code == 99) GTEST_SKIP() << "it was over before it could be killed";
  EXPECT_EQ(result.exit_code, 2) << result.errors;
  EXPECT_TRUE(has(result.errors, "not the same: the scene")) << result.errors;
  EXPECT_GT(parse_csv(content_of(folder / "map/stability.csv")).rows.size(), 2u);
}

}  // namespace
}  // namespace cloth::test::folders_test
