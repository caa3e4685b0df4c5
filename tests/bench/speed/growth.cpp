#include "bench/speed/growth.h"

#include <algorithm>

namespace cloth::speed {
namespace {

bool belongs(const Growth& growth, const StepCost& row) {
  return growth.method == row.method && growth.feature == row.feature && growth.threads == row.threads;
}

}  // namespace

std::vector<Growth> fit_growth(const std::vector<StepCost>& rows) {
  std::vector<Growth> found;
  for (const StepCost& row : rows)
    if (std::none_of(found.begin(), found.end(), [&](const Growth& growth) { return belongs(growth, row); }))
      found.push_back({.method = row.method, .feature = row.feature, .threads = row.threads});

  for (Growth& growth : found) {
    std::vector<OrderPoint> points;  // of ln y against ln x, whatever they are
    for (const StepCost& row : rows) {
      if (!belongs(growth, row) || row.samples == 0) continue;
      const double particles = static_cast<double>(row.size) * row.size;
      points.push_back({particles, particles * row.time.low / row.inner_steps});
      growth.smallest = growth.smallest == 0 ? row.size : std::min(growth.smallest, row.size);
      growth.largest = std::max(growth.largest, row.size);
    }
    growth.exponent = fit_slope(points);
  }
  std::erase_if(found, [](const Growth& growth) { return growth.exponent.points < 2; });
  return found;
}

}  // namespace cloth::speed
