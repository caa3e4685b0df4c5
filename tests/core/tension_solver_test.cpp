// The deformation rate by tensions: the rate is kept by forces that only pull, and only where a spring is at
// its limit.
#include "limiter/tension_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "cloth/grid.h"
#include "limiter/nearest_shape.h"
#include "support/hung_cloth.h"
#include "support/meshes.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::tension_solver_test {
namespace {

constexpr double step = 0.001;

TEST(TensionSolver, KeepsTheRateOfRandomlyStretchedCloths) {
  Random random;
  for (const int side : {17, 33, 65})
    for (const double rate : {0.1, 0.01, 0.001}) {
      const Hung cloth(side, rate);
      TensionSolver solver(cloth.deformation, cloth.system);
      for (const double noise : {0.0, 0.02, 0.1}) {
        if (side == 65 && noise > 0.05) continue;  // seconds
        Vec3Field x =
            stretched(cloth.system, random.uniform(0.5, 1.5) * rate, noise * cloth.spacing(), random);
        SpringTensions tension = no_tension(solver);
        const TensionReport report = solver.solve(cloth.system, step, tension, x);
        EXPECT_TRUE(report.converged) << side << " " << rate << " " << noise;
        EXPECT_LE(report.excess, cloth.deformation.tolerance);
        EXPECT_NEAR(solver.excess(x), report.excess, 1e-12);
        expect_solution(solver, cloth.deformation.tolerance, tension, x);
      }
    }
}

TEST(TensionSolver, KeepsTheRateWhateverItBeginsWith) {
  Random random;
  for (const double noise : {0.3, 1.0, 5.0}) {  // in cells: far beyond what a step does
    const Hung cloth(17, 0.01);
    TensionSolver solver(cloth.deformation, cloth.system);
    Vec3Field x = stretched(cloth.system, 1, noise * cloth.spacing(), random);
    SpringTensions tension = no_tension(solver);
    const TensionReport report = solver.solve(cloth.system, step, tension, x);
    EXPECT_TRUE(report.converged) << noise;
    expect_solution(solver, cloth.deformation.tolerance, tension, x);
  }
}

TEST(TensionSolver, LeavesPinsWhereTheyAre) {
  Random random;
  const Hung cloth(17, 0.01, {NamedPin::top_edge});
  TensionSolver solver(cloth.deformation, cloth.system);
  const Vec3Field from = stretched(cloth.system, 0.05, 0.05 * cloth.spacing(), random);
  Vec3Field x = from;
  SpringTensions tension = no_tension(solver);
  ASSERT_TRUE(solver.solve(cloth.system, step, tension, x).converged);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (cloth.system.pinned[i]) {
      EXPECT_EQ(x[i], from[i]);
    }
}

TEST(TensionSolver, KeepsTheMomentumOfAFreeCloth) {
  Random random;
  for (const double noise : {0.1, 2.0}) {  // by rounds, and by the interior point method
    Hung cloth(17, 0.01, {});
    for (std::size_t i = 0; i < cloth.system.mass.size(); ++i) {
      cloth.system.mass[i] *= random.uniform(0.5, 2);
      cloth.system.inverse_mass[i] = 1 / cloth.system.mass[i];
    }
    TensionSolver solver(cloth.deformation, cloth.system);
    const Vec3Field from = stretched(cloth.system, 0.05, noise * cloth.spacing(), random);
    Vec3Field x = from;
    SpringTensions tension = no_tension(solver);
    ASSERT_TRUE(solver.solve(cloth.system, step, tension, x).converged) << noise;
    Vec3 moved = Vec3::Zero(), turned = Vec3::Zero();
    double path = 0, area = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 change = cloth.system.mass[i] * (x[i] - from[i]);
      moved += change;
      path += change.norm();
      turned += x[i].cross(change);
      area += x[i].norm() * change.norm();
    }
    EXPECT_LE(moved.norm(), 1e-12 * path) << noise;
    EXPECT_LE(turned.norm(), (noise < 1 ? 1e-2 : 1e-3) * area) << noise;
  }
}

