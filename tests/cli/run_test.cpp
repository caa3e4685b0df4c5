#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "io/obj_reader.h"
#include "io/text_file.h"
#include "scene/scene_json.h"
#include "support/files.h"

namespace cloth::test::run_test {
namespace {

const std::string short_run = "run pendulum --set duration=0.2 ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string out(const TemporaryFolder& folder, const std::string& name = "result") {
  return "--out '" + (folder / name).string() + "'";
}

TEST(Run, LeavesItsFourFilesInTheFolder) {
  const TemporaryFolder folder;
  const CommandResult result = cli(short_run + out(folder, "a/new/folder"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "a/new/folder"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, std::set<std::string>({"scene.json", "record.csv", "final_state.csv", "summary.json"}));
  EXPECT_EQ(parse_csv(content_of(folder / "a/new/folder/record.csv")).rows.size(), 21u);
  EXPECT_TRUE(has(result.output, "finished"));
}

TEST(Run, OfAFileInTheCurrentFolderRecordsWhereItsMeshIs) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  ASSERT_FALSE(
      write_text_file(folder / "in/sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"));
  ASSERT_FALSE(
      write_text_file(folder / "in/x.scene.json", R"({"cloth": {"mesh": "sheet.obj"}, "duration": 0.1})"));
  const CommandResult first =
      shell("cd '" + (folder / "in").string() + "' && \"$CLI\" run x.scene.json " + out(folder, "a/result"));
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const CommandResult again = cli("run '" + (folder / "a/result/scene.json").string() + "'");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
}

TEST(Run, SaysProgressOnStandardErrorAndTheResultOnStandardOutput) {
  const CommandResult result = cli(short_run);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(has(result.errors, "time step: auto")) << result.errors;
  EXPECT_FALSE(has(result.output, "time step: auto"));
  EXPECT_FALSE(has(result.errors, "\r")) << "no progress bar where there is no terminal";
}

TEST(Run, GivesItsSummaryAsJson) {
  const TemporaryFolder folder;
  const CommandResult result = cli(short_run + "--json " + out(folder));
  const auto summary = nlohmann::json::parse(result.output);
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_EQ(summary, nlohmann::json::parse(content_of(folder / "result/summary.json")));
}

TEST(Run, OfTheRecordedSceneGivesTheSameRecord) {
  const TemporaryFolder folder;
  cli(short_run + out(folder, "first"));
  const CommandResult again =
      cli("run '" + (folder / "first/scene.json").string() + "' " + out(folder, "second"));
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(without_column(parse_csv(content_of(folder / "first/record.csv")), "step_time_us").rows,
            without_column(parse_csv(content_of(folder / "second/record.csv")), "step_time_us").rows);
}

TEST(Run, TakesSettings) {
  const TemporaryFolder folder;
  cli(short_run + "--set integrator.method=verlet --set springs.structural=77 " + out(folder));
  const auto reading = read_scene(content_of(folder / "result/scene.json"), "scene.json");
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(reading.scene->integrator.method, "verlet");
  EXPECT_EQ(reading.scene->springs->structural, 77);
}

TEST(Run, ThatDivergesExitsWithThreeAndKeepsTheLastGoodState) {
  const TemporaryFolder folder;
  const CommandResult result = cli("run corners-free --set integrator.time_step=0.005 --json " + out(folder));
  EXPECT_EQ(result.exit_code, 3);
  for (const char* word : {"diverged in step", "particle", "row", "t = ", "stable in every shape"})
    EXPECT_TRUE(has(result.errors, word)) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(result.output)["status"], "diverged");
  const CsvTable state = parse_csv(content_of(folder / "result/final_state.csv"));
  EXPECT_EQ(state.rows.size(), 33u * 33u);
  for (const char* column : {"x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"})
    for (const double value : column_of(state, column)) ASSERT_TRUE(std::isfinite(value));
  for (const double value : column_of(parse_csv(content_of(folder / "result/record.csv")), "kinetic_J"))
    EXPECT_TRUE(std::isfinite(value));
}

TEST(Run, ThatDoesNotKeepItsRateGoesOnAndExitsWithThree) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli("run corners-shear --set duration=0.1 --set deformation.rate=0.001 --set deformation.solver=sweeps "
          "--set deformation.max_sweeps=1 " +
          out(folder));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(has(result.errors, "rate not kept: in step ")) << result.errors;
  const auto summary = nlohmann::json::parse(content_of(folder / "result/summary.json"));
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_GT(summary["rate_not_kept"]["first_step"], 0);
  EXPECT_EQ(summary["rate_not_kept"]["particles"].size(), 2u);
  EXPECT_GE(summary["rate_not_kept"]["largest_excess"], summary["limiter_excess"]);
}

