// Panes side by side: what each does is what it would do alone.
#include "compare/lockstep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "compare/comparison_json.h"
#include "compare/comparison_report.h"
#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "support/files.h"
#include "support/scenes.h"
#include "support/states.h"
#include "support/xml.h"

namespace cloth::test::lockstep_test {
namespace {

Comparison comparison_of(const Scene& scene, const std::vector<std::string>& methods, double time_step) {
  Comparison comparison;
  comparison.scene = scene;
  comparison.scene.integrator.time_step = time_step;
  comparison.scene.duration = 0.3;
  comparison.panes = panes_for(methods);
  return comparison;
}

ComparisonRun run_in(const TemporaryFolder& folder, const Comparison& comparison, int threads = 1) {
  return run_comparison(comparison,
                        {.folder = folder.path(), .threads = threads, .progress = {}, .may_go_on = {}});
}

/// A pane's recording without the one column that differs between repeats.
CsvTable rows_of(const TemporaryFolder& folder, const std::string& file) {
  return without_column(parse_csv(content_of(folder / file)), "step_time_us");
}

void expect_same(const CsvTable& a, const CsvTable& b) {
  EXPECT_EQ(a.header, b.header);
  EXPECT_EQ(a.rows, b.rows);
}

TEST(LockStep, OfOneMethodTwiceHasNoDifferenceToTheBit) {
  for (const char* method : {"verlet", "rk4", "dormand-prince", "bdf2", "projective"}) {
    Comparison comparison = comparison_of(smooth_scene(6, 5), {method, method}, 0.002);
    comparison.reference = "A";
    LockStep lockstep(comparison);
    for (std::int64_t k = 1; k <= lockstep.last_index(); ++k) ASSERT_TRUE(lockstep.advance(k));
    ASSERT_TRUE(lockstep.difference(1));
    EXPECT_EQ(lockstep.difference(1)->rms, 0) << method;
    EXPECT_EQ(lockstep.difference(1)->largest, 0) << method;
    EXPECT_EQ(*lockstep.rms_over_time(1), 0) << method;
    EXPECT_EQ(lockstep.lane(0).state, lockstep.lane(1).state);
    EXPECT_FALSE(lockstep.difference(0)) << "the reference is not compared with itself";
  }
}

/// A hand that tugs: the steps of "auto" become shorter in the midst of an interval, whose rest has a length
/// of its own.
TEST(LockStep, OfPanesWhoseStepsBecomeShorterMeetsAtItsCommonTimes) {
  Comparison comparison;
  comparison.scene = builtin_scene("wind");
  comparison.scene.cloth.rows = comparison.scene.cloth.columns = 9;
  comparison.panes = panes_for({"verlet", "rk4"});
  int shortened = 0;
  for (int first = 0; first < 12; ++first) {
    LockStep lockstep(comparison);
    for (std::int64_t k = 1; k <= 40; ++k) {
      const double far = 0.3 * static_cast<double>((7 * k + first) % 10);
      if (k % 2 == first % 2) lockstep.set_pull(Pull{.particle = 40, .target = {far, 0, 0}});
      ASSERT_TRUE(lockstep.advance(k));
      for (std::size_t i = 0; i < 2; ++i)
        if (lockstep.lane(i).going()) {
          EXPECT_NEAR(lockstep.lane(i).state.time, lockstep.time_of(k), 1e-9) << first << ", " << i;
        }
    }
    shortened += !lockstep.lane(0).simulation->step_changes().empty();
  }
  EXPECT_GT(shortened, 0);
}

TEST(LockStep, RecordsOfEachPaneWhatItsSceneRecordsAlone) {
  for (const char* scene : {"pendulum", "ball", "flag"}) {
    Comparison comparison =
        comparison_of(builtin_scene(scene), {"verlet", "semi-implicit-euler", "rk4"}, 0.001);
    comparison.scene.integrator.time_step.reset();
    comparison.scene.duration = 0.1;
    comparison.reference = "none";
    set_own(comparison.panes[1], "integrator.time_step", 0.00025);
    const TemporaryFolder together, alone;
    run_in(together, comparison);
    for (std::size_t i = 0; i < 3; ++i) {
      run_scene(scene_of(comparison, i), {.folder = alone.path(), .progress = {}});
      expect_same(rows_of(together, comparison.panes[i].name + ".csv"), rows_of(alone, "record.csv"));
    }
  }
}

TEST(LockStep, RanksByErrorAsTheOrdersOfTheMethodsSay) {
  const Comparison comparison =
      comparison_of(smooth_scene(6, 5), {"semi-implicit-euler", "verlet", "rk4"}, 0.002);
  const TemporaryFolder folder;
  const ComparisonRun run = run_in(folder, comparison);
  const std::vector<std::size_t> order = ranked(run.panes);
  EXPECT_EQ(order, std::vector<std::size_t>({2, 1, 0}));
  EXPECT_EQ(run.panes[2].error_rank, 1);
  EXPECT_LT(100 * *run.panes[2].rms, *run.panes[1].rms);
  EXPECT_LT(5 * *run.panes[1].rms, *run.panes[0].rms);
  EXPECT_LT(*run.panes[2].rms_over_time, *run.panes[1].rms_over_time);
  for (const PaneResult& pane : run.panes) {
    EXPECT_GE(*pane.largest, *pane.rms);
    EXPECT_GT(pane.cost_rank, 0);
  }
}

TEST(AControlledReference, IsAsGoodAsItsCheckSays) {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"dormand-prince", "rk4"}, 0.01);
  set_own(comparison.panes[0], "integrator.tolerance", 1e-13);
  set_own(comparison.panes[1], "integrator.time_step", 0.0001);
  LockStep lockstep(comparison);
  for (std::int64_t k = 1; k <= lockstep.last_index(); ++k) lockstep.advance(k);
  ASSERT_TRUE(lockstep.floor());
  EXPECT_GT(lockstep.floor()->rms, 0);
  EXPECT_LT(lockstep.floor()->rms, 1e-7);
  EXPECT_LT(lockstep.difference(0)->rms, lockstep.floor()->rms);
  EXPECT_TRUE(results_of(lockstep)[0].below_floor);
  EXPECT_LT(lockstep.difference(1)->rms, 2 * lockstep.floor()->rms);
}

