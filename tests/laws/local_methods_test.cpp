// The methods that solve the implicit Euler step by local solves: projective dynamics, XPBD and VBD.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "integrators/registry.h"
#include "measure/amplification.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/implicit_euler_step.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::local_methods_test {
namespace {

constexpr double g = 9.81;

IntegratorChoice projective(int iterations) {
  IntegratorChoice choice{"projective"};
  choice.projective_iterations = iterations;
  return choice;
}

IntegratorChoice xpbd(int substeps, int iterations) {
  IntegratorChoice choice{"xpbd"};
  choice.substeps = substeps;
  choice.xpbd_iterations = iterations;
  return choice;
}

IntegratorChoice vbd(int iterations, const char* acceleration = "chebyshev") {
  IntegratorChoice choice{"vbd"};
  choice.vbd_iterations = iterations;
  choice.vbd_acceleration = acceleration;
  return choice;
}

// ---- the implicit Euler step ----

Scene hanging_cloth(double viscous, double spring_damping) {
  Scene scene = bare_sheet(5, 5, 0.1, 0.01);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 60, .shear = 30, .flexion = 10, .damping = spring_damping};
  if (viscous > 0) scene.damping = viscous;
  scene.gravity = Vec3(0, -g, 0);
  return scene;
}

/// The largest distance of one step's velocities from those of implicit Euler, relative to the largest speed.
double step_error(const Scene& scene, const IntegratorChoice& choice, double h) {
  Random random;
  DirectRun run(scene, choice);
  run.state = crumpled_state(run.system, 0.01, 0.5, random);
  const Vec3Field expected = ImplicitEulerStep(scene, run.system, run.state, h).velocity();
  run.advance(1, h);
  return largest_distance(run.state.velocity, expected) / largest_norm(expected);
}

TEST(Projective, ConvergesToTheImplicitEulerStepAtAGeometricRate) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  std::map<int, double> error;
  for (const int n : {5, 10, 20, 40, 80, 160}) error[n] = step_error(scene, projective(n), 0.01);
  for (const int n : {5, 10, 20, 40}) EXPECT_LT(error[2 * n], 0.5 * error[n]) << n;
  const double early = std::pow(error[40] / error[20], 1.0 / 20);
  const double late = std::pow(error[80] / error[40], 1.0 / 40);
  EXPECT_NEAR(early, late, 0.05);
  EXPECT_LT(error[160], 1e-12);
}

TEST(Xpbd, ConvergesToTheImplicitEulerStep) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  std::map<int, double> error;
  for (const int n : {1, 5, 10, 20, 40}) error[n] = step_error(scene, xpbd(1, n), 0.01);
  EXPECT_LT(error[5], 0.1 * error[1]);
  EXPECT_LT(error[10], 0.1 * error[5]);
  EXPECT_LT(error[20], 0.1 * error[10]);
  EXPECT_LT(error[40], 1e-12);
}

TEST(Vbd, ConvergesToTheImplicitEulerStep) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  for (const char* acceleration : {"none", "chebyshev"}) {
    std::map<int, double> error;
    for (const int n : {1, 5, 10, 20, 40}) error[n] = step_error(scene, vbd(n, acceleration), 0.01);
    std::printf("vbd, %s:", acceleration);
    for (const auto& [n, of] : error) std::printf(" %d: %.1e", n, of);
    std::printf("\n");
    EXPECT_LT(error[5], 0.3 * error[1]);
    EXPECT_LT(error[10], 0.1 * error[5]);
    EXPECT_LT(error[20], 0.1 * error[10]);
    EXPECT_LT(error[40], 1e-8);
  }
}

TEST(LocalMethods, ConvergeToTheImplicitEulerStepWithEitherDampingAndWithNone) {
  for (const double viscous : {0.0, 0.05})
    for (const double along : {0.0, 0.05}) {
      const Scene scene = hanging_cloth(viscous, along);
      EXPECT_LT(step_error(scene, projective(400), 0.005), 1e-12) << viscous << " " << along;
      EXPECT_LT(step_error(scene, xpbd(1, 200), 0.005), 1e-12) << viscous << " " << along;
      EXPECT_LT(step_error(scene, vbd(100, "none"), 0.005), 1e-12) << viscous << " " << along;
      EXPECT_LT(step_error(scene, vbd(100), 0.005), 1e-12) << viscous << " " << along;
    }
}

