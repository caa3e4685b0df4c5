// One point of every live chart. A NaN is a quantity that this sample does not have: the curve has a gap
// there.
#pragma once

#include <array>
#include <limits>

#include "compare/comparison.h"

namespace clothlab {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

struct ChartSample {
  double time_s = 0;
  double kinetic_J = 0, elastic_J = 0, gravity_J = 0, total_J = 0;
  double max_strain = 0;      ///< a fraction; charts show percent
  double step_ms = no_value;  ///< one simulation step
  double draw_ms = no_value;  ///< one drawing of the view
  bool is_cut =
      false;  ///< no point: the run went back to this time and on from there; what came later is gone
};

/// One pane at one common time.
struct PaneSample {
  double total_J = no_value;
  double max_strain = no_value;  ///< a fraction
  double step_ms = no_value;     ///< mean of the steps since the common time before
  double rms_m = no_value;       ///< from the reference
};

struct CompareSample {
  double time_s = 0;
  bool is_start = false;                            ///< of a new run: what came before belongs to another
  std::array<PaneSample, cloth::most_panes> panes;  ///< by style_of(pane): A, B, C, D, whatever their order
};

}  // namespace clothlab