TEST(LockStep, HalvesTheErrorOfAFirstOrderMethodWithItsStep) {
  Comparison comparison =
      comparison_of(smooth_scene(6, 5), {"semi-implicit-euler", "semi-implicit-euler"}, 0.001);
  set_own(comparison.panes[1], "integrator.time_step", 0.0005);
  const TemporaryFolder folder;
  const ComparisonRun run = run_in(folder, comparison);
  EXPECT_NEAR(*run.panes[0].rms / *run.panes[1].rms, 2, 0.1);
}

TEST(LockStep, MeasuresTheDistanceOfEachParticle) {
  Comparison comparison = comparison_of(smooth_scene(5, 4), {"verlet", "rk4"}, 0.002);
  comparison.reference = "B";
  LockStep lockstep(comparison);
  for (std::int64_t k = 1; k <= 20; ++k) lockstep.advance(k);
  const Difference& difference = *lockstep.difference(0);
  const Vec3Field &a = lockstep.lane(0).state.position, &b = lockstep.lane(1).state.position;
  EXPECT_DOUBLE_EQ(difference.rms, rms_distance(a, b));
  EXPECT_DOUBLE_EQ(difference.largest, largest_distance(a, b));
  const auto particle = static_cast<std::size_t>(difference.particle);
  EXPECT_DOUBLE_EQ((a[particle] - b[particle]).norm(), difference.largest);
  ASSERT_EQ(difference.distance.size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_FLOAT_EQ(difference.distance[i], static_cast<float>((a[i] - b[i]).norm()));
}

/// The second pane's step is far beyond what Verlet stands.
Comparison with_a_bad_pane() {
  Comparison comparison = comparison_of(smooth_scene(6, 5), {"verlet", "verlet", "rk4"}, 0.002);
  comparison.scene.record.interval = 0.05;
  comparison.scene.duration = 1;
  set_own(comparison.panes[1], "integrator.time_step", 0.05);
  return comparison;
}

TEST(APaneThatDiverges, StopsWithItsCauseAtItsLastGoodStateAndLeavesTheOthersAlone) {
  const Comparison comparison = with_a_bad_pane();
  Comparison sound = comparison;
  remove_pane(sound, 1);
  const TemporaryFolder with, without;
  const ComparisonRun run = run_in(with, comparison);
  run_in(without, sound);
  expect_same(rows_of(with, "A.csv"), rows_of(without, "A.csv"));
  expect_same(rows_of(with, "C.csv"), rows_of(without, "C.csv"));

  const PaneResult& bad = run.panes[1];
  ASSERT_TRUE(bad.divergence);
  EXPECT_EQ(bad.status, Status::diverged);
  EXPECT_NE(describe(*bad.divergence).find("particle"), std::string::npos);
  EXPECT_LT(bad.simulated, run.panes[0].simulated);
  EXPECT_FALSE(bad.rms);
  EXPECT_EQ(bad.error_rank, 0);
  EXPECT_EQ(bad.cost_rank, 0);
  EXPECT_EQ(ranked(run.panes).back(), 1u);
  EXPECT_EQ(run.panes[0].status, Status::finished);
  EXPECT_TRUE(run.has_result());

  const CsvTable table = parse_csv(content_of(with / "compare.csv"));
  const auto column =
      std::find(table.header.begin(), table.header.end(), "B_max_strain") - table.header.begin();
  EXPECT_EQ(table.rows.back()[static_cast<std::size_t>(column)], "");
  EXPECT_EQ(table.rows.size(), 21u);
}

TEST(APaneThatDiverges, KeepsAFiniteState) {
  LockStep lockstep(with_a_bad_pane());
  for (std::int64_t k = 1; k <= lockstep.last_index(); ++k) lockstep.advance(k);
  EXPECT_FALSE(lockstep.lane(1).going());
  EXPECT_TRUE(all_finite(lockstep.lane(1).state));
  EXPECT_LT(lockstep.lane(1).index, lockstep.index());
  EXPECT_NEAR(lockstep.lane(1).state.time, lockstep.time_of(lockstep.lane(1).index), 1e-9);
  EXPECT_EQ(lockstep.index(), lockstep.last_index());
}

TEST(AReferenceThatDiverges, TakesTheDifferencesWithItAndNothingElse) {
  Comparison comparison = with_a_bad_pane();
  comparison.reference = "B";
  const TemporaryFolder folder;
  const ComparisonRun run = run_in(folder, comparison);
  EXPECT_FALSE(run.reference_failure.empty());
  EXPECT_FALSE(run.has_result());
  EXPECT_FALSE(run.panes[0].rms);
  EXPECT_EQ(run.panes[0].status, Status::finished);
}

TEST(Threads, GiveTheSameBitsAsOne) {
  Comparison comparison = comparison_of(smooth_scene(6, 5), {"verlet", "rk4", "bdf2", "xpbd"}, 0.0025);
  comparison.scene.deformation.emplace().rate = 0.02;
  const TemporaryFolder one, several;
  const ComparisonRun a = run_in(one, comparison, 1), b = run_in(several, comparison, 5);
  for (const char* file : {"A.csv", "B.csv", "C.csv", "D.csv"})
    expect_same(rows_of(one, file), rows_of(several, file));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(a.panes[i].rms, b.panes[i].rms);
    EXPECT_EQ(a.panes[i].rms_over_time, b.panes[i].rms_over_time);
  }
}

