#include "study/energy_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cloth {
namespace {

constexpr int windows = 8;          // of the second half; two of them are a quarter
constexpr double least_rise = 1.5;  // from quarter to quarter
constexpr double rounding = 1e-13;  // created energy below this part of the scale is none

struct Growth {
  double rate = 0;  // 1/s
  bool steady = false;
};

/// The second half of the run in windows of equal time: the largest energy created in each.
std::array<double, windows> window_maxima(std::span<const EnergySample> samples, double begin, double end,
                                          double floor) {
  std::array<double, windows> maxima;
  maxima.fill(floor);
  for (const EnergySample& sample : samples) {
    if (sample.time < begin) continue;
    const int window = static_cast<int>(windows * (sample.time - begin) / (end - begin));
    double& largest = maxima[static_cast<std::size_t>(std::clamp(window, 0, windows - 1))];
    largest = std::max(largest, sample.error);
  }
  return maxima;
}

/// The slope of the least-squares line through the logarithms.
double logarithmic_slope(const std::array<double, windows>& values, double spacing) {
  double slope = 0, squares = 0;
  for (int k = 0; k < windows; ++k) {
    const double from_middle = k - 0.5 * (windows - 1);
    slope += from_middle * std::log(values[static_cast<std::size_t>(k)]);
    squares += from_middle * from_middle;
  }
  return slope / squares / spacing;
}

Growth measure_growth(std::span<const EnergySample> samples, double scale) {
  if (samples.size() < 2 * windows) return {};
  const double end = samples.back().time;
  const double begin = 0.5 * (samples.front().time + end);
  if (!(end > begin)) return {};
  const auto maxima = window_maxima(samples, begin, end, rounding * scale);
  Growth growth{.rate = logarithmic_slope(maxima, (end - begin) / windows), .steady = true};
  for (std::size_t k = 2; k < windows; k += 2) {
    const double before = std::max(maxima[k - 2], maxima[k - 1]);
    if (!(std::max(maxima[k], maxima[k + 1]) >= least_rise * before)) growth.steady = false;
  }
  return growth;
}

}  // namespace

EnergyVerdict judge_energy(std::span<const EnergySample> samples, double scale,
                           const StabilityCriterion& criterion) {
  EnergyVerdict verdict;
  if (samples.empty()) return verdict;
  double created = 0, largest = 0;
  for (const EnergySample& sample : samples) {
    created = std::max(created, sample.error);
    largest = std::max(largest, std::abs(sample.error));
  }
  const Growth growth = measure_growth(samples, scale);
  const double half = 0.5 * (samples.back().time - samples.front().time);
  verdict.growth_rate = growth.rate;
  verdict.largest_ratio = scale > 0 ? largest / scale : (largest > 0 ? HUGE_VAL : 0);

  const bool keeps_growing = growth.steady && growth.rate * half >= std::log(criterion.growth_factor);
  if (created > scale || (created > criterion.growth * scale && keeps_growing))
    verdict.run_class = RunClass::energy_growth;
  else if (largest > criterion.accuracy * scale)
    verdict.run_class = RunClass::stable_but_inaccurate;
  return verdict;
}

}  // namespace cloth
