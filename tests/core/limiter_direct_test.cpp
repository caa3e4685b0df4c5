// The direct solver of the deformation rate: it finds the nearest shape, in bounded work.
#include <gtest/gtest.h>

#include <cmath>

#include "cloth/grid.h"
#include "limiter/deformation_limiter.h"
#include "limiter/unreachable_rate.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::limiter_direct_test {
namespace {

constexpr double spacing = 0.1;
constexpr double step = 0.001;

Scene limited_sheet(int rows, int columns, double rate, double tolerance = 1e-6) {
  Scene scene = bare_sheet(rows, columns, spacing);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
  scene.deformation = Deformation{};
  scene.deformation->rate = rate;
  scene.deformation->tolerance = tolerance;
  scene.deformation->solver = "direct";
  return scene;
}

/// The largest component of w (x - x0) + J^T multipliers over free particles, in m; the masses are equal.
double largest_residual(const ClothSystem& system, const NearestShape& nearest, const Vec3Field& from,
                        const Vec3Field& to) {
  Vec3Field residual(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) residual.set(i, to[i] - from[i]);
  for (std::size_t s = 0; s < nearest.springs().size(); ++s) {
    const TensionSpring& spring = nearest.springs()[s];
    const Vec3 pull = nearest.multipliers()[s] * (to[spring.second] - to[spring.first]).normalized();
    residual.add(spring.first, -pull);
    residual.add(spring.second, pull);
  }
  for (std::size_t i = 0; i < to.size(); ++i)
    if (system.pinned[i]) residual.set(i, Vec3::Zero());
  return largest_norm(residual);
}

TEST(NearestShape, FulfilsTheConditionsOfTheNearestPoint) {
  Random random;
  for (const double rate : {0.001, 0.01, 0.1}) {
    Scene scene = limited_sheet(9, 8, rate);
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    const Vec3Field from = crumpled_state(system, 0.02, 0, random).position;
    NearestShape nearest(*scene.deformation, system);
    Vec3Field to = from;
    const NearestShapeReport report = nearest.find(system, 1e-9, to);
    ASSERT_TRUE(report.converged) << rate;
    EXPECT_LE(report.excess, 1e-9);
    EXPECT_LE(largest_residual(system, nearest, from, to), 1e-8);  // M (x - x0) = -J^T multipliers
    int taut = 0;
    for (std::size_t s = 0; s < nearest.springs().size(); ++s) {
      const TensionSpring& spring = nearest.springs()[s];
      EXPECT_GE(nearest.multipliers()[s], 0);
      const double slack = spring.limit - (to[spring.second] - to[spring.first]).norm();
      EXPECT_LE(std::abs(nearest.multipliers()[s] * slack), 1e-10);  // m^2
      taut += nearest.multipliers()[s] > 1e-6;
    }
    EXPECT_GT(taut, 10);
    for (const std::size_t pin : {0u, 7u}) EXPECT_EQ(to[pin], from[pin]);
  }
}

/// Dykstra's alternating projections: slow, simple, and convergent to the nearest point.
Vec3Field nearest_by_dykstra(const ClothSystem& system, const std::vector<TensionSpring>& springs,
                             Vec3Field x, int sweeps) {
  std::vector<Vec3> left(springs.size(), Vec3::Zero()), right = left;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const auto& [i, j, rest_length, limit] = springs[s];
      const Vec3 a = x[i] + left[s], b = x[j] + right[s];
      const Vec3 d = b - a;
      const bool free_i = !system.pinned[i], free_j = !system.pinned[j];
      const double over = std::max(0.0, d.norm() - limit) / ((free_i ? 1 : 0) + (free_j ? 1 : 0));
      const Vec3 shift = over > 0 ? Vec3(over * d.normalized()) : Vec3(Vec3::Zero());
      if (free_i) x.set(i, a + shift), left[s] = a - x[i];
      if (free_j) x.set(j, b - shift), right[s] = b - x[j];
    }
  }
  return x;
}

TEST(NearestShape, IsThatOfDykstrasAlternatingProjections) {
  Random random;
  Scene scene = limited_sheet(2, 5, 0.1);
  scene.cloth.pins = {NamedPin::top_left, PinnedParticle{1, 4}};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const Vec3Field from = crumpled_state(system, 0.03, 0, random).position;
  NearestShape nearest(*scene.deformation, system);
  Vec3Field found = from;
  ASSERT_TRUE(nearest.find(system, 1e-10, found).converged);
  const Vec3Field expected = nearest_by_dykstra(system, nearest.springs(), from, 20000);
  EXPECT_GT(largest_distance(from, found), 0.01);
  EXPECT_LE(largest_distance(expected, found), 1e-7);
}

/// Hung by two corners, and stretched downward by 20 %, with noise.
ClothState overstretched(const ClothSystem& system, Random& random) {
  ClothState state = starting_state(system);
  const double cell = (state.position[1] - state.position[0]).norm();
  const Vec3 top = state.position[0];
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (system.pinned[i]) continue;
    const Vec3 from_top = state.position[i] - top;
    state.position.set(i, top + Vec3(from_top.x(), 1.2 * from_top.y(), 0) + random.vector(0.05 * cell));
  }
  return state;
}

