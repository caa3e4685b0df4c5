// Contact as a constraint of a long step's equation.
#include "contact/stiff_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/implicit_methods.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/contact_check.h"

namespace cloth::test::stiff_contact_test {
namespace {

constexpr double weight = 1.0 / 60;  // s, of the step
constexpr double above = 1e-9;       // m, of a place on a surface: rounding

struct Solved {
  double residual = 0;  ///< of the forces that remain, as a part of those on the surfaces
  double deepest = 0;   ///< m, inside of an obstacle
  double pull = 0;      ///< N, the most that a surface pulls
};

/// A step of implicit Euler of a sheet that is just above the obstacle, `aside` metres to the side, and falls
/// by `fall` metres in it. It bends, and gets wider and narrower, by a hundredth of that.
Solved solved(Scene scene, double fall, double aside) {
  scene.deformation.reset();
  const Simulation simulation(scene);
  const ClothSystem& system = simulation.system();
  ForceModel forces(scene, system);
  const Eigen::AlignedBox3d bounds = shape_of(scene.obstacles[0]).bounds(scene.obstacles[0]);
  ClothState state = simulation.state();
  double lowest = infinity;
  for (std::size_t i = 0; i < system.size(); ++i) lowest = std::min(lowest, state.position[i].y());
  const double speed = fall / weight;
  for (std::size_t i = 0; i < system.size(); ++i) {
    state.position.add(i, {aside, bounds.max().y() + 1e-4 - lowest, 0.5 * aside});
    const Vec3 place = state.position[i];
    state.velocity.set(i, {0.01 * speed * std::sin(8 * place.x()),
                           -speed * (1 + 0.01 * std::cos(9 * place.z() + 4 * place.x())),
                           0.01 * speed * std::sin(7 * place.z() + 1)});
  }
  const Vec3Field begin = state.position;
  ImplicitEuler method(1e-6, 100);
  Work work;
  method.step(forces, {0, weight, weight}, state, work);
  const Vec3Field target = state.position;

  Vec3Field position = target;
  StiffContact contact;
  const auto held = contact.solve(system, forces, scene.obstacles, weight, weight, begin, position);

  forces.update(target, weight);
  const Vec3Field force_before = forces.position_force();
  forces.update(position, weight);
  Vec3Field rest(position.size());
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (!system.pinned[i])
      rest.set(i, system.mass[i] / (weight * weight) * (position[i] - target[i]) -
                      (forces.position_force()[i] - force_before[i]));
  Solved result;
  double loads = 0;
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
          const Solved result = solved(coarser(builtin_scene(name), part), fall, aside);
          const std::string where = std::string(name) + ", part " + std::to_string(part) + ", falls by " +
                                    std::to_string(fall) + " m, aside by " + std::to_string(aside);
          EXPECT_LT(result.residual, 0.9) << where;
          EXPECT_EQ(result.deepest, 0) << where;
          EXPECT_LE(result.pull, 0) << where;
        }
}

}  // namespace
}  // namespace cloth::test::stiff_contact_test
