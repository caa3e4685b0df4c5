// A scene that starts with crossings is refused with place, value and rule, for every kind of obstacle.
#include "contact/start_check.h"

#include <gtest/gtest.h>

#include "scene/obstacle_shape.h"
#include "scene/scene_json.h"
#include "support/contact_scenes.h"
#include "support/random.h"

namespace cloth::test::start_check_test {
namespace {

/// The one problem that is found.
std::string start_problem(const Scene& scene) {
  const std::vector<Problem> problems = find_start_problems(scene);
  EXPECT_EQ(problems.size(), 1u);
  return problems.empty() ? "" : problems[0].text();
}

/// Three by three particles 0.2 m apart in the plane y = 0, the first at (-0.2, 0, -0.2).
Scene sheet_on(const Obstacle& obstacle) {
  Scene scene = sheet_over(0, 3);
  scene.cloth.origin = {-0.2, 0, -0.2};
  scene.obstacles = {obstacle};
  return scene;
}

Obstacle shaped(Shape shape, const Vec3& center) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.center = obstacle.point = obstacle.translate = center;
  return obstacle;
}

TEST(StartCheck, NamesObstacleRuleParticleAndPlace) {
  Obstacle ball = shaped(&sphere_shape(), {0.1, 0, 0.1});
  ball.radius = 0.05;
  EXPECT_EQ(
      start_problem(sheet_on(ball)),
      "obstacles.0: the cloth starts in this obstacle or touches it, first near particle 4 at (0, 0, 0) m");
}

TEST(StartCheck, FindsATouchAndNotAMiss) {
  Obstacle ball = shaped(&sphere_shape(), {0.15, -0.25, 0.1});
  ball.radius = 0.25;
  EXPECT_NE(start_problem(sheet_on(ball)), "");
  ball.radius = 0.2499;
  EXPECT_TRUE(find_start_problems(sheet_on(ball)).empty());

  Obstacle floor = shaped(&plane_shape(), {7, 0, 7});
  EXPECT_NE(start_problem(sheet_on(floor)), "");
  floor.point.y() = -1e-9;
  EXPECT_TRUE(find_start_problems(sheet_on(floor)).empty());
}

TEST(StartCheck, OfContactParticleByParticleFindsFreeParticlesInsideAndLetsThemTouch) {
  Obstacle ball = shaped(&sphere_shape(), {0.2, -0.25, 0.2});
  ball.radius = 0.25;
  Scene scene = sheet_on(ball);
  scene.contact.reset();
  scene.self_contact.reset();
  EXPECT_TRUE(find_start_problems(scene).empty()) << "on its top";
  scene.obstacles[0].center.y() += 1e-3;
  EXPECT_EQ(start_problem(scene),
            "obstacles.0: the cloth starts in this obstacle, first near particle 8 at (0.2, 0, 0.2) m");
  const SceneReading reading = read_runnable_scene(write_scene(scene), "inside");
  EXPECT_FALSE(reading.scene);
  scene.cloth.pins = {PinnedParticle{2, 2}};
  EXPECT_TRUE(find_start_problems(scene).empty()) << "a pin stays where it is";

  scene = sheet_on(shaped(&plane_shape(), {7, 0, 7}));
  scene.contact.reset();
  scene.self_contact.reset();
  EXPECT_TRUE(find_start_problems(scene).empty());
  scene.obstacles[0].point.y() = 1e-3;
  EXPECT_NE(start_problem(scene), "");
}

TEST(StartCheck, FindsABoxByItsCornerItsEdgeAndItsInside) {
  Obstacle box = shaped(&box_shape(), {0.05, -0.2, 0.12});
  box.size = {0.05, 0.3, 0.05};
  EXPECT_TRUE(find_start_problems(sheet_on(box)).empty());
  box.size.y() = 0.5;  // only its upright edges meet the inside of a face
  EXPECT_NE(start_problem(sheet_on(box)), "");
  box.size = {3, 3, 3};  // holds the whole cloth: no two surfaces meet
  EXPECT_NE(start_problem(sheet_on(box)), "");
  box.size = {0.2, 0.2, 0.2};
  box.center = {0.05, -0.12, 0.12};
  EXPECT_TRUE(find_start_problems(sheet_on(box)).empty());
  box.keyframes = {{0, box.center, {0.8, 0, 0}}};  // turned, an edge comes up
  EXPECT_NE(start_problem(sheet_on(box)), "");
}

TEST(StartCheck, FindsAMeshWhereItIsAtTheStart) {
  Obstacle cones = shaped(&mesh_shape(), {0, -0.03, 0});
  cones.scale = 0.4;
  cones.mesh.file = "cone-bed.obj";
  Scene scene = sheet_on(cones);
  ASSERT_TRUE(load_meshes(scene).empty());
  EXPECT_NE(start_problem(scene).find("obstacles.0: the cloth starts in this obstacle"), std::string::npos);
  scene.obstacles[0].keyframes = {{0, {0, -0.5, 0}, {0, 0, 0}}};
  EXPECT_TRUE(find_start_problems(scene).empty());
}

TEST(StartCheck, NamesEveryObstacleThatIsTouched) {
  Scene scene = sheet_on(shaped(&sphere_shape(), {0, 0, 0}));
  scene.obstacles.push_back(shaped(&sphere_shape(), {0, -5, 0}));
  scene.obstacles.push_back(shaped(&plane_shape(), {0, 1, 0}));
  const std::vector<Problem> problems = find_start_problems(scene);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].path, "obstacles.0");
  EXPECT_EQ(problems[1].path, "obstacles.2");
}

