#include <gtest/gtest.h>

#include <cmath>

#include "cloth/grid.h"
#include "contact/obstacle_contact.h"
#include "scene/obstacle_shape.h"
#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test::contact_test {
namespace {

Obstacle sphere() {
  Obstacle obstacle;
  obstacle.shape = &sphere_shape();
  obstacle.center = {1, 2, 3};
  obstacle.radius = 0.5;
  return obstacle;
}

Obstacle box() {
  Obstacle obstacle;
  obstacle.shape = &box_shape();
  obstacle.center = {1, 0, 0};
  obstacle.size = {2, 4, 6};  // x in [0, 2], y in [-2, 2], z in [-3, 3]
  return obstacle;
}

Obstacle plane() {
  Obstacle obstacle;
  obstacle.shape = &plane_shape();
  obstacle.point = {5, 1, 5};
  obstacle.normal = {0, 2, 0};  // of any length
  return obstacle;
}

void expect_moved_to(const Obstacle& obstacle, const Vec3& from, const Vec3& to, const Vec3& normal) {
  const auto surface = penetration(obstacle, from);
  ASSERT_TRUE(surface) << from.transpose();
  EXPECT_LE((surface->point - to).norm(), 1e-15) << surface->point.transpose();
  EXPECT_LE((surface->normal - normal).norm(), 1e-15) << surface->normal.transpose();
}

TEST(Sphere, MovesAParticleInsideAlongItsRadius) {
  expect_moved_to(sphere(), {1.2, 2, 3}, {1.5, 2, 3}, {1, 0, 0});
  const Vec3 out = Vec3(1, -2, 2) / 3;
  expect_moved_to(sphere(), sphere().center + 0.3 * out, sphere().center + 0.5 * out, out);
}

TEST(Sphere, MovesItsCentreToTheTop) {
  expect_moved_to(sphere(), {1, 2, 3}, {1, 2.5, 3}, {0, 1, 0});
}

TEST(Sphere, LeavesParticlesOutsideAndOnTheSurface) {
  EXPECT_FALSE(penetration(sphere(), {1.5, 2, 3}));
  EXPECT_FALSE(penetration(sphere(), {1, 2.6, 3}));
  EXPECT_FALSE(penetration(sphere(), {1.4, 2.4, 3.4}));
}

TEST(Box, MovesOnlyTheCoordinateOfLeastPenetration) {
  expect_moved_to(box(), {1.9, 0.5, 0.5}, {2, 0.5, 0.5}, {1, 0, 0});
  expect_moved_to(box(), {0.2, 0.5, 0.5}, {0, 0.5, 0.5}, {-1, 0, 0});
  expect_moved_to(box(), {1, 1.9, 2}, {1, 2, 2}, {0, 1, 0});
  expect_moved_to(box(), {1, -1.9, 2}, {1, -2, 2}, {0, -1, 0});
  expect_moved_to(box(), {1, 1, 2.99}, {1, 1, 3}, {0, 0, 1});
  expect_moved_to(box(), {1, 1, -2.99}, {1, 1, -3}, {0, 0, -1});
}

TEST(Box, JustBelowAFaceMovesByThatMuch) {  // the report's Eq. (20) would move it to a corner
  expect_moved_to(box(), {1, 1.99, 0}, {1, 2, 0}, {0, 1, 0});
}

TEST(Box, NearAnEdgeMovesOneCoordinate) {
  expect_moved_to(box(), {1.9, 1.8, 0}, {2, 1.8, 0}, {1, 0, 0});
  expect_moved_to(box(), {1.8, 1.9, 0}, {1.8, 2, 0}, {0, 1, 0});
  expect_moved_to(box(), {1.75, 1.75, 0}, {2, 1.75, 0}, {1, 0, 0});  // a tie: the first axis
}

TEST(Box, NearACornerMovesOneCoordinate) {
  expect_moved_to(box(), {1.9, 1.8, 2.7}, {2, 1.8, 2.7}, {1, 0, 0});
  expect_moved_to(box(), {0.25, -1.75, -2.75}, {0, -1.75, -2.75}, {-1, 0, 0});  // a tie of all three
}

TEST(Box, LeavesParticlesOutsideAndOnFaceEdgeAndCorner) {
  for (const Vec3& position : {Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(2, 2, 3), Vec3(0, -2, -3), Vec3(1, 2.5, 0),
                               Vec3(1, 0, 3.1), Vec3(-0.1, 0, 0)})
    EXPECT_FALSE(penetration(box(), position)) << position.transpose();
}

TEST(Plane, MovesAParticleBelowStraightUp) {
  expect_moved_to(plane(), {7, 0.4, -2}, {7, 1, -2}, {0, 1, 0});
  Obstacle slope = plane();
  slope.normal = {1, 1, 0}, slope.point = {0, 0, 0};
  expect_moved_to(slope, {-1, -1, 4}, {0, 0, 4}, Vec3(1, 1, 0).normalized());
}

TEST(Plane, LeavesParticlesAboveAndOnIt) {
  EXPECT_FALSE(penetration(plane(), {7, 1, -2}));
  EXPECT_FALSE(penetration(plane(), {7, 1.1, -2}));
}

Obstacle coulomb(double friction, double restitution) {
  Obstacle obstacle = plane();
  obstacle.friction = friction, obstacle.restitution = restitution;
  return obstacle;
}

const Vec3 up{0, 1, 0};

void expect_velocity(const Obstacle& obstacle, const Vec3& before, const Vec3& after) {
  const Vec3 velocity = contact_velocity(obstacle, up, before);
  EXPECT_LE((velocity - after).norm(), 1e-15) << velocity.transpose();
}

TEST(CoulombResponse, TakesTheInwardSpeed) {
  expect_velocity(coulomb(0, 0), {3, -2, 4}, {3, 0, 4});
}

TEST(CoulombResponse, BouncesByTheRestitution) {
  expect_velocity(coulomb(0, 0.25), {3, -2, 4}, {3, 0.5, 4});
  expect_velocity(coulomb(0, 1), {0, -2, 0}, {0, 2, 0});
}

TEST(CoulombResponse, RubsInProportionToTheChangeOfNormalSpeed) {
  expect_velocity(coulomb(0.5, 0), {3, -2, 4}, {3 * 0.8, 0, 4 * 0.8});    // 1 of a speed of 5 is lost
  expect_velocity(coulomb(0.5, 0.5), {3, -2, 4}, {3 * 0.7, 1, 4 * 0.7});  // 0.5 * (1 + 0.5) * 2 is lost
}

TEST(CoulombResponse, SticksWhereFrictionCouldTakeMoreThanThereIs) {
  expect_velocity(coulomb(0.5, 0), {0.6, -2, 0.8}, {0, 0, 0});
  expect_velocity(coulomb(10, 0), {3, -2, 4}, {0, 0, 0});
  expect_velocity(coulomb(0.5, 0.5), {0.3, -2, 0.4}, {0, 1, 0});
}

TEST(ReflectResponse, MirrorsAndScales) {  // the report's Eq. (17)
  Obstacle obstacle = plane();
  obstacle.response = "reflect", obstacle.friction = 0.8;
  expect_velocity(obstacle, {3, -2, 4}, {2.4, 1.6, 3.2});
}

TEST(EveryResponse, LeavesAParticleThatLeaves) {
  Obstacle reflect = plane();
  reflect.response = "reflect";
  for (const Obstacle& obstacle : {coulomb(0.5, 0.5), reflect}) {
    expect_velocity(obstacle, {3, 2, 4}, {3, 2, 4});
    expect_velocity(obstacle, {3, 0, 4}, {3, 0, 4});
  }
}

/// A 2x2 cloth with particle (0,0) pinned, all of it inside the plane's solid half.
struct SunkenCloth {
  SunkenCloth() {
    Scene scene = lying_sheet(2, 2);
    scene.cloth.pins = {NamedPin::top_left};
    system = make_grid(scene.cloth, {});
    state = starting_state(system);
    for (std::size_t i = 0; i < 4; ++i) state.velocity.set(i, {0, -1, 0});
    state.velocity.set(0, Vec3::Zero());
  }
  ClothSystem system;
  ClothState state;
};

/// As the end of a step that began where it is.
ContactReport apply_contact(const ObstacleContact& contact, SunkenCloth& cloth) {
  ContactMemory memory;
  const ClothState begin = cloth.state;
  return contact.apply(cloth.system, {begin.position, begin.velocity, 1e-3, memory}, cloth.state);
}

TEST(ObstacleContact, MovesFreeParticlesAndNeverPins) {
  SunkenCloth cloth;
  const ObstacleContact contact({coulomb(0, 0)}, 0);
  ASSERT_TRUE(contact.touches(cloth.system, cloth.state));
  EXPECT_EQ(apply_contact(contact, cloth).contacts, 3);
  EXPECT_EQ(cloth.state.position[0], cloth.system.start[0]);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(cloth.state.position[i].y(), 1);
    EXPECT_EQ(cloth.state.velocity[i].norm(), 0);
  }
  EXPECT_FALSE(contact.touches(cloth.system, cloth.state));
}

