// Edits of a running scene and checkpoints under continuous contact: an obstacle that an edit puts elsewhere,
// turns or grows goes its way from where and what it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "contact/continuous_contact.h"
#include "scene/obstacle_shape.h"
#include "simulation/session.h"
#include "support/contact_scenes.h"

namespace cloth::test::contact_edit_test {
namespace {

void run(Simulation& simulation, int steps) {
  for (int step = 0; step < steps; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
  }
}

/// Runs and looks at every state.
void run_checked(Simulation& simulation, int steps) {
  for (int step = 0; step < steps; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
    const Count count = all_crossings(simulation);
    ASSERT_EQ(count.number, 0) << "t = " << simulation.time() << ": " << count.first;
  }
}

/// A sheet that lies on the obstacle of one of the small scenes.
Scene resting(const std::string& name) {
  Scene scene = contact_scene(name);
  scene.damping = 0.004;
  scene.integrator = {.method = "semi-implicit-euler", .time_step = 0.002};
  return scene;
}

TEST(AnEditOfAnObstacle, PushesTheClothThatLiesOnItUp) {
  Scene scene = resting("plane");
  Simulation simulation(scene);
  run(simulation, 100);
  const double before = simulation.state().position[40].y();
  scene.obstacles[0].point.y() += 0.1;
  simulation.edit(scene);
  run_checked(simulation, 60);
  EXPECT_GT(simulation.state().position[40].y(), before + 0.09);
}

/// What is done to a running scene, and how fast the cloth may be afterwards: some times as fast as the
/// obstacle's fastest point, and what it falls.
struct EditCase {
  const char* name;
  const char* scene;
  void (*edit)(Scene&);
  double speed;  // m/s
};

Obstacle obstacle(Shape shape, const Vec3& place) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.center = obstacle.point = obstacle.translate = place;
  obstacle.radius = 0.08;
  obstacle.size = {0.1, 0.12, 0.14};
  obstacle.scale = 0.3;
  if (shape == &mesh_shape()) obstacle.mesh.file = "cone-bed.obj";
  return obstacle;
}

const EditCase edits[]{
    {"ball_grows", "sphere", [](Scene& s) { s.obstacles[0].radius *= 1.5; }, 6},
    {"ball_grows_far", "sphere", [](Scene& s) { s.obstacles[0].radius *= 4; }, 45},
    {"ball_shrinks", "sphere", [](Scene& s) { s.obstacles[0].radius *= 0.3; }, 4},
    {"box_grows", "box", [](Scene& s) { s.obstacles[0].size *= 1.3; }, 4},
    {"box_grows_along_one_axis", "box", [](Scene& s) { s.obstacles[0].size.x() *= 3; }, 25},
    {"box_gets_flat_and_wide", "box",
     [](Scene& s) {
       s.obstacles[0].size = {0.5, 0.02, 0.4};
     },
     20},
    {"box_shrinks", "box", [](Scene& s) { s.obstacles[0].size *= 0.4; }, 4},
    {"box_on_its_corner_grows", "corner",
     [](Scene& s) {
       s.obstacles[0].size = {0.2, 0.3, 0.25};
     },
     14},
    {"turning_box_grows", "turning-box",
     [](Scene& s) {
       s.obstacles[0].size = {0.2, 0.3, 0.25};
     },
     12},
    {"box_moves_and_grows", "box",
     [](Scene& s) { s.obstacles[0].center.y() += 0.1, s.obstacles[0].size *= 1.4; }, 8},
    {"box_turns_by_keyframes", "box",
     [](Scene& s) {
       s.obstacles[0].keyframes = {{0, s.obstacles[0].center, {0.5, 1.2, 0}}};
     },
     8},
    {"cones_grow", "cones", [](Scene& s) { s.obstacles[0].scale *= 1.5; }, 8},
    {"cones_turn", "cones",
     [](Scene& s) {
       s.obstacles[0].rotate = {20, 70, 0};
     },
     15},
    {"cones_turn_move_and_shrink", "cones",
     [](Scene& s) {
       s.obstacles[0].rotate.z() = 40, s.obstacles[0].translate.y() += 0.05, s.obstacles[0].scale *= 0.7;
     },
     15},
    {"plane_turns", "plane",
     [](Scene& s) {
       s.obstacles[0].normal = {0.6, 1, 0.3};
     },
     8},
    {"plane_turns_far", "plane",
     [](Scene& s) {
       s.obstacles[0].normal = {1, -0.2, 0};
     },
     20},
    {"plane_turns_and_rises", "plane",
     [](Scene& s) {
       s.obstacles[0].normal = {0, 1, 0.4}, s.obstacles[0].point = {0, 0.2, 0.1};
     },
     15},
    {"contact_gets_thicker", "sphere", [](Scene& s) { s.contact->thickness = 0.03; }, 6},
    {"contact_gets_much_thicker", "corner", [](Scene& s) { s.contact->thickness = 0.1; }, 15},
    {"contact_with_cones_gets_thicker", "cones", [](Scene& s) { s.contact->thickness = 0.02; }, 6},
    {"contact_with_itself_gets_thicker", "itself", [](Scene& s) { s.self_contact->thickness = 0.02; }, 6},
    {"ball_becomes_a_box", "sphere",
     [](Scene& s) { s.obstacles[0] = obstacle(&box_shape(), s.obstacles[0].center + Vec3(0, 0.06, 0)); }, 8},
    {"box_becomes_a_bed_of_cones", "box",
     [](Scene& s) { s.obstacles[0] = obstacle(&mesh_shape(), s.obstacles[0].center); }, 10},
    {"ball_comes_into_the_cloth", "hanging",
     [](Scene& s) {
       s.obstacles = {obstacle(&sphere_shape(), {0.01, -0.3, 0.03})};
     },
     8},
    {"box_comes_with_its_middle_in_the_cloth", "hanging",
     [](Scene& s) {
       s.obstacles = {obstacle(&box_shape(), {0.01, -0.3, 0})};
     },
     8},
    {"cones_come_into_the_cloth", "hanging",
     [](Scene& s) {
       s.obstacles = {obstacle(&mesh_shape(), {0.01, -0.3, -0.01})};
     },
     15},
    {"plane_comes_over_half_of_the_cloth", "sphere",
     [](Scene& s) {
       s.obstacles.push_back(obstacle(&plane_shape(), {0, -0.05, 0}));
     },
     8},
    {"contact_comes", "without-contact", [](Scene& s) { s.contact = ContactSettings{}; }, 8},
};

class AnEdit : public ::testing::TestWithParam<std::tuple<EditCase, const char*>> {};

Scene edited_scene(const std::string& name) {
  if (name == "hanging") {
    Scene scene = resting("sphere");
    scene.obstacles.clear();
    scene.cloth.down = {0, -1, 0};
    scene.cloth.origin = {-0.2, 0, 0};
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    return scene;
  }
  Scene scene = resting(name == "without-contact" ? "sphere" : name);
  if (name == "without-contact") scene.contact.reset();
  return scene;
}

TEST_P(AnEdit, LetsNothingThroughAndDoesNotDiverge) {
  const auto& [tested, method] = GetParam();
  Scene scene = edited_scene(tested.scene);
  scene.integrator.method = method;
  scene.integrator.time_step = scene.integrator.method == "implicit-euler" ? 0.01 : 0.001;
  Simulation simulation(scene, thrown({0, -1, 0}));
  run(simulation, static_cast<int>(0.3 / simulation.time_step()));
  tested.edit(scene);
  load_meshes(scene);
  simulation.edit(scene);
  double fastest = 0;
  for (int step = 0; step < static_cast<int>(0.4 / simulation.time_step()); ++step) {
    run_checked(simulation, 1);
    if (HasFatalFailure()) return;
    for (std::size_t i = 0; i < simulation.state().velocity.size(); ++i)
      fastest = std::max(fastest, simulation.state().velocity[i].norm());
  }
  EXPECT_LT(fastest, tested.speed);
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    EXPECT_EQ(simulation.obstacle_pose(k, simulation.time()), pose_of(scene.obstacles[k], simulation.time()))
        << "it is not where the edit has put it";
}

INSTANTIATE_TEST_SUITE_P(Contact, AnEdit,
                         ::testing::Combine(::testing::ValuesIn(edits),
                                            ::testing::Values("semi-implicit-euler", "implicit-euler")),
                         [](const auto& tested) {
                           const bool implicitly = std::get<1>(tested.param) == std::string("implicit-euler");
                           return std::get<0>(tested.param).name +
                                  std::string(implicitly ? "_implicitly" : "");
                         });

TEST(AnEditThatLetsABallGrow, StopsARunWhereTheClothCannotGiveWay) {
  Scene scene = resting("plane");
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles.push_back(obstacle(&sphere_shape(), {0.01, 0.03, 0}));  // it reaches into the plane
  simulation.edit(scene);
  std::optional<Divergence> stop;
  for (int step = 0; step < 100; ++step) {
    stop = simulation.step();
    if (stop) break;
    ASSERT_EQ(all_crossings(simulation).number, 0);
  }
  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->pinched) << describe(*stop);
}

