// The study of error against run time, piece by piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/builtin_scenes.h"
#include "study/order_estimate.h"
#include "study/reference_solution.h"
#include "study/work_precision_report.h"
#include "support/scenes.h"

namespace cloth::test::work_precision_test {
namespace {

/// Errors that behave as `error(step)` at n steps halved from `longest`.
template <class Error>
std::vector<OrderPoint> halved(double longest, int n, Error error) {
  std::vector<OrderPoint> points;
  for (int k = 0; k < n; ++k) {
    const double step = std::ldexp(longest, -k);
    points.push_back({step, error(step)});
  }
  return points;
}

TEST(AnOrder, OfExactPowersIsTheirExponentWithoutUncertainty) {
  for (const int order : {1, 2, 4, 5}) {
    const auto points = halved(0.1, 6, [&](double h) { return 3 * std::pow(h, order); });
    const OrderEstimate estimate = estimate_order(points, order_rule(order));
    ASSERT_TRUE(estimate.asymptotic) << estimate.reason;
    EXPECT_EQ(estimate.count, 6);
    EXPECT_NEAR(estimate.order.value, order, 1e-12);
    EXPECT_LT(estimate.order.standard_error, 1e-7);
  }
}

TEST(AnOrder, IsTakenWhereItHasSettled) {
  const auto points = halved(1, 9, [](double h) { return h * h + 2 * h * h * h; });
  const OrderEstimate estimate = estimate_order(points, order_rule(2));
  ASSERT_TRUE(estimate.asymptotic);
  EXPECT_GT(estimate.first, 1);
  EXPECT_NEAR(estimate.order.value, 2, 0.1);
  EXPECT_GT(estimate.order.standard_error, 0);
  EXPECT_EQ(estimate.first + estimate.count, 9);
}

TEST(AnOrder, IsPreAsymptoticWhereItStillChanges) {
  const auto points = halved(1, 6, [](double h) { return h / (1 + 8 * h); });
  const OrderEstimate estimate = estimate_order(points, order_rule(1));
  EXPECT_FALSE(estimate.asymptotic);
  EXPECT_EQ(order_text(estimate), "pre-asymptotic");
  EXPECT_NE(estimate.reason, "");
  EXPECT_EQ(estimate.overall.points, 6);
}

TEST(AnOrder, IsPreAsymptoticWhereItScatters) {
  auto points = halved(0.1, 8, [](double h) { return h; });
  for (std::size_t k = 0; k < points.size(); ++k) points[k].error *= k % 2 ? 1.1 : 1;
  EXPECT_FALSE(estimate_order(points, order_rule(1)).asymptotic);
}

TEST(AnOrder, DoesNotCountErrorsNearTheFloorOrLongSteps) {
  const auto points = halved(1, 10, [](double h) { return std::pow(h, 4) + 1e-12; });
  OrderRule rule = order_rule(4);
  rule.floor = 1e-12;
  const OrderEstimate estimate = estimate_order(points, rule);
  ASSERT_TRUE(estimate.asymptotic) << estimate.reason;
  EXPECT_GT(points[static_cast<std::size_t>(estimate.first + estimate.count - 1)].error, 1e-11);
  rule.excited_frequency = 3;
  const OrderEstimate slow = estimate_order(points, rule);
  ASSERT_TRUE(slow.asymptotic) << slow.reason;
  EXPECT_EQ(slow.first, 4);  // step 1/16 is the first with 3 * step <= 0.3
  rule.excited_frequency = 30;
  EXPECT_FALSE(estimate_order(points, rule).asymptotic);
}

/// x'' = -4 x - 0.2 x', from x = 1 at rest.
struct Oscillator {
  static void derivative(double, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    dy.resize(2);
    dy << y(1), -4 * y(0) - 0.2 * y(1);
  }
  static double position(double t) {
    const double w = std::sqrt(4 - 0.01);
    return std::exp(-0.1 * t) * (std::cos(w * t) + 0.1 / w * std::sin(w * t));
  }
};

TEST(BothReferenceSolvers, MeetAnExactLinearSolution) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(2);
  Eigen::VectorXd a(2), b(2);
  a << 1, 0;
  b = a;
  Extrapolation extrapolation(1e-13, one);
  Collocation collocation(one);
  for (int k = 0; k < 20; ++k) {
    ASSERT_FALSE(extrapolation.advance(Oscillator::derivative, k, k + 1, a));
    ASSERT_FALSE(collocation.advance(Oscillator::derivative, k, k + 1, 8, b));
    EXPECT_NEAR(a(0), Oscillator::position(k + 1), 1e-12);
    EXPECT_NEAR(b(0), Oscillator::position(k + 1), 1e-12);
  }
}

TEST(Collocation, IsOfOrderTwelve) {
  std::vector<OrderPoint> points;
  for (const int steps : {20, 24, 30, 36}) {
    Eigen::VectorXd y(2);
    y << 1, 0;
    Collocation collocation(Eigen::VectorXd::Ones(2));
    ASSERT_FALSE(collocation.advance(Oscillator::derivative, 0, 20, steps, y));
    points.push_back({20.0 / steps, std::abs(y(0) - Oscillator::position(20))});
  }
  EXPECT_NEAR(fit_slope(points).value, 12, 0.6);
}

TEST(BothReferenceSolvers, SayWhereTheyFail) {
  const Derivative blow_up = [](double, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    dy = y.cwiseAbs2();
  };
  Eigen::VectorXd y = Eigen::VectorXd::Ones(1), z = Eigen::VectorXd::Ones(1);  // 1/(1 - t)
  EXPECT_TRUE(Extrapolation(1e-13, y).advance(blow_up, 0, 2, y));
  EXPECT_TRUE(Collocation(z).advance(blow_up, 0, 2, 10, z));
}

TEST(TheTwoReferences, AgreeOnSmoothScenes) {
  for (const Scene& scene : {builtin_scene("pendulum"), smooth_scene(6, 6)}) {
    const ReferenceSolution solution = solve_smooth(scene, 0.4, 8);
    ASSERT_EQ(solution.failure, "");
    ASSERT_EQ(solution.states.size(), 8u);
    EXPECT_LT(solution.floor.largest_position, 1e-11);
    EXPECT_GT(solution.floor.largest_position, 0) << "two methods never agree to the bit";
    EXPECT_LT(solution.floor.rms_velocity, 1e-9);
    std::printf("floor %.2e m, %.2e m/s, excited frequency %.3g /s, %lld evaluations\n",
                solution.floor.largest_position, solution.floor.rms_velocity, solution.excited_frequency,
                static_cast<long long>(solution.evaluations));
  }
}

TEST(TheTwoReferences, AgreeWithTheExactSolutionOfALinearCloth) {
  const double mass = 0.01, height = 0.3;  // a free sheet falls as x = -g t^2 / 2, whatever its springs
  Scene scene = bare_sheet(4, 4, 0.1, mass);
  scene.springs = SpringMaterial{.structural = 30, .shear = 10, .flexion = 5, .damping = 0.01};
  scene.gravity = Vec3(0, -9.81, 0);
  const double horizon = std::sqrt(2 * height / 9.81);
  const ReferenceSolution solution = solve_smooth(scene, horizon, 5);
  ASSERT_EQ(solution.failure, "");
  const ClothMotion motion(scene);
  for (int i = 0; i < motion.system().size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 moved = solution.states.back().position[k] - motion.system().start[k];
    EXPECT_NEAR((moved - Vec3(0, -height, 0)).norm(), 0, 1e-12);
  }
  EXPECT_LT(solution.floor.largest_position, 1e-11);
}

TEST(TheReferenceOfALimitedScene, IsTheLoopItselfAndChecksItsOwnStep) {
  Scene scene = smooth_scene(5, 5);
  EXPECT_TRUE(is_smooth(scene));
  scene.deformation = Deformation{.rate = 0.02};
  EXPECT_FALSE(is_smooth(scene));
  const ReferenceSolution solution = solve_by_loop(scene, 0.2, 4, 1600);
  ASSERT_EQ(solution.failure, "");
  ASSERT_EQ(solution.states.size(), 4u);
  EXPECT_NEAR(solution.states.back().time, 0.2, 1e-12);
  EXPECT_GT(solution.floor.rms_position, 0);
  EXPECT_LT(solution.floor.rms_position, 1e-2);
}

TEST(AScene, IsSmoothUnlessSomethingIsProjected) {
  EXPECT_TRUE(is_smooth(builtin_scene("corners-free")));
  EXPECT_FALSE(is_smooth(builtin_scene("corners-shear")));
  Scene ball = builtin_scene("ball");
  ball.deformation.reset();
  EXPECT_FALSE(is_smooth(ball));
}

TEST(TheHorizon, IsAWholeNumberOfEveryStepAndOfTheSampleTimes) {
  for (const char* name : {"pendulum", "corners-free", "wind", "free-fall"}) {
    const Scene scene = builtin_scene(name);
    const double horizon = default_horizon(scene);
    EXPECT_LE(horizon, scene.duration);
    const Ladders ladders = make_ladders(scene, integrator_names(), horizon);
    EXPECT_GE(ladders.samples, 5);
    for (const StepLadder& ladder : ladders.methods)
      for (int rung = ladder.beyond_steps > 0 ? -1 : 0; rung < 7; ++rung) {
        EXPECT_EQ(ladder.steps(rung) % ladders.samples, 0) << name << ", " << ladder.facts.name;
        const Scene at = scene_at(scene, ladder, rung, horizon);
        const double steps = horizon / at.integrator.time_step.value();
        EXPECT_NEAR(steps, std::round(steps), 1e-9);
        const bool halved_before = rung > 0 && !ladder.by_tolerance;
        EXPECT_TRUE(!halved_before || ladder.steps(rung) == 2 * ladder.steps(rung - 1));
      }
  }
}

TEST(ALadder, BeginsJustUnderTheLimitAndLooksBeyondItOnce) {
  const Scene scene = builtin_scene("corners-free");
  const double horizon = default_horizon(scene);
  for (const StepLadder& ladder :
       make_ladders(scene, {"semi-implicit-euler", "verlet", "rk4"}, horizon).methods) {
    const double first = horizon / static_cast<double>(ladder.steps(0));
    EXPECT_LT(first, *ladder.limit);
    EXPECT_GT(first, 0.85 * *ladder.limit);
    const double beyond = horizon / static_cast<double>(ladder.steps(-1));
    EXPECT_GT(beyond, 1.1 * *ladder.limit);
    EXPECT_LT(beyond, 1.4 * *ladder.limit);
  }
}

/// Small and quick: every method, three runs each at least.
WorkPrecision quick_study(const Scene& scene, std::vector<std::string> methods = {}) {
  return study_work_precision(scene, {.methods = std::move(methods),
                                      .horizon = 0.2,
                                      .repeats = 1,
                                      .steps_per_method = 6,
                                      .budget = 0.4,
                                      .progress = {}});
}

const MethodStudy& of(const WorkPrecision& study, const std::string& method) {
  for (const MethodStudy& candidate : study.methods)
    if (candidate.ladder.facts.name == method) return candidate;
  ADD_FAILURE() << method;
  return study.methods.front();
}

TEST(AStudy, FindsTheNominalOrdersOfASmoothScene) {
  const WorkPrecision study = quick_study(smooth_scene(6, 6), {"semi-implicit-euler", "verlet", "rk4"});
  for (const MethodStudy& method : study.methods) {
    ASSERT_TRUE(method.order.asymptotic) << method.ladder.facts.name << ": " << method.order.reason;
    EXPECT_NEAR(method.order.order.value, method.ladder.facts.order, 0.2) << method.ladder.facts.name;
  }
}

TEST(AStudy, CountsWhatEachMethodSpends) {
  const WorkPrecision study = quick_study(smooth_scene(6, 6));
  for (const MethodStudy& method : study.methods) {
    const int each = method.ladder.facts.evaluations_per_step;
    if (each == 0 || method.ladder.by_tolerance) continue;
    for (const WorkPrecisionRun& run : method.runs) {
      if (!run.reached_horizon()) continue;
      EXPECT_NEAR(static_cast<double>(run.count.force_evaluations), static_cast<double>(each * run.steps), 1)
          << method.ladder.facts.name;
    }
  }
}

TEST(AStudy, KeepsRunsThatFailedAndThoseItRefused) {
  Scene scene = smooth_scene(6, 6);
  const WorkPrecision study = study_work_precision(scene, {.methods = {"verlet"},
                                                           .horizon = 2.0,
                                                           .repeats = 1,
                                                           .steps_per_method = 12,
                                                           .budget = 0.05,
                                                           .progress = {}});
  const MethodStudy& verlet = of(study, "verlet");
  const WorkPrecisionRun& beyond = verlet.runs.front();
  EXPECT_EQ(beyond.rung, -1);
  EXPECT_EQ(beyond.status, RunStatus::diverged);
  EXPECT_NE(beyond.detail.find("particle"), std::string::npos) << beyond.detail;
  EXPECT_FALSE(beyond.samples.empty());
  const WorkPrecisionRun& refused = verlet.runs.back();
  EXPECT_EQ(refused.status, RunStatus::refused);
  EXPECT_NE(refused.detail.find("budget"), std::string::npos) << refused.detail;
  EXPECT_TRUE(refused.samples.empty());
  EXPECT_EQ(table_of(study).rows.size(), verlet.runs.size());
  const LinePlot plot = study_plot(study, PlotAgainst::run_time);
  EXPECT_EQ(plot.series.front().failed.size() + plot.series.front().points.size(), verlet.runs.size());
  EXPECT_GE(plot.series.front().failed.size(), 2u);
}

TEST(AStudy, ChoosesTheSameRunsAndErrorsEveryTime) {
  const auto first = table_of(quick_study(smooth_scene(5, 5)));
  const auto second = table_of(quick_study(smooth_scene(5, 5)));
  for (const char* column : {"steps", "force_evaluations", "rms_error_m", "status", "repeats", "detail"}) {
    const auto at = static_cast<std::size_t>(std::find(first.header.begin(), first.header.end(), column) -
                                             first.header.begin());
    ASSERT_EQ(first.rows.size(), second.rows.size());
    for (std::size_t k = 0; k < first.rows.size(); ++k)
      EXPECT_EQ(first.rows[k][at], second.rows[k][at]) << column;
  }
}

TEST(AStudy, CanBeStoppedAtAnyMomentAndKeepsWhatIsFinished) {
  for (const double at : {0.0, 0.12, 0.7}) {
    const WorkPrecision study = study_work_precision(
        smooth_scene(5, 5), {.methods = {"verlet", "rk4"},
                             .horizon = 0.2,
                             .budget = 0.4,
                             .progress = [&](const StudyProgress& p) { return p.fraction < at; }});
    EXPECT_TRUE(study.stopped) << at;
    const LinePlot plot = study_plot(study, PlotAgainst::run_time);
    EXPECT_NE(study_page(study, "made by a test").find("was stopped"), std::string::npos);
    EXPECT_NE(to_svg(plot).find("</svg>"), std::string::npos);
  }
}

TEST(AStudyOfALimitedScene, SaysThatItIsOfFirstOrder) {
  Scene scene = smooth_scene(5, 5);
  scene.deformation = Deformation{.rate = 0.02};
  const WorkPrecision study = quick_study(scene, {"verlet", "rk4"});
  EXPECT_FALSE(study.reference.smooth);
  EXPECT_NE(study_page(study, "").find("first order"), std::string::npos);
  const LinePlot plot = study_plot(study, PlotAgainst::step);
  ASSERT_EQ(plot.triangles.size(), 1u);
  EXPECT_EQ(plot.triangles.front().slope, 1);
  for (const MethodStudy& method : study.methods) EXPECT_LT(method.order.overall.value, 1.6);
}

TEST(RepeatedTimes, AreSummedUpByTheLeastAndQuartiles) {
  const TimeSpread spread = spread_of({{1, 1, 5}, {2, 1, 1}, {3, 1, 2}, {4, 1, 4}, {5, 1, 3}});
  EXPECT_EQ(spread.least, 1);
  EXPECT_EQ(spread.lower_quartile, 2);
  EXPECT_EQ(spread.median, 3);
  EXPECT_EQ(spread.upper_quartile, 4);
}

/// A method that took `first` s for an error of 1e-3 m at a step of 1e-2 s, and is of order 2.
MethodStudy line_of_order_two(double first) {
  MethodStudy method;
  for (int k = 0; k < 3; ++k) {
    WorkPrecisionRun run;
    run.rung = k;
    run.time_step = 1e-2 / std::pow(10, k);
    run.error.rms_position = 1e-3 / std::pow(100, k);
    run.time.least = first * std::pow(10, k);
    run.samples = {{1, 1, run.time.least}};
    method.runs.push_back(run);
  }
  return method;
}

TEST(TheCostOfAnError, IsReadBetweenMeasuredRunsOnly) {
  const MethodStudy method = line_of_order_two(1);
  const auto between = cost_of(method, 1e-4);
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->seconds, std::sqrt(10), 1e-9);
  EXPECT_NEAR(between->time_step, 1e-2 / std::sqrt(10), 1e-12);
  EXPECT_FALSE(between->at_first_run);
  const auto loose = cost_of(method, 1e-2);
  ASSERT_TRUE(loose);
  EXPECT_TRUE(loose->at_first_run);
  EXPECT_EQ(loose->seconds, 1);
  EXPECT_FALSE(cost_of(method, 1e-8));
}

TEST(TheCheapestMethod, IsThatOfTheLeastTime) {
  WorkPrecision study;
  study.methods = {line_of_order_two(2), line_of_order_two(1)};
  EXPECT_EQ(cheapest(study, 1e-4), 1u);
  EXPECT_EQ(cheapest(study, 1e-9), std::nullopt);
}

TEST(TheTable, BeginsWithTheColumnsOfItsContract) {
  const CsvTable table = table_of(quick_study(smooth_scene(4, 4), {"verlet"}));
  const std::vector<std::string> first{"method",        "time_step",   "steps",          "force_evaluations",
                                       "wall_s",        "rms_error_m", "relative_error", "status",
                                       "observed_order"};
  ASSERT_GT(table.header.size(), first.size());
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(table.header[k], first[k]);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
}

}  // namespace
}  // namespace cloth::test::work_precision_test
