// What a whole step of an explicit method adds up on its way, over all particles and all springs.
#pragma once

#include <array>

namespace cloth {

struct StepSums {
  double before = 0, after = 0;  ///< of |v|^2, in (m/s)^2
  double dampers = 0;            ///< W, taken by the dampers along springs before the step
  double air = 0;                ///< W, given by the air before the step
};

/// Of Runge-Kutta at its four stages.
struct StageSums {
  std::array<double, 4> squares{};  ///< of |v|^2, in (m/s)^2
  std::array<double, 4> dampers{};  ///< W
  std::array<double, 4> air{};      ///< W
  double after = 0;                 ///< of |v|^2, after the step
};

}  // namespace cloth