TEST(AnEditThatLetsABoxGrow, IsHalfDoneAfterHalfOfItsTime) {
  Scene scene = resting("box");
  Simulation simulation(scene);
  scene.obstacles[0].size = {0.32, 0.16, 0.08};
  simulation.edit(scene);
  EXPECT_EQ(simulation.obstacle_pose(0, 0).stretch, Vec3(0.5, 1, 2));
  EXPECT_LT((simulation.obstacle_pose(0, 0.5 * transition_time).stretch - Vec3(0.75, 1, 1.5)).norm(), 1e-12);
  EXPECT_EQ(simulation.obstacle_pose(0, transition_time), Pose{});
}

TEST(AnEditOfASpin, TurnsABallNoFurtherThanItsSpin) {
  Scene scene = resting("sphere");
  scene.obstacles[0].spin = {0, 5, 0};
  Simulation simulation(scene);
  run(simulation, 100);
  scene.obstacles[0].spin = {0, 0, 0};
  simulation.edit(scene);
  EXPECT_EQ(simulation.obstacle_pose(0, simulation.time()), Pose{}) << "its surface would rub at the cloth";
}

TEST(AnEditThatTurnsSelfContactOn, IsRefusedWhereTheClothPassesThroughItself) {
  Scene scene = contact_scene("itself");
  scene.self_contact.reset();
  scene.obstacles.clear();
  Simulation simulation(scene, [](ClothSystem&, ClothState& state) {
    state.position.set(0, state.position[40] + Vec3(0.01, 0.005, 0.05));
    state.position.set(1, state.position[40] + Vec3(0.012, 0.005, -0.05));
  });
  ASSERT_GT(self_crossings(simulation.cloth_mesh()).number, 0);
  const auto problems = carry_out(Edits{{"self_contact", "{}"}}, simulation);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].text().find("the cloth passes through itself now"), std::string::npos);
  EXPECT_FALSE(simulation.scene().self_contact);
}

