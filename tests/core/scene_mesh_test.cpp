// Meshes in scene files: where they are found, what is said when they are not, and that they come back.
#include "scene/scene_mesh.h"

#include <gtest/gtest.h>

#include <fstream>

#include "scene/obstacle_shape.h"
#include "scene/scene_checks.h"
#include "scene/scene_edits.h"
#include "scene/scene_parameters.h"
#include "support/files.h"

namespace cloth::test::scene_mesh_test {
namespace {

const char* const tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string scene_with(const std::string& obstacle) {
  return R"({"cloth": {}, "obstacles": [)" + obstacle + "]}";
}

std::string cloth_of(const std::string& cloth) {
  return R"({"cloth": )" + cloth + R"(, "springs": {"structural": 10}})";
}

std::string only_problem_of(const SceneReading& reading) {
  EXPECT_FALSE(reading.scene);
  EXPECT_EQ(reading.problems.size(), 1U);
  return reading.problems.empty() ? "" : reading.problems.front().text();
}

class SceneMeshFile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  SceneReading read(const std::string& text, const std::vector<Override>& overrides = {}) {
    return read_scene(text, folder_ / "x.scene.json", overrides);
  }
  std::string folder() const { return folder_.path().string(); }

  TemporaryFolder folder_;
};

TEST_F(SceneMeshFile, IsFoundBesideTheSceneFile) {
  write("meshes/t.obj", tetrahedron);
  const SceneReading reading =
      read(scene_with(R"({"shape": "mesh", "file": "meshes/t.obj", "translate": [0, -9, 0]})"));
  ASSERT_TRUE(reading.scene) << reading.problems.front().text();
  const Obstacle& obstacle = reading.scene->obstacles.front();
  ASSERT_TRUE(obstacle.mesh.is_loaded());
  EXPECT_EQ(obstacle.mesh.loaded->surface.triangles.size(), 4U);
  EXPECT_EQ(obstacle.mesh.loaded->edges.size(), 6U);
  EXPECT_EQ(mesh_notices(*reading.scene), std::vector<std::string>{});
}

TEST_F(SceneMeshFile, GoesBeforeABuiltInMeshOfItsNameExceptInABuiltInScene) {
  write("disc.obj", tetrahedron);
  const std::string text = scene_with(R"({"shape": "mesh", "file": "disc.obj", "translate": [0, -9, 0]})");
  const auto triangles = [](const SceneReading& reading) {
    return reading.scene ? reading.scene->obstacles.front().mesh.loaded->surface.triangles.size() : 0U;
  };
  EXPECT_EQ(triangles(read(text)), 4U);
  EXPECT_GT(triangles(read_scene(text, "x", {}, {SceneFolder{folder(), true}})), 1000U);
}

TEST_F(SceneMeshFile, ThatIsMissingIsAProblemWithPlaceValueAndRule) {
  const std::string text =
      "{\n\"cloth\": {},\n\"obstacles\": [{\"shape\": \"mesh\",\n  \"file\": \"none.obj\"}]}";
  const std::string problem = only_problem_of(read(text));
  EXPECT_NE(problem.find("x.scene.json:4:"), std::string::npos) << problem;
  EXPECT_NE(problem.find("obstacles.0.file = \"none.obj\": must be a file"), std::string::npos) << problem;
  EXPECT_NE(problem.find("bunny.obj"), std::string::npos) << problem;
}

TEST_F(SceneMeshFile, ThatIsBrokenIsOneProblemWithTheLineInTheFile) {
  write("t.obj", "v 0 0 0\nv 1 nan 0\n");
  const std::string problem =
      only_problem_of(read(scene_with(R"({"shape": "mesh", "file": "t.obj", "translate": [0, -9, 0]})")));
  EXPECT_NE(problem.find("t.obj:2:"), std::string::npos) << problem;
  EXPECT_EQ(problem.find(folder(), 1), std::string::npos)
      << "no machine's path but the scene's own: " << problem;
}

TEST_F(SceneMeshFile, MustBeGiven) {
  EXPECT_NE(only_problem_of(read(scene_with(R"({"shape": "mesh"})"))).find("must name a mesh"),
            std::string::npos);
  EXPECT_NE(only_problem_of(read(cloth_of(R"({"mesh": ""})"))).find("must name a mesh"), std::string::npos);
}

TEST_F(SceneMeshFile, ThatIsOpenOrUnevenWorksAndIsNoticed) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 1\nf 1 3 2\nf 1 2 5\nf 1 3 4\n");
  const SceneReading reading =
      read(scene_with(R"({"shape": "mesh", "file": "t.obj", "translate": [0, -9, 0]})"));
  ASSERT_TRUE(reading.scene);
  const std::vector<std::string> notices = mesh_notices(*reading.scene);
  EXPECT_EQ(notices.size(), 3U);  // welded, winding, open
  for (const std::string& notice : notices) EXPECT_EQ(notice.find("obstacles.0.file = \"t.obj\": "), 0U);
}

