// Times several things against each other: each runs for a moment, one after the other, again and again, so
// that what slows the machine for a while slows all of them. Compared is what stood side by side in time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cloth::bench {

struct Subject {
  std::string name;
  double scale = 1;               ///< what a run's seconds are multiplied with
  std::function<void(int)> run;   ///< does its work so many times
  std::vector<double> samples{};  ///< scaled time of one run, one for each repeat
};

struct Spread {
  double low = 0, median = 0, high = 0;  ///< quartiles
};

/// Quartiles, interpolated. Precondition: not empty.
Spread spread_of(std::vector<double> samples);

/// Of the ratios of two subjects' samples, repeat by repeat.
Spread ratio_of(const Subject& subject, const Subject& to);

/// Warms each subject up, then takes `repeats` samples of each, of some `moment` seconds, in turn and
/// starting with another one every time.
void time_interleaved(std::vector<Subject>& subjects, int repeats, double moment);

}  // namespace cloth::bench