TEST(Run, WritesTheClothAfterTheLastStepAsAnObjFile) {
  const TemporaryFolder folder;
  const std::string obj = (folder / "the cloth.obj").string();
  const CommandResult result = cli("run corners-free --set duration=0.05 --obj '" + obj + "' " + out(folder));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const ObjReading reading = read_obj(obj);
  ASSERT_TRUE(reading.mesh) << reading.problem;
  const CsvTable state = parse_csv(content_of(folder / "result/final_state.csv"));
  const auto x = column_of(state, "x_m"), y = column_of(state, "y_m"), z = column_of(state, "z_m");
  ASSERT_EQ(reading.mesh->vertices.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(reading.mesh->vertices[i], Vec3(x[i], y[i], z[i]));
  EXPECT_EQ(reading.mesh->triangles.size(), 2u * 32 * 32);
  EXPECT_TRUE(has(content_of(obj), "limit on stretching, at 0.05 s\n"));
}

TEST(Run, ThatDivergesWritesTheLastGoodCloth) {
  const TemporaryFolder folder;
  const std::string obj = (folder / "cloth.obj").string();
  EXPECT_EQ(cli("run corners-free --set integrator.time_step=0.005 --obj '" + obj + "'").exit_code, 3);
  EXPECT_TRUE(read_obj(obj).mesh) << read_obj(obj).problem;  // which takes finite numbers alone
}

TEST(Run, IntoAnObjFileWithoutAFolderExitsWithFourBeforeItRuns) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli(short_run + "--obj '" + (folder / "none/cloth.obj").string() + "' " + out(folder));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "none/cloth.obj: there is no folder")) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "result"));
}

TEST(Run, WithoutAStableStepExitsWithTwoAndSaysWhy) {
  const CommandResult result = cli("run free-fall --set integrator.method=explicit-euler");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(has(result.errors, "explicit-euler has no stable time step for this scene")) << result.errors;
}

TEST(Run, IntoAFolderThatCannotBeMadeExitsWithFour) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "file", "x"));
  const CommandResult result = cli(short_run + out(folder, "file/below"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "file/below")) << result.errors;
  EXPECT_EQ(result.output, "");
}

TEST(Run, WhereNobodyMayWriteExitsWithFour) {
  const CommandResult result = cli(short_run + "--out /proc/clothlab-result");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "/proc/clothlab-result: ")) << result.errors;
}

TEST(Run, IntoAFolderThatIsNotWritableExitsWithFour) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const CommandResult result = cli(short_run + "--out '" + folder.path().string() + "'");
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(has(result.errors, "Permission denied")) << result.errors;
}

TEST(Run, OnADiskThatFillsUpExitsWithFourAndLeavesAValidRecord) {
  const TemporaryFolder folder;
  const std::string run = "\"$CLI\" run pendulum --set record.interval=0.0005 " + out(folder);
  const CommandResult result = shell("ulimit -f 40\n" + run);  // blocks of 512 bytes or of 1 KiB
  EXPECT_EQ(result.exit_code, 4) << result.errors;
  EXPECT_TRUE(has(result.errors, "record.csv: File too large")) << result.errors;
  const std::string record = content_of(folder / "result/record.csv");
  const CsvTable table = parse_csv(record);
  EXPECT_EQ(record.back(), '\n');
  EXPECT_GT(table.rows.size(), 10u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
}

TEST(Run, IntoAClosedPipeEnds) {
  const CommandResult result = shell("\"$CLI\" " + short_run + "| head -c 0; echo over");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.output, "over\n");
}

TEST(Run, ThatIsInterruptedLeavesAValidRecordAndSaysStopped) {
  const TemporaryFolder folder;
  // The shell ends the run once its record has grown, however long that takes.
  const std::string record = (folder / "result/record.csv").string();
  const CommandResult result = shell("\"$CLI\" run corners-shear --set duration=100000 " + out(folder) +
                                     " &\n"
                                     "run=$!\n"
                                     "until [ \"$(wc -l < '" +
                                     record +
                                     "' 2> /dev/null || echo 0)\" -gt 3 ]; do sleep 0.05; done\n"
                                     "kill -TERM $run\n"
                                     "wait $run");
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  const CsvTable table = parse_csv(content_of(record));
  EXPECT_GT(table.rows.size(), 2u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "result/summary.json"))["status"], "stopped");
}

TEST(Run, ThatIsKilledLeavesAValidRecord) {
  const TemporaryFolder folder;
  const std::string record = (folder / "result/record.csv").string();
  shell("\"$CLI\" run corners-shear --set duration=100000 " + out(folder) +
        " &\n"
        "run=$!\n"
        "until [ \"$(wc -l < '" +
        record +
        "' 2> /dev/null || echo 0)\" -gt 3 ]; do sleep 0.05; done\n"
        "kill -KILL $run\n"
        "wait $run");
  const std::string text = content_of(record);
  EXPECT_EQ(text.back(), '\n');
  for (const auto& row : parse_csv(text).rows) EXPECT_EQ(row.size(), parse_csv(text).header.size());
}

