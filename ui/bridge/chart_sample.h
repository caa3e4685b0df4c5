// Samples that the worker sends to the live charts. NaN marks a quantity that the sample does not have; its
// curve has a gap there.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "compare/comparison.h"

namespace clothlab {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

struct ChartSample {
  double time_s = 0;
  double kinetic_J = 0, elastic_J = 0, gravity_J = 0, total_J = 0;
  double max_strain = 0;                                            ///< a fraction; charts show percent
  double step_ms = no_value;                                        ///< one simulation step
  double draw_ms = no_value;                                        ///< one drawing of the view
  std::shared_ptr<const std::vector<std::string>> probe_columns{};  ///< of record.csv; null: none
  std::vector<double> probes{};                                     ///< one for each of these
  bool is_cut = false;  ///< a marker, not a point: the run went back to this time, and the charts delete all
                        ///< later points
};

/// One pane at one common time.
struct PaneSample {
  double total_J = no_value;
  double max_strain = no_value;  ///< a fraction
  double step_ms = no_value;     ///< mean of the steps since the common time before
  double rms_m = no_value;       ///< rms distance from the reference
  std::vector<double> probes{};  ///< one for each of CompareSample::probe_columns; empty: none
};

struct CompareSample {
  double time_s = 0;
  bool is_start = false;                                            ///< the first sample of a new run
  bool is_cut = false;                                              ///< a marker, as in ChartSample
  std::shared_ptr<const std::vector<std::string>> probe_columns{};  ///< of all panes; null: none
  std::array<PaneSample, cloth::max_panes>
      panes{};  ///< indexed by style_of(pane): A, B, C, D, independent of the panes' order
};

}  // namespace clothlab