TEST(SceneMesh, ComesBackFromWhatIsWritten) {
  for (
      const std::string& text :
      {scene_with(
           R"({"shape": "mesh", "file": "cone-bed.obj", "scale": 0.1, "rotate": [1, 2, 3.5], "translate": [0, -9, 0]})"),
       cloth_of(R"({"mesh": "disc.obj", "origin": [0, 1, 2], "mass": 0.2, "pins": [3, 1800]})")}) {
    const SceneReading once = read_scene(text, "x");
    ASSERT_TRUE(once.scene) << once.problems.front().text();
    const SceneReading again = read_scene(write_scene(*once.scene), "y");
    ASSERT_TRUE(again.scene);
    EXPECT_EQ(*once.scene, *again.scene);
  }
}

TEST(SceneMesh, ClothHasTheMeshesVerticesAndTheirNumbersAsPins) {
  const SceneReading reading = read_scene(cloth_of(R"({"mesh": "disc.obj", "pins": [7, 3]})"), "x");
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(reading.scene->cloth.columns, 1801);
  EXPECT_EQ(reading.scene->cloth.origin, Vec3(0, 0, 0));
  EXPECT_EQ(pinned_particles(reading.scene->cloth), (std::vector<int>{3, 7}));
}

TEST(SceneMesh, ClothRefusesWhatOnlyAGridHas) {
  const auto rule = [](const char* cloth) { return only_problem_of(read_scene(cloth_of(cloth), "x")); };
  EXPECT_NE(rule(R"({"mesh": "disc.obj", "columns": 3})").find("cloth.columns"), std::string::npos);
  EXPECT_NE(rule(R"({"mesh": "disc.obj", "pins": ["top-left"]})").find("number of a vertex"),
            std::string::npos);
  EXPECT_NE(rule(R"({"mesh": "disc.obj", "pins": [1801]})").find("0 to 1800"), std::string::npos);
  EXPECT_NE(rule(R"({"mesh": "disc.obj", "pins": [-1]})").find("cloth.pins.0 = -1"), std::string::npos);
}

TEST(SceneMesh, OverridesReachIt) {
  const std::string text = scene_with(R"({"shape": "mesh", "file": "disc.obj", "translate": [0, -9, 0]})");
  const SceneReading reading =
      read_scene(text, "x", {{"obstacles.0.scale", "2"}, {"obstacles.0.file", "cone-bed.obj"}});
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(reading.scene->obstacles.front().scale, 2);
  EXPECT_EQ(reading.scene->obstacles.front().mesh.loaded->surface.triangles.size(), 5184U);
  EXPECT_NE(only_problem_of(read_scene(text, "x", {{"obstacles.0.scale", "0"}})).find("must be > 0"),
            std::string::npos);
}

