// The implicit methods solve their own equations, keep what they must keep, and say so where they cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/sums.h"
#include "geometry/split_mix.h"
#include "integrators/implicit/limited_memory.h"
#include "integrators/implicit_methods.h"
#include "measure/energy.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/scenes.h"
#include "support/states.h"
#include "support/test_names.h"

namespace cloth::test::implicit_test {
namespace {

IntegratorChoice tight(const std::string& method) {
  IntegratorChoice choice{method};
  choice.tolerance = 1e-12;
  return choice;
}

/// Everything that a scene can have that acts on velocities or turns with the cloth.
Scene windy_scene() {
  Scene scene = smooth_scene(6, 6);
  scene.springs->damping = 0.05;
  return scene;
}

/// M (v - v0) - weight f(x, v, t), the largest component in N s.
double equation_residual(DirectRun& run, const Vec3Field& before, double weight, const Vec3Field& position,
                         const Vec3Field& velocity, double time) {
  Vec3Field force(position.size());
  run.forces.update(position, time);
  run.forces.force(position, velocity, force);
  double largest = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (!run.system.pinned[i])
      largest = std::max(
          largest,
          (run.system.mass[i] * (velocity[i] - before[i]) - weight * force[i]).cwiseAbs().maxCoeff());
  return largest;
}

Vec3Field combination(double a, const Vec3Field& x, double b, const Vec3Field& y) {
  Vec3Field sum(x.size());
  add_scaled(a, x, sum);
  add_scaled(b, y, sum);
  return sum;
}

constexpr double long_step = 0.02;  // s, omega h = 13 in the windy scene

TEST(ImplicitEuler, SolvesItsEquationWithEveryForce) {
  DirectRun run(windy_scene(), tight("implicit-euler"));
  for (int n = 0; n < 10; ++n) {
    const ClothState before = run.state;
    run.advance(1, long_step);
    const ClothState after = run.state;
    EXPECT_LE(equation_residual(run, before.velocity, long_step, after.position, after.velocity, after.time),
              1e-11);
    EXPECT_LE(largest_distance(after.position, combination(1, before.position, long_step, after.velocity)),
              1e-15);
  }
}

/// From a state so crumpled that the matrix is not positive definite.
void expect_that_multigrid_solves_the_equation(const Scene& scene) {
  DirectRun run(scene, tight("implicit-euler"));
  ASSERT_EQ(
      choose_linear_method(run.system, {.position = long_step * long_step, .velocity = long_step}).method,
      LinearMethod::multigrid);
  Random random;
  run.state = crumpled_state(run.system, 0.01, 0.5, random);
  for (int n = 0; n < 3; ++n) {
    const Vec3Field before = run.state.velocity;
    run.advance(1, long_step);
    const ClothState after = run.state;
    EXPECT_LE(equation_residual(run, before, long_step, after.position, after.velocity, after.time), 1e-10);
  }
}

TEST(ImplicitEuler, SolvesItsEquationByMultigridToo) {
  Scene scene = smooth_scene(64, 61);
  scene.springs = SpringMaterial{.structural = 3e4, .shear = 2e4, .flexion = 5e3, .damping = 0.02};
  expect_that_multigrid_solves_the_equation(scene);
}

TEST(ImplicitEuler, SolvesItsEquationByMultigridOfAMeshToo) {
  Random random;
  Material material;
  material.areal_density = 0.2, material.shear = 30;
  material.stretch_warp = 120, material.stretch_weft = 60;
  material.bending_warp = 2e-5, material.bending_weft = 1e-5, material.twist = 1e-5;
  Scene scene = material_mesh_sheet(40, 40, 1, 1, 0.3, material, random);
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 39}};
  expect_that_multigrid_solves_the_equation(scene);
  scene.material.reset();
  scene.cloth.mass = 0.25;
  scene.springs = SpringMaterial{.structural = 3e4, .flexion = 5e3, .damping = 0.02};
  expect_that_multigrid_solves_the_equation(scene);
}