BrushGust brush_in_front() {
  BrushGust brush;
  brush.velocity = {0, 0, 3};
  brush.cursor = {0.4, -0.6};
  brush.radius = 0.5;
  return brush;
}

Scene with_spring_damping() {
  Scene scene = smooth_scene(6, 6);
  scene.springs->damping = 0.05;
  return scene;
}

/// The brush in front of the cloth, which hangs as seen, and a particle pulled away from it.
void lay_hands_on(ForceModel& forces) {
  forces.set_brush(brush_in_front());
  forces.set_pull(Pull{.particle = 20, .target = {0.5, -0.8, 0.3}}, 3, 0.02);
}

/// What a step of h seconds leaves of the equations of implicit Euler, N s.
void expect_step_equations(DirectRun& run, double h, const std::string& method) {
  const ClothState start = run.state;
  run.advance(1, h);
  Vec3Field force(start.position.size());
  run.forces.update(run.state.position, h);
  run.forces.force(run.state.position, run.state.velocity, force);
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (run.system.pinned[i]) continue;
    const Vec3 gained = run.state.velocity[i] - start.velocity[i];
    EXPECT_LE((run.system.mass[i] * gained - h * force[i]).norm(), 1e-14) << method << " " << i;
  }
}

/// Of a crumpled cloth of 6 x 6 particles.
void expect_the_step_equations_to_hold(const Scene& scene, const IntegratorChoice& choice) {
  Random random;
  DirectRun run(scene, choice);
  run.state = crumpled_state(run.system, 0.02, 0.5, random);
  lay_hands_on(run.forces);
  expect_step_equations(run, 0.01, choice.method);
}

TEST(LocalMethods, SolveTheStepEquationsWithEveryForceAndTheHand) {
  expect_the_step_equations_to_hold(with_spring_damping(), projective(300));
  Scene rubbed = with_spring_damping();
  for (const double friction : {0.0, 2 * rubbed.air->drag}) {
    rubbed.air->skin_friction = friction;
    expect_the_step_equations_to_hold(rubbed, vbd(200, "none"));
    expect_the_step_equations_to_hold(rubbed, vbd(100));
  }
}

/// The same of a mesh of 11 x 13 particles in an irregular triangulation, whose springs the kernels visit by
/// colours.
void expect_the_step_equations_to_hold_on_a_mesh(const IntegratorChoice& choice, double damping) {
  Random random;
  Scene scene = bare_sheet(2, 2);
  scene.springs = SpringMaterial{.structural = 60, .shear = 0, .flexion = 6, .damping = damping};
  scene.gravity = Vec3(0, -g, 0);
  scene.damping = 0.001;
  DirectRun run(irregular_triangulation(11, 13, 60, true, random), scene, choice);
  run.state = crumpled_state(run.system, 0.01, 0.5, random);
  run.forces.set_pull(Pull{.particle = 20, .target = {0.5, -0.8, 0.3}}, 3, 0.02);
  expect_step_equations(run, 0.004, choice.method);
}

TEST(LocalMethods, SolveTheStepEquationsOfAMesh) {
  for (const double damping : {0.0, 0.005}) {
    expect_the_step_equations_to_hold_on_a_mesh(xpbd(1, 600), damping);
    expect_the_step_equations_to_hold_on_a_mesh(vbd(600, "none"), damping);
    expect_the_step_equations_to_hold_on_a_mesh(vbd(300), damping);
  }
}

TEST(Xpbd, KeepsTheMomentumOfAFreeMeshHoweverFarFromConverged) {
  Random random;
  for (const IntegratorChoice& choice : {xpbd(1, 1), xpbd(4, 3)}) {
    Scene scene = bare_sheet(2, 2);
    scene.springs = SpringMaterial{.structural = 2000, .shear = 0, .flexion = 200, .damping = 0.01};
    DirectRun run(irregular_triangulation(12, 14, 2000, false, random), scene, choice);
    run.state = crumpled_state(run.system, 0.01, 0.5, random);
    const Vec3 first = momentum(run.system, run.state);
    run.advance(100, 0.02);
    EXPECT_LE((momentum(run.system, run.state) - first).norm(), 1e-12 * first.norm());
  }
}

