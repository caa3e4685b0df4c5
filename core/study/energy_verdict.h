// What a run's energy says of its stability: the written criterion of the stability map.
#pragma once

#include <span>

#include "report/palette.h"

namespace cloth {

/// The thresholds. They are printed with every map.
struct StabilityCriterion {
  double periods = 200;            ///< of the fastest motion, that a run lasts
  int least_steps = 200;           ///< that it lasts at any rate
  int max_steps = 20000;           ///< after which it ends even if it should last longer
  double perturbation = 1e-4;      ///< of the start, in lengths of a cell
  unsigned perturbation_seed = 1;  ///< of its random numbers
  double growth = 1e-3;            ///< energy that a method may create, of the energy scale
  double growth_factor = 10;       ///< by which it must still grow in the second half to be an instability
  double accuracy = 0.01;          ///< energy error of an accurate run, of the energy scale
};

/// One moment of a run.
struct EnergySample {
  double time = 0;   ///< s
  double error = 0;  ///< J: total energy - that at the start - works + losses
};

struct EnergyVerdict {
  RunClass run_class = RunClass::accurate;
  double growth_rate = 0;    ///< 1/s, of the created energy in the second half; 0 where nothing was created
  double largest_ratio = 0;  ///< largest |error| / scale
};

/// Judges a run that came to its end. `scale` in J.
///
/// energy growth: the method has created more than `growth` of the scale and what it has created goes on
/// growing like an exponential: the maxima of the four quarters of the second half rise by 1.5 each at least,
/// and the straight line fitted to their logarithm rises by `growth_factor` or more. Or it has created the
/// whole scale. A bounded oscillation of the energy is neither. Stable but inaccurate: the error passed
/// `accuracy`. Samples in order of time.
EnergyVerdict judge_energy(std::span<const EnergySample> samples, double scale,
                           const StabilityCriterion& criterion);

}  // namespace cloth
