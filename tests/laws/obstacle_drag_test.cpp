// An obstacle that an edit moves under continuous contact comes to its new place through what lies between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/continuous_contact.h"
#include "scene/obstacle_shape.h"
#include "support/contact_scenes.h"

namespace cloth::test::obstacle_drag_test {
namespace {

Scene hung_cloth(Shape shape, const std::string& method) {
  Scene scene = sheet_over(0, 13);
  scene.cloth.origin = {-0.2, 0.4, 0};
  scene.cloth.down = {0, -1, 0};
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.integrator.method = method;
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.center = {0.013, 0.15, 0.25};
  obstacle.radius = 0.07;
  obstacle.size = {0.12, 0.1, 0.14};
  scene.obstacles = {obstacle};
  return scene;
}

/// The obstacle is dragged through the cloth's plane and back: by an edit every few steps, or at once there
/// and at once back, further than it is wide, so that it would pass the cloth unseen if it were just put
/// there.
struct Drag {
  const char* name;
  int edits;
  double time_between;  // s
  Vec3 way(int edit) const {
    constexpr double reach = 0.45;  // m
    const double there = 1 - std::abs(2.0 * edit / edits - 1);
    return {0, 0, -reach * there};
  }
};
constexpr Drag gentle{"gently", 24, 0.016}, sudden{"at_once", 2, 1.02 * transition_time};

struct Case {
  Shape shape;
  std::string method;
  Drag drag;
};

/// How far the cloth reaches beyond the front of what was dragged towards -z, in m; below 0 it does not.
double ahead_of(const Simulation& simulation) {
  double furthest = 0;
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    furthest = std::min(furthest, simulation.state().position[i].z());
  const Obstacle& obstacle = simulation.scene().obstacles[0];
  const double half = obstacle.shape == &sphere_shape() ? obstacle.radius : 0.5 * obstacle.size.z();
  return simulation.obstacle_pose(0, simulation.time()).at(obstacle.center).z() - half - furthest;
}

class DraggedObstacle : public ::testing::TestWithParam<Case> {};

TEST_P(DraggedObstacle, LetsNothingThrough) {
  const auto& [shape, method, drag] = GetParam();
  Scene scene = hung_cloth(shape, method);
  Simulation simulation(scene);
  const Vec3 start = scene.obstacles[0].center;
  const int steps_between = static_cast<int>(std::ceil(drag.time_between / simulation.time_step()));
  bool touched = false;
  for (int edit = 1; edit <= drag.edits; ++edit) {
    scene.obstacles[0].center = start + drag.way(edit);
    simulation.edit(scene);
    for (int step = 0; step < steps_between; ++step) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << describe(*stop);
      touched = touched || simulation.last_contact().contacts > 0;
      const Count count = all_crossings(simulation);
      ASSERT_EQ(count.number, 0) << "edit " << edit << ", step " << step << ": " << count.first;
    }
    if (2 * edit == drag.edits) {
      EXPECT_GT(ahead_of(simulation), 0) << "the cloth was not taken along";
    }
  }
  EXPECT_TRUE(touched);
}

std::vector<Case> all_drags() {
  std::vector<Case> cases;
  for (const Shape shape : {&sphere_shape(), &box_shape()})
    for (const char* method : {"semi-implicit-euler", "verlet", "rk4"})
      for (const Drag& drag : {gentle, sudden}) cases.push_back({shape, method, drag});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Contact, DraggedObstacle, ::testing::ValuesIn(all_drags()), [](const auto& tested) {
  const Case& drag = tested.param;
  std::string name = std::string(drag.shape->name) + "_" + drag.method + "_" + drag.drag.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ObstacleTransition, StaysWhereItIsAtTheEditAndArrivesInItsTime) {
  Scene scene = hung_cloth(&sphere_shape(), "verlet");
  scene.obstacles[0].velocity = {0.2, 0, 0};
  Simulation simulation(scene);
  while (simulation.time() < 0.1) ASSERT_FALSE(simulation.step());
  const double edited = simulation.time();
  const Vec3 old_center = scene.obstacles[0].center,
             before = simulation.obstacle_pose(0, edited).at(old_center);
  scene.obstacles[0].center += Vec3(0, 0.1, 0.3);
  simulation.edit(scene);
  const Vec3 center = scene.obstacles[0].center;
  EXPECT_LT((simulation.obstacle_pose(0, edited).at(center) - before).norm(), 1e-15);
  const double half = edited + 0.5 * transition_time, end = edited + transition_time;
  const Vec3 moving = scene.obstacles[0].velocity;
  EXPECT_LT(
      (simulation.obstacle_pose(0, half).at(center) - (center + half * moving - Vec3(0, 0.05, 0.15))).norm(),
      1e-12);
  EXPECT_EQ(simulation.obstacle_pose(0, end).at(center), pose_of(scene.obstacles[0], end).at(center));
}

TEST(ObstacleTransition, AnEditOfAVelocityDoesNotMoveTheObstacleEither) {
  Scene scene = hung_cloth(&box_shape(), "verlet");
  scene.obstacles[0].velocity = {0, 0, 0.1};
  Simulation simulation(scene);
  while (simulation.time() < 0.1) ASSERT_FALSE(simulation.step());
  const Vec3 center = scene.obstacles[0].center;
  const Vec3 before = simulation.obstacle_pose(0, simulation.time()).at(center);
  scene.obstacles[0].velocity = {0, 0, -2};
  simulation.edit(scene);
  EXPECT_LT((simulation.obstacle_pose(0, simulation.time()).at(center) - before).norm(), 1e-15);
}

TEST(ObstacleTransition, GoesOnFromACheckpointToTheBit) {
  Scene scene = hung_cloth(&sphere_shape(), "semi-implicit-euler");
  Simulation first(scene), second(scene);
  scene.obstacles[0].center.z() -= 0.25;
  first.edit(scene);
  second.edit(scene);
  for (int step = 0; step < 10; ++step) ASSERT_FALSE(first.step());
  const Checkpoint checkpoint = first.checkpoint();
  ASSERT_LT(first.time(), transition_time) << "on the way";
  for (int step = 0; step < 40; ++step) ASSERT_FALSE(first.step());
  second.restore(checkpoint);
  for (int step = 0; step < 40; ++step) ASSERT_FALSE(second.step());
  EXPECT_TRUE(std::ranges::equal(first.state().position.flat(), second.state().position.flat()));
  EXPECT_TRUE(std::ranges::equal(first.state().velocity.flat(), second.state().velocity.flat()));
}

TEST(ObstacleTransition, CountsForTheHighestSpeedOfAnObstacle) {
  const Scene scene = hung_cloth(&sphere_shape(), "verlet");
  EXPECT_EQ(highest_obstacle_speed(scene, {}, {}), 0);
  EXPECT_NEAR(highest_obstacle_speed(scene, {ObstacleTransition{.displacement = {0, 0, 0.1}}}, {}),
              0.1 / transition_time, 1e-12);
}

TEST(ObstacleTransition, IsNotThereWhereObstaclesAreTestedParticleByParticle) {
  Scene scene = hung_cloth(&sphere_shape(), "verlet");
  scene.contact.reset();
  Simulation simulation(scene);
  scene.obstacles[0].center.z() -= 0.25;
  simulation.edit(scene);
  EXPECT_EQ(simulation.obstacle_pose(0, simulation.time()), Pose{});
}

TEST(ContactMarks, AreTheTouchesOfTheLastStep) {
  Scene scene = contact_scene("sphere");
  Simulation simulation(scene, thrown({0, -2, 0}));
  std::vector<ContactMark> marks;
  simulation.append_contact_marks(marks);
  EXPECT_TRUE(marks.empty());
  while (simulation.last_contact().contacts == 0) ASSERT_FALSE(simulation.step());
  simulation.append_contact_marks(marks);
  ASSERT_FALSE(marks.empty());
  const Obstacle& ball = scene.obstacles[0];
  for (const ContactMark& mark : marks) {
    const Vec3 out = mark.point - ball.center;
    EXPECT_GT(mark.normal_impulse, 0);
    EXPECT_NEAR(mark.normal.norm(), 1, 1e-12);
    EXPECT_GT(mark.normal.dot(out.normalized()), 0.9);
    EXPECT_NEAR(out.norm(), ball.radius + scene.contact->thickness, 2 * scene.contact->thickness);
  }
  simulation.restore(simulation.checkpoint());
  marks.clear();
  simulation.append_contact_marks(marks);
  EXPECT_TRUE(marks.empty()) << "of another step than was computed last";
}

TEST(ContactMarks, DoNotChangeABit) {
  Scene scene = contact_scene("itself");
  Simulation watched(scene, thrown({0, -2, 0})), alone(scene, thrown({0, -2, 0}));
  std::vector<ContactMark> marks;
  std::vector<Bounds> boxes;
  for (int step = 0; step < 60; ++step) {
    ASSERT_FALSE(watched.step());
    ASSERT_FALSE(alone.step());
    watched.append_contact_marks(marks);
    watched.append_hierarchy_boxes(-1, step % 4, boxes);
  }
  EXPECT_EQ(watched.hierarchy_depth(-1), alone.hierarchy_depth(-1));
  EXPECT_FALSE(boxes.empty());
  EXPECT_TRUE(std::ranges::equal(watched.state().position.flat(), alone.state().position.flat()));
}

}  // namespace
}  // namespace cloth::test::obstacle_drag_test