// Exactly: a pendulum of two particles below two pins, as in oscillator_test.
TEST(LocalMethods, MultiplyTheDampedOscillatorAsImplicitEulerDoes) {
  constexpr double stiffness = 40, mass = 0.1, amplitude = 0.01;
  const double omega = std::sqrt(stiffness / mass);
  for (const IntegratorChoice& choice : {projective(400), xpbd(1, 50), vbd(50, "none"), vbd(60)})
    for (const double ratio : {0.0, 0.1, 1.0})
      for (const double w : {0.1, 1.0}) {
        Scene scene = bare_sheet(2, 2, 0.5, mass);
        scene.cloth.pins = {NamedPin::top_edge};
        scene.springs = only(SpringFamily::structural, stiffness);
        if (ratio > 0) scene.damping = 2 * ratio * omega * mass;
        DirectRun run(scene, choice);
        for (const std::size_t i : {2u, 3u}) run.state.position.add(i, {0, amplitude, 0});
        const Eigen::Matrix2d factor = amplification_matrix(choice.method, w, ratio);
        Eigen::Vector2d expected(amplitude, 0);  // (x, h v)
        for (int n = 0; n < 20; ++n) {
          run.advance(1, w / omega);
          expected = factor * expected;
          ASSERT_NEAR(run.state.position[2].y() + 0.5, expected[0], 1e-14) << choice.method << " " << ratio;
          ASSERT_NEAR(run.state.velocity[2].y() * w / omega, expected[1], 1e-14) << choice.method;
        }
      }
}

// ---- order ----

struct Solution {
  ClothState state;
  Work work;
};

Solution solve(const IntegratorChoice& choice, int steps) {
  constexpr double horizon = 0.4;  // s
  DirectRun run(with_spring_damping(), choice);
  lay_hands_on(run.forces);
  run.advance(steps, horizon / steps);
  return {run.state, run.work};
}

/// Every observed order from `first` steps on.
void expect_order_one(const IntegratorChoice& choice, int first) {
  static const Solution exact = solve({"rk4"}, 1600);
  std::map<std::string, std::vector<double>> errors;
  for (int k = 0; k < 3; ++k) {
    const auto [state, work] = solve(choice, first << k);
    errors["position"].push_back(rms_distance(state.position, exact.state.position));
    errors["velocity"].push_back(rms_distance(state.velocity, exact.state.velocity));
    errors["damping loss"].push_back(std::abs(work.damping_loss - exact.work.damping_loss));
    errors["air"].push_back(std::abs(work.air - exact.work.air));
    errors["brush"].push_back(std::abs(work.brush - exact.work.brush));
    errors["pull"].push_back(std::abs(work.pull - exact.work.pull));
  }
  for (const auto& [what, error] : errors)
    for (std::size_t k = 1; k < error.size(); ++k)
      EXPECT_NEAR(std::log2(error[k - 1] / error[k]), 1, 0.1)
          << choice.method << " " << what << " " << error[k];
}

TEST(Projective, IsOfOrderOneWithEveryForceTheHandAndTheirWork) {
  expect_order_one(projective(10), 800);
}

TEST(Vbd, IsOfOrderOneWithEveryForceTheHandAndTheirWork) {
  expect_order_one(vbd(5, "none"), 800);
  expect_order_one(vbd(10), 800);
}

TEST(Xpbd, IsOfOrderOneWithEveryForceTheHandAndTheirWork) {
  expect_order_one(xpbd(4, 1), 200);
  expect_order_one(xpbd(1, 5), 800);
}

// ---- laws ----

TEST(LocalMethods, FallAsImplicitEulerDoesWhateverTheSpringDamping) {
  for (const IntegratorChoice& choice : {projective(10), xpbd(4, 2), vbd(1), vbd(10)})
    for (const double damping : {0.0, 0.01, 1.0, 100.0}) {
      Scene scene = lying_sheet(6, 5, 0.1, 0.01);
      scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = damping};
      scene.gravity = Vec3(0, -g, 0);
      DirectRun run(scene, choice);
      const int steps = 100;
      const double h = 0.01, inner = choice.method == "xpbd" ? h / 4 : h, n = steps * h / inner;
      run.advance(steps, h);
      const Vec3 fall(0, -0.5 * g * inner * inner * n * (n + 1), 0);
      for (std::size_t i = 0; i < run.state.position.size(); ++i) {
        ASSERT_LE((run.state.position[i] - run.system.start[i] - fall).norm(), 1e-12) << choice.method;
        ASSERT_LE((run.state.velocity[i] - Vec3(0, -g * steps * h, 0)).norm(), 1e-12) << choice.method;
      }
    }
}

