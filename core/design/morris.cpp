#include "design/bootstrap.h"
#include "design/sensitivity.h"

namespace cloth {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double mean_magnitude(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum / static_cast<double>(values.size());
}

/// Of a sample; not a number of fewer than two.
double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / (static_cast<double>(values.size()) - 1));
}

Estimate estimate_mu_star(const std::vector<double>& effects, SplitMix random) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (effects.size() < 2) return {mean_magnitude(effects), none, none};
  std::vector<double> found(bootstrap_samples), sample(effects.size());
  for (double& value : found) {
    for (double& drawn : sample) drawn = effects[choice_below(random, effects.size())];
    value = mean_magnitude(sample);
  }
  const auto [low, high] = interval_of(found);
  return {mean_magnitude(effects), low, high};
}

/// The dimension in which two neighbours of a trajectory differ.
std::size_t changed(const UnitPoint& from, const UnitPoint& to) {
  std::size_t j = 0;
  while (j + 1 < from.size() && from[j] == to[j]) ++j;
  return j;
}

}  // namespace

MorrisScreening morris_screening(const UnitPoints& points, std::span<const double> outputs,
                                 std::uint64_t seed) {
  MorrisScreening screening;
  if (points.empty()) return screening;
  const std::size_t dimensions = points.front().size();
  screening.parameters.resize(dimensions);
  std::vector<std::vector<double>> effects(dimensions);
  screening.trajectories = std::min(points.size(), outputs.size()) / (dimensions + 1);
  for (std::size_t i = 0; i < screening.trajectories * (dimensions + 1); ++i) {
    screening.failed += std::isfinite(outputs[i]) ? 0 : 1;
    if (i % (dimensions + 1) == 0) continue;
    const std::size_t j = changed(points[i - 1], points[i]);
    const double effect = (outputs[i] - outputs[i - 1]) / (points[i][j] - points[i - 1][j]);
    if (std::isfinite(effect)) effects[j].push_back(effect);
  }
  for (std::size_t j = 0; j < dimensions; ++j)
    screening.parameters[j] = {.mu = mean_of(effects[j]),
                               .mu_star = estimate_mu_star(effects[j], SplitMix(seed)),
                               .sigma = deviation_of(effects[j]),
                               .effects = effects[j].size()};
  return screening;
}

}  // namespace cloth