TEST(TensionSolver, MovesByWhatItsTensionsPull) {
  Random random;
  const Hung cloth(9, 0.1, {});
  TensionSolver solver(cloth.deformation, cloth.system);
  // The motion is small against a cell, so that directions hardly change.
  const Vec3Field from = stretched(cloth.system, 0.101, 1e-4 * cloth.spacing(), random);
  Vec3Field x = from;
  SpringTensions tension = no_tension(solver);
  ASSERT_TRUE(solver.solve(cloth.system, step, tension, x).converged);
  Vec3Field pull(x.size());
  solver.add_force(tension, x, pull);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 expected = step * step * cloth.system.inverse_mass[i] * pull[i];
    EXPECT_LE((x[i] - from[i] - expected).norm(), 0.02 * largest_distance(x, from)) << i;
  }
}

TEST(TensionSolver, FindsTheNearestShape) {
  Random random;
  for (const double rate : {0.001, 0.01, 0.1}) {
    const Hung cloth(17, rate);
    TensionSolver solver(cloth.deformation, cloth.system);
    const Vec3Field from = stretched(cloth.system, 1.02 * rate, 0.02 * cloth.spacing(), random);
    Vec3Field x = from, nearest = from;
    SpringTensions tension = no_tension(solver);
    ASSERT_TRUE(solver.solve(cloth.system, step, tension, x).converged) << rate;
    ASSERT_TRUE(NearestShape(cloth.deformation, cloth.system).find(cloth.system, 1e-7, nearest).converged);
    EXPECT_LE(rms_distance(x, nearest), 0.05 * rms_distance(from, nearest)) << rate;
  }
}

TEST(TensionSolver, FindsTheNearestShapeWhereRoundsDoNotEnd) {
  const Hung cloth(17, 0.1);
  TensionSolver solver(cloth.deformation, cloth.system);
  Random random;
  const Vec3Field from = stretched(cloth.system, 1, 2 * cloth.spacing(), random);
  Vec3Field x = from, nearest = from;
  SpringTensions tension = no_tension(solver);
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  ASSERT_TRUE(report.converged);
  ASSERT_GT(report.factorisations, 0);
  ASSERT_TRUE(NearestShape(cloth.deformation, cloth.system).find(cloth.system, 1e-7, nearest).converged);
  EXPECT_LE(rms_distance(x, nearest), 1e-3 * rms_distance(from, nearest));
}

TEST(TensionSolver, HasNothingToDoWhereTheRateIsKept) {
  const Hung cloth(17, 0.01);
  TensionSolver solver(cloth.deformation, cloth.system);
  Vec3Field x = cloth.system.start;
  SpringTensions tension = no_tension(solver);
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.rounds, 0);
  EXPECT_EQ(x, cloth.system.start);
}

TEST(TensionSolver, LetsGoOfTensionsOfSlackSprings) {
  Random random;
  const Hung cloth(17, 0.01);
  TensionSolver solver(cloth.deformation, cloth.system);
  Vec3Field x = cloth.system.start;
  std::vector<double> pulls(solver.springs().size());
  for (double& t : pulls) t = random.uniform(0, 1e-3);
  SpringTensions tension(pulls);
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  EXPECT_TRUE(report.converged);
  expect_solution(solver, cloth.deformation.tolerance, tension, x);
}

TEST(TensionSolver, HoldsNoMoreThanASpringCanTurnBy) {
  const Hung cloth(5, 0.1);
  const TensionSolver solver(cloth.deformation, cloth.system);
  std::vector<double> pulls(solver.springs().size(), 1e9);
  pulls[3] = 1e-9;
  const SpringTensions tension(pulls);
  SpringTensions held = no_tension(solver);
  solver.hold(tension, step, held);
  EXPECT_EQ(held[3], 1e-9);
  const double mass = cloth.system.mass[12];
  for (std::size_t s = 0; s < held.size(); ++s) {
    const TensionSpring& spring = solver.springs()[s];
    const bool pins = cloth.system.pinned[spring.first] && cloth.system.pinned[spring.second];
    if (s == 3) continue;
    EXPECT_NEAR(held[s], pins ? 0 : 0.5 * mass * spring.limit / (step * step), 1e-9 * held[s]);
  }
}

