// The study of error against run time, piece by piece.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin_scenes.h"
#include "study/order_estimate.h"
#include "study/reference_solution.h"
#include "support/scenes.h"

namespace cloth::test {
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
  const auto points = halved(1, 10, [](double h) { return std::pow(h, 4) + 1e-9; });
  OrderRule rule = order_rule(4);
  rule.floor = 1e-9;
  const OrderEstimate estimate = estimate_order(points, rule);
  ASSERT_TRUE(estimate.asymptotic) << estimate.reason;
  EXPECT_GT(points[static_cast<std::size_t>(estimate.first + estimate.count - 1)].error, 1e-8);
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
  Eigen::VectorXd y = Eigen::VectorXd::Ones(1), z = y;  // 1/(1 - t)
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

}  // namespace
}  // namespace cloth::test