TEST(DirectSolver, ReachesAMillionthOnSixtyFiveSquareByTwoCornersInFortyIterations) {
  Random random;
  for (const double rate : {0.1, 0.01}) {
    Scene scene = limited_sheet(65, 65, rate);
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    ClothState state = overstretched(system, random);
    DeformationLimiter limiter(*scene.deformation, system);
    const double before = limiter.excess(state.position);
    EXPECT_GT(before, 0.09);
    const LimiterReport report = limiter.apply(system, step, state);
    std::printf("rate %g: excess %.3g -> %.3g in %d iterations\n", rate, before, report.excess,
                report.direct_iterations);
    EXPECT_LE(report.excess, 1e-6);
    EXPECT_LE(report.direct_iterations, 40);
    EXPECT_EQ(report.sweeps, 0);
    EXPECT_TRUE(all_finite(state));
  }
}

TEST(DirectSolver, KeepsRatesDownToZero) {
  Random random;
  for (const double rate : {0.0, 0.001, 0.01}) {
    Scene scene = limited_sheet(17, 17, rate);
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    ClothState state = overstretched(system, random);
    const LimiterReport report = DeformationLimiter(*scene.deformation, system).apply(system, step, state);
    EXPECT_LE(report.excess, 1e-6) << rate;
    EXPECT_LE(report.direct_iterations, NearestShape::max_iterations) << rate;
  }
}

TEST(DirectSolver, KeepsMomentumAndPushesWithoutTorque) {
  Random random;
  const Scene scene = limited_sheet(8, 7, 0.05, 1e-8);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = crumpled_state(system, 0.03, 1, random);
  const ClothState before = state;
  const LimiterReport report = DeformationLimiter(*scene.deformation, system).apply(system, step, state);
  ASSERT_LE(report.excess, 1e-8);
  const double scale = largest_distance(before.position, state.position) / step * system.mass.front();
  EXPECT_LE((momentum(system, state) - momentum(system, before)).norm(), 1e-10 * scale);
  // Pulls act along springs where these are afterwards: the change of velocity has no torque there. What is
  // left of the change of angular momentum is that old velocities are carried to new places.
  ClothState pushed = state;
  for (std::size_t i = 0; i < pushed.velocity.size(); ++i)
    pushed.velocity.set(i, state.velocity[i] - before.velocity[i]);
  EXPECT_GT(scale, 0.01);
  EXPECT_LE(angular_momentum(system, pushed).norm(), 1e-6 * scale);
}

TEST(DirectSolver, GivesTheSameBitsForTheSameState) {
  Random random;
  Scene scene = limited_sheet(12, 12, 0.02);
  scene.cloth.pins = {NamedPin::top_left};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const ClothState start = crumpled_state(system, 0.02, 1, random);
  const ClothState other = crumpled_state(system, 0.03, 1, random);
  DeformationLimiter once(*scene.deformation, system), again(*scene.deformation, system);
  ClothState a = start, b = start, between = other;
  once.apply(system, step, a);
  again.apply(system, step, between);  // nothing of this may be remembered
  again.apply(system, step, b);
  EXPECT_EQ(a, b);
}

TEST(DirectSolver, PutsAParticleBetweenTwoPinsWhereBothReachIt) {
  Scene scene = limited_sheet(2, 3, 0.1);
  scene.deformation->springs = {"structural"};
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 2}, NamedPin::bottom_edge};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = starting_state(system);
  state.position.set(1, state.position[4] + Vec3(0.3, 0.05, 0.2));
  const Vec3Field from = state.position;
  const LimiterReport report = DeformationLimiter(*scene.deformation, system).apply(system, step, state);
  EXPECT_LE(report.excess, 1e-6);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (i != 1) {
      EXPECT_EQ(state.position[i], from[i]);
    }
}

TEST(DirectSolver, MeetsHalfwayBetweenPinsOutOfReach) {
  Scene scene = limited_sheet(2, 3, 0.1);
  scene.deformation->springs = {"structural"};
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 2}};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = starting_state(system);
  const Vec3 middle = state.position[1];
  state.position.add(0, {-0.1, 0, 0});  // 0.4 m apart, reach 0.22 m
  state.position.add(2, {0.1, 0, 0});
  state.position.add(1, {0.05, 0.02, 0.01});
  const LimiterReport report = DeformationLimiter(*scene.deformation, system).apply(system, step, state);
  EXPECT_LE(report.direct_iterations, NearestShape::max_iterations * NearestShape::max_rounds);
  EXPECT_LE((state.position[1] - middle).norm(), 1e-4);
  EXPECT_NEAR(report.excess, 0.9, 1e-3);
  EXPECT_TRUE(all_finite(state));
}

