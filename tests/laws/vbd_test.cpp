// VBD beyond what local_methods_test.cpp asks of it: every kind of element, colours, the paths by the kernels
// and one by one, the semi-iteration, and what it says where numbers fail.
#include "integrators/vbd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "measure/energy.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::vbd_test {
namespace {

IntegratorChoice vbd(int iterations, const char* acceleration = "chebyshev") {
  IntegratorChoice choice{"vbd"};
  choice.vbd_iterations = iterations;
  choice.vbd_acceleration = acceleration;
  return choice;
}

Scene stiff_sheet(int rows, int columns, double damping) {
  Scene scene = bare_sheet(rows, columns, 0.05, 0.002);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 300, .shear = 100, .flexion = 30, .damping = damping};
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

/// What a step of `h` seconds from a crumpled state leaves of the equations.
double left_of_the_equations(DirectRun& run, double h, double crumple) {
  Random random;
  run.state = crumpled_state(run.system, crumple, 0.2, random);
  return left_of_the_step_equations(run, h);
}

// ---- every kind of element ----

TEST(Vbd, SolvesTheStepEquationsOfAMaterialsGridWithDampingAirAndHysteresis) {
  Scene scene = complete_material_scene();
  DirectRun plain(scene, vbd(4000, "none")), accelerated(scene, vbd(2000));
  EXPECT_FALSE(plain.system.bending.empty());
  EXPECT_LE(left_of_the_equations(plain, 2e-3, 1e-3), 1e-8);
  EXPECT_LE(left_of_the_equations(accelerated, 2e-3, 1e-3), 1e-8);
  scene.material = material_with_hysteresis();
  DirectRun lagging(scene, vbd(2000));
  EXPECT_FALSE(lagging.system.sliders.empty());
  EXPECT_LE(left_of_the_equations(lagging, 2e-3, 1e-3), 1e-8);
}

TEST(Vbd, SolvesTheStepEquationsOfAMaterialsMesh) {
  Random random;
  for (const Material& material : {any_material(), material_with_hysteresis()}) {
    Scene scene = material_mesh_sheet(9, 7, 0.3, 0.2, 0.15, material, random);
    scene.gravity = Vec3(0, 0, -9.81);
    scene.cloth.pins = {PinnedParticle{0, 0}};
    scene.air = Air{.wind = {0.5, 0.2, 2}, .gust = std::nullopt};
    DirectRun run(scene, vbd(3000));
    EXPECT_FALSE(run.system.membrane.empty());
    EXPECT_LE(left_of_the_equations(run, 1e-3, 5e-4), 1e-8);
  }
}

TEST(Vbd, SolvesTheStepEquationsOfAMeshOfSprings) {
  Random random;
  Scene scene = bare_sheet(2, 2);
  scene.springs = SpringMaterial{.structural = 1, .shear = 0, .flexion = 0, .damping = 0.02};
  scene.gravity = Vec3(0, -9.81, 0);
  DirectRun run(irregular_triangulation(12, 9, 80, true, random), scene, vbd(400));
  EXPECT_LE(left_of_the_equations(run, 5e-3, 0.01), 1e-8);
}

// ---- colours ----

/// Particles that share an element, by the elements themselves.
std::vector<std::set<int>> neighbours_in(const ClothSystem& system) {
  std::vector<std::set<int>> neighbours(system.mass.size());
  const auto join = [&](const std::vector<int>& together) {
    for (const int i : together)
      for (const int j : together)
        if (i != j) neighbours[static_cast<std::size_t>(i)].insert(j);
  };
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    if (run.stiffness > 0) join({static_cast<int>(i), static_cast<int>(j)});
  });
  for (const BendingRun& run : system.bending)
    for (int e = run.first; e < run.first + run.count; ++e) {
      std::vector<int> points;
      for (int p = 0; p < run.points; ++p) points.push_back(e + run.offset[static_cast<std::size_t>(p)]);
      join(points);
    }
  for (const BendingSlider& s : system.sliders) join({s.particle.begin(), s.particle.begin() + s.points});
  for (const MembraneTriangle& t : system.membrane) join({t.corner.begin(), t.corner.end()});
  return neighbours;
}

void expect_colours(const ClothSystem& system, std::size_t most) {
  ParticleElements elements(system);
  elements.list();
  const auto neighbours = neighbours_in(system);
  std::vector<int> colour_of(system.mass.size(), -1);
  for (std::size_t c = 0; c < elements.colours().size(); ++c)
    for (const int i : elements.colours()[c]) {
      EXPECT_EQ(colour_of[static_cast<std::size_t>(i)], -1) << "visited twice: " << i;
      colour_of[static_cast<std::size_t>(i)] = static_cast<int>(c);
    }
  for (std::size_t i = 0; i < colour_of.size(); ++i) {
    EXPECT_GE(colour_of[i], 0) << "never visited: " << i;
    for (const int j : neighbours[i]) EXPECT_NE(colour_of[i], colour_of[static_cast<std::size_t>(j)]);
  }
  EXPECT_LE(elements.colours().size(), most);
}