TEST(ObstacleContact, LeavesWhatItDoesNotTouchToTheBit) {
  SunkenCloth cloth;
  const ClothState before = cloth.state;
  const ObstacleContact contact({sphere()}, 0);
  EXPECT_FALSE(contact.touches(cloth.system, cloth.state));
  EXPECT_EQ(apply_contact(contact, cloth).contacts, 0);
  EXPECT_EQ(cloth.state, before);
}

/// 49 of them, on a slope and in a ball that reaches into it.
TEST(ObstacleContact, OfManyParticlesAndObstaclesIsThatOfEachParticle) {
  Random random;
  Scene scene = lying_sheet(7, 7);
  scene.cloth.pins = {NamedPin::top_left};
  const ClothSystem system = make_grid(scene.cloth, {});
  const ClothState begin = starting_state(system);
  Obstacle slope = coulomb(0.3, 0.6), ball = sphere();
  slope.normal = {0.1, 1, 0}, slope.point = begin.position[24] + Vec3(0, 1e-3, 0);
  ball.center = begin.position[24] - Vec3(0.05, 0.2, 0), ball.radius = 0.21, ball.friction = 0.5;
  const ObstacleContact contact({slope, ball}, 9.81);
  const auto apply = [&](ClothState& state) {
    ContactMemory memory;
    return contact.apply(system, {begin.position, begin.velocity, 1e-3, memory}, state);
  };
  ClothState integrated = begin;
  for (std::size_t i = 0; i < 49; ++i) {
    integrated.velocity.set(i, random.vector(1)), integrated.position.add(i, random.vector(1e-3));
  }
  ClothState all = integrated;
  const ContactReport report = apply(all);
  int contacts = 0;
  double work = 0;
  for (std::size_t i = 0; i < 49; ++i) {
    ClothState one = integrated;
    for (std::size_t k = 0; k < 49; ++k)
      if (k != i) one.position.set(k, {0, 100, 0});
    const ContactReport of_one = apply(one);
    EXPECT_EQ(one.position[i], all.position[i]) << i;
    EXPECT_EQ(one.velocity[i], all.velocity[i]) << i;
    contacts += of_one.contacts, work += of_one.work;
  }
  EXPECT_EQ(report.contacts, contacts);
  EXPECT_NEAR(report.work, work, 1e-12);
  EXPECT_GT(contacts, 20);
}

TEST(ObstacleContact, PutsEveryParticleOnTheNearestSurface) {
  Random random;
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 inside = box().center + Vec3(random.uniform(-0.999, 0.999), random.uniform(-1.999, 1.999),
                                            random.uniform(-2.999, 2.999));
    const auto surface = penetration(box(), inside);
    ASSERT_TRUE(surface);
    const Vec3 depth = 0.5 * box().size - (inside - box().center).cwiseAbs();
    EXPECT_NEAR((surface->point - inside).norm(), depth.minCoeff(), 1e-15);
    EXPECT_FALSE(penetration(box(), surface->point));
  }
}

}  // namespace
}  // namespace cloth::test::contact_test
