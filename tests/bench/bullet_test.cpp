// A cloth in Bullet: the same start and the same springs as ours, and what each of its models solves.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/peers/bullet_cloth.h"
#include "scene/scene_cloth.h"
#include "study/reference_solution.h"

namespace cloth::peers::bullet_test {
namespace {

constexpr double stiffness = 70, rest = 0.8;  // N/m, m
constexpr double inverse_mass = 1 / 0.3 + 1 / 0.5;

/// Two particles along x, stretched by `stretch` (m), at rest.
SpringList pair(double stretch) {
  SpringList list{.position = Vec3Field(2),
                  .velocity = Vec3Field(2),
                  .mass = {0.3, 0.5},
                  .springs = {{.a = 0, .b = 1, .rest_length = rest, .stiffness = stiffness}}};
  list.position.set(1, {rest + stretch, 0, 0});
  return list;
}

/// How long the spring of a pair is beyond its rest length after every step, the start first.
std::vector<double> stretches(const BulletSettings& settings, double stretch, int steps) {
  BulletCloth cloth(pair(stretch), settings);
  Vec3Field position(2), velocity(2);
  std::vector<double> result{stretch};
  for (int k = 0; k < steps; ++k) {
    cloth.step();
    cloth.copy_to(position, velocity);
    result.push_back((position[1] - position[0]).norm() - rest);
  }
  return result;
}

/// A sheet that swings down from where it lay flat, its upper edge pinned.
Scene swinging(int size) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.cloth.down = {0, 0, 1};
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = SpringMaterial{.structural = 20, .shear = 20, .flexion = 2};
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

TEST(Bullet, StartsWithTheClothThatOursStartsWith) {
  const Scene scene = swinging(7);
  const ClothSystem system = make_cloth(scene);
  const SpringList list = spring_list(system, gravity_of(scene));
  const auto count = static_cast<std::size_t>(system.size());
  for (const BulletModel model : {BulletModel::springs_explicit, BulletModel::links_by_stiffness}) {
    const BulletCloth cloth(list, {.model = model, .time_step = 1e-3});
    Vec3Field position(count), velocity(count);
    cloth.copy_to(position, velocity);
    EXPECT_EQ(position, system.start);
    EXPECT_EQ(velocity, Vec3Field(count));
    const std::vector<double> masses = cloth.masses();
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(masses[i], system.pinned[i] ? 0 : system.mass[i], 1e-15);
  }
  EXPECT_EQ(list.springs.size(), static_cast<std::size_t>(system.spring_count(SpringFamily::structural) +
                                                          system.spring_count(SpringFamily::shear) +
                                                          system.spring_count(SpringFamily::flexion)));
}

TEST(Bullet, ExplicitSpringsAreOursInNewtonsPerMetre) {
  const double h = 0.01, a = h * h * stiffness * inverse_mass;
  const auto d = stretches({.model = BulletModel::springs_explicit, .time_step = h}, 0.02, 200);
  EXPECT_NEAR(d[1], (1 - a) * d[0], 1e-14);  // at rest before
  for (std::size_t n = 1; n + 1 < d.size(); ++n)
    ASSERT_NEAR(d[n + 1], (2 - a) * d[n] - d[n - 1], 1e-14) << "semi-implicit Euler, step " << n;
}

TEST(Bullet, ImplicitSpringsAreBackwardEulerOfThem) {
  const double h = 0.01, a = h * h * stiffness * inverse_mass;
  const auto d =
      stretches({.model = BulletModel::springs_implicit, .time_step = h, .iterations = 5}, 0.02, 200);
  for (std::size_t n = 1; n + 1 < d.size(); ++n)
    ASSERT_NEAR(d[n + 1], (2 * d[n] - d[n - 1]) / (1 + a), 1e-9) << "step " << n;
}

TEST(Bullet, OneLinkByStiffnessIsBackwardEulerInAnyNumberOfPasses) {
  const double h = 0.01, a = h * h * stiffness * inverse_mass, small = 1e-6;
  for (const int passes : {1, 4}) {
    const auto d = stretches({.model = BulletModel::links_by_stiffness, .time_step = h, .iterations = passes},
                             small, 100);
    for (std::size_t n = 1; n + 1 < d.size(); ++n)
      ASSERT_NEAR(d[n + 1], (2 * d[n] - d[n - 1]) / (1 + a), 1e-5 * small) << passes << " passes";
  }
}

TEST(Bullet, OneLinkThatIsNoNumberOfNewtonsPerMetreIsInextensible) {
  const auto d = stretches({.model = BulletModel::links, .time_step = 1e-3, .iterations = 1}, 1e-6, 1);
  EXPECT_NEAR(d[1], 0, 1e-11) << "whatever its stiffness";
}

TEST(Bullet, PartOfALinkIsWithinItsRangeAndAddsUpOverThePasses) {
  for (const double k : {1e-3, 1.0, 1e3, 1e9})
    for (const int passes : {1, 3, 10}) {
      const double a = 1e-4 * k * 5, part = links_part(k, 1e-2, 5, passes);
      EXPECT_GT(part, 0);
      EXPECT_LT(part, 1);
      EXPECT_NEAR(std::pow(1 - part, passes), 1 / (1 + a), 1e-12);
    }
}

TEST(Bullet, FallsAsOursWhereNothingHolds) {
  SpringList list = pair(0);
  list.gravity = {0, -9.81, 0};
  const double h = 0.01;
  for (const BulletModel model :
       {BulletModel::springs_explicit, BulletModel::springs_implicit, BulletModel::links}) {
    BulletCloth cloth(list, {.model = model, .time_step = h});
    for (int k = 0; k < 10; ++k) cloth.step();
    Vec3Field position(2), velocity(2);
    cloth.copy_to(position, velocity);
    EXPECT_NEAR(velocity[0].y(), -9.81 * 0.1, 1e-7);
    EXPECT_NEAR(position[0].y(), -9.81 * h * h * 55, 1e-7);
  }
}

/// Largest distance to the reference of the swinging sheet after 0.2 s.
double error_of(BulletModel model, int steps, const ReferenceSolution& reference, const Scene& scene) {
  const SpringList list = spring_list(make_cloth(scene), gravity_of(scene));
  BulletCloth cloth(list, {.model = model, .time_step = 0.2 / steps, .iterations = 4});
  for (int k = 0; k < steps; ++k) cloth.step();
  ClothState state = reference.states.back();
  cloth.copy_to(state.position, state.velocity);
  return difference({state}, reference.states).largest_position;
}

TEST(Bullet, SpringsConvergeToOurReferenceWithTheFirstOrderAndLinksDoNot) {
  const Scene scene = swinging(5);
  const ReferenceSolution reference = solve_smooth(scene, 0.2, 1);
  ASSERT_EQ(reference.failure, "");
  const auto order = [&](BulletModel model, int steps) {
    return std::log2(error_of(model, steps, reference, scene) / error_of(model, 2 * steps, reference, scene));
  };
  EXPECT_NEAR(order(BulletModel::springs_explicit, 800), 1, 0.1);
  EXPECT_NEAR(order(BulletModel::springs_implicit, 800), 1, 0.1);
  EXPECT_LT(order(BulletModel::links, 800), 0.5) << "another model: the error levels off";
}

TEST(Bullet, SaysThatItHasNoSpringsOfAThirdStiffness) {
  Scene scene = swinging(4);
  EXPECT_EQ(broken_bullet_rule(spring_list(make_cloth(scene), {0, 0, 0})), "");
  scene.springs->shear = 10;
  EXPECT_NE(broken_bullet_rule(spring_list(make_cloth(scene), {0, 0, 0})), "");
}

}  // namespace
}  // namespace cloth::peers::bullet_test
