// A long step with contact without gaps: loads and springs in one equation.
#include "contact/stiff_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/implicit_methods.h"
#include "limiter/tension_springs.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/contact_check.h"

namespace cloth::test::stiff_target_test {
namespace {

constexpr double weight = 1.0 / 60;  // s, of the step

/// A tilted plane through the cloth's place after a free step, `depth` above its lowest point; of every
/// particle by itself, or of the middles of three that follow each other in a row.
std::vector<ContactConstraint> constraints_of(const ClothSystem& system, const Vec3Field& position,
                                              double depth, bool by_three) {
  const Vec3 normal = Vec3(0.2, 1, -0.1).normalized();
  std::vector<ContactConstraint> constraints;
  const int count = by_three ? 3 : 1, columns = system.columns;
  for (int i = 0; i + count <= static_cast<int>(position.size()); ++i) {
    if (i % columns + count > columns) continue;
    ContactConstraint& contact = constraints.emplace_back();
    contact.count = count;
    for (int k = 0; k < count; ++k) contact.particle[at(k)] = i + k, contact.weight[at(k)] = 1.0 / count;
    contact.normal = normal;
    contact.mobility = mobility_of(contact, system.inverse_mass);
  }
  double lowest = infinity;
  for (const ContactConstraint& contact : constraints)
    if (contact.mobility > 0) lowest = std::min(lowest, normal.dot(contact.point(position)));
  for (ContactConstraint& contact : constraints) contact.bound = lowest + depth;
  return constraints;
}

struct Solved {
  double left = 0;     ///< of the equation, as a part of the loads
  double missing = 0;  ///< m
  double pull = 0;     ///< N, the most that a contact pulls
  double idle = 0;     ///< the most load of a contact that is not reached by 0.1 mm, of the largest load
  int loaded = 0;
};

Solved solved(Scene scene, bool by_three) {
  scene.deformation.reset();
  const Simulation simulation(scene);
  const ClothSystem& system = simulation.system();
  ForceModel forces(scene, system);
  ClothState state = simulation.state();
  for (std::size_t i = 0; i < state.position.size(); ++i)
    if (!system.pinned[i]) state.velocity.set(i, {0.1, -1 + 0.2 * std::sin(9 * state.position[i].x()), 0});
  const Vec3Field begin = state.position;
  ImplicitEuler method(1e-6, 100);
  Work work;
  method.step(forces, {0, weight, weight}, state, work);
  const Vec3Field ended = state.position, velocity = state.velocity;
  const auto contacts = constraints_of(system, ended, 0.004, by_three);

  Vec3Field position = ended;
  StiffTarget target;
  EXPECT_TRUE(target.solve(system, forces, contacts, {weight, weight, begin, velocity}, 0, position));

  const ClothState led{ended, velocity};
  const Vec3Field force_before = force_after_step(forces, led, weight, ended),
                  force_after = force_after_step(forces, led, weight, position);
  Vec3Field left(position.size()), given(position.size());
  for (std::size_t i = 0; i < left.size(); ++i)
    if (!system.pinned[i])
      left.set(i, force_after[i] - force_before[i] -
                      system.mass[i] / (weight * weight) * (position[i] - ended[i]));
  Solved result;
  const double largest = *std::max_element(target.loads().begin(), target.loads().end());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactConstraint& contact = contacts[c];
    const double load = target.loads()[c], gap = contact.normal.dot(contact.point(position)) - contact.bound;
    if (contact.mobility > 0) result.missing = std::max(result.missing, -gap);
    result.pull = std::max(result.pull, -load);
    if (gap > 1e-4) result.idle = std::max(result.idle, load / largest);
    result.loaded += load > 0;
    contact.for_each([&](std::size_t i) {
      if (!system.pinned[i]) given.add(i, load / contact.count * contact.normal);
    });
  }
  double squares = 0, loads = 0;
  for (std::size_t i = 0; i < left.size(); ++i)
    squares += (left[i] + given[i]).squaredNorm(), loads += given[i].squaredNorm();
  result.left = std::sqrt(squares / loads);
  return result;
}

/// Damping is part of the step: without it what is left would be 1.5 times the loads of the last cloth.
TEST(StiffTarget, SolvesTheStepWithLoadsThatPushWhereTheClothIsAndNowhereElse) {
  for (const char* name : {"corners-free", "corners-shear", "curtain", "tablecloth", "damped"})
    for (const bool by_three : {false, true}) {
      Scene scene = builtin_scene(std::string(name) == "damped" ? "tablecloth" : name);
      if (std::string(name) == "damped") scene.springs->damping = 0.05;
      const Solved result = solved(scene, by_three);
      const std::string where = std::string(name) + (by_three ? ", of three particles each" : "");
      EXPECT_LT(result.left, by_three ? 0.4 : 0.1) << where;  // penalties bound those of three
      EXPECT_LT(result.missing, 1e-4) << where;
      EXPECT_LE(result.pull, 0) << where;
      EXPECT_LT(result.idle, by_three ? 0.5 : 1e-9) << where;
      EXPECT_GT(result.loaded, 0) << where;
    }
}

/// Tensions as loads: they pull the ends of springs at their longest, and no others.
TEST(StiffTarget, KeepsTheDeformationRateWithTensionsOfTautSprings) {
  for (const double rate : {0.02, 0.002}) {
    Scene scene = builtin_scene("curtain");
    scene.deformation.emplace().rate = rate;
    const Simulation simulation(scene);
    const ClothSystem& system = simulation.system();
    ForceModel forces(scene, system);
    ClothState state = simulation.state();
    for (std::size_t i = 0; i < state.position.size(); ++i)
      if (!system.pinned[i]) state.velocity.set(i, {0, -3, 0.5 * std::sin(9 * state.position[i].x())});
    const Vec3Field begin = state.position;
    ImplicitEuler method(1e-6, 100);
    Work work;
    method.step(forces, {0, weight, weight}, state, work);
    Vec3Field position = state.position;
    RateTensions tensions(*scene.deformation, system);
    ASSERT_FALSE(tensions.keeps(position)) << rate;
    const std::vector<TensionSpring> springs = tension_springs(*scene.deformation, system);
    const double excess = largest_excess(springs, position);
    ASSERT_GT(excess, 0.1) << rate;

    StiffTarget target;
    EXPECT_TRUE(target.solve(system, forces, {}, {weight, weight, begin, state.velocity, nullptr, &tensions},
                             0, position));
    EXPECT_LT(largest_excess(springs, position), 0.01 * excess) << rate;

    const Vec3Field before = force_after_step(forces, state, weight, state.position),
                    after = force_after_step(forces, state, weight, position);
    Vec3Field pull(position.size());
    tensions.add_force(position, pull);
    double squares = 0, pulls = 0;
    for (std::size_t i = 0; i < position.size(); ++i) {
      if (system.pinned[i]) continue;
      const Vec3 moved = position[i] - state.position[i];
      squares += (after[i] + pull[i] - before[i] - system.mass[i] / (weight * weight) * moved).squaredNorm();
      pulls += pull[i].squaredNorm();
    }
    EXPECT_LT(std::sqrt(squares / pulls), 0.1) << rate;
    EXPECT_GT(pulls, 0) << rate;
    EXPECT_LT(tensions.power(position, state.velocity), 0) << "they take from what falls";
  }
}

TEST(StiffTarget, LeavesAStepThatViolatesNothing) {
  const Scene scene = builtin_scene("corners-free");
  const Simulation simulation(scene);
  ForceModel forces(scene, simulation.system());
  const Vec3Field begin = simulation.state().position;
  Vec3Field position = begin;
  StiffTarget target;
  const auto contacts = constraints_of(simulation.system(), begin, -0.001, false);
  EXPECT_FALSE(target.solve(simulation.system(), forces, contacts,
                            {weight, weight, begin, simulation.state().velocity}, 0, position));
  EXPECT_TRUE(std::ranges::equal(position.flat(), begin.flat()));
}

}  // namespace
}  // namespace cloth::test::stiff_target_test
