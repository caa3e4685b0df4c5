// One point of every live chart. A NaN is a quantity that this sample does not have: the curve has a gap
// there.
#pragma once

#include <limits>

namespace clothlab {

struct ChartSample {
  double time_s = 0;
  double kinetic_J = 0, elastic_J = 0, gravity_J = 0, total_J = 0;
  double max_strain = 0;                                      ///< a fraction; charts show percent
  double step_ms = std::numeric_limits<double>::quiet_NaN();  ///< one simulation step
  double draw_ms = std::numeric_limits<double>::quiet_NaN();  ///< one drawing of the view
  bool is_cut =
      false;  ///< no point: the run went back to this time and on from there; what came later is gone
};

}  // namespace clothlab
