// The history of panes in lock step: every common time is reached again with the same bits.
#include <gtest/gtest.h>

#include "compare/lockstep.h"
#include "scene/builtin_scenes.h"
#include "support/states.h"

namespace cloth::test::lockstep_history_test {
namespace {

constexpr std::size_t enough = std::size_t{64} << 20, little = 40000;  // bytes

Comparison methods_with_air() {
  Comparison comparison;
  comparison.scene = builtin_scene("wind");
  comparison.scene.cloth.rows = comparison.scene.cloth.columns = 7;
  comparison.scene.integrator = {"verlet", 0.001};
  comparison.scene.duration = 0.5;
  comparison.panes = panes_for({"verlet", "bdf2", "rk4"});
  comparison.reference = "A";
  return comparison;
}

void advance_to(LockStep& lockstep, std::int64_t index) {
  for (std::int64_t k = lockstep.index() + 1; k <= index; ++k) ASSERT_TRUE(lockstep.advance(k));
}

struct Seen {
  std::vector<ClothState> states;
  std::vector<std::optional<double>> rms, over_time;
  std::vector<double> energy_errors;
  Comparison comparison;
  bool operator==(const Seen&) const = default;
};

Seen seen(const LockStep& lockstep) {
  Seen now{
      .states = {}, .rms = {}, .over_time = {}, .energy_errors = {}, .comparison = lockstep.comparison()};
  for (std::size_t i = 0; i < lockstep.lane_count(); ++i) {
    now.states.push_back(lockstep.lane(i).state);
    now.energy_errors.push_back(lockstep.lane(i).energy.largest_error());
  }
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i) {
    const Difference* difference = lockstep.difference(i);
    now.rms.push_back(difference ? std::optional(difference->rms) : std::nullopt);
    now.over_time.push_back(lockstep.rms_over_time(i));
  }
  return now;
}

/// Advances, with an edit, a gust and a pull on the way, and looks at every common time.
std::vector<Seen> run_with_edits(LockStep& lockstep, Comparison comparison, std::int64_t last) {
  std::vector<Seen> all{seen(lockstep)};
  for (std::int64_t k = 1; k <= last; ++k) {
    EXPECT_TRUE(lockstep.advance(k));
    if (k == 3) {
      set_shared_value(comparison, "springs.structural", 260.0);
      set_own(comparison.panes[2], "integrator.time_step", 0.0005);
      lockstep.edit(comparison);
    }
    if (k == 5) lockstep.set_pull(Pull{.particle = 24, .target = {0.3, 0.2, 0.4}});
    if (k == 6) {
      set_shared_value(comparison, "springs.structural", 900.0);  // another strength of the hand
      lockstep.edit(comparison);
    }
    if (k == 7) lockstep.set_brush(BrushGust{.velocity = {3, 0, 1}});
    if (k == 9) lockstep.set_pull(std::nullopt);
    all.push_back(seen(lockstep));
  }
  return all;
}

TEST(TheHistoryOfPanes, LeadsBackToEveryCommonTimeToTheBitWithTheEditsThatWereInForce) {
  for (const std::size_t bytes : {enough, little}) {
    LockStep lockstep(methods_with_air());
    lockstep.keep_history(bytes);
    const std::vector<Seen> all = run_with_edits(lockstep, methods_with_air(), 14);
    for (const std::int64_t k : {13, 2, 6, 5, 0, 14, 3, 8}) {
      ASSERT_TRUE(lockstep.go_to(k));
      EXPECT_EQ(lockstep.index(), k);
      EXPECT_EQ(seen(lockstep), all[static_cast<std::size_t>(k)]) << k << " with " << bytes;
    }
    EXPECT_EQ(lockstep.known_index(), 14);
  }
}

TEST(TheHistoryOfPanes, IsRepeatedFromAnyTimeWithAllThatWasDone) {
  LockStep lockstep(methods_with_air());
  lockstep.keep_history(enough);
  const std::vector<Seen> all = run_with_edits(lockstep, methods_with_air(), 14);
  ASSERT_TRUE(lockstep.go_to(1));
  for (std::int64_t k = 2; k <= 14; ++k) {
    ASSERT_TRUE(lockstep.advance(k));
    EXPECT_EQ(seen(lockstep), all[static_cast<std::size_t>(k)]) << k;
  }
  advance_to(lockstep, 16);
  LockStep straight(methods_with_air());
  run_with_edits(straight, methods_with_air(), 16);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lockstep.lane(i).state, straight.lane(i).state) << i;
}

TEST(TheHistoryOfPanes, ChangesNoBitOfARun) {
  LockStep with(methods_with_air()), without(methods_with_air());
  with.keep_history(little);
  EXPECT_EQ(run_with_edits(with, methods_with_air(), 12), run_with_edits(without, methods_with_air(), 12));
}

TEST(TheHistoryOfPanes, EndsWhereAnEditBeginsANewBranch) {
  LockStep lockstep(methods_with_air()), straight(methods_with_air());
  lockstep.keep_history(enough);
  run_with_edits(lockstep, methods_with_air(), 12);
  ASSERT_TRUE(lockstep.go_to(2));
  Comparison changed = methods_with_air();
  set_shared_value(changed, "springs.shear", 400.0);
  lockstep.edit(changed);
  EXPECT_EQ(lockstep.known_index(), 2);
  advance_to(lockstep, 8);
  advance_to(straight, 2);
  straight.edit(changed);
  advance_to(straight, 8);
  EXPECT_EQ(seen(lockstep), seen(straight));
}