TEST(AnEditOfTheScene, ThatLeavesObstaclesAloneDoesNotMoveThem) {
  Scene scene = resting("turning-box");
  Simulation simulation(scene);
  run(simulation, 37);
  const Pose before = simulation.obstacle_pose(0, simulation.time());
  scene.gravity = Vec3(0, -5, 0);
  simulation.edit(scene);
  EXPECT_EQ(simulation.obstacle_pose(0, simulation.time()), before);
  run_checked(simulation, 30);
}

TEST(AnEditOfTheScene, MayAddAndTakeAwayObstaclesBesideOneInUse) {
  Scene scene = resting("sphere");
  Simulation simulation(scene);
  run(simulation, 60);
  Obstacle floor;
  floor.shape = &plane_shape();
  floor.point = {0, -0.25, 0};
  scene.obstacles.push_back(floor);
  simulation.edit(scene);
  run_checked(simulation, 60);
  scene.obstacles.erase(scene.obstacles.begin());
  simulation.edit(scene);
  run_checked(simulation, 120);
  EXPECT_LT(simulation.state().position[40].y(), -0.15) << "the ball is gone";
}

TEST(AnEditOfTheScene, MayTurnSelfContactOffAndOnWhereNothingCrosses) {
  Scene scene = resting("plane");
  scene.self_contact = SelfContact{};
  Simulation simulation(scene);
  run_checked(simulation, 20);
  scene.self_contact.reset();
  simulation.edit(scene);
  run_checked(simulation, 20);
  scene.self_contact = SelfContact{};
  simulation.edit(scene);
  run_checked(simulation, 20);
}

TEST(ACheckpointOfContact, SaysWhatItTakesInMemory) {
  Scene scene = contact_scene("sphere");
  const std::size_t one = Simulation(scene).checkpoint().bytes();
  Obstacle floor;
  floor.shape = &plane_shape();
  floor.point = {0, -1, 0};
  for (int n = 0; n < 10; ++n) scene.obstacles.push_back(floor);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.checkpoint().bytes(), one + 10 * sizeof(Pose));
  scene.obstacles[0].center.y() -= 0.1;
  simulation.edit(scene);
  EXPECT_EQ(simulation.checkpoint().bytes(), one + 10 * sizeof(Pose) + 11 * sizeof(ObstacleTransition));
}

TEST(ACheckpointOfContact, HasTheImpulseInIt) {
  Simulation simulation(resting("plane"));
  run(simulation, 60);
  const Checkpoint checkpoint = simulation.checkpoint();
  const Vec3 impulse = simulation.measure().contact_impulse;
  EXPECT_GT(impulse.y(), 0);
  run(simulation, 60);
  EXPECT_GT(simulation.measure().contact_impulse.y(), impulse.y());
  simulation.restore(checkpoint);
  EXPECT_EQ(simulation.measure().contact_impulse, impulse);
}

TEST(TheImpulseOfContact, IsTheMomentumThatGravityDoesNotExplain) {
  Scene scene = contact_scene("sphere");
  scene.damping.reset();
  scene.integrator = {.method = "semi-implicit-euler", .time_step = 0.001};
  Simulation simulation(scene, thrown({0, -2, 0}));
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < simulation.state().velocity.size(); ++i)
      sum += simulation.system().mass[i] * simulation.state().velocity[i];
    return sum;
  };
  const Vec3 before = momentum();
  run(simulation, 80);
  const Vec3 gained = momentum() - before - simulation.time() * scene.cloth.mass * *scene.gravity;
  const Vec3 impulse = simulation.measure().contact_impulse;
  EXPECT_GT(impulse.norm(), 0.05);
  EXPECT_LE((gained - impulse).norm(), 1e-9 * impulse.norm())
      << gained.transpose() << " for " << impulse.transpose();
}

}  // namespace
}  // namespace cloth::test::contact_edit_test