TEST(ImplicitMidpoint, SolvesItsEquationWithEveryForce) {
  DirectRun run(windy_scene(), tight("implicit-midpoint"));
  for (int n = 0; n < 10; ++n) {
    const ClothState before = run.state;
    run.advance(1, long_step);
    const ClothState after = run.state;
    const Vec3Field middle = combination(0.5, before.position, 0.5, after.position);
    const Vec3Field velocity = combination(0.5, before.velocity, 0.5, after.velocity);
    EXPECT_LE(equation_residual(run, before.velocity, 0.5 * long_step, middle, velocity,
                                before.time + 0.5 * long_step),
              1e-11);
    EXPECT_LE(largest_distance(after.position, combination(1, before.position, long_step, velocity)), 1e-15);
  }
}

TEST(Bdf2, SolvesItsEquationWithEveryForceFromTheSecondStepOn) {
  DirectRun run(windy_scene(), tight("bdf2"));
  ClothState older = run.state;
  run.advance(1, long_step);
  for (int n = 1; n < 10; ++n) {
    const ClothState before = run.state;
    run.advance(1, long_step);
    const ClothState after = run.state;
    const Vec3Field known = combination(4.0 / 3, before.velocity, -1.0 / 3, older.velocity);
    EXPECT_LE(equation_residual(run, known, 2.0 / 3 * long_step, after.position, after.velocity, after.time),
              1e-11);
    Vec3Field position = combination(4.0 / 3, before.position, -1.0 / 3, older.position);
    add_scaled(2.0 / 3 * long_step, after.velocity, position);
    EXPECT_LE(largest_distance(after.position, position), 1e-14);
    older = before;
  }
}

TEST(ImplicitMidpoint, KeepsMomentumAndAngularMomentumOfAFreeCloth) {
  Scene scene = bare_sheet(7, 7);
  scene.springs = SpringMaterial{.structural = 500, .shear = 200, .flexion = 50};
  DirectRun run(scene, tight("implicit-midpoint"));
  run.state = waving_state(run.system, 0.1, 1);
  const Vec3 before = momentum(run.system, run.state), turning = angular_momentum(run.system, run.state);
  run.advance(100, 0.005);
  EXPECT_LE((momentum(run.system, run.state) - before).norm(), 1e-12 * before.norm());
  EXPECT_LE((angular_momentum(run.system, run.state) - turning).norm(), 1e-9 * turning.norm());
}

TEST(NewtonsMethod, IsQuadraticOnAStretchedCloth) {
  DirectRun run(smooth_scene(6, 6), tight("implicit-euler"));
  Integrator& integrator = run.integrator();
  int iterations = 0;
  for (int n = 0; n < 20; ++n) {
    const IntegratorReport report =
        integrator.step(run.forces, {n * 0.01, (n + 1) * 0.01, 0.01}, run.state, run.work);
    ASSERT_FALSE(report.failure);
    iterations = std::max(iterations, report.iterations);
    EXPECT_LE(report.residual, 1e-12 + 1e-10);
  }
  EXPECT_LE(iterations, 12);  // of a tolerance of 1e-12: a linear rate would take some forty
}

TEST(NewtonsMethod, LeavesTheSaddlesOfAFlagThatBuckles) {
  Scene scene = builtin_scene("flag");
  scene.integrator = {"implicit-midpoint", 0.01};
  Simulation simulation(scene);
  for (int n = 0; n < 120; ++n) {
    const auto stop = simulation.step();
    if (!stop) continue;
    ASSERT_FALSE(stop->solver_failed) << describe(*stop);
    EXPECT_GT(n, 80) << describe(*stop);  // its steps make energy, for which it is stopped after the buckling
    break;
  }
}