/// A sheet whose right corner has been carried off and pinned there.
Scene carried_off() {
  Scene scene = builtin_scene("corners-shear");
  scene.cloth.rows = scene.cloth.columns = 9;
  scene.cloth.pins = {NamedPin::top_left};
  scene.integrator.time_step = 0.001;
  scene.gravity = Vec3(20, 0, 0);
  scene.deformation.reset();
  scene.springs = SpringMaterial{.structural = 2, .shear = 1, .flexion = 0, .damping = 0.01};
  return scene;
}

TEST(DirectSolver, StaysFiniteAndSaysSoWherePinsAreOutOfReach) {
  for (const char* solver : {"direct", "auto"}) {
    Scene scene = carried_off();
    Simulation simulation(scene);
    while (simulation.time() < 0.5) ASSERT_FALSE(simulation.step());
    scene.cloth.pins.push_back(NamedPin::bottom_right);
    scene.deformation = Deformation{};
    scene.deformation->solver = solver;
    simulation.edit(scene);
    ASSERT_TRUE(simulation.unreachable_rate()) << solver;
    for (int n = 0; n < 20; ++n) {
      simulation.step();
      EXPECT_TRUE(all_finite(simulation.state())) << solver;
      EXPECT_GT(simulation.measure().limiter_excess, 1e-3) << solver;
    }
  }
}

/// At a rate of 0 no shape lies within the permitted ones: sweeps approach it ever more slowly.
LimiterReport limit_to_rate_zero(const char* solver) {
  Random random;
  Scene scene = limited_sheet(9, 9, 0);
  scene.deformation->solver = solver;
  scene.deformation->max_sweeps = 500;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = overstretched(system, random);
  return DeformationLimiter(*scene.deformation, system).apply(system, step, state);
}

TEST(DirectSolver, KeepsARateThatSweepsDoNot) {
  const LimiterReport swept = limit_to_rate_zero("sweeps");
  EXPECT_EQ(swept.sweeps, 500);
  EXPECT_GT(swept.excess, 1e-6);
  const LimiterReport solved = limit_to_rate_zero("direct");
  EXPECT_GT(solved.direct_iterations, 0);
  EXPECT_LE(solved.excess, 1e-6);
}

TEST(EverySolver, RepeatsTheSameBitsAfterRestore) {
  for (const char* solver : {"sweeps", "direct", "auto"}) {
    Scene scene = builtin_scene("corners-shear");
    scene.cloth.rows = scene.cloth.columns = 13;
    scene.deformation->rate = 0.01;
    scene.deformation->solver = solver;
    scene.integrator.time_step = 0.001;
    Simulation simulation(scene);
    while (simulation.time() < 0.1) ASSERT_FALSE(simulation.step());
    const Checkpoint checkpoint = simulation.checkpoint();
    std::int64_t work = 0;
    const auto run = [&] {
      for (int n = 0; n < 50; ++n) {
        EXPECT_FALSE(simulation.step());
        work += simulation.last_limit().sweeps + simulation.last_limit().direct_iterations;
      }
    };
    run();
    EXPECT_GT(work, 0) << solver;
    const ClothState first = simulation.state();
    simulation.restore(checkpoint);
    run();
    EXPECT_EQ(simulation.state(), first) << solver;
  }
}

std::optional<UnreachableRate> judged(Scene scene, const std::vector<std::pair<std::size_t, Vec3>>& moved) {
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  Vec3Field position = system.start;
  for (const auto& [particle, by] : moved) position.add(particle, by);
  return find_unreachable_rate(scene, system, position);
}

TEST(UnreachableRate, IsSaidOfTwoPinsWithOneSpringBetween) {
  Scene scene = limited_sheet(3, 3, 0.1);
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 1}};
  EXPECT_FALSE(judged(scene, {{1, Vec3(0.009, 0, 0)}}));
  const auto found = judged(scene, {{1, Vec3(0.011, 0, 0)}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reach, 0.11, 1e-12);
}

TEST(UnreachableRate, CountsEachSideOfARectangularCellByItsOwnLength) {
  Scene scene = limited_sheet(4, 4, 0);
  scene.cloth.width = 0.6, scene.cloth.height = 0.3;  // cells of 0.2 x 0.1 m
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{1, 3}};
  const double chain = 2 * 0.2 + std::hypot(0.2, 0.1);
  const Vec3 along = Vec3(0.6, -0.1, 0).normalized();
  const Vec3 at = Vec3(0.6, -0.1, 0);
  EXPECT_FALSE(judged(scene, {{7, 0.999 * chain * along - at}}));
  const auto found = judged(scene, {{7, 1.001 * chain * along - at}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reach, chain, 1e-12);
}

TEST(UnreachableRate, OfShearSpringsAloneIsJudgedOnTheirColour) {
  Scene scene = limited_sheet(4, 4, 0);
  scene.springs->structural = 0;
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 1}};  // of different colours: no chain
  EXPECT_FALSE(judged(scene, {{1, Vec3(100, 0, 0)}}));
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 2}};
  EXPECT_FALSE(judged(scene, {{2, Vec3(0.05, 0, 0)}}));
  const auto found = judged(scene, {{2, Vec3(0.1, 0, 0)}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reach, 2 * spacing * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace cloth::test::limiter_direct_test