TEST(Colours, ArePassedOnceByEachParticleAndSharedByNoTwoOfAnElement) {
  Random random;
  expect_colours(DirectRun(stiff_sheet(7, 11, 0), vbd(1)).system, 5);
  expect_colours(DirectRun(complete_material_scene(), vbd(1)).system, 5);
  expect_colours(shuffled_grid(9, 8, random), 13);
  expect_colours(irregular_triangulation(9, 8, 10, false, random), 24);
  expect_colours(
      DirectRun(material_mesh_sheet(9, 7, 0.3, 0.2, 0.15, material_with_hysteresis(), random), vbd(1)).system,
      60);
}

TEST(Colours, OfAGridAreThoseOfItsRowsAndColumns) {
  const Scene scene = stiff_sheet(6, 9, 0);
  DirectRun run(scene, vbd(1));
  ParticleElements elements(run.system);
  elements.list();
  for (std::size_t colour = 0; colour < 5; ++colour)
    for (const int i : elements.colours().at(colour))
      EXPECT_EQ((i / 9 + 2 * (i % 9)) % 5, static_cast<int>(colour));
}

// ---- the two paths ----

/// The same springs, but one by one: no kernel knows such a cloth.
void list_springs_one_by_one(DirectRun& run) {
  std::vector<SpringRun> single;
  for_each_spring(run.system.springs, [&](const SpringRun& of, std::size_t, std::size_t i, std::size_t) {
    SpringRun one = of;
    one.first = static_cast<int>(i), one.count = 1;
    single.push_back(one);
  });
  run.system.springs = SpringRuns(single);
  run.forces.system_changed();
}

TEST(Vbd, GoesTheSameWayByTheKernelsAndOneByOne) {
  for (const double damping : {0.0, 0.02})
    for (const char* acceleration : {"none", "chebyshev"}) {
      Scene scene = stiff_sheet(13, 17, damping);
      scene.damping = 0.001;
      DirectRun by_kernels(scene, vbd(8, acceleration)), one_by_one(scene, vbd(8, acceleration));
      list_springs_one_by_one(one_by_one);
      for (DirectRun* run : {&by_kernels, &one_by_one}) {
        Random random;
        run->state = crumpled_state(run->system, 0.01, 0.3, random);
        run->forces.set_pull(Pull{.particle = 100, .target = {0.4, -0.3, 0.4}}, 20, 0.01);
        run->advance(10, 4e-3);
      }
      const double moved = largest_norm(one_by_one.state.velocity);
      EXPECT_LE(largest_distance(by_kernels.state.velocity, one_by_one.state.velocity), 1e-8 * moved)
          << damping << " " << acceleration;
      EXPECT_NEAR(by_kernels.work.pull, one_by_one.work.pull, 1e-8 * std::abs(one_by_one.work.pull));
      EXPECT_NE(by_kernels.state.velocity, one_by_one.state.velocity) << "one path alone was taken";
    }
}

TEST(Vbd, GivesTheSameBitsWithAnyNumberOfThreads) {
  for (const bool has_air : {false, true}) {
    Scene scene = stiff_sheet(40, 40, 0.005);
    scene.damping = 0.001;
    if (has_air) scene.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = std::nullopt};
    scene.integrator = vbd(5);
    scene.integrator.time_step = 2e-3;
    Simulation one(scene), two(scene);
    two.set_threads(2, ThreadUse::always);
    ASSERT_FALSE(one.advance(30));
    ASSERT_FALSE(two.advance(30));
    EXPECT_TRUE(one.state() == two.state()) << has_air;
  }
}

// ---- invariants ----

TEST(Vbd, KeepsTheMomentumOfAFreeClothAsFarAsItIsConverged) {
  Scene scene = bare_sheet(6, 6, 0.2, 0.01);
  scene.springs = SpringMaterial{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0.01};
  const auto lost_with = [&](int iterations) {
    DirectRun run(scene, vbd(iterations));
    run.state = waving_state(run.system, 0.05, 0.3);
    const Vec3 first = momentum(run.system, run.state);
    run.advance(20, 0.01);
    return (momentum(run.system, run.state) - first).norm() / first.norm();
  };
  const double coarse = lost_with(10), fine = lost_with(100);
  EXPECT_LT(coarse, 0.2);
  EXPECT_LT(fine, 1e-3 * coarse);
  EXPECT_LT(lost_with(1000), 1e-11);
}