// Relaxed or along directions downhill, the second step goes around for ever: where the flag is then, the
// symmetric part of its Jacobian is indefinite.
TEST(NewtonsMethod, FindsTheLongStepsOfAFlagInWindWhichAreNoMinimum) {
  Scene scene = builtin_scene("flag");
  for (const std::string method : {"implicit-euler", "bdf2"}) {
    scene.integrator = {method, 1.0 / 60};
    Simulation simulation(scene);
    for (int n = 0; n < 15; ++n) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << method << ": " << describe(*stop);
    }
    EXPECT_EQ(simulation.count().held_normals, 0) << method;
  }
}

struct Push {
  double narrower = 0;   ///< part of the width by which the corners are nearer to each other
  double off_plane = 0;  ///< cells, at most, of every particle, at random
};

/// A sheet of 1 m x 1 m and 0.25 kg that hangs by two corners which are too near for it to be flat.
Scene pushed_sheet(int size) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.cloth.pins = std::vector<Pin>{NamedPin::top_left, NamedPin::top_right};
  scene.cloth.down = Vec3(0, -0.95, 0.3);
  scene.springs = SpringMaterial{.structural = 1000, .shear = 500, .flexion = 100};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator = {"implicit-euler", 1.0 / 60};
  return scene;
}

Preparation pushed(const Push& push) {
  return [push](ClothSystem& system, ClothState& state) {
    SplitMix random(1);
    const double cell = (*system.springs.begin()).rest_length;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      Vec3 x = state.position[i];
      x.x() *= 1 - push.narrower;
      const double part = static_cast<double>(random.bits() >> 11) * 0x1p-53;
      if (!system.pinned[i]) x.z() += push.off_plane * cell * (2 * part - 1);
      state.position.set(i, x);
    }
  };
}

constexpr Push pushes[] = {{0.15, 0.02}, {0.3, 0.05}};

/// The most iterations that one of the first steps takes, in the first of which the flat sheet snaps into its
/// folds.
long most_iterations(const Scene& scene, const Push& push, int steps) {
  Simulation simulation(scene, pushed(push));
  long most = 0, before = 0;
  for (int n = 0; n < steps; ++n) {
    if (const auto stop = simulation.step()) {
      ADD_FAILURE() << describe(*stop);
      break;
    }
    most = std::max(most, simulation.count().iterations - before);
    before = simulation.count().iterations;
  }
  return most;
}

TEST(NewtonsMethod, TakesAtMostEightIterationsAStepWhereASheetBuckles) {
  for (const int size : {9, 33, 65})
    for (const Push& push : pushes) {
      constexpr int steps = 20;
      EXPECT_LE(most_iterations(pushed_sheet(size), push, steps), 8) << size << " by " << push.narrower;
      if (size == 65) continue;
      Scene two_steps = pushed_sheet(size);
      two_steps.integrator.method = "bdf2";
      EXPECT_LE(most_iterations(two_steps, push, steps), 8) << size << " by " << push.narrower;
    }
}

/// At 1000 N/m it is the sheet above.
Scene pushed_sheet_of_stiffness(int size, double stiffness) {
  Scene scene = pushed_sheet(size);
  scene.springs = SpringMaterial{.structural = stiffness, .shear = stiffness / 2, .flexion = stiffness / 10};
  return scene;
}

TEST(NewtonsMethod, TakesAtMostEightIterationsAStepWhereASoftOrAStiffSheetBuckles) {
  for (const double stiffness : {1.0, 1e5, 3e6, 1e8})
    EXPECT_LE(most_iterations(pushed_sheet_of_stiffness(33, stiffness), pushes[0], 6), 8)
        << stiffness << " N/m";
}

// Three hundred steps of a relaxation leave the first step of these sheets on its way.
TEST(NewtonsMethod, TakesAtMostEightIterationsWhereAFineAndStiffSheetBucklesWithOrWithoutDampers) {
  Scene scene = pushed_sheet_of_stiffness(65, 1e5);
  EXPECT_LE(most_iterations(scene, pushes[0], 1), 8);
  scene.air.emplace().drag = 0.0005;
  scene.springs->damping = 0.01;
  EXPECT_LE(most_iterations(scene, pushes[0], 1), 8) << "with dampers";
}

