// The deformation rate where few springs are taut, which are solved for spring by spring, and where few
// become many.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "limiter/nearest_shape.h"
#include "support/hung_cloth.h"
#include "support/states.h"

namespace cloth::test::few_tensions_test {
namespace {

constexpr double step = 0.001;

/// A cloth at rest of which a part around one particle is stretched.
Vec3Field stretched_at(const ClothSystem& system, std::size_t middle, double radius, double strain,
                       Random& random) {
  Vec3Field x = system.start;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 from = system.start[i] - system.start[middle];
    if (from.norm() < radius && !system.pinned[i])
      x.add(i, strain * from + random.vector(0.01 * strain * radius));
  }
  return x;
}

TEST(FewTensions, SolvesForFewTautSpringsAndLeavesTheRestOfTheClothAsItIs) {
  Random random;
  for (const int side : {65, 129})
    for (const double rate : {0.1, 0.01}) {
      const Hung cloth(side, rate);
      TensionSolver solver(cloth.deformation, cloth.system);
      const auto middle = static_cast<std::size_t>(random.uniform(0.3, 0.7) * side * side);
      const Vec3Field from = stretched_at(cloth.system, middle, 4 * cloth.spacing(), 1.1 * rate, random);
      Vec3Field x = from, nearest = from;
      SpringTensions tension = no_tension(solver);
      const TensionReport report = solver.solve(cloth.system, step, tension, x);
      ASSERT_TRUE(report.converged) << side << " " << rate;
      ASSERT_GT(report.rounds, 0);
      EXPECT_TRUE(tension.is_few() && tension.any());
      EXPECT_NEAR(solver.excess(x), report.excess, 1e-12);
      expect_solution(solver, cloth.deformation.tolerance, tension, x);
      EXPECT_FALSE(solver.moved_from().is_everywhere());
      EXPECT_LT(solver.moved_from().particles().size(), x.size() / 10);
      for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_EQ(solver.moved_from().has(i) ? solver.moved_from()[i] : x[i], from[i]) << i;
      ASSERT_TRUE(NearestShape(cloth.deformation, cloth.system).find(cloth.system, 1e-7, nearest).converged);
      EXPECT_LE(rms_distance(x, nearest), 0.05 * rms_distance(from, nearest)) << side << " " << rate;
    }
}

TEST(FewTensions, FindsSpringsThatBecomeTautWhileItSolves) {
  // One spring is over its limit, all others of its row are just at theirs: shortening it stretches these.
  const Hung cloth(65, 0.01, {});
  TensionSolver solver(cloth.deformation, cloth.system);
  Vec3Field x = cloth.system.start;
  for (std::size_t i = 0; i < x.size(); ++i) x.x()[i] *= 1.01 - 1e-9;
  const std::size_t row = 32 * 65;
  for (std::size_t i = row + 32; i < row + 65; ++i) x.x()[i] += 0.02 * cloth.spacing();
  SpringTensions tension = no_tension(solver);
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  ASSERT_TRUE(report.converged);
  EXPECT_GT(tension.held().size(), 10u);
  EXPECT_NEAR(solver.excess(x), report.excess, 1e-12);
  expect_solution(solver, cloth.deformation.tolerance, tension, x);
}

/// Hung from its top edge, in its plane, with columns at their limits less a little; below its top row moved
/// down, so that only the springs of the first row are over their limits, and then one row after the other.
Vec3Field lowered_beside_its_limits(const Hung& cloth) {
  Vec3Field x = cloth.system.start;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double down = cloth.system.start.y()[0] - x.y()[i];
    x.y()[i] -= (cloth.deformation.rate - 1e-9) * down;
    if (!cloth.system.pinned[i]) x.y()[i] -= 0.05 * cloth.spacing();
  }
  return x;
}

TEST(FewTensions, CarriesAFrontOfTautSpringsAcrossTheCloth) {
  Hung cloth(17, 0.0, {NamedPin::top_edge});
  cloth.scene.cloth.rows = 129;
  cloth.scene.cloth.height = 8;
  cloth.system = make_grid(cloth.scene.cloth, *cloth.scene.springs);
  ClothSystem line = cloth.system;
  line.rows = 1, line.columns = cloth.system.size();  // no longer a grid
  const Vec3Field from = lowered_beside_its_limits(cloth);
  for (const ClothSystem* system : std::array<const ClothSystem*, 2>{&cloth.system, &line}) {
    TensionSolver solver(cloth.deformation, *system);
    SpringTensions tension = no_tension(solver);
    Vec3Field x = from;
    const TensionReport report = solver.solve(*system, step, tension, x);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.factorisations, 0) << "as rounds over all springs at once need none";
    EXPECT_FALSE(tension.is_few());
    expect_solution(solver, cloth.deformation.tolerance, tension, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_EQ(solver.moved_from().has(i) ? solver.moved_from()[i] : x[i], from[i]) << i;
  }
}

