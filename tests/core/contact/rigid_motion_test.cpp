#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth::test::rigid_motion_test {
namespace {

using std::numbers::pi;

Obstacle ball() {
  Obstacle obstacle;
  obstacle.center = {1, 2, 3};
  return obstacle;
}

TEST(AnObstacle, RestsWithoutMotion) {
  EXPECT_FALSE(moves(ball()));
  EXPECT_EQ(pose_of(ball(), 7), Pose{});
}

TEST(AnObstacle, MovesByItsVelocity) {
  Obstacle obstacle = ball();
  obstacle.velocity = {1, 0, -2};
  EXPECT_LE((pose_of(obstacle, 2).at({1, 2, 3}) - Vec3(3, 2, -1)).norm(), 1e-15);
}

TEST(AnObstacle, TurnsAboutItsCentre) {
  Obstacle obstacle = ball();
  obstacle.spin = {0, 0, pi};
  const Pose pose = pose_of(obstacle, 0.5);
  EXPECT_LE((pose.at({1, 2, 3}) - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LE((pose.at({2, 2, 3}) - Vec3(1, 3, 3)).norm(), 1e-15);
  EXPECT_LE((pose.inverse(pose.at({4, 5, 6})) - Vec3(4, 5, 6)).norm(), 1e-14);
}

TEST(Keyframes, HoldOutsideAndAreStraightBetween) {
  Obstacle obstacle = ball();
  obstacle.keyframes = {{1, {0, 0, 0}, {0, 0, 0}}, {3, {2, 0, 0}, {0, pi / 2, 0}}};
  EXPECT_LE((pose_of(obstacle, 0).at({1, 2, 3}) - Vec3(0, 0, 0)).norm(), 1e-15);
  EXPECT_LE((pose_of(obstacle, 9).at({1, 2, 3}) - Vec3(2, 0, 0)).norm(), 1e-15);
  const Pose middle = pose_of(obstacle, 2);
  EXPECT_LE((middle.at({1, 2, 3}) - Vec3(1, 0, 0)).norm(), 1e-15);
  const double half = std::sqrt(0.5);
  EXPECT_LE((middle.at({2, 2, 3}) - Vec3(1 + half, 0, -half)).norm(), 1e-14);
}

TEST(APoseInterpolation, EndsAtItsPosesToTheBit) {
  Obstacle obstacle = ball();
  obstacle.spin = {1, 2, 3}, obstacle.velocity = {3, 2, 1};
  const Pose from = pose_of(obstacle, 0.1), to = pose_of(obstacle, 0.2);
  const PoseInterpolation path(obstacle.center, from, to);
  EXPECT_EQ(path.at(0), from);
  EXPECT_EQ(path.at(1), to);
  EXPECT_FALSE(path.is_still());
  EXPECT_NEAR(path.angle(), 0.1 * std::sqrt(14.0), 1e-12);
  const Pose there = pose_of(obstacle, 0.15), between = path.at(0.5);
  EXPECT_LE((there.rotation - between.rotation).norm(), 1e-13);
  EXPECT_LE((there.translation - between.translation).norm(), 1e-13);
}

TEST(APoseInterpolation, MakesAsManyWholeTurnsAsTheObstacleHasMade) {
  Obstacle obstacle = ball();
  for (const Vec3& spin : {Vec3(10, 40, 20), Vec3(0, -63, 0), Vec3(0, 20 * pi, 0), Vec3(-35, 0, 0)}) {
    obstacle.spin = spin;
    const double begin = 0.3, step = 0.1;
    const PoseInterpolation path(obstacle.center, pose_of(obstacle, begin), pose_of(obstacle, begin + step),
                                 step * spin);
    EXPECT_NEAR(path.angle(), step * spin.norm(), 1e-12);
    EXPECT_FALSE(path.is_still());
    for (const double part : {0.1, 0.25, 0.5, 0.9}) {
      const Pose there = pose_of(obstacle, begin + part * step), between = path.at(part);
      EXPECT_LE((there.rotation - between.rotation).norm(), 1e-12) << spin.transpose() << ", part " << part;
      EXPECT_LE((there.translation - between.translation).norm(), 1e-12);
    }
  }
}

TEST(TheHighestSpeed, IsThatOfTheFastestPoint) {
  Obstacle obstacle = ball();
  obstacle.velocity = {3, 0, 0}, obstacle.spin = {0, 2, 0};
  EXPECT_DOUBLE_EQ(highest_speed(obstacle, 0.5), 4);
  obstacle.keyframes = {{0, {0, 0, 0}, {0, 0, 0}}, {2, {2, 0, 0}, {0, 1, 0}}};
  EXPECT_NEAR(highest_speed(obstacle, 4), 1 + 4 * 0.5, 1e-12);
}

/// As an edit of its normal does, by the least angle, also where that is half a turn.
TEST(APlane, TurnsWithItsNormal) {
  Obstacle from, to;
  from.shape = to.shape = &plane_shape();
  const Vec3 normals[] = {{0, 1, 0},   {0, 3, 0},     {0, -1, 0}, {1, 2, -2},
                          {-1, -2, 2}, {1e-9, -1, 0}, {1, 0, 0}};
  for (const Vec3& before : normals)
    for (const Vec3& after : normals) {
      from.normal = before, to.normal = after;
      const Eigen::Matrix3d rotation = shape_of(to).rotation_between(from, to);
      EXPECT_LE((rotation * before.normalized() - after.normalized()).norm(), 1e-7) << before << "\n"
                                                                                    << after;
      EXPECT_LE((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_NEAR(rotation.determinant(), 1, 1e-14);
      const double cosine = before.normalized().dot(after.normalized());
      EXPECT_NEAR((rotation.trace() - 1) / 2, cosine, 1e-12) << "the least angle";
    }
}

}  // namespace
}  // namespace cloth::test::rigid_motion_test
