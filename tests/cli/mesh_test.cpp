// Meshes on the command line: run, explained, written, and refused where a file is none.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/obj_reader.h"
#include "support/files.h"

namespace cloth::test::mesh_test {
namespace {

using Json = nlohmann::json;

TEST(Mesh, ListsTheBuiltInOnesAndPrintsOneThatReadsBack) {
  EXPECT_NE(cli("mesh").output.find("bunny.obj"), std::string::npos);
  const ObjReading disc = parse_obj(cli("mesh disc.obj").output, "disc.obj");
  ASSERT_TRUE(disc.mesh) << disc.problem;
  EXPECT_EQ(disc.mesh->vertices.size(), 1801U);
  EXPECT_EQ(cli("mesh none.obj").exit_code, 2);
}

TEST(Mesh, ClothIsRunAndRecordedIntoAFolderFromWhichItRunsAgain) {
  TemporaryFolder folder;
  std::ofstream(folder / "disc of mine.obj") << cli("mesh disc.obj").output;
  std::ofstream(folder / "x.scene.json")
      << R"({"cloth": {"mesh": "disc of mine.obj", "pins": [0]}, "springs": {"structural": 50, "flexion": 5},
             "gravity": [0, -9.81, 0], "duration": 0.02})";
  const std::string out = (folder / "runs/one").string();
  const CommandResult first =
      cli("run '" + (folder / "x.scene.json").string() + "' --out '" + out + "' --json");
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(Json::parse(first.output)["particles"], 1801);
  const CommandResult again = cli("run '" + out + "/scene.json' --out '" + out + "2'");
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(content_of(out + "/final_state.csv"), content_of(out + "2/final_state.csv"));
}

TEST(Mesh, IsExplainedWithItsTrianglesAndWithoutShear) {
  const CommandResult text = cli("explain disc");
  ASSERT_EQ(text.exit_code, 0) << text.errors;
  EXPECT_NE(text.output.find("1801 particles (disc.obj: 3456 triangles)"), std::string::npos) << text.output;
  const Json json = Json::parse(cli("explain disc --set springs.shear=10 --json").output);
  EXPECT_EQ(json["springs"]["shear"], 0);
  EXPECT_EQ(json["springs"]["structural"], 5256);
}

TEST(Mesh, WarnsOfAnOpenObstacleAndRunsAllTheSame) {
  TemporaryFolder folder;
  std::ofstream(folder / "open.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
  std::ofstream(folder / "x.scene.json")
      << R"({"cloth": {"columns": 3, "rows": 3, "origin": [0, 5, 0], "down": [0, 0, 1]},
             "springs": {"structural": 50}, "duration": 0.02, "obstacles": [{"shape": "mesh", "file": "open.obj"}]})";
  const std::string scene = "'" + (folder / "x.scene.json").string() + "'";
  const CommandResult run = cli("run " + scene);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.errors.find("3 of its edges are open"), std::string::npos) << run.errors;
  EXPECT_NE(cli("explain " + scene).output.find("3 of its edges are open"), std::string::npos);
}

TEST(Mesh, ThatCannotBeReadIsOneProblemWithItsPlace) {
  TemporaryFolder folder;
  std::ofstream(folder / "bad.obj") << "v 0 0 0\nv 1 nan 0\n";
  std::ofstream(folder / "x.scene.json")
      << "{\"cloth\": {},\n\"obstacles\": [{\"shape\": \"mesh\", \"file\": \"bad.obj\"}]}";
  const CommandResult run = cli("run '" + (folder / "x.scene.json").string() + "'");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.errors.find("x.scene.json:2:"), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find("bad.obj:2: \"nan\""), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace cloth::test::mesh_test