TEST(ProjectiveAndXpbd, KeepTheMomentumOfAFreeClothHoweverFarFromConverged) {
  for (const IntegratorChoice& choice : {projective(1), projective(10), xpbd(1, 1), xpbd(4, 3)}) {
    Scene scene = bare_sheet(6, 6, 0.2, 0.01);
    scene.springs = SpringMaterial{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0.01};
    DirectRun run(scene, choice);
    run.state = waving_state(run.system, 0.05, 0.3);
    const Vec3 first = momentum(run.system, run.state);
    run.advance(200, 0.02);
    EXPECT_LE((momentum(run.system, run.state) - first).norm(), 1e-12 * first.norm()) << choice.method;
  }
}

TEST(LocalMethods, GiveTheSameBitsTwice) {
  for (const IntegratorChoice& choice : {projective(10), xpbd(4, 2), vbd(5)}) {
    DirectRun one(with_spring_damping(), choice), other(with_spring_damping(), choice);
    one.advance(50, 0.01), other.advance(50, 0.01);
    EXPECT_EQ(one.state, other.state) << choice.method;
  }
}

const std::vector<IntegratorChoice> few_iterations{projective(1), projective(10),  xpbd(10, 1), xpbd(1, 20),
                                                   vbd(1),        vbd(10, "none"), vbd(20)};

/// Nothing faster than a cloth of a metre can be in its place: bounded through 2 s of steps of 1/60 s.
void expect_bounded(DirectRun& run, double speed, double reach, const std::string& what) {
  for (int n = 0; n < 120; ++n) {
    run.advance(1, 1.0 / 60);
    ASSERT_TRUE(all_finite(run.state)) << what << " step " << n;
  }
  EXPECT_LE(largest_norm(run.state.velocity), speed) << what;
  EXPECT_LE(largest_norm(run.state.position), reach) << what;
}

Scene stiff_cloth(double stiffness) {
  Scene scene = bare_sheet(8, 8, 0.15, 0.01);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs =
      SpringMaterial{.structural = stiffness, .shear = stiffness / 2, .flexion = stiffness / 4, .damping = 0};
  scene.gravity = Vec3(0, -g, 0);
  return scene;
}

TEST(LocalMethods, StayBoundedFromDegenerateStartsAtAnyStiffness) {
  for (const IntegratorChoice& choice : few_iterations)
    for (const double stiffness : {1e1, 1e4, 1e9}) {
      const std::string what = choice.method + " " + std::to_string(stiffness);
      DirectRun collapsed(stiff_cloth(stiffness), choice);
      for (std::size_t i = 0; i < collapsed.state.position.size(); ++i)
        if (!collapsed.system.pinned[i]) collapsed.state.position.set(i, {0.3, -0.3, 0});
      expect_bounded(collapsed, 20, 5, what + " collapsed");

      Random random;
      DirectRun scrambled(stiff_cloth(stiffness), choice);
      scrambled.state = crumpled_state(scrambled.system, 0.3, 10, random);
      expect_bounded(scrambled, 20, 5, what + " scrambled");

      DirectRun shrunk(stiff_cloth(stiffness), choice);
      for (SpringBlock& block : shrunk.system.springs.blocks()) block.run.rest_length = 0;
      shrunk.forces.system_changed();
      expect_bounded(shrunk, 20, 5, what + " without rest length");
    }
}

TEST(LocalMethods, StayBoundedInAnyWind) {
  for (const IntegratorChoice& choice : few_iterations)
    for (const double wind : {10.0, 100.0, 1000.0}) {
      Scene scene = stiff_cloth(200);
      scene.springs->damping = 0.01;
      scene.air = Air{.drag = 0.05, .wind = {0.2 * wind, 0, wind}, .gust = Gust{1.0, 1.3}};
      DirectRun run(scene, choice);
      expect_bounded(run, 2.5 * wind, 5 + 0.05 * wind, choice.method + " " + std::to_string(wind));
    }
}