/// The largest difference of the velocities after a step from those of a tighter tolerance, over the largest.
double farthest_from_exact(const Scene& scene, const Push& push, int steps) {
  Simulation simulation(scene, pushed(push));
  Scene tighter = scene;
  tighter.integrator.tolerance = 1e-12;
  Simulation exact(tighter, pushed(push));
  double farthest = 0;
  for (int n = 0; n < steps; ++n) {
    if (n > 0) exact.restore(simulation.checkpoint());
    if (simulation.step() || exact.step()) {
      ADD_FAILURE() << "stopped in step " << n + 1;
      break;
    }
    const Vec3Field &v = simulation.state().velocity, &better = exact.state().velocity;
    farthest = std::max(farthest, largest_distance(v, better) / largest_norm(better));
  }
  return farthest;
}

TEST(NewtonsMethod, EndsWhereATighterToleranceWouldToo) {
  for (const Push& push : pushes) EXPECT_LE(farthest_from_exact(pushed_sheet(33), push, 14), 1e-6);
  EXPECT_LE(farthest_from_exact(pushed_sheet_of_stiffness(33, 1e5), pushes[0], 8), 1e-6);
}

TEST(LimitedMemory, MapsTheLastGrowthToItsChangeAndGoesDownhill) {
  constexpr std::size_t size = 20;
  Random random;
  const LinearMap inverse = [](const Vec3Field& in, Vec3Field& out) {
    out.fill(0);
    add_scaled(0.3, in, out);
  };
  LimitedMemory memory;
  Vec3Field direction(size);
  for (int n = 0; n < 12; ++n) {
    // From a random residual along its direction; returns change and growth.
    const auto go = [&](double length, double stiffness) {
      const Vec3Field residual = random.field(size, 1);
      memory.next(residual, 0, inverse, direction);
      EXPECT_LT(dot(direction.flat(), residual.flat()), 0);
      const Vec3Field change = combination(length, direction, 0, direction);
      Vec3Field growth = random.field(size, 0.4);
      add_scaled(stiffness, change, growth);
      memory.next(combination(1, residual, 1, growth), length, inverse, direction);
      return std::pair(change, growth);
    };
    const auto [change, growth] = go(0.7, 2);
    const auto expect_its_change = [&] {
      memory.next(growth, 0, inverse, direction);
      EXPECT_LE(largest_distance(direction, combination(-1, change, 0, change)), 1e-11);
    };
    expect_its_change();
    go(0.7, -2);  // falls along the change: not kept
    expect_its_change();
  }
}

TEST(NewtonsMethod, ThatMayNotIterateEnoughStopsWithParticleAndCause) {
  Scene scene = builtin_scene("wind");
  scene.deformation.reset();
  scene.springs->structural = scene.springs->shear = 1e7;
  scene.integrator = {"implicit-euler", 0.1};
  scene.integrator.newton_iterations = 1;
  Simulation simulation(scene);
  std::optional<Divergence> stop;
  for (int n = 0; n < 20 && !stop; ++n) stop = simulation.step();
  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->solver_failed);
  EXPECT_NE(stop->cause.find("Newton's method did not converge"), std::string::npos);
  EXPECT_NE(describe(*stop).find("stopped in step"), std::string::npos);
  EXPECT_GE(stop->particle, 0);
}