TEST(LockStep, ShortensAStepThatDoesNotDivideTheIntervalAndSaysSo) {
  Comparison comparison = comparison_of(smooth_scene(4, 4), {"verlet", "verlet", "bdf2"}, 0.001);
  set_own(comparison.panes[1], "integrator.time_step", 0.003);
  set_own(comparison.panes[2], "integrator.time_step", 0.04);
  const LockStep lockstep(comparison);
  EXPECT_EQ(lockstep.lane(0).simulation->time_step(), 0.001);
  EXPECT_EQ(lockstep.lane(0).notice, "");
  EXPECT_DOUBLE_EQ(lockstep.lane(1).simulation->time_step(), 0.0025);
  EXPECT_NE(lockstep.lane(1).notice.find("0.0025 s instead"), std::string::npos);
  EXPECT_EQ(lockstep.lane(2).simulation->time_step(), 0.01);
}

TEST(LockStep, EndedWithinAnIntervalGoesOnToTheSameBits) {
  const Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "rk4"}, 0.001);
  LockStep whole(comparison), broken(comparison);
  int asked = 0;
  for (std::int64_t k = 1; k <= 10; ++k) {
    whole.advance(k);
    while (!broken.advance(k, [&] { return ++asked % 4 != 0; })) {
    }
  }
  for (std::size_t i = 0; i < whole.lane_count(); ++i) EXPECT_EQ(whole.lane(i).state, broken.lane(i).state);
  EXPECT_EQ(whole.difference(0)->rms, broken.difference(0)->rms);
  EXPECT_EQ(*whole.rms_over_time(0), *broken.rms_over_time(0));
}