// W^-1 = m I + c n n^T with a negative c.
TEST(Xpbd, StaysBoundedInAnyWindWithMoreSkinFrictionThanDrag) {
  for (const IntegratorChoice& choice : {xpbd(10, 1), xpbd(1, 20)})
    for (const double wind : {10.0, 100.0, 1000.0}) {
      Scene scene = stiff_cloth(200);
      scene.air =
          Air{.drag = 0.05, .skin_friction = 0.1, .wind = {0.2 * wind, 0, wind}, .gust = Gust{1.0, 1.3}};
      DirectRun run(scene, choice);
      expect_bounded(run, 2.5 * wind, 5 + 0.05 * wind, std::to_string(wind));
    }
}

TEST(LocalMethods, FollowTheHandOfALoopWithStepsBeyondAnyExplicitLimit) {
  for (const IntegratorChoice& choice : {projective(10), xpbd(10, 1), vbd(30)}) {
    Scene scene = stiff_cloth(1e4);
    scene.integrator = choice;
    scene.integrator.time_step = 0.01;
    scene.damping = 0.05;
    Simulation simulation(scene);
    const Vec3 target(0.5, -0.7, 0.4);  // within the reach of the pins
    simulation.set_pull(Pull{.particle = 60, .target = target});
    for (int n = 0; n < 300; ++n) ASSERT_FALSE(simulation.step()) << choice.method;
    EXPECT_LT((simulation.state().position[60] - target).norm(), 0.02) << choice.method;
    EXPECT_GT(simulation.measure().ledger.forces.pull, 0) << choice.method;
  }
}

TEST(Projective, FactorsOnceAndAgainWhenTheStepOrTheHandChanges) {
  const Scene scene = smooth_scene(5, 5);
  const auto method = make_integrator(projective(7));
  DirectRun run(scene, "verlet");  // for its system and forces
  const auto step = [&](double h) { return method->step(run.forces, {0, h, h}, run.state, run.work); };
  EXPECT_EQ(step(0.01).factorisations, 1);
  const IntegratorReport report = step(0.01);
  EXPECT_EQ(report.factorisations, 0);
  EXPECT_EQ(report.iterations, 7);
  EXPECT_EQ(report.force_evaluations, 8);  // and one at the end for the work
  EXPECT_GT(report.residual, 0);
  EXPECT_LT(report.residual, 0.1);
  EXPECT_EQ(step(0.02).factorisations, 1);
  run.forces.set_pull(Pull{.particle = 7, .target = {0, 0, 0}}, 5, 0.1);
  EXPECT_EQ(step(0.02).factorisations, 1);
  run.forces.set_pull(Pull{.particle = 7, .target = {1, 0, 0}}, 5, 0.1);
  EXPECT_EQ(step(0.02).factorisations, 0);  // the hand moves, its spring stays
  run.forces.set_pull(std::nullopt, 0, 0);
  EXPECT_EQ(step(0.02).factorisations, 1);
  run.system.mass[12] *= 2, run.system.inverse_mass[12] /= 2;
  run.forces.system_changed();
  EXPECT_EQ(step(0.02).factorisations, 1);
}

TEST(Projective, ReachesTheImplicitEulerStepWithEveryAccelerationByFactorsToo) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  for (const char* acceleration : {"chebyshev", "anderson", "l-bfgs"}) {
    IntegratorChoice choice = projective(120);
    choice.projective_acceleration = acceleration;
    EXPECT_LT(step_error(scene, choice, 0.01), 1e-11) << acceleration;
  }
}

TEST(Xpbd, LeavesOutSpringsWithoutStiffnessHoweverHeavyTheCloth) {
  for (const double mass : {1e-9, 1e9}) {
    Scene scene = bare_sheet(3, 3, 0.1, mass);
    scene.springs = only(SpringFamily::structural, 50 * mass);
    DirectRun weak(scene, xpbd(1, 10)), none(scene, xpbd(1, 10));
    for (DirectRun* run : {&weak, &none}) run->state.position.add(4, {0.02, 0, 0});
    for (SpringBlock& block : none.system.springs.blocks()) block.run.stiffness = 0;
    none.forces.system_changed();
    weak.advance(1, 0.01), none.advance(1, 0.01);
    EXPECT_LT(weak.state.velocity[4].x(), -1e-3) << mass;
    EXPECT_EQ(none.state.velocity[4].x(), 0) << mass;
  }
}

}  // namespace
}  // namespace cloth::test::local_methods_test
