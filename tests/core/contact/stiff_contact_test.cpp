// Contact as a constraint of a long step's equation.
#include "contact/stiff_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/implicit_methods.h"
#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/contact_check.h"

namespace cloth::test::stiff_contact_test {
namespace {

constexpr double weight = 1.0 / 60;  // s, of the step
constexpr double above = 1e-9;       // m, of a place on a surface: rounding

struct Solved {
  double residual = 0;   ///< of the forces that remain, as a part of those on the surfaces
  double part_left = 0;  ///< of the forces that remain, of those that the method had left
  double deepest = 0;    ///< m, inside of an obstacle
  double pull = 0;       ///< N, the most that a surface pulls
};

/// What is left of the equation of a step of implicit Euler without dampers and air.
Vec3 left_of_step(const ClothSystem& system, const Vec3Field& force, const ClothState& begin,
                  const Vec3Field& position, std::size_t i) {
  const Vec3 velocity = (position[i] - begin.position[i]) / weight;
  return system.mass[i] / weight * (velocity - begin.velocity[i]) - force[i];
}

/// A step of the method of a sheet that is just above the obstacle, `aside` metres to the side, and falls
/// by `fall` metres in it. It bends, and gets wider and narrower, by a hundredth of that or at `stir` m/s.
Solved solved(Scene scene, Integrator& method, double fall, double aside, double stir = 0) {
  scene.deformation.reset();
  const Simulation simulation(scene);
  const ClothSystem& system = simulation.system();
  ForceModel forces(scene, system);
  const Eigen::AlignedBox3d bounds = shape_of(scene.obstacles[0]).bounds(scene.obstacles[0]);
  ClothState state = simulation.state();
  double lowest = infinity;
  for (std::size_t i = 0; i < state.position.size(); ++i) lowest = std::min(lowest, state.position[i].y());
  const double speed = fall / weight, wave = stir > 0 ? stir : 0.01 * speed;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.position.add(i, {aside, bounds.max().y() + 1e-4 - lowest, 0.5 * aside});
    const Vec3 place = state.position[i];
    state.velocity.set(
        i, {wave * std::sin(8 * place.x()), -speed - wave * std::cos(9 * place.z() + 4 * place.x()),
            wave * std::sin(7 * place.z() + 1)});
  }
  const ClothState begin = state;
  const StepTimes times{0, weight, weight};
  Work work;
  method.step(forces, times, state, work);
  const Vec3Field target = state.position, velocity = state.velocity;
  const Vec3Field* left = method.force_left(forces, times);

  Vec3Field position = target;
  StiffContact contact;
  const auto held = contact.solve(system, forces, scene.obstacles,
                                  {weight, weight, begin.position, velocity, left}, position);

  const ClothState led{target, velocity};
  const Vec3Field force_before = force_after_step(forces, led, weight, target),
                  force_after = force_after_step(forces, led, weight, position);
  Vec3Field rest(position.size());
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (!system.pinned[i])
      rest.set(i, left ? left_of_step(system, force_after, begin, position, i)
                       : Vec3(system.mass[i] / (weight * weight) * (position[i] - target[i]) -
                              (force_after[i] - force_before[i])));
  Solved result;
  double loads = 0, left_before = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (!system.pinned[i]) left_before += left_of_step(system, force_before, begin, target, i).squaredNorm();
  for (const HeldParticle& one : held) {
    const double load = one.normal.dot(rest[one.particle]);
    result.pull = std::max(result.pull, -load);
    loads += load * load;
    rest.add(one.particle, -load * one.normal);
  }
  for (std::size_t i = 0; i < rest.size(); ++i) {
    result.residual += rest[i].squaredNorm();
    if (system.pinned[i]) continue;
    for (const Obstacle& obstacle : scene.obstacles)
      if (const auto out = penetration(grown(obstacle, -above), position[i]))
        result.deepest = std::max(result.deepest, (out->point - position[i]).norm());
  }
  result.part_left = std::sqrt(result.residual / left_before);
  result.residual = std::sqrt(result.residual / loads);
  return result;
}

/// On `cube` and `tablecloth` rows of particles lie on the edges. If iterations go to and fro between holding
/// them and letting them slide beyond, the forces that remain are several times those on the surfaces.
TEST(ContactOfALongStep, LeavesNothingInsideNoSurfaceThatPullsAndLessForceThanItGives) {
  for (const char* name : {"ball", "cube", "rectangle", "tablecloth"})
    for (const double part : {0.5, 1.0})
      for (const double fall : {0.005, 0.03})
        for (const double aside : {0.0, 1e-7, 1e-3}) {
          ImplicitEuler method(1e-6, 100);
          const Solved result = solved(coarser(builtin_scene(name), part), method, fall, aside);
          const std::string where = std::string(name) + ", part " + std::to_string(part) + ", falls by " +
                                    std::to_string(fall) + " m, aside by " + std::to_string(aside);
          EXPECT_LT(result.residual, 0.9) << where;
          EXPECT_EQ(result.deepest, 0) << where;
          EXPECT_LE(result.pull, 0) << where;
        }
}

/// A cloth that waves at 1 m/s as it meets the obstacle. Held where they are, the forces that five iterations
/// leave would remain whole.
TEST(ContactOfALongStep, SolvesWhatMethodsOfFewIterationsLeave) {
  for (const char* name : {"ball", "cube", "rectangle", "tablecloth"})
    for (const char* of : {"projective", "vbd"})
      for (const double stiffer : {1.0, 10.0})
        for (const double fall : {0.0002, 0.002}) {
          Scene scene = coarser(builtin_scene(name), 0.5);
          scene.springs->damping = 0, scene.air.reset();
          scene.springs->structural *= stiffer, scene.springs->shear *= stiffer;
          const auto method =
              make_integrator({.method = of, .projective_iterations = 5, .vbd_iterations = 5});
          const Solved result = solved(scene, *method, fall, 1e-3, 1);
          const std::string where = std::string(name) + ", " + of + ", " + std::to_string(stiffer) +
                                    " times as stiff, falls by " + std::to_string(fall) + " m";
          EXPECT_LT(result.part_left, 0.3) << where;
          EXPECT_EQ(result.deepest, 0) << where;
          EXPECT_LE(result.pull, 0) << where;
        }
}

}  // namespace
}  // namespace cloth::test::stiff_contact_test