TEST(TensionSolver, PullsTheEndsOfASpringTogether) {
  const Hung cloth(3, 0.1);
  const TensionSolver solver(cloth.deformation, cloth.system);
  const std::size_t s = 4;
  SpringTensions tension = no_tension(solver);
  tension.write()[s] = 2;
  tension.list_held();
  Vec3Field force(cloth.system.start.size());
  solver.add_force(tension, cloth.system.start, force);
  const TensionSpring& spring = solver.springs()[s];
  const Vec3 along = (cloth.system.start[spring.second] - cloth.system.start[spring.first]).normalized();
  EXPECT_LE((force[spring.first] - 2 * along).norm(), 1e-15);
  EXPECT_LE((force[spring.second] + 2 * along).norm(), 1e-15);
  EXPECT_NEAR(largest_norm(force), 2, 1e-15);
}

TEST(TensionSolver, PullsOnAGridAsOnAnySprings) {
  Random random;
  const Hung cloth(9, 0.1);
  ClothSystem line = cloth.system;
  line.rows = 1, line.columns = cloth.system.size();  // no longer a grid
  const TensionSolver families(cloth.deformation, cloth.system), lines(cloth.deformation, line);
  SpringTensions tension = no_tension(families);
  for (double& t : tension.write()) t = std::max(0.0, random.uniform(-1, 1));
  tension.list_held();
  const Vec3Field x = stretched(cloth.system, 0.1, 0.5 * cloth.spacing(), random);
  Vec3Field one(x.size()), two(x.size());
  families.add_force(tension, x, one);
  lines.add_force(tension, x, two);
  EXPECT_LE(largest_distance(one, two), 1e-13);
}

TEST(TensionSolver, GivesTheSameBitsAgainWhateverItSolvedBefore) {
  Random random;
  const Hung cloth(33, 0.01);
  TensionSolver solver(cloth.deformation, cloth.system);
  const Vec3Field from = stretched(cloth.system, 0.02, 0.05 * cloth.spacing(), random);
  Vec3Field x = from, y = from, between = stretched(cloth.system, 0.05, 0.1 * cloth.spacing(), random);
  SpringTensions tension = no_tension(solver), again = tension, other = tension;
  solver.solve(cloth.system, step, tension, x);
  solver.solve(cloth.system, step, other, between);
  solver.solve(cloth.system, step, again, y);
  EXPECT_EQ(x, y);
  EXPECT_EQ(tension, again);
}

TEST(TensionSolver, GivesAGridTheSameAsAnySpringsWhetherFamiliesOrLinesAreSolved) {
  Random random;
  for (const bool flexion : {false, true})
    for (const auto& [rows, columns] : {std::pair{17, 17}, std::pair{9, 40}, std::pair{50, 5}}) {
      Scene scene = bare_sheet(rows, columns, 0.05);
      scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
      const ClothSystem grid = make_grid(scene.cloth, *scene.springs);
      ClothSystem line = grid;
      line.rows = 1, line.columns = grid.size();  // no longer a grid: every spring for itself
      Deformation deformation;
      deformation.rate = 0.01;
      if (flexion) deformation.springs = {"structural", "shear", "flexion"};
      TensionSolver families(deformation, grid), lines(deformation, line);
      const Vec3Field from = stretched(grid, 0.0105, 1e-5, random);
      Vec3Field x = from, y = from;
      SpringTensions tension = no_tension(families), other = tension;
      const TensionReport one = families.solve(grid, step, tension, x);
      const TensionReport two = lines.solve(line, step, other, y);
      EXPECT_TRUE(one.converged && two.converged) << rows;
      EXPECT_NEAR(one.rounds, two.rounds, 2) << rows;
      EXPECT_LE(rms_distance(x, y), 0.02 * rms_distance(x, from)) << rows;
    }
}