TEST(FewTensions, TellsWhereParticlesWereThoughItBeganAnew) {
  Random random;
  const Hung cloth(33, 0.01);
  ClothSystem line = cloth.system;
  line.rows = 1, line.columns = cloth.system.size();
  Vec3Field from = cloth.system.start;
  for (std::size_t i = 500; i < 503; ++i) from.add(i, random.vector(10 * cloth.spacing()));
  int begun_anew = 0;
  for (const ClothSystem* system : std::array<const ClothSystem*, 2>{&cloth.system, &line}) {
    TensionSolver solver(cloth.deformation, *system);
    SpringTensions tension = no_tension(solver);
    Vec3Field x = from;
    const TensionReport report = solver.solve(*system, step, tension, x);
    begun_anew += report.factorisations > 0 ? 1 : 0;
    EXPECT_TRUE(report.converged);
    expect_solution(solver, cloth.deformation.tolerance, tension, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_EQ(solver.moved_from().has(i) ? solver.moved_from()[i] : x[i], from[i]) << i;
  }
  EXPECT_GT(begun_anew, 0);
}

/// Whatever it solved before, and with tensions that a checkpoint kept.
TEST(FewTensions, GivesTheSameBitsWhereTensionsBecomeManyAndFewAgain) {
  Random random;
  const Hung cloth(33, 0.1);
  TensionSolver solver(cloth.deformation, cloth.system);
  SpringTensions tension = no_tension(solver);
  std::vector<bool> few;
  for (const double strain : {0.0, 0.11, 0.0, 0.0, 0.11}) {
    Vec3Field x = strain > 0 ? stretched(cloth.system, strain, 0.01 * cloth.spacing(), random)
                             : stretched_at(cloth.system, 33 * 16 + 16, 2.5 * cloth.spacing(), 0.12, random);
    TensionSolver other(cloth.deformation, cloth.system);
    SpringTensions kept(tension.values());
    Vec3Field y = x;
    ASSERT_TRUE(solver.solve(cloth.system, step, tension, x).converged);
    ASSERT_TRUE(other.solve(cloth.system, step, kept, y).converged);
    EXPECT_EQ(x, y);
    EXPECT_EQ(tension, kept);
    few.push_back(tension.is_few());
    EXPECT_EQ(std::vector<std::uint32_t>(tension.held().begin(), tension.held().end()),
              std::vector<std::uint32_t>(kept.held().begin(), kept.held().end()));
    if (strain == 0) tension.clear();  // as a step does that finds no spring over its limit
  }
  EXPECT_EQ(few, (std::vector<bool>{true, false, false, true, false}));
}

TEST(FewTensions, GivesSpringsBetweenTwoPinsNoTension) {
  Random random;
  const Hung cloth(33, 0.01, {NamedPin::top_edge});
  TensionSolver solver(cloth.deformation, cloth.system);
  SpringTensions tension = no_tension(solver);
  tension.write()[3] = 1e-3;  // in the top row
  tension.list_held();
  ASSERT_TRUE(cloth.system.pinned[solver.springs()[3].first] &&
              cloth.system.pinned[solver.springs()[3].second]);
  Vec3Field x = stretched_at(cloth.system, 33 * 16 + 16, 3 * cloth.spacing(), 0.02, random);
  for (std::size_t i = 0; i < 33; ++i) x.x()[i] *= 1.5;  // pins where no spring between them can be kept
  for (std::size_t i = 33; i < x.size(); ++i) x.x()[i] *= 1 + 0.5 * std::pow(1 - double(i / 33) / 32, 40.0);
  const TensionReport report = solver.solve(cloth.system, step, tension, x);
  EXPECT_GT(report.rounds, 0);
  EXPECT_EQ(tension[3], 0);
}

TEST(FewTensions, PullsByFewTensionsAsByAll) {
  Random random;
  const Hung cloth(33, 0.1);
  const TensionSolver solver(cloth.deformation, cloth.system);
  const Vec3Field x = stretched(cloth.system, 0.1, 0.5 * cloth.spacing(), random);
  SpringTensions few = no_tension(solver);
  for (int k = 0; k < 40; ++k)
    few.write()[static_cast<std::size_t>(random.uniform(0, 1) * double(few.size() - 1))] =
        random.uniform(0, 2);
  few.list_held();
  ASSERT_TRUE(few.is_few());
  std::vector<double> pulls = few.values();
  for (double& t : pulls) t += 1e-300;
  const SpringTensions many(pulls);
  ASSERT_FALSE(many.is_few());
  SparseField sparse, whole;
  sparse.clear(x.size()), whole.clear(x.size());
  solver.add_force(few, x, sparse);
  solver.add_force(many, x, whole);
  EXPECT_FALSE(sparse.is_everywhere());
  EXPECT_TRUE(whole.is_everywhere());
  EXPECT_LE(largest_distance(sparse.values(), whole.values()), 1e-14);
  SpringTensions held = few, all = many;
  solver.hold(few, 0.1, held), solver.hold(many, 0.1, all);
  for (std::size_t s = 0; s < few.size(); ++s) ASSERT_NEAR(held[s], all[s], 1e-299) << s;
}

}  // namespace
}  // namespace cloth::test::few_tensions_test
