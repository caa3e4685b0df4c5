// Dormand-Prince with a tolerance: what its error control promises.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/builtin_scenes.h"
#include "simulation/energy_account.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::error_control_test {
namespace {

constexpr double horizon = 0.4;  // s

IntegratorChoice controlled(double tolerance) {
  IntegratorChoice choice{"dormand-prince"};
  choice.tolerance = tolerance;
  return choice;
}

TEST(ErrorControl, MakesTheErrorFallInProportionToTheTolerance) {
  const Scene scene = smooth_scene(6, 6);
  DirectRun reference(scene, "rk4");
  reference.advance(12800, horizon / 12800);
  double before = 0;
  int evaluations_before = 0;
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    DirectRun run(scene, controlled(tolerance));
    run.advance(1, horizon);
    const double error = largest_distance(run.state.position, reference.state.position) / run.system.diagonal;
    std::printf("tolerance %.0e: error %.2e diagonals, %d steps, %d rejected\n", tolerance, error,
                run.inner_steps, run.rejected_steps);
    EXPECT_LE(error, 10 * tolerance);  // the errors of all steps together
    if (before > 0) {
      EXPECT_GE(std::log10(before / error), 0.5);
      EXPECT_LE(std::log10(before / error), 1.5);
      // A tenth of the tolerance takes 10^(1/5) as many steps of a method of order 5.
      EXPECT_NEAR(static_cast<double>(run.force_evaluations) / evaluations_before, std::pow(10, 0.2), 0.35);
    }
    before = error;
    evaluations_before = run.force_evaluations;
  }
}

TEST(ErrorControl, CountsSixEvaluationsForEveryInnerStepAcceptedOrNot) {
  DirectRun run(smooth_scene(5, 5), controlled(1e-7));
  run.advance(10, 0.04);
  EXPECT_GT(run.inner_steps, 10);
  EXPECT_EQ(run.force_evaluations, 6 * (run.inner_steps + run.rejected_steps) + 1);
}

TEST(ErrorControl, CarriesItsStepSizeOverToTheNextOuterStep) {
  // Cut short by the end of every outer step, the size that is remembered stays what the error allows.
  const Scene scene = smooth_scene(5, 5);
  DirectRun whole(scene, controlled(1e-8)), parts(scene, controlled(1e-8));
  whole.advance(1, horizon);
  parts.advance(10, horizon / 10);
  EXPECT_LE(parts.inner_steps, whole.inner_steps + 10 + 5);
  EXPECT_LE(parts.rejected_steps, whole.rejected_steps + 10);
  EXPECT_LE(largest_distance(whole.state.position, parts.state.position), 1e-6);
}

TEST(ErrorControl, TakesShortOuterStepsAsOneEach) {
  DirectRun run(smooth_scene(5, 5), controlled(1e-3));
  run.advance(200, 1e-4);
  EXPECT_EQ(run.inner_steps, 200);
  EXPECT_EQ(run.rejected_steps, 0);
}

TEST(ErrorControl, IsExactWhereNothingCurves) {  // free fall: error 0, any step will do
  Scene scene = lying_sheet(4, 4);
  scene.gravity = Vec3(0, -10, 0);
  DirectRun run(scene, controlled(1e-12));
  run.advance(1, 2);
  EXPECT_EQ(run.inner_steps, 1);
  for (std::size_t i = 0; i < run.state.position.size(); ++i)
    EXPECT_NEAR(run.state.position[i].y(), -20, 1e-12);
}

TEST(ErrorControl, GivesTheSameBitsAgain) {
  const auto state = [] {
    DirectRun run(smooth_scene(6, 6), controlled(1e-6));
    run.advance(20, 0.02);
    return run.state;
  };
  EXPECT_EQ(state(), state());
}

TEST(ErrorControl, GoesOnAfterContactHasMovedTheCloth) {
  Scene scene = builtin_scene("ball");
  scene.cloth.rows = scene.cloth.columns = 9;
  scene.integrator = controlled(1e-4);
  scene.duration = 1;
  Simulation simulation(scene);
  int contacts = 0;
  while (simulation.time() < 1 - 1e-9) {
    ASSERT_FALSE(simulation.step());
    contacts += simulation.measure().contacts;
  }
  EXPECT_GT(contacts, 0);
  const StepCount& count = simulation.count();
  EXPECT_GT(count.force_evaluations, 6 * (count.inner_steps + count.rejected_steps) + 1);  // one per forget
}

/// At the bound on stiff damping the stages leave the solution: of their powers, with weights of both signs,
/// the ledger had as much as there was to exchange.
TEST(ErrorControl, BooksOfStiffDampersInWindWhatTheMotionLoses) {
  Scene scene = builtin_scene("flag-cotton");
  scene.cloth.rows = 9, scene.cloth.columns = 12;
  scene.material->stretch_damping = 0.005;
  scene.integrator = {.method = "dormand-prince", .time_step = 0.01};
  Simulation simulation(scene);
  EnergyAccount account;
  account.add(simulation.measure());
  for (int n = 0; n < 30; ++n) {
    ASSERT_FALSE(simulation.step());
    account.add(simulation.measure());
  }
  EXPECT_LT(account.share(), 0.01);
  EXPECT_GT(simulation.measure().ledger.forces.damping_loss, 0);
  EXPECT_GT(account.exchanged(), 0.01);
}

TEST(ErrorControl, GivesUpWithAReasonWhereNoStepIsShortEnough) {
  Scene scene = bare_sheet(3, 3);
  scene.springs = only(SpringFamily::structural, 10);
  scene.integrator = controlled(1e-6);
  scene.integrator.time_step = 0.01;
  Simulation simulation(scene, [](ClothSystem&, ClothState& state) {
    state.velocity.set(7, {0, std::numeric_limits<double>::quiet_NaN(), 0});
  });
  const auto divergence = simulation.step();
  ASSERT_TRUE(divergence);
  EXPECT_TRUE(divergence->solver_failed);
  EXPECT_EQ(divergence->particle, 7);  // though NaN has spread to every other
  EXPECT_NE(divergence->cause.find("error control"), std::string::npos) << divergence->cause;
}

TEST(ErrorControl, ShortensStepsUntilAStiffClothIsFollowed) {  // at 1000 times the stable step
  Scene scene = smooth_scene(5, 5);
  scene.springs->structural = scene.springs->shear = 1e6;
  DirectRun run(scene, controlled(1e-9));
  run.advance(1, 0.05);
  EXPECT_TRUE(all_finite(run.state));
  EXPECT_LE(largest_norm(run.state.velocity), 2);
  EXPECT_GT(run.inner_steps, 100);
}

}  // namespace
}  // namespace cloth::test::error_control_test