TEST(Vbd, GivesNoEnergyToAnUndampedClothThatFalls) {
  for (const double step : {1e-3, 1e-2})
    for (const int iterations : {5, 20, 100}) {
      Scene scene = stiff_sheet(9, 9, 0);
      DirectRun run(scene, vbd(iterations));
      Random random;
      run.state = crumpled_state(run.system, 0.005, 0, random);
      const auto energy = [&] { return measure_energy(run.system, *scene.gravity, run.state).total(); };
      const double first = energy();
      double most = first;
      for (int n = 0; n < 200; ++n) run.advance(1, step), most = std::max(most, energy());
      EXPECT_LE(most, first + 1e-12) << step << " " << iterations;
    }
}

// ---- the semi-iteration ----

/// The distance of one step's velocities from those of 4000 iterations, over the largest speed.
double distance_from_the_end(const Scene& scene, const IntegratorChoice& choice, double h) {
  const auto end_of = [&](const IntegratorChoice& way) {
    DirectRun run(scene, way);
    Random random;
    run.state = crumpled_state(run.system, 0.002, 0.2, random);
    run.advance(1, h);
    return run.state.velocity;
  };
  const Vec3Field exact = end_of(vbd(6000));
  return largest_distance(end_of(choice), exact) / largest_norm(exact);
}

TEST(Chebyshev, HarmsNoEasyStepAndGainsOnStiffOnes) {
  const Scene scene = stiff_sheet(17, 17, 0);
  EXPECT_LE(distance_from_the_end(scene, vbd(12), 5e-4),
            1.1 * distance_from_the_end(scene, vbd(12, "none"), 5e-4));
  for (const double h : {4e-3, 1.0 / 60})
    EXPECT_LE(distance_from_the_end(scene, vbd(100), h),
              0.1 * distance_from_the_end(scene, vbd(100, "none"), h))
        << h;
}

TEST(Chebyshev, FindsTheRadiusOfALinearIteration) {
  for (const double radius : {0.3, 0.8, 0.93, 0.99}) {
    // One error that a plain iteration shrinks by `radius`; the extrapolation is the method's.
    ChebyshevWeights weights;
    double before = 1, now = 1;
    int iterations = 0;
    while (std::abs(now) > 1e-9 && iterations < 5000) {
      const double plain = radius * now, weight = weights.next((plain - now) * (plain - now));
      const double next = before + weight * (plain - before);
      before = now, now = next, ++iterations;
    }
    const double plain_needs = std::log(1e-9) / std::log(radius);
    EXPECT_LE(iterations, radius < 0.5 ? plain_needs + 1 : 0.7 * plain_needs) << radius;
    EXPECT_LE(weights.radius(), ChebyshevWeights::largest_radius);
    EXPECT_NEAR(weights.radius(), std::min(radius, ChebyshevWeights::largest_radius), 0.05) << radius;
  }
}

TEST(Chebyshev, StopsWhereMovesGrow) {
  ChebyshevWeights weights;
  for (const double move : {1.0, 0.9, 0.8, 0.75, 0.7, 0.66}) weights.next(move * move);
  ASSERT_GT(weights.next(0.62 * 0.62), 1);
  const double radius = weights.radius();
  weights.next(0.6 * 0.6), weights.next(0.58 * 0.58);
  EXPECT_EQ(weights.next(4), 1);
  EXPECT_LT(weights.radius(), radius);
}

// ---- what it says where numbers fail ----

TEST(Vbd, NamesAParticleWhoseEquationHasNoFiniteSolution) {
  for (const bool one_by_one : {false, true}) {
    const Scene scene = stiff_sheet(6, 6, 0);
    const IntegratorChoice choice = vbd(5);
    DirectRun run(scene, choice);
    if (one_by_one) list_springs_one_by_one(run);
    run.state.position.set(20, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    const auto method = make_integrator(choice);
    const IntegratorReport report = method->step(run.forces, {0, 0.01, 0.01}, run.state, run.work);
    ASSERT_TRUE(report.failure) << one_by_one;
    EXPECT_FALSE(report.failure->cause.empty());
    EXPECT_GE(report.failure->particle, 0);
    EXPECT_LT(report.failure->particle, 36);
  }
}

TEST(Vbd, ReportsWhatItsLastIterationStillChanges) {
  const Scene scene = stiff_sheet(9, 9, 0);
  double before = std::numeric_limits<double>::infinity();
  for (const int iterations : {2, 10, 50}) {
    const IntegratorChoice choice = vbd(iterations);
    DirectRun run(scene, choice);
    Random random;
    run.state = crumpled_state(run.system, 0.005, 0.2, random);
    const auto method = make_integrator(choice);
    const IntegratorReport report = method->step(run.forces, {0, 0.005, 0.005}, run.state, run.work);
    EXPECT_EQ(report.iterations, iterations);
    EXPECT_LT(report.residual, 0.5 * before);
    EXPECT_GT(report.residual, 0);
    before = report.residual;
  }
  EXPECT_LT(before, 1e-6);
}

}  // namespace
}  // namespace cloth::test::vbd_test