TEST(TheHand, ActsOnAllPanesAlike) {
  Comparison comparison = comparison_of(smooth_scene(6, 6), {"rk4", "dormand-prince"}, 0.002);
  comparison.reference = "B";
  set_own(comparison.panes[1], "integrator.tolerance", 1e-10);
  set_own(comparison.panes[1], "integrator.time_step", 0.0005);
  LockStep lockstep(comparison), still(comparison);
  ASSERT_NE(lockstep.lane(0).simulation->strongest_pull(), lockstep.lane(1).simulation->strongest_pull());
  for (std::int64_t k = 1; k <= 8; ++k) {
    if (k == 5) lockstep.set_pull(Pull{.particle = 20, .target = {0.3, 0.2, 0.4}});
    lockstep.advance(k);
    still.advance(k);
  }
  EXPECT_GT(rms_distance(lockstep.lane(0).state.position, still.lane(0).state.position), 1e-3);
  EXPECT_LT(lockstep.difference(0)->rms, 1e-4) << "hands of different strengths would part the panes";
}

TEST(AnEdit, CountsNoDifferenceTwice) {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "rk4"}, 0.002);
  LockStep lockstep(comparison);
  for (std::int64_t k = 1; k <= 5; ++k) lockstep.advance(k);
  const double before = *lockstep.rms_over_time(0);
  lockstep.edit(comparison);
  EXPECT_EQ(*lockstep.rms_over_time(0), before);
}

TEST(AnEdit, ActsOnAllPanesButWhereTheyHaveTheirOwnValue) {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "verlet"}, 0.001);
  set_own(comparison.panes[1], "damping", 0.01);
  LockStep lockstep(comparison);
  lockstep.advance(5);
  Comparison edited = comparison;
  set_shared_value(edited, "damping", 0.05);
  set_shared_value(edited, "gravity", Vec3(0, -3, 0));
  set_own(edited.panes[0], "integrator.time_step", 0.0005);
  ASSERT_TRUE(acts_at_once(comparison, edited));
  lockstep.edit(edited);
  EXPECT_EQ(lockstep.lane(0).simulation->scene().damping, 0.05);
  EXPECT_EQ(lockstep.lane(1).simulation->scene().damping, 0.01);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lockstep.lane(i).simulation->scene().gravity->y(), -3);
  for (std::int64_t k = 6; k <= 10; ++k) ASSERT_TRUE(lockstep.advance(k));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(lockstep.lane(i).state.time, 0.1, 1e-12);
  EXPECT_EQ(lockstep.lane(0).state.step, 50 + 100);
}

TEST(AnEdit, ToAnotherReferenceForgetsTheDifferencesSoFar) {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "rk4"}, 0.002);
  LockStep lockstep(comparison);
  for (std::int64_t k = 1; k <= 5; ++k) lockstep.advance(k);
  comparison.reference = "B";
  lockstep.edit(comparison);
  EXPECT_EQ(lockstep.lane_count(), 2u);
  EXPECT_FALSE(lockstep.difference(1));
  EXPECT_EQ(lockstep.difference(0)->rms,
            rms_distance(lockstep.lane(0).state.position, lockstep.lane(1).state.position));
  EXPECT_DOUBLE_EQ(*lockstep.rms_over_time(0), lockstep.difference(0)->rms);
}

/// One of them remembers earlier steps. No limiter: what moves particles makes it forget.
Comparison three_methods() {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "bdf2", "rk4"}, 0.001);
  comparison.reference = "A";
  return comparison;
}

void advance_to(LockStep& lockstep, std::int64_t index) {
  for (std::int64_t k = lockstep.index() + 1; k <= index; ++k) ASSERT_TRUE(lockstep.advance(k));
}

