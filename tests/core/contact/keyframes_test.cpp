// Keyframes of obstacles: in scene files, as poses, and what is said of bad ones.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_json.h"
#include "support/contact_scenes.h"
#include "support/random.h"

namespace cloth::test::keyframes_test {
namespace {

std::string with_keyframes(const std::string& keyframes) {
  return "{ \"cloth\": { \"origin\": [0, 9, 0] },\n"
         "  \"obstacles\": [ { \"shape\": \"sphere\", \"center\": [1, 2, 3], \"keyframes\":\n"
         "    " +
         keyframes + " } ] }";
}

std::vector<std::string> problems_of(const std::string& keyframes) {
  const SceneReading reading = read_scene(with_keyframes(keyframes), "name");
  EXPECT_NE(reading.scene.has_value(), !reading.problems.empty());
  std::vector<std::string> texts;
  for (const Problem& problem : reading.problems) texts.push_back(problem.text());
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Keyframes, ReadBackAsTheyWereWritten) {
  Random random;
  Scene scene = contact_scene("box");
  scene.obstacles[0].keyframes.clear();
  double time = -1;
  for (int n = 0; n < 7; ++n) {
    time += random.uniform(0.001, 1);
    scene.obstacles[0].keyframes.push_back({time, random.vector(1), random.vector(2)});
  }
  scene.obstacles[0].keyframes[0].position = {0, -3, 0};  // clear of the cloth if that is the first that acts
  for (Keyframe& key : scene.obstacles[0].keyframes) key.position.y() = -3;
  const SceneReading reading = read_scene(write_scene(scene), "name");
  ASSERT_TRUE(reading.scene) << reading.problems[0].text();
  EXPECT_EQ(reading.scene->obstacles[0].keyframes, scene.obstacles[0].keyframes);
  EXPECT_EQ(write_scene(*reading.scene), write_scene(scene));
}

TEST(Keyframes, LeaveOutWhatIsAsTheSceneHasIt) {
  const SceneReading reading =
      read_scene(with_keyframes("[ { \"time\": 1 }, { \"time\": 2, \"position\": [4, 5, 6] } ]"), "name");
  ASSERT_TRUE(reading.scene);
  const std::vector<Keyframe>& keys = reading.scene->obstacles[0].keyframes;
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(keys[0], (Keyframe{1, {1, 2, 3}, {0, 0, 0}}));
  EXPECT_EQ(keys[1], (Keyframe{2, {4, 5, 6}, {0, 0, 0}}));
}

TEST(Keyframes, MustComeLaterThanTheOneBefore) {
  EXPECT_EQ(problems_of("[ { \"time\": 1 },\n { \"time\": 1 } ]"),
            Texts({"name:4:12: obstacles.0.keyframes.1.time = 1 s: must be later than the key before, 1 s"}));
  EXPECT_EQ(problems_of("[ { \"time\": 3 }, { \"time\": 4 }, { \"time\": 2.5 } ]").size(), 1u);
}

TEST(Keyframes, OfWrongTypesAreReportedWithTheirPlaces) {
  EXPECT_EQ(problems_of("7"), Texts({"name:3:5: obstacles.0.keyframes = 7: must be a list"}));
  EXPECT_EQ(problems_of("[ { \"time\": \"soon\" } ]"),
            Texts({"name:3:17: obstacles.0.keyframes.0.time = \"soon\": must be a number"}));
  for (const char* keys :
       {"[ 4 ]", "[ { \"time\": 0, \"position\": [1, 2] } ]", "[ { \"time\": 0, \"place\": [1, 2, 3] } ]",
        "[ { \"time\": 0, \"rotation\": 1 } ]"}) {
    const Texts texts = problems_of(keys);
    ASSERT_EQ(texts.size(), 1u) << keys;
    EXPECT_NE(texts[0].find("name:3:"), std::string::npos) << texts[0];
    EXPECT_NE(texts[0].find("obstacles.0.keyframes.0"), std::string::npos) << texts[0];
  }
}

TEST(Keyframes, AreReachedToTheBitAndPassedWithoutAJump) {
  Obstacle box;
  box.shape = &box_shape();
  box.center = {0.3, -0.2, 0.1};
  box.keyframes = {{0.5, {0, 1, 0}, {0, 0, 0}}, {0.75, {1, 1, 0}, {0, 2, 0}}, {2, {1, 1, 3}, {1, 0, 0}}};
  for (const Keyframe& key : box.keyframes) {
    const Pose pose = pose_of(box, key.time);
    EXPECT_LE((pose.at(box.center) - key.position).norm(), 1e-15);
    const double angle = key.rotation.norm();
    const Eigen::Matrix3d turn = angle > 0 ? Eigen::AngleAxisd(angle, key.rotation / angle).toRotationMatrix()
                                           : Eigen::Matrix3d::Identity();
    EXPECT_LE((pose.rotation - turn).norm(), 1e-14);
    constexpr double moment = 1e-9;  // s
    for (const double side : {-moment, moment}) {
      const Pose beside = pose_of(box, key.time + side);
      EXPECT_LE((beside.rotation - pose.rotation).norm(), 1e-7);
      EXPECT_LE((beside.translation - pose.translation).norm(), 1e-7);
    }
  }
}

TEST(Keyframes, TurnEvenlyBetweenByTheShortWay) {
  Obstacle box;
  box.shape = &box_shape();
  const double most = 0.9 * std::numbers::pi;
  box.keyframes = {{0, {0, 0, 0}, {0, 0, most}}, {1, {0, 0, 0}, {0, 0, -most}}};  // 0.2 pi apart through pi
  for (const double part : {0.25, 0.5, 0.75}) {
    const double angle = most + part * 0.2 * std::numbers::pi;
    const Vec3 expected(std::cos(angle), std::sin(angle), 0);
    EXPECT_LE((pose_of(box, part).at({1, 0, 0}) - expected).norm(), 1e-12) << part;
  }
}

TEST(Keyframes, LeadAnObstacleThroughAStep) {
  Scene scene = contact_scene("sphere");
  const Vec3 center = scene.obstacles[0].center;
  scene.obstacles[0].keyframes = {{0, center, {0, 0, 0}}, {0.1, center + Vec3(0, 0.2, 0), {0, 0, 0}}};
  scene.integrator = {.method = "implicit-euler", .time_step = 1.0 / 60};
  Simulation simulation(scene);
  for (int step = 0; step < 12; ++step) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
    const double part = std::min(1.0, simulation.time() / 0.1);
    EXPECT_LE(
        (simulation.obstacle_pose(0, simulation.time()).at(center) - center - Vec3(0, 0.2 * part, 0)).norm(),
        1e-14);
    ASSERT_EQ(all_crossings(simulation).number, 0) << "step " << step;
  }
}

}  // namespace
}  // namespace cloth::test::keyframes_test