TEST(Run, AcceptsThreadsAndGivesTheSameBits) {
  const TemporaryFolder folder;
  const std::string large =
      "run corners-free --set cloth.rows=128 --set cloth.columns=128 --set duration=0.02 ";
  for (const char* threads : {"1", "4"}) {
    const CommandResult result = cli(large + "--json --threads " + threads + " " + out(folder, threads));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["threads"], std::stoi(threads)) << "they are not used";
  }
  const std::string state = content_of(folder / "1/final_state.csv");
  EXPECT_EQ(parse_csv(state).rows.size(), 128u * 128u);
  EXPECT_EQ(state, content_of(folder / "4/final_state.csv"));
}

/// Of a PNG file: its width and height, which follow the names of the format and of the first chunk.
std::pair<int, int> png_size(const std::string& png) {
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t k = at; k < at + 4; ++k) value = value << 8 | static_cast<unsigned char>(png.at(k));
    return value;
  };
  return {number(16), number(20)};
}

TEST(Run, WritesAPictureOfTheClothAfterTheLastStep) {
  const TemporaryFolder folder;
  const auto picture = [&](const std::string& name, const std::string& options) {
    const CommandResult result =
        cli("run ball --set duration=0.05 --picture '" + (folder / name).string() + "' " + options);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const std::string png = content_of(folder / name);
    EXPECT_EQ(png.substr(1, 3), "PNG") << name;
    return png;
  };
  const std::string usual = picture("usual.png", "");
  EXPECT_EQ(png_size(usual), std::pair(1280, 960));
  EXPECT_EQ(picture("again.png", ""), usual) << "the same bytes again";
  const std::string small = picture("small.png", "--size 120x90");
  EXPECT_EQ(png_size(small), std::pair(120, 90));
  EXPECT_EQ(png_size(picture("dot.png", "--size 1x1")), std::pair(1, 1));
  std::set<std::string> different{small};
  for (const char* options : {"--view front", "--view left", "--view top", "--view -30,80", "--theme dark"})
    EXPECT_TRUE(different.insert(picture("other.png", std::string("--size 120x90 ") + options)).second)
        << options << " shows what another one shows";
  EXPECT_EQ(picture("right.png", "--size 120x90 --view right"),
            picture("90.png", "--size 120x90 --view 90,0"));
}

TEST(Run, SaysWhatIsWrongWithAPictureBeforeItRuns) {
  const TemporaryFolder folder;
  const std::string file = "--picture '" + (folder / "cloth.png").string() + "' ";
  const struct {
    std::string options, message;
  } cases[] = {{file + "--view below", "--view: below: must be front, back, left, right, top, corner, or"},
               {file + "--view 10", "--view: 10: must be"},
               {file + "--view 10,91", "--view: 10,91: must be"},
               {file + "--view nan,0", "--view: nan,0: must be"},
               {file + "--size 0x10", "--size: 0x10: must be WIDTHxHEIGHT in pixels, each from 1 to 8192"},
               {file + "--size 100", "--size: 100: must be"},
               {file + "--size 9000x10", "--size: 9000x10: must be"},
               {file + "--theme blue", "--theme: blue: must be light or dark"},
               {"--view top", "--view requires --picture"},
               {"--picture ''", "--picture: must be a name"}};
  for (const auto& [options, message] : cases) {
    const CommandResult result = cli(short_run + options + " " + out(folder));
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_TRUE(has(result.errors, message)) << options << "\n" << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "result")) << options;
    EXPECT_FALSE(std::filesystem::exists(folder / "cloth.png")) << options;
  }
}

TEST(Run, RefusesAPictureThatHasNoPlace) {
  const TemporaryFolder folder;
  const auto run_with = [&](const std::string& picture, const std::string& more = "") {
    return cli(short_run + "--picture '" + (folder / picture).string() + "' " + more + out(folder));
  };
  const CommandResult nowhere = run_with("none/cloth.png");
  EXPECT_EQ(nowhere.exit_code, 4);
  EXPECT_TRUE(has(nowhere.errors, "none/cloth.png: there is no folder")) << nowhere.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "result"));
  const CommandResult own = run_with("result/record.csv");
  EXPECT_EQ(own.exit_code, 4) << "its folder is not there yet";
  const CommandResult twice = run_with("both", "--obj '" + (folder / "both").string() + "' ");
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_TRUE(has(twice.errors, "give the picture another name") ||
              has(twice.errors, "give the OBJ file another name"))
      << twice.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "both"));
}

}  // namespace
}  // namespace cloth::test::run_test