TEST(SceneMesh, IsReadAgainWhenItsNameIsEdited) {
  Scene scene =
      *read_scene(scene_with(R"({"shape": "mesh", "file": "disc.obj", "translate": [0, -9, 0]})"), "x").scene;
  const Scene before = scene;
  find_parameter(scene, "obstacles.0.file")->set(scene, std::string("cone-bed.obj"));
  EXPECT_EQ(find_problems(scene).size(), 1U) << "until it is read";
  EXPECT_TRUE(load_meshes(scene, &before).empty());
  EXPECT_TRUE(find_problems(scene).empty());
  const SceneReading edited = edited_scene(before, edits_between(before, scene));
  ASSERT_TRUE(edited.scene);
  EXPECT_EQ(*edited.scene, scene);
  EXPECT_NE(scene_hash(scene), scene_hash(before));
}

TEST_F(SceneMeshFile, EditsKeepWhatIsLoadedWhateverBecomesOfTheFile) {
  write("t.obj", tetrahedron);
  const Scene scene =
      *read(scene_with(R"({"shape": "mesh", "file": "t.obj", "translate": [0, -9, 0]})")).scene;
  std::filesystem::remove(folder_ / "t.obj");
  const SceneReading edited = edited_scene(scene, {{"obstacles.0.scale", "3"}});
  ASSERT_TRUE(edited.scene);
  EXPECT_EQ(edited.scene->obstacles.front().mesh.loaded, scene.obstacles.front().mesh.loaded);
}

TEST_F(SceneMeshFile, IsNamedAsSeenFromWhereTheSceneIsWritten) {
  write("meshes/t.obj", tetrahedron);
  const Scene scene =
      *read(scene_with(R"({"shape": "mesh", "file": "meshes/t.obj", "translate": [0, -9, 0]})")).scene;
  const Scene moved = moved_to_folder(scene, (folder_ / "runs/one").string());
  EXPECT_EQ(moved.obstacles.front().mesh.file, "../../meshes/t.obj");
  std::filesystem::create_directories(folder_ / "runs/one");
  const SceneReading again = read_scene(write_scene(moved), folder_ / "runs/one/scene.json");
  ASSERT_TRUE(again.scene) << again.problems.front().text();
  EXPECT_EQ(again.scene->obstacles.front().mesh.loaded->hash, scene.obstacles.front().mesh.loaded->hash);
}

TEST(SceneMesh, IsScaledThenTurnedAboutXYAndZThenMoved) {
  Obstacle obstacle{.shape = &mesh_shape()};
  auto mesh = std::make_shared<LoadedMesh>();
  mesh->file = obstacle.mesh.file = "x";
  mesh->surface = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  for (const Vec3& vertex : mesh->surface.vertices) mesh->bounds.extend(vertex);
  obstacle.mesh.loaded = mesh;
  obstacle.scale = 2;
  obstacle.rotate = {90, 0, 90};
  obstacle.translate = {10, 0, 0};
  const TriangleMesh placed = placed_mesh(obstacle);
  EXPECT_NEAR((placed.vertices[0] - Vec3(10, 2, 0)).norm(), 0, 1e-12);  // x -> x -> y
  EXPECT_NEAR((placed.vertices[1] - Vec3(10, 0, 2)).norm(), 0, 1e-12);  // y -> z -> z
  EXPECT_NEAR((placed.vertices[2] - Vec3(12, 0, 0)).norm(), 0, 1e-12);  // z -> -y -> x
  for (const Vec3& vertex : placed.vertices)
    EXPECT_LT(shape_of(obstacle).bounds(obstacle).exteriorDistance(vertex), 1e-12);
}

TEST(SceneMesh, AnObstacleIsOfferedWithABuiltInMesh) {
  Scene scene;
  for (const BlockOffer& offer : offers_for(scene))
    if (offer.path == "mesh") offer.add(scene);
  ASSERT_EQ(scene.obstacles.size(), 1U);
  EXPECT_TRUE(find_problems(scene).empty());
  EXPECT_TRUE(default_of(scene, "obstacles.0.file"));
}

}  // namespace
}  // namespace cloth::test::scene_mesh_test
