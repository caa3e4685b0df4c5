#include "study/order_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

constexpr int least_window = 4;  // points: three pairwise orders

bool above_floor(const OrderPoint& point, const OrderRule& rule) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  return std::isfinite(point.error) && point.error > std::max(10 * rule.floor, 100 * eps * rule.scale) &&
         point.step > 0;
}

bool slow_enough(const OrderPoint& point, const OrderRule& rule) {
  return point.step * rule.excited_frequency <= rule.largest_phase;
}

/// Neither a rise followed by a fall nor the other way round, but for scatter.
bool monotone(const double* p, std::size_t count, double scatter) {
  bool rises = false, falls = false;
  for (std::size_t k = 1; k < count; ++k) {
    rises |= p[k] > p[k - 1] + scatter;
    falls |= p[k] < p[k - 1] - scatter;
  }
  return !(rises && falls);
}

bool settled(const std::vector<double>& pairwise, std::size_t first, std::size_t points,
             const OrderRule& rule) {
  const double* p = pairwise.data() + first;
  if (!std::all_of(p, p + points - 1, [](double order) { return std::isfinite(order); })) return false;
  const auto [low, high] = std::minmax_element(p, p + points - 1);
  return *high - *low <= rule.slack && monotone(p, points - 1, 0.2 * rule.slack);
}

/// The first point from which `count` points all satisfy `test`, sought from the fine end; -1: none.
template <class Test>
int finest_window(int size, int count, Test test) {
  for (int first = size - count; first >= 0; --first)
    if (test(first)) return first;
  return -1;
}

std::string missing(int eligible, int above) {
  if (above < least_window)
    return fmt::format("{} of the errors lie above the floor, {} are needed", above, least_window);
  if (eligible < least_window)
    return fmt::format("{} of the steps resolve the fastest excited motion, {} are needed", eligible,
                       least_window);
  return "the orders between successive steps have not settled";
}

}  // namespace

OrderRule order_rule(int nominal_order) {
  OrderRule rule;
  if (nominal_order >= 4) rule.slack = 0.2;
  return rule;
}

Slope fit_slope(const std::vector<OrderPoint>& points) {
  const auto n = static_cast<double>(points.size());
  if (points.size() < 2) return {};
  double mean_x = 0, mean_y = 0;
  for (const OrderPoint& point : points) {
    mean_x += std::log(point.step) / n;
    mean_y += std::log(point.error) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (const OrderPoint& point : points) {
    const double x = std::log(point.step) - mean_x, y = std::log(point.error) - mean_y;
    xx += x * x, xy += x * y, yy += y * y;
  }
  if (!(xx > 0)) return {};
  Slope slope{.value = xy / xx, .standard_error = 0, .points = static_cast<int>(points.size())};
  if (points.size() > 2) slope.standard_error = std::sqrt(std::max(0.0, yy - xy * xy / xx) / (n - 2) / xx);
  return slope;
}

OrderEstimate estimate_order(const std::vector<OrderPoint>& points, const OrderRule& rule) {
  OrderEstimate estimate;
  for (std::size_t k = 1; k < points.size(); ++k)
    estimate.pairwise.push_back(std::log(points[k - 1].error / points[k].error) /
                                std::log(points[k - 1].step / points[k].step));
  std::vector<OrderPoint> above;
  int eligible = 0;
  for (const OrderPoint& point : points) {
    if (!above_floor(point, rule)) continue;
    above.push_back(point);
    if (slow_enough(point, rule)) ++eligible;
  }
  estimate.overall = fit_slope(above);

  const int size = static_cast<int>(points.size());
  for (int count = size; count >= least_window; --count) {
    const int first = finest_window(size, count, [&](int begin) {
      const auto from = points.begin() + begin;
      return std::all_of(from, from + count,
                         [&](const OrderPoint& p) { return above_floor(p, rule) && slow_enough(p, rule); }) &&
             settled(estimate.pairwise, static_cast<std::size_t>(begin), static_cast<std::size_t>(count),
                     rule);
    });
    if (first < 0) continue;
    estimate.asymptotic = true;
    estimate.first = first;
    estimate.count = count;
    estimate.order = fit_slope({points.begin() + first, points.begin() + first + count});
    return estimate;
  }
  estimate.reason = missing(eligible, static_cast<int>(above.size()));
  return estimate;
}

std::string order_text(const OrderEstimate& estimate) {
  if (!estimate.asymptotic) return "pre-asymptotic";
  return fmt::format("{:.2f} ± {:.2f}", estimate.order.value, std::max(0.01, estimate.order.standard_error));
}

}  // namespace cloth