TEST(LinearChoice, TakesTheCheapestAndMultigridOnlyWhereItsPrecisionAllows) {
  const auto chosen = [](int size, double stiffness) {
    Scene scene = builtin_scene("corners-free");
    scene.cloth.rows = scene.cloth.columns = size;
    scene.springs = SpringMaterial{.structural = stiffness, .shear = stiffness, .flexion = stiffness};
    return choose_linear_method(Simulation(scene).system(), {.position = 1.0 / 3600, .velocity = 1.0 / 60});
  };
  EXPECT_EQ(chosen(33, 1).method, LinearMethod::conjugate_gradients);
  EXPECT_EQ(chosen(33, 1e9).method, LinearMethod::cholesky);
  EXPECT_EQ(chosen(129, 1000).method, LinearMethod::multigrid);
  EXPECT_FALSE(chosen(129, 1e7).multigrid);
  for (const int size : {9, 65}) {
    double before = 0;
    for (double stiffness = 1; stiffness <= 1e9; stiffness *= 10) {
      const LinearChoice choice = chosen(size, stiffness);
      const double multigrid = choice.multigrid.value_or(std::numeric_limits<double>::infinity());
      const double cheapest = std::min({choice.factors, choice.gradients, multigrid});
      EXPECT_EQ(cheapest, choice.method == LinearMethod::cholesky              ? choice.factors
                          : choice.method == LinearMethod::conjugate_gradients ? choice.gradients
                                                                               : multigrid);
      EXPECT_EQ(choice.factors, chosen(size, 1).factors) << "whatever the stiffness";
      EXPECT_GE(choice.gradients, before);
      before = choice.gradients;
    }
  }
}

TEST(LinearChoice, TakesMultigridOnFineMeshesAtEveryStiffness) {
  Random random;
  const auto chosen = [&](int side, double stiffness) {
    Scene scene = material_mesh_sheet(side, side, 1, 1, 0.3, {}, random);
    scene.material.reset();
    scene.springs = SpringMaterial{.structural = stiffness, .flexion = 0.1 * stiffness};
    return choose_linear_method(Simulation(scene).system(), {.position = 1.0 / 3600, .velocity = 1.0 / 60})
        .method;
  };
  EXPECT_EQ(chosen(33, 1e-3), LinearMethod::conjugate_gradients);
  for (double stiffness = 1000; stiffness <= 1e7; stiffness *= 100) {
    EXPECT_EQ(chosen(9, stiffness), LinearMethod::cholesky);
    EXPECT_EQ(chosen(65, stiffness), LinearMethod::multigrid);
  }
}

class Implicit : public ::testing::TestWithParam<std::string> {};

TEST_P(Implicit, FinishesEveryStiffnessAtASixtiethOfASecond) {
  for (double stiffness = 1; stiffness <= 1e9; stiffness *= 10) {
    Scene scene = builtin_scene("corners-free");
    scene.cloth.rows = scene.cloth.columns = 9;
    scene.springs =
        SpringMaterial{.structural = stiffness, .shear = 0.5 * stiffness, .flexion = 0.1 * stiffness};
    scene.integrator = {GetParam(), 1.0 / 60};
    Simulation simulation(scene);
    for (int n = 0; n < 30; ++n) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << "k = " << stiffness << ": " << describe(*stop);
    }
    EXPECT_TRUE(all_finite(simulation.state())) << stiffness;
  }
}

TEST_P(Implicit, GivesTheSameBitsTwice) {
  Scene scene = windy_scene();
  scene.integrator = {GetParam(), long_step};
  const auto run = [&] {
    Simulation simulation(scene);
    for (int n = 0; n < 20; ++n) simulation.step();
    return simulation.state();
  };
  EXPECT_EQ(run(), run());
}

TEST_P(Implicit, CountsItsIterationsAndSolves) {
  Scene scene = windy_scene();
  scene.integrator = {GetParam(), long_step};
  Simulation simulation(scene);
  for (int n = 0; n < 10; ++n) ASSERT_FALSE(simulation.step());
  EXPECT_GE(simulation.count().iterations, 10);
  EXPECT_GT(simulation.count().factorisations + simulation.count().linear_iterations, 0);
  EXPECT_GE(simulation.count().force_evaluations, simulation.count().iterations + 10);
  EXPECT_LE(simulation.count().largest_residual, scene.integrator.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Method, Implicit, ::testing::Values("implicit-euler", "implicit-midpoint", "bdf2"),
                         test_name);

}  // namespace
}  // namespace cloth::test::implicit_test
