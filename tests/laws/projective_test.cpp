// Projective dynamics on grids of many particles, by a cycle of multigrid, and its accelerations.
#include <gtest/gtest.h>

#include "integrators/projective_matrix.h"
#include "integrators/registry.h"
#include "support/direct_run.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::projective_test {
namespace {

/// Of 400 particles and more, so that a cycle of multigrid solves.
Scene large_cloth() {
  Scene scene = smooth_scene(22, 21);
  scene.springs->damping = 0.02;
  return scene;
}

/// How far the velocities of a step lie from the solution of its equations, as Newton's method finds it,
/// relative to the largest.
double distance_from_implicit_euler(const Scene& scene, const IntegratorChoice& choice, double h) {
  IntegratorChoice exact{"implicit-euler"};
  exact.tolerance = 1e-13;
  Random random, same;
  DirectRun expected(scene, exact), run(scene, choice);
  expected.state = crumpled_state(expected.system, 0.01, 0.5, random);
  run.state = crumpled_state(run.system, 0.01, 0.5, same);
  expected.advance(1, h), run.advance(1, h);
  return largest_distance(run.state.velocity, expected.state.velocity) /
         largest_norm(expected.state.velocity);
}

IntegratorChoice accelerated(int iterations, const std::string& acceleration) {
  IntegratorChoice choice{"projective"};
  choice.projective_iterations = iterations;
  choice.projective_acceleration = acceleration;
  return choice;
}

const std::vector<std::string> accelerations{"chebyshev", "anderson", "l-bfgs"};

TEST(Projective, ReachesTheImplicitEulerStepWithMultigridAndWithEveryAcceleration) {
  const Scene scene = large_cloth();
  EXPECT_LT(distance_from_implicit_euler(scene, accelerated(600, "none"), 0.01), 1e-10);
  for (const std::string& acceleration : accelerations)
    EXPECT_LT(distance_from_implicit_euler(scene, accelerated(300, acceleration), 0.01), 1e-10)
        << acceleration;
}

TEST(Projective, ComesNearerWithAnAccelerationThanWithTwiceTheIterations) {
  const Scene scene = large_cloth();
  const double h = 0.05, plain = distance_from_implicit_euler(scene, accelerated(120, "none"), h);
  EXPECT_GT(plain, 1e-9) << "so that there is something to gain";
  for (const std::string& acceleration : accelerations)
    EXPECT_LT(distance_from_implicit_euler(scene, accelerated(60, acceleration), h), plain) << acceleration;
}

TEST(Projective, KeepsTheMomentumOfAFreeClothWithMultigrid) {
  Scene scene = bare_sheet(25, 24, 0.05, 0.001);
  scene.springs = SpringMaterial{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0.01};
  for (const std::string acceleration : {"none", "chebyshev", "anderson", "l-bfgs"}) {
    DirectRun run(scene, accelerated(7, acceleration));
    run.state = waving_state(run.system, 0.05, 0.3);
    const Vec3 first = momentum(run.system, run.state);
    run.advance(50, 0.02);
    EXPECT_LE((momentum(run.system, run.state) - first).norm(), 1e-11 * first.norm()) << acceleration;
  }
}

TEST(Projective, StaysBoundedWithEveryAccelerationHoweverStiff) {
  for (const std::string& acceleration : accelerations)
    for (const double stiffness : {1e3, 1e6, 1e9})
      for (const int side : {9, 22}) {  // by factors, and by multigrid
        Scene scene = smooth_scene(side, side);
        scene.springs = SpringMaterial{.structural = stiffness, .shear = stiffness, .flexion = stiffness};
        DirectRun run(scene, accelerated(10, acceleration));
        Random random;
        run.state = crumpled_state(run.system, 0.05, 1, random);
        run.advance(100, 1.0 / 60);
        EXPECT_TRUE(all_finite(run.state)) << acceleration << " " << stiffness;
        EXPECT_LT(largest_norm(run.state.position), 10) << acceleration << " " << stiffness;
      }
}

TEST(ProjectiveMatrix, IsSolvedByMultigridOnGridsWhereACycleIsGoodEnough) {
  const auto uses_multigrid = [](const Scene& scene, double h) {
    const DirectRun run(scene, accelerated(1, "none"));
    ProjectiveMatrix matrix;
    ProjectiveMatrix::Coefficients numbers;
    numbers.step = h;
    bool usable = false;
    EXPECT_EQ(matrix.prepare(run.system, numbers, &usable), 1);
    EXPECT_TRUE(usable);
    EXPECT_EQ(matrix.prepare(run.system, numbers, &usable), 0) << "nothing has changed";
    return matrix.uses_multigrid();
  };
  EXPECT_TRUE(uses_multigrid(smooth_scene(33, 33), 0.01));
  EXPECT_FALSE(uses_multigrid(smooth_scene(9, 9), 0.01)) << "too small to gain";
  Scene sheared = smooth_scene(33, 33);
  sheared.springs = SpringMaterial{.structural = 1, .shear = 8000, .flexion = 0};
  EXPECT_FALSE(uses_multigrid(sheared, 0.05));
}

}  // namespace
}  // namespace cloth::test::projective_test