TEST(TensionSolver, KeepsTheRateOfMeshes) {
  Random random;
  for (const double rate : {0.1, 0.01, 0.001})
    for (const double noise : {0.02, 0.1, 1.0}) {
      const ClothSystem system = irregular_triangulation(14, 15, 100, noise < 1, random);
      Deformation deformation;
      deformation.rate = rate;
      TensionSolver solver(deformation, system);
      const double cell = solver.springs()[0].rest_length;
      const Vec3Field from = stretched(system, random.uniform(0.5, 1.5) * rate, noise * cell, random);
      Vec3Field x = from;
      SpringTensions tension = no_tension(solver);
      const TensionReport report = solver.solve(system, step, tension, x);
      EXPECT_TRUE(report.converged) << rate << " " << noise;
      expect_solution(solver, deformation.tolerance, tension, x);
      for (std::size_t i = 0; i < x.size(); ++i)
        if (system.pinned[i]) {
          EXPECT_EQ(x[i], from[i]);
        }
    }
}

TEST(TensionSolver, LinesContainEverySpringOnceAndMeetNoParticleTwice) {
  Random random;
  const Hung cloth(9, 0.1);
  for (const ClothSystem& system : {cloth.system, irregular_triangulation(9, 8, 100, true, random)}) {
    const std::vector<TensionSpring> springs = tension_springs(cloth.deformation, system);
    const SpringLines lines = spring_lines(springs, system);
    std::vector<int> seen(springs.size(), 0);
    for (const std::size_t s : lines.springs) ++seen[s];
    EXPECT_EQ(seen, std::vector<int>(springs.size(), 1));
    for (std::size_t line = 0; line < lines.count(); ++line) {
      std::vector<int> met(system.pinned.size(), 0);
      for (std::size_t k = lines.begin[line]; k < lines.begin[line + 1]; ++k) {
        const TensionSpring& spring = springs[lines.springs[k]];
        ++met[spring.first], ++met[spring.second];
      }
      int ends = 0;
      for (const int times : met) {
        EXPECT_LE(times, 2);
        ends += times == 1;
      }
      EXPECT_EQ(ends, 2);
    }
  }
  // On a grid: rows, columns and both kinds of diagonals.
  EXPECT_EQ(spring_lines(tension_springs(cloth.deformation, cloth.system), cloth.system).count(),
            9u + 9u + 15u + 15u);
}

TEST(TensionSolver, CompromisesWhereThePinsMakeTheRateUnreachable) {
  Hung cloth(17, 0.01);
  TensionSolver solver(cloth.deformation, cloth.system, true);
  Random random;
  Vec3Field x = stretched(cloth.system, 0.01, 0.01 * cloth.spacing(), random);
  x.add(16, Vec3(0.05, 0, 0));  // a pin
  SpringTensions tension = no_tension(solver);
  const Vec3Field from = x;
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.excess, cloth.deformation.tolerance);
  EXPECT_LT(report.excess, solver.excess(from));
  for (const double t : tension.values()) EXPECT_GE(t, 0);
  SpringTensions held = no_tension(solver);
  solver.hold(tension, step, held);
  EXPECT_FALSE(held.any());
  for (const double t : held.values()) EXPECT_EQ(t, 0);
}

TEST(TensionSolver, SaysThatItHasNotConvergedWhereNothingCan) {
  Hung cloth(9, 0.01);
  TensionSolver solver(cloth.deformation, cloth.system);
  SpringTensions tension = no_tension(solver);
  Vec3Field x = cloth.system.start;
  x.add(8, Vec3(0.1, 0, 0));  // a pin out of reach
  const TensionReport out_of_reach = solver.solve(cloth.system, step, tension, x);
  EXPECT_FALSE(out_of_reach.converged);
  EXPECT_GT(out_of_reach.excess, cloth.deformation.tolerance);
  EXPECT_TRUE(all_finite(x));

  tension = no_tension(solver);
  x = cloth.system.start;
  x.x()[40] = std::nan("");
  EXPECT_FALSE(solver.solve(cloth.system, step, tension, x).converged);
}

}  // namespace
}  // namespace cloth::test::tension_solver_test