TEST(TheHistoryOfPanes, IsSharedByAPaneAndItsCopy) {
  LockStep lockstep(methods_with_air());
  lockstep.keep_history(enough);
  advance_to(lockstep, 4);
  Comparison comparison = methods_with_air();
  duplicate_pane(comparison, 1);
  lockstep.edit(comparison);
  advance_to(lockstep, 6);
  set_own(comparison.panes[2], "springs.structural", 50.0);
  lockstep.edit(comparison);
  advance_to(lockstep, 9);
  EXPECT_NE(lockstep.lane(2).state, lockstep.lane(1).state);
  ASSERT_TRUE(lockstep.go_to(2));
  EXPECT_EQ(lockstep.pane_count(), 4u);
  EXPECT_EQ(lockstep.lane(2).state, lockstep.lane(1).state);
  EXPECT_EQ(scene_of(lockstep.comparison(), 2), scene_of(lockstep.comparison(), 1));
  ASSERT_TRUE(lockstep.go_to(9));
  EXPECT_EQ(lockstep.comparison(), comparison);
}

TEST(TheHistoryOfPanes, KnowsWhereAPaneStoppedAndGoesOnFromBefore) {
  Comparison comparison = methods_with_air();
  comparison.scene.deformation.reset();  // a limited cloth cannot diverge
  comparison.panes = panes_for({"rk4", "explicit-euler"});
  set_own(comparison.panes[1], "integrator.time_step", 0.005);
  LockStep lockstep(comparison);
  lockstep.keep_history(enough);
  while (lockstep.lane(1).going() && lockstep.index() < lockstep.last_index())
    ASSERT_TRUE(lockstep.advance(lockstep.index() + 1));
  ASSERT_FALSE(lockstep.lane(1).going());
  const std::int64_t stop = lockstep.lane(1).index;
  const ClothState last_good = lockstep.lane(1).state;
  advance_to(lockstep, stop + 4);
  ASSERT_TRUE(lockstep.go_to(stop + 2));
  EXPECT_FALSE(lockstep.lane(1).going());
  EXPECT_EQ(lockstep.lane(1).state, last_good);
  ASSERT_TRUE(lockstep.go_to(stop - 1));
  EXPECT_TRUE(lockstep.lane(1).going());
  set_own(comparison.panes[1], "integrator.method", std::string("rk4"));
  lockstep.edit(comparison);
  advance_to(lockstep, stop + 4);
  EXPECT_TRUE(lockstep.lane(1).going());
}

/// A scene's run, taken to `steps` with its history.
RunWithHistory run_of(const Scene& scene, int steps) {
  RunWithHistory run{std::make_unique<Simulation>(scene), History()};
  run.history.begin(*run.simulation);
  for (int n = 0; n < steps; ++n) {
    EXPECT_FALSE(run.simulation->step());
    run.history.extend(*run.simulation);
    run.history.keep(*run.simulation);
  }
  return run;
}

TEST(ARunTakenOver, GoesOnInItsPanesToTheBitAndIsGivenBackSo) {
  for (const int steps : {0, 20, 33}) {  // 33: between two common times
    Scene scene = methods_with_air().scene;
    RunWithHistory alone = run_of(scene, steps);
    LockStep lockstep(scene, run_of(scene, steps));
    Comparison comparison = comparison_of_one(scene, "A");
    duplicate_pane(comparison, 0);
    ASSERT_TRUE(acts_at_once(lockstep.comparison(), comparison));
    lockstep.edit(comparison);
    EXPECT_EQ(lockstep.lane(1).state, alone.simulation->state());
    EXPECT_EQ(lockstep.time_of(lockstep.index()), alone.simulation->time());
    set_own(comparison.panes[1], "integrator.method", std::string("rk4"));
    lockstep.edit(comparison);
    const std::int64_t from = lockstep.index();
    advance_to(lockstep, from + 3);
    for (int n = 0; n < 30; ++n) ASSERT_FALSE(alone.simulation->step());
    EXPECT_EQ(lockstep.lane(0).state, alone.simulation->state()) << steps;
    EXPECT_GT(lockstep.difference(1)->rms, 0);
    ASSERT_TRUE(lockstep.go_to(0));
    EXPECT_NEAR(lockstep.lane(1).state.time, 0, 0.0101);
    EXPECT_EQ(lockstep.lane(0).state, lockstep.lane(1).state);
    ASSERT_TRUE(lockstep.go_to(from + 3));
    EXPECT_EQ(lockstep.lane(0).state, alone.simulation->state()) << steps;
    const RunWithHistory back = lockstep.release(0);
    EXPECT_EQ(back.simulation->state(), alone.simulation->state());
    EXPECT_EQ(back.history.last_step(), steps + 30);
  }
}

TEST(ARunTakenOver, MeetsAtCommonTimesAlsoWhereItsOldStepsDidNot) {
  Scene scene = methods_with_air().scene;
  scene.integrator.time_step = 0.0007;
  LockStep lockstep(scene, run_of(scene, 40));
  Comparison comparison = comparison_of_one(scene, "A");
  duplicate_pane(comparison, 0);
  set_own(comparison.panes[1], "integrator.time_step", 0.0005);
  Comparison copied = comparison_of_one(scene, "A");
  duplicate_pane(copied, 0);
  lockstep.edit(copied);
  ASSERT_TRUE(lockstep.go_to(1));  // before it was taken over
  lockstep.edit(comparison);
  advance_to(lockstep, 6);
  EXPECT_NEAR(lockstep.lane(0).state.time, lockstep.lane(1).state.time, 1e-12);
  EXPECT_NEAR(lockstep.lane(0).state.time, lockstep.time_of(6), 1e-12);
}

}  // namespace
}  // namespace cloth::test::lockstep_history_test