TEST(StartCheck, AsksForAThicknessThatTheClothKeepsAtItsStart) {
  Scene scene = sheet_over(0, 9);  // cells of 0.05 m
  scene.self_contact = SelfContact{.thickness = 0.025};
  EXPECT_TRUE(find_start_problems(scene).empty());
  scene.cloth.down = {0.95, 0, 0.3};  // cells as slanting as this are narrow
  scene.self_contact->thickness = 0.02;
  const std::string text = start_problem(scene);
  EXPECT_EQ(text.find("self_contact.thickness = 0.02 m: must be at most 0.0"), 0u) << text;
  EXPECT_NE(text.find("so near parts of the cloth are at the start"), std::string::npos) << text;
}

/// Where rounding has put particles beside the plane of a flat grid, faces that lie in it do not meet.
TEST(StartCheck, LetsFlatGridsStartHoweverTheyLie) {
  Random random;
  for (int round = 0; round < 40; ++round) {
    Scene scene = sheet_over(0, 17);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(0, 3.1), random.vector(1).normalized()).toRotationMatrix();
    scene.cloth.origin = random.vector(10);
    scene.cloth.across = turn.col(0);
    scene.cloth.down = (turn.col(1) + (round % 2 == 0 ? 0 : 0.4) * turn.col(0)).normalized();
    scene.self_contact = SelfContact{.thickness = 0.001};
    const std::vector<Problem> problems = find_start_problems(scene);
    ASSERT_TRUE(problems.empty()) << "round " << round << ": " << problems[0].text();
  }
}

/// Two sheets of 4 x 4 cells of 0.1 m, one lying in y = 0, one standing in x = `place`, down to y = `bottom`.
TriangleMesh two_sheets(double place, double bottom) {
  TriangleMesh mesh;
  for (int sheet = 0; sheet < 2; ++sheet) {
    Vec3Field position(25);
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 5; ++column)
        position.set(
            static_cast<std::size_t>(5 * row + column),
            sheet == 0 ? Vec3(0.1 * row, 0, 0.1 * column) : Vec3(place, bottom + 0.1 * row, 0.1 * column));
    const TriangleMesh one = grid_triangles(5, 5, position);
    mesh.vertices.insert(mesh.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const Triangle& t : one.triangles)
      mesh.triangles.push_back({t[0] + 25 * sheet, t[1] + 25 * sheet, t[2] + 25 * sheet});
  }
  return mesh;
}

TEST(SelfIntersection, TellsPassingFromTouchingByTheLastBit) {
  constexpr double cell = 0.1, place = 0.17;
  EXPECT_FALSE(find_self_intersection(two_sheets(place, 1e-9 * cell)));
  EXPECT_FALSE(find_self_intersection(two_sheets(place, 1e-300)));
  const auto touching = find_self_intersection(two_sheets(place, 0));
  ASSERT_TRUE(touching);
  EXPECT_FALSE(touching->passes);
  for (const double bottom : {-1e-18, -1e-9 * cell, -0.1 * cell, -0.15}) {
    const auto passing = find_self_intersection(two_sheets(place, bottom));
    ASSERT_TRUE(passing) << bottom;
    EXPECT_TRUE(passing->passes) << bottom;
  }
  EXPECT_TRUE(find_self_intersection(two_sheets(0.2, -0.2)))
      << "edges cross in a vertex, nowhere within a face";
}

TEST(SelfIntersection, IsThereWhereACellIsFoldedOntoItsNeighbourAndNowhereElse) {
  Vec3Field position(9);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      position.set(static_cast<std::size_t>(3 * row + column), {0.1 * column, 0, 0.1 * row});
  EXPECT_FALSE(find_self_intersection(grid_triangles(3, 3, position)));
  for (int row = 0; row < 3; ++row)
    position.set(static_cast<std::size_t>(3 * row + 2), {0.01, 1e-9, 0.1 * row});
  EXPECT_FALSE(find_self_intersection(grid_triangles(3, 3, position)));
  for (int row = 0; row < 3; ++row) position.set(static_cast<std::size_t>(3 * row + 2), {0.01, 0, 0.1 * row});
  const auto folded = find_self_intersection(grid_triangles(3, 3, position));
  ASSERT_TRUE(folded);
  EXPECT_FALSE(folded->passes);
}

TEST(StartCheck, StandsInTheReadersMessageWithItsLine) {
  const SceneReading reading = read_runnable_scene(
      "{ \"cloth\": {}, \"contact\": {},\n"
      "  \"obstacles\": [\n"
      "    { \"shape\": \"plane\", \"point\": [0, 9, 0] } ] }",
      "name");
  ASSERT_EQ(reading.problems.size(), 1u);
  const std::string text = reading.problems[0].text();
  EXPECT_EQ(text.find("name:3:5: obstacles.0: the cloth starts in this obstacle"), 0u) << text;
}

}  // namespace
}  // namespace cloth::test::start_check_test
