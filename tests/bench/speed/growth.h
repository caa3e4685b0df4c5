// How the time of a step grows with the number of particles.
#pragma once

#include <string>
#include <vector>

#include "bench/speed/step_costs.h"
#include "study/order_estimate.h"

namespace cloth::speed {

struct Growth {
  std::string method, feature;
  int threads = 1;
  int smallest = 0, largest = 0;  ///< particles along an edge
  Slope exponent = {};            ///< p of time ~ particles^p, with its standard error from three sizes on
};

/// Least squares of ln(time of a step, or of an inner step) against ln(particles), for each method, feature
/// and number of threads that was timed at two sizes or more, in the order of the rows. The time is the lower
/// quartile, which other work of the machine disturbs less than the median.
std::vector<Growth> fit_growth(const std::vector<StepCost>& rows);

}  // namespace cloth::speed
