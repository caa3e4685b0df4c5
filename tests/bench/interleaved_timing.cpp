#include "interleaved_timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace cloth::bench {
namespace {

double seconds_for(const Subject& subject, int times) {
  const auto start = std::chrono::steady_clock::now();
  subject.run(times);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Doubles the number of runs until they take a moment: that warms up, and says how many make one.
int runs_in(const Subject& subject, double moment) {
  constexpr int most = 1 << 20;
  int times = 1;
  double taken = seconds_for(subject, times);
  while (taken < 0.5 * moment && times < most) {
    times *= 2;
    taken = seconds_for(subject, times);
  }
  return std::max(1, static_cast<int>(std::lround(times * std::min(1.0, moment / taken))));
}

}  // namespace

Spread spread_of(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, samples.size() - 1);
    return samples[below] + (place - static_cast<double>(below)) * (samples[above] - samples[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

Spread ratio_of(const Subject& subject, const Subject& to) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < subject.samples.size(); ++k)
    ratios.push_back(subject.samples[k] / to.samples[k]);
  return spread_of(std::move(ratios));
}

void time_interleaved(std::vector<Subject>& subjects, int repeats, double moment) {
  std::vector<int> times;
  for (const Subject& subject : subjects) times.push_back(runs_in(subject, moment));
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t k = 0; k < subjects.size(); ++k) {
      const std::size_t turn = (k + static_cast<std::size_t>(repeat)) % subjects.size();
      Subject& subject = subjects[turn];
      subject.samples.push_back(subject.scale * seconds_for(subject, times[turn]) / times[turn]);
    }
}

}  // namespace cloth::bench
