// Times several things against each other: each runs for a moment, one after the other, again and again, so
// that what slows the machine for a while slows all of them. Compared is what stood side by side in time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cloth::speed {

struct Sample {
  int repeat = 0;
  double time = 0;  ///< seconds of one run times the subject's scale
};

struct Subject {
  std::string name;
  double scale = 1;                  ///< what a run's seconds are multiplied with
  std::function<bool(int)> run;      ///< does its work so many times; false: it broke down
  int threads = 1;                   ///< that its work is shared among
  int runs_to_settle = 1;            ///< before the first sample
  double moments = 1;                ///< that one sample takes
  int runs_at_least = 1;             ///< in one sample
  std::function<void()> warm = {};   ///< called once, between warming up and the first sample
  std::vector<Sample> samples = {};  ///< none if it broke down
  bool broken = false;
};

struct Spread {
  double low = 0, median = 0, high = 0;  ///< quartiles
  double least = 0;
};

/// Quartiles, interpolated, and the least; zeros if there is nothing.
Spread spread_of(std::vector<double> values);
Spread spread_of(const Subject& subject);

/// Of the ratios of two subjects' samples, repeat by repeat.
Spread ratio_of(const Subject& subject, const Subject& to);

struct TimingPlan {
  int repeats = 11;      ///< samples of each subject
  double moment = 0.02;  ///< s that one sample takes, about
  double budget = 3;     ///< s for all samples of one subject: a slow one gets fewer, at least one
};

/// Asked before every sample, with the part that is done and what comes next; false ends the timing.
using TimingProgress = std::function<bool(double fraction, const std::string& name)>;

/// The time of one thread is its processor time, which other work on the machine lengthens little; that of
/// several is wall time. Warms each subject up, then takes samples of each in turn, starting with another one
/// every time. False: it was ended, and the samples are not complete.
bool time_interleaved(std::vector<Subject>& subjects, const TimingPlan& plan, const TimingProgress& progress);

}  // namespace cloth::speed
