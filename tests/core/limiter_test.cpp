#include <gtest/gtest.h>

#include <cmath>

#include "cloth/grid.h"
#include "limiter/deformation_limiter.h"
#include "limiter/unreachable_rate.h"
#include "measure/strain.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::limiter_test {
namespace {

constexpr double spacing = 0.1;
constexpr double step = 0.001;

/// Two columns, two rows; the right column is moved right by `shift`, so that both horizontal springs are
/// longer by that.
struct Stretched {
  explicit Stretched(double shift, std::vector<Pin> pins = {}, double rate = 0.1) {
    scene = bare_sheet(2, 2, spacing);
    scene.springs = only(SpringFamily::structural, 100);
    scene.cloth.pins = std::move(pins);
    scene.deformation = Deformation{};
    scene.deformation->rate = rate;
    scene.deformation->solver = "sweeps";
    system = make_grid(scene.cloth, *scene.springs);
    state = starting_state(system);
    for (const std::size_t right : {1u, 3u}) state.position.add(right, {shift, 0, 0});
    before = state;
  }
  LimiterReport limit() { return DeformationLimiter(*scene.deformation, system).apply(system, step, state); }
  double moved(std::size_t i) const { return state.position[i].x() - before.position[i].x(); }

  Scene scene;
  ClothSystem system;
  ClothState state, before;
};

TEST(Limiter, MovesTwoFreeEndsByHalfTheExcessEach) {
  Stretched cloth(0.03);  // 0.02 beyond 10 %
  const LimiterReport report = cloth.limit();
  EXPECT_NEAR(cloth.moved(0), 0.01, 1e-15);
  EXPECT_NEAR(cloth.moved(1), -0.01, 1e-15);
  EXPECT_LE(report.excess, 1e-15);
  EXPECT_GE(report.sweeps, 1);
}

TEST(Limiter, MovesTheFreeEndByAllOfTheExcess) {
  Stretched cloth(0.03, {NamedPin::left_edge});
  cloth.limit();
  EXPECT_EQ(cloth.moved(0), 0);
  EXPECT_NEAR(cloth.moved(1), -0.02, 1e-15);
}

TEST(Limiter, LeavesTwoPinnedEndsAlone) {
  Stretched cloth(0.03, {NamedPin::left_edge, NamedPin::right_edge});
  const LimiterReport report = cloth.limit();
  EXPECT_EQ(cloth.state, cloth.before);
  EXPECT_EQ(report.excess, 0);  // not the limiter's to change
}

TEST(Limiter, ShortensExactlyToTheLimitAlongTheSpring) {
  Stretched cloth(0.03);
  cloth.state.position.add(1, {0, 0, 0.2});
  cloth.state.position.add(3, {0, 0, 0.2});
  cloth.limit();
  const Vec3 d = cloth.state.position[1] - cloth.state.position[0];
  EXPECT_NEAR(d.norm(), 1.1 * spacing, 1e-15);
  EXPECT_LE(d.normalized().cross(Vec3(0.13, 0, 0.2).normalized()).norm(), 1e-14);
}

TEST(Limiter, ChangesNothingBelowTheToleranceOrInCompression) {
  for (const double shift : {-0.05, 0.0, 0.0099, 0.01 + 0.5e-4 * spacing}) {
    Stretched cloth(shift);
    const DeformationLimiter limiter(*cloth.scene.deformation, cloth.system);
    EXPECT_TRUE(limiter.accepts(limiter.excess(cloth.state.position))) << shift;
  }
  Stretched beyond(0.01 + 2e-4 * spacing);
  const DeformationLimiter limiter(*beyond.scene.deformation, beyond.system);
  EXPECT_FALSE(limiter.accepts(limiter.excess(beyond.state.position)));
}

TEST(Limiter, ChangesTheVelocityByTheDisplacementOverTheStep) {
  Stretched cloth(0.03, {NamedPin::left_edge});
  cloth.state.velocity.set(1, {1, 2, 3});
  cloth.limit();
  EXPECT_LE((cloth.state.velocity[1] - (Vec3(1, 2, 3) + Vec3(-0.02, 0, 0) / step)).norm(), 1e-11);
  EXPECT_EQ(cloth.state.velocity[0].norm(), 0);
}

Scene crumpled_scene() {
  Scene scene = bare_sheet(8, 7, spacing);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
  scene.deformation = Deformation{};
  scene.deformation->solver = "sweeps";
  return scene;
}

TEST(Limiter, KeepsMomentumAmongFreeParticles) {
  Random random;
  const Scene scene = crumpled_scene();
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = crumpled_state(system, 0.03, 1, random);
  const Vec3 before = momentum(system, state);
  Vec3 centre_before = Vec3::Zero(), centre_after = Vec3::Zero();
  for (std::size_t i = 0; i < state.position.size(); ++i) centre_before += state.position[i];
  DeformationLimiter(*scene.deformation, system).apply(system, step, state);
  for (std::size_t i = 0; i < state.position.size(); ++i) centre_after += state.position[i];
  EXPECT_LE((momentum(system, state) - before).norm(), 1e-12 * system.mass.front() * 1e3);
  EXPECT_LE((centre_after - centre_before).norm(), 1e-13);
}

TEST(Limiter, LeavesNoLimitedSpringBeyondTheRateAndTolerance) {
  Random random;
  for (const double rate : {0.0, 0.05, 0.5}) {
    Scene scene = crumpled_scene();
    scene.deformation->rate = rate;
    scene.deformation->max_sweeps = 100000;
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    ClothState state = crumpled_state(system, 0.03, 0, random);
    const DeformationLimiter limiter(*scene.deformation, system);
    ASSERT_FALSE(limiter.accepts(limiter.excess(state.position)));
    DeformationLimiter working(*scene.deformation, system);
    const LimiterReport report = working.apply(system, step, state);
    const Strain strain = measure_strain(system, state.position);
    EXPECT_LE(report.excess, 1e-4);
    EXPECT_LE(strain.maximum(), rate + 1e-4 + 1e-12);
    EXPECT_NEAR(std::max(0.0, strain.maximum() - rate), report.excess, 1e-12);
  }
}

TEST(Limiter, StopsAtItsMostSweepsAndReportsTheRest) {
  Random random;
  Scene scene = crumpled_scene();
  scene.deformation->rate = 0, scene.deformation->max_sweeps = 3;
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = crumpled_state(system, 0.03, 0, random);
  DeformationLimiter limiter(*scene.deformation, system);
  const LimiterReport report = limiter.apply(system, step, state);
  EXPECT_EQ(report.sweeps, 3);
  EXPECT_GT(report.excess, 1e-4);
  EXPECT_DOUBLE_EQ(report.excess, limiter.excess(state.position));
}

TEST(Limiter, LimitsOnlyTheFamiliesItIsGiven) {
  Scene scene = crumpled_scene();
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  scene.deformation->springs = {"structural"};
  ClothState sheared = starting_state(system);
  for (std::size_t i = 0; i < sheared.position.size(); ++i)  // rows slide: diagonals stretch, rows do not
    sheared.position.add(i, {0.05 * (static_cast<int>(i) / system.columns), 0, 0});
  const double structural = DeformationLimiter(*scene.deformation, system).excess(sheared.position);
  scene.deformation->springs = {"structural", "shear"};
  const double both = DeformationLimiter(*scene.deformation, system).excess(sheared.position);
  EXPECT_NEAR(structural, std::sqrt(1.25) - 1.1, 1e-12);
  EXPECT_NEAR(both, std::sqrt((1.5 * 1.5 + 1) / 2) - 1.1, 1e-12);
}

TEST(Limiter, IsNotNeededWhereItsSpringsDoNotExist) {
  Scene scene = crumpled_scene();
  EXPECT_TRUE(DeformationLimiter::is_needed(*scene.deformation, make_grid(scene.cloth, *scene.springs)));
  EXPECT_FALSE(DeformationLimiter::is_needed(*scene.deformation, make_grid(scene.cloth, {})));
  EXPECT_FALSE(DeformationLimiter::is_needed(*scene.deformation,
                                             make_grid(scene.cloth, only(SpringFamily::flexion, 1))));
  scene.deformation->springs = {};
  EXPECT_FALSE(DeformationLimiter::is_needed(*scene.deformation, make_grid(scene.cloth, *scene.springs)));
}

/// A 4x4 sheet pinned at two opposite corners, the last one moved along the diagonal so that the pins are
/// `distance` apart.
std::optional<UnreachableRate> unreachable(double distance, const Words& limited) {
  Scene scene = bare_sheet(4, 4, spacing);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
  scene.deformation = Deformation{};
  scene.deformation->springs = limited;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::bottom_right};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  Vec3Field position = system.start;
  position.set(15, position[0] + distance * Vec3(1, -1, 0).normalized());
  return find_unreachable_rate(scene, system, position);
}

TEST(UnreachableRate, OfStructuralSpringsIsJudgedAlongRowsAndColumns) {
  const double reach = 1.1 * 6 * spacing;
  EXPECT_FALSE(unreachable(0.99 * reach, {"structural"}));
  const auto found = unreachable(1.01 * reach, {"structural"});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first, 0);
  EXPECT_EQ(found->second, 15);
  EXPECT_NEAR(found->reach, reach, 1e-12);
  EXPECT_NEAR(found->distance, 1.01 * reach, 1e-12);
}

TEST(UnreachableRate, WithShearSpringsIsJudgedAlongTheDiagonal) {
  const double reach = 1.1 * 3 * std::sqrt(2.0) * spacing;
  EXPECT_FALSE(unreachable(0.99 * reach, {"structural", "shear"}));
  const auto found = unreachable(1.01 * reach, {"structural", "shear"});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reach, reach, 1e-12);
}

TEST(UnreachableRate, IsNotSaidOfASheetAtRestOrWithoutLimits) {
  EXPECT_FALSE(unreachable(3 * std::sqrt(2.0) * spacing, {"structural", "shear"}));
  EXPECT_FALSE(unreachable(100, {}));
}

}  // namespace
}  // namespace cloth::test::limiter_test
