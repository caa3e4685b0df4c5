#include "bench/speed/interleaved_timing.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "design/quantile.h"

namespace cloth::speed {
namespace {

/// How a subject is sampled: so many runs in a sample, and so many samples.
struct Pace {
  int runs = 1, repeats = 1;
};

double seconds_on(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_for(Subject& subject, int runs) {
  const clockid_t clock = subject.threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
  const double start = seconds_on(clock);
  if (!subject.run(runs)) subject.broken = true;
  return std::max(seconds_on(clock) - start, 1e-9);
}

/// Doubles the number of runs until they take a moment: that warms up, and says how many make one.
Pace pace_of(Subject& subject, const TimingPlan& plan) {
  constexpr int most = 1 << 20;
  int runs = 1;
  double taken = seconds_for(subject, runs);
  const double moment = plan.moment * subject.moments;
  while (!subject.broken && (taken < 0.5 * moment || runs < subject.runs_to_settle) && runs < most) {
    runs *= 2;
    taken = seconds_for(subject, runs);
  }
  Pace pace;
  pace.runs =
      std::max(subject.runs_at_least, static_cast<int>(std::lround(runs * std::min(1.0, moment / taken))));
  const double sample = taken * pace.runs / runs;
  pace.repeats = static_cast<int>(std::clamp(plan.budget / sample, 1.0, static_cast<double>(plan.repeats)));
  return pace;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75), values.front()};
}

Spread spread_of(const Subject& subject) {
  std::vector<double> times;
  for (const Sample& sample : subject.samples) times.push_back(sample.time);
  return spread_of(std::move(times));
}

Spread ratio_of(const Subject& subject, const Subject& to) {
  std::vector<double> ratios;
  for (const Sample& sample : subject.samples)
    for (const Sample& other : to.samples)
      if (other.repeat == sample.repeat) ratios.push_back(sample.time / other.time);
  return spread_of(std::move(ratios));
}

bool time_interleaved(std::vector<Subject>& subjects, const TimingPlan& plan,
                      const TimingProgress& progress) {
  const auto goes_on = [&](double fraction, const Subject& subject) {
    return !progress || progress(fraction, subject.name);
  };
  const std::size_t count = subjects.size();
  const double turns = static_cast<double>(count) * (plan.repeats + 1);
  double done = 0;
  std::vector<Pace> paces;
  for (Subject& subject : subjects) {
    if (!goes_on(done++ / turns, subject)) return false;
    paces.push_back(pace_of(subject, plan));
    if (subject.warm) subject.warm();
  }
  for (int repeat = 0; repeat < plan.repeats; ++repeat)
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t turn = (k + static_cast<std::size_t>(repeat)) % count;
      Subject& subject = subjects[turn];
      if (!goes_on(done++ / turns, subject)) return false;
      if (subject.broken || repeat >= paces[turn].repeats) continue;
      const int runs = paces[turn].runs;
      const double time = subject.scale * seconds_for(subject, runs) / runs;
      subject.samples.push_back({repeat, time});
    }
  for (Subject& subject : subjects)
    if (subject.broken) subject.samples.clear();
  return true;
}

}  // namespace cloth::speed
