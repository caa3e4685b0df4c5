#include "contact/touch_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/contact_work.h"
#include "contact/obstacle_contact.h"
#include "kernels/instruction_set.h"
#include "support/random.h"

namespace cloth::test::touch_kernels_test {
namespace {

using Vectors = TouchBlock::Vectors;

Vec3 get(const Vectors& from, std::size_t k) {
  return {from[0][k], from[1][k], from[2][k]};
}
void set(Vectors& to, std::size_t k, const Vec3& v) {
  to[0][k] = v.x(), to[1][k] = v.y(), to[2][k] = v.z();
}

/// One particle after the text of obstacle_contact.h.
struct Answer {
  Vec3 velocity;
  double work = 0;
};

Vec3 after_contact(const TouchLaw& law, const Vec3& v, const Vec3& n, double approach, double load) {
  const double inward = v.dot(n);
  if (!(inward < 0)) return v;
  if (law.reflects) return law.friction * (v - inward * n + approach * n);
  const Vec3 along = v - inward * n;
  const double rebound = law.restitution * approach, lost = law.friction * (rebound - inward + load);
  return std::max(0.0, 1 - lost / along.norm()) * along + rebound * n;
}

Answer answer_of(const TouchLaw& law, const TouchBlock& block, std::size_t k) {
  const Vec3 n = get(block.normal, k), v = get(block.velocity, k), start = get(block.start, k);
  const Vec3 began = get(block.start_velocity, k);
  const double mass = block.mass[k], load = block.normal_load[k] / mass;
  const Vec3 moved = (get(block.integrated_position, k) - start) / law.step;
  double approach = law.reflects ? -v.dot(n) : -n.dot(block.held[k] != 0 ? began : moved);
  const double added = n.dot(began - get(block.integrated_velocity, k));
  if (!law.reflects && !(approach > 2 * std::max(law.gravity_speed, added))) approach = 0;

  const Vec3 stopped = after_contact(law, v, n, 0, load), change = stopped - v;
  ContactConstraint contact;
  contact.normal = n, contact.mobility = 1 / mass;
  contact.normal_impulse = block.normal_load[k] + std::max(0.0, mass * change.dot(n));
  contact.friction_impulse = mass * (change - change.dot(n) * n);
  const PointSpeeds speeds{get(block.before, k), stopped, (get(block.point, k) - start) / law.step};
  const double impact = impact_of(contact, speeds);
  double work = work_of(contact, speeds, impact);
  // the springs' load does no work
  work -= std::min(block.normal_load[k], contact.normal_impulse - impact) * n.dot(speeds.gone);
  Vec3 answer = approach > 0 ? after_contact(law, v, n, approach, load) : stopped;
  const double square = 0.5 * mass * (answer - stopped).squaredNorm();
  if (square > 0)
    answer = stopped + part_within(square, mass * stopped.dot(answer - stopped), std::max(-work, 0.0)) *
                           (answer - stopped);
  return {answer, work + 0.5 * mass * (answer.squaredNorm() - stopped.squaredNorm())};
}

TouchBlock random_block(Random& random) {
  TouchBlock block{};
  for (std::size_t k = 0; k < TouchBlock::size; ++k) {
    block.mass[k] = random.uniform(1e-4, 1e-2), block.held[k] = random.uniform(0, 1) < 0.3;
    block.touched[k] = random.uniform(0, 1) < 0.7, block.normal_load[k] = random.uniform(0, 1e-3);
    const auto vector = [&](double most) { return random.vector(most); };
    set(block.start, k, vector(1)), set(block.start_velocity, k, vector(1));
    set(block.integrated_position, k, get(block.start, k) + vector(1e-3));
    set(block.integrated_velocity, k, get(block.start_velocity, k) + vector(0.1));
    set(block.point, k, get(block.start, k) + vector(1e-3)), set(block.normal, k, vector(1).normalized());
    set(block.position, k, get(block.integrated_position, k));
    set(block.velocity, k, get(block.integrated_velocity, k)),
        set(block.before, k, get(block.start_velocity, k));
  }
  return block;
}

void expect_as_one_by_one(const TouchLaw& law, const TouchBlock& before, const TouchBlock& after) {
  for (std::size_t k = 0; k < TouchBlock::size; ++k) {
    if (before.touched[k] == 0) {
      EXPECT_EQ(get(after.position, k), get(before.position, k));
      EXPECT_EQ(get(after.velocity, k), get(before.velocity, k));
      EXPECT_EQ(after.work[k], 0);
      EXPECT_EQ(after.outcome[k], 0);
      continue;
    }
    const Answer one = answer_of(law, before, k);
    EXPECT_EQ(get(after.position, k), get(before.point, k));
    EXPECT_LE((get(after.velocity, k) - one.velocity).norm(), 1e-13) << k;
    EXPECT_EQ(get(after.before, k), get(after.velocity, k));
    EXPECT_NEAR(after.work[k], one.work, 1e-15) << k;
    EXPECT_GE(after.outcome[k], 1);
  }
}

class TouchOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, TouchOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

TEST_P(TouchOfEverySet, OfManyParticlesIsThatOfEach) {
  Random random;
  int rebounds = 0, others = 0;
  for (const TouchLaw law : {TouchLaw{0.4, 0, false, 1e-3, 1e-2}, TouchLaw{0.4, 0.7, false, 1e-3, 1e-2},
                             TouchLaw{0.8, 0, true, 1e-3, 1e-2}, TouchLaw{0, 1, false, 1e-3, 1e-2}})
    for (int round = 0; round < 20; ++round) {
      const TouchBlock before = random_block(random);
      TouchBlock after = before;
      active_kernels<TouchKernels>().respond(law, after);
      expect_as_one_by_one(law, before, after);
      for (const double outcome : after.outcome) rebounds += outcome == 2, others += outcome == 1;
    }
  EXPECT_GT(rebounds, 100);
  EXPECT_GT(others, 500);
}

Obstacle obstacle_of(const ObstacleShape& shape, Random& random) {
  Obstacle obstacle;
  obstacle.shape = &shape;
  obstacle.point = obstacle.center = random.vector(0.5);
  obstacle.normal = random.vector(1), obstacle.radius = random.uniform(0.2, 0.9);
  obstacle.size = 2 * random.vector(0.9).cwiseAbs();
  return obstacle;
}

TEST_P(TouchOfEverySet, FindsTheFreeParticlesInsideWithTheNearestPointOfTheSurface) {
  Random random;
  int inside = 0, outside = 0;
  for (int round = 0; round < 60; ++round) {
    const ObstacleShape* const shapes[] = {&plane_shape(), &sphere_shape(), &box_shape()};
    const Obstacle obstacle = obstacle_of(*shapes[round % 3], random);
    TouchBlock block{};
    for (std::size_t k = 0; k < TouchBlock::size; ++k)
      set(block.position, k, random.vector(1)), block.is_free[k] = k % 5 != 0;
    set(block.position, 1, obstacle.center);
    const int number = active_kernels<TouchKernels>().find_touched(*solid_of(obstacle), block);
    int touched = 0;
    for (std::size_t k = 0; k < TouchBlock::size; ++k) {
      const auto surface = penetration(obstacle, get(block.position, k));
      EXPECT_EQ(block.touched[k] != 0, surface && k % 5 != 0) << obstacle.shape->name << ' ' << k;
      if (block.touched[k] == 0) {
        ++outside;
        continue;
      }
      ++inside, ++touched;
      EXPECT_LE((get(block.point, k) - surface->point).norm(), 1e-15) << obstacle.shape->name << ' ' << k;
      EXPECT_LE((get(block.normal, k) - surface->normal).norm(), 1e-15) << obstacle.shape->name << ' ' << k;
    }
    EXPECT_EQ(number, touched);
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(outside, 200);
  EXPECT_FALSE(solid_of(obstacle_of(mesh_shape(), random))) << "a surface has no inside";
}

}  // namespace
}  // namespace cloth::test::touch_kernels_test
