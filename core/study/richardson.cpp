#include "study/richardson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double least_order = 0.5;  // with less the limit is far outside all values

/// Differences below it are rounding.
double rounding_of(const std::vector<GridValue>& grids) {
  double largest = 0;
  for (const GridValue& grid : grids) largest = std::max(largest, std::abs(grid.value));
  return 100 * std::numeric_limits<double>::epsilon() * largest;
}

/// r_21^p (r_32^p - 1)/(r_21^p - 1), where r_21 = e^a and r_32 = e^b.
double ratio_of_differences(double a, double b, double p) {
  if (std::abs(p) < 1e-9) return b / a;
  return std::expm1(b * p) / -std::expm1(-a * p);
}

/// What the finest value is short of the limit by.
double left_over(const GridValue& middle, const GridValue& fine, double order) {
  return (fine.value - middle.value) / std::expm1(order * std::log(middle.cell / fine.cell));
}

void extrapolate(const std::vector<GridValue>& grids, double formal_order, Richardson& found) {
  const GridValue &middle = grids[grids.size() - 2], &fine = grids.back();
  found.extrapolate = fine.value + left_over(middle, fine, found.order);
  found.band = found.safety * std::abs(left_over(middle, fine, std::min(found.order, formal_order)));
  if (fine.value != 0) found.index = found.band / std::abs(fine.value);
}

/// Whether the orders have settled, and whether the fourth grid lies on the power law of the other three.
void look_at_range(const std::vector<GridValue>& grids, Richardson& found) {
  if (found.orders.size() < 2) return;
  const double before = found.orders[found.orders.size() - 2];
  found.is_asymptotic = std::abs(found.order - before) <= order_slack && found.order >= least_order;
  const std::size_t last = grids.size() - 1;
  const double logs[] = {std::log(grids[last - 3].cell / grids[last - 2].cell),
                         std::log(grids[last - 2].cell / grids[last - 1].cell)};
  const double expected = found.differences[last - 2] * ratio_of_differences(logs[1], logs[0], found.order);
  found.range_ratio = found.differences[last - 3] / expected;
}

std::string words_of_order(const std::vector<GridValue>& grids, const Richardson& found) {
  std::string text = fmt::format("Order {:.2f} from the finest three grids", found.order);
  if (found.order < least_order) return text + ": so low that the limit is a guess, far from every value.";
  if (grids.size() == 3) return text + "; whether it has settled, a fourth grid would show.";
  const double before = found.orders[found.orders.size() - 2];
  if (found.is_asymptotic)
    return text + fmt::format(", {:.2f} from the three before: in the asymptotic range.", before);
  return text +
         (std::isfinite(before) ? fmt::format(", {:.2f} from the three before", before)
                                : std::string(", none from the three before")) +
         ": not yet in the asymptotic range.";
}

std::string words_of(const std::vector<GridValue>& grids, const Richardson& found) {
  const auto spread = [&](std::size_t count) {
    const auto [low, high] =
        std::minmax_element(grids.end() - static_cast<std::ptrdiff_t>(count), grids.end(),
                            [](const auto& a, const auto& b) { return a.value < b.value; });
    return fmt::format("from {:.6g} to {:.6g}", low->value, high->value);
  };
  const double last = found.differences.empty() ? 0 : found.differences.back();
  switch (found.verdict) {
    case GridVerdict::converging:
      return words_of_order(grids, found);
    case GridVerdict::oscillating:
      return fmt::format(
          "The differences shrink but change their sign: no order. The last three values lie {}.", spread(3));
    case GridVerdict::diverging:
      return fmt::format(
          "The differences do not shrink with the cells (the last two are {:.3g} and {:.3g}): no order, and "
          "no "
          "limit is in sight.",
          found.differences[found.differences.size() - 2], last);
    case GridVerdict::unchanged:
      return "The finest two grids give the same value but for rounding.";
    case GridVerdict::two_grids:
      return fmt::format("Two grids show no order; {:.3g} is assumed.", found.order);
    case GridVerdict::too_few:
      break;
  }
  return "Fewer than two grids have a value.";
}

GridVerdict verdict_of(const std::vector<GridValue>& grids, const Richardson& found) {
  if (grids.size() < 2) return GridVerdict::too_few;
  const double least = rounding_of(grids), fine = found.differences.back();
  if (std::abs(fine) <= least) return GridVerdict::unchanged;
  if (grids.size() == 2) return GridVerdict::two_grids;
  const double coarse = found.differences[found.differences.size() - 2];
  if (std::abs(coarse) <= least) return GridVerdict::diverging;
  if (coarse * fine < 0)
    return std::abs(fine) < std::abs(coarse) ? GridVerdict::oscillating : GridVerdict::diverging;
  return found.orders.back() > 0 ? GridVerdict::converging : GridVerdict::diverging;
}

}  // namespace

double observed_order(const GridValue& coarse, const GridValue& middle, const GridValue& fine) {
  const double wanted = (middle.value - coarse.value) / (fine.value - middle.value);
  const double a = std::log(middle.cell / fine.cell), b = std::log(coarse.cell / middle.cell);
  if (!(wanted > 0) || !std::isfinite(wanted) || !(a > 0) || !(b > 0)) return no_value;
  double low = -1, high = 1;
  while (ratio_of_differences(a, b, low) > wanted) low *= 2;
  while (ratio_of_differences(a, b, high) < wanted) high *= 2;
  for (int k = 0; k < 200 && high - low > 1e-14 * std::max(1.0, std::abs(high)); ++k) {
    const double middle_order = low + (high - low) / 2;
    (ratio_of_differences(a, b, middle_order) < wanted ? low : high) = middle_order;
  }
  return low + (high - low) / 2;
}

Richardson richardson(const std::vector<GridValue>& grids, double formal_order) {
  Richardson found;
  found.order = found.extrapolate = found.band = found.index = found.range_ratio = no_value;
  for (std::size_t k = 1; k < grids.size(); ++k)
    found.differences.push_back(grids[k].value - grids[k - 1].value);
  for (std::size_t k = 2; k < grids.size(); ++k)
    found.orders.push_back(observed_order(grids[k - 2], grids[k - 1], grids[k]));
  found.verdict = verdict_of(grids, found);
  if (found.verdict == GridVerdict::converging) {
    found.order = found.orders.back();
    found.safety = gci_safety;
    extrapolate(grids, formal_order, found);
    look_at_range(grids, found);
  } else if (found.verdict == GridVerdict::two_grids) {
    found.order = formal_order;
    found.safety = gci_safety_of_two;
    extrapolate(grids, formal_order, found);
  } else if (found.verdict == GridVerdict::unchanged) {
    found.extrapolate = grids.back().value;
    found.band = rounding_of(grids);
    found.index = grids.back().value != 0 ? found.band / std::abs(grids.back().value) : 0;
  }
  found.words = words_of(grids, found);
  return found;
}

}  // namespace cloth