TEST(APaneAddedOrRemoved, LeavesTheOthersToTheBit) {
  Comparison comparison = three_methods();
  LockStep alone(comparison), changed(comparison);
  advance_to(alone, 12);
  advance_to(changed, 4);
  duplicate_pane(comparison, 1);
  changed.edit(comparison);
  advance_to(changed, 8);
  remove_pane(comparison, 1);  // the one that was copied
  changed.edit(comparison);
  advance_to(changed, 12);
  ASSERT_EQ(changed.pane_count(), 3u);
  EXPECT_EQ(changed.lane(1).name, "D");
  for (const std::size_t i : {0U, 2U}) EXPECT_EQ(changed.lane(i).state, alone.lane(i).state) << i;
  EXPECT_EQ(*changed.rms_over_time(2), *alone.rms_over_time(2));
}

TEST(APaneThatIsACopy, GoesOnAsItsSourceDoesToTheBit) {
  Comparison comparison = three_methods();
  comparison.scene.cloth.pins = {};
  LockStep lockstep(comparison);
  advance_to(lockstep, 3);
  set_shared_value(comparison, "damping", 0.004);  // its past is more than its scene
  lockstep.edit(comparison);
  lockstep.set_pull(Pull{.particle = 20, .target = {0.3, 0.2, 0.4}});
  advance_to(lockstep, 6);
  for (const std::size_t source : {2U, 1U, 0U}) {
    Comparison copied = comparison;
    duplicate_pane(copied, source);
    ASSERT_TRUE(acts_at_once(comparison, copied));
    lockstep.edit(copied);
    advance_to(lockstep, lockstep.index() + 4);
    EXPECT_EQ(lockstep.lane(source + 1).state, lockstep.lane(source).state) << source;
    EXPECT_EQ(lockstep.lane(source + 1).measurement.energy_error(),
              lockstep.lane(source).measurement.energy_error());
    EXPECT_EQ(lockstep.lane(source + 1).name, "D");
    lockstep.edit(comparison);
  }
}

TEST(AnEdit, OfOnePaneLeavesTheOthersToTheBit) {
  Comparison comparison = three_methods();
  LockStep alone(comparison), edited(comparison);
  advance_to(alone, 8);
  advance_to(edited, 4);
  set_own(comparison.panes[2], "integrator.time_step", 0.0005);
  edited.edit(comparison);
  advance_to(edited, 8);
  EXPECT_EQ(edited.lane(1).state, alone.lane(1).state);
  EXPECT_NE(edited.lane(2).state, alone.lane(2).state);
}

TEST(ARecordedComparison, RunAgainFromItsFolderGivesTheSameRows) {
  Comparison comparison = comparison_of(smooth_scene(5, 5), {"verlet", "rk4"}, 0.003);
  comparison.scene.integrator.time_step.reset();
  const TemporaryFolder first, second;
  run_in(first, comparison);
  const ComparisonReading reading = read_comparison(content_of(first / "comparison.json"), "comparison.json");
  ASSERT_TRUE(reading.comparison);
  const ComparisonRun again = run_in(second, *reading.comparison);
  for (const char* file : {"A.csv", "B.csv"}) expect_same(rows_of(first, file), rows_of(second, file));
  for (const char* column : {"A_rms_difference_m", "B_largest_difference_m", "A_total_J"})
    EXPECT_EQ(column_of(parse_csv(content_of(first / "compare.csv")), column),
              column_of(parse_csv(content_of(second / "compare.csv")), column));
  EXPECT_TRUE(again.comparison == *reading.comparison);
}

TEST(AComparisonsReport, ShowsEveryPaneInItsStyleAndNamesThoseThatStopped) {
  const TemporaryFolder folder;
  const ComparisonRun run = run_in(folder, with_a_bad_pane());
  const LinePlot plot = difference_plot(run);
  ASSERT_EQ(plot.series.size(), 4u) << "the panes and the reference's check";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(plot.series[static_cast<std::size_t>(i)].style, i);
  EXPECT_EQ(plot.series[1].failed.size(), 1u);
  EXPECT_EQ(plot.y.scale, AxisScale::logarithmic);
  EXPECT_EQ(read_xml(to_svg(plot)).error, "");
  const std::string page = comparison_page(run, "clothlab-cli compare x --out DIR");
  EXPECT_NE(page.find("its energy is out of bounds"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::lockstep_test
