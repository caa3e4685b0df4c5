// What a study of convergence reads off a run: a column of its record or a measure of its shape, at the end
// or over all rows of the record.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace cloth {

enum class OverTime { at_end, maximum, minimum, mean };

/// "max_strain" at the end; "max_strain:max", ":min" and ":mean" over the rows of the record, that at t = 0
/// too. The mean is that of the straight lines between the rows.
struct GridOutput {
  std::string quantity;
  OverTime over = OverTime::at_end;
};
GridOutput parse_output(const std::string& text);

/// The quantities that a scene's runs have: columns of its record.csv, then lowest_point_m, and where
/// particles are pinned droop_m and droop_ratio (measure/droop.h). Preconditions: find_problems(scene) is
/// empty, and its cloth is a grid.
std::vector<std::string> output_quantities(const Scene& scene);

/// The value of one of these quantities at a row of the record; not a number where there is none.
double value_of_quantity(const std::string& quantity, const Simulation& simulation, const Measurement& row);

/// The rule that these outputs break; nothing if every quantity is one of `known` and none is there twice.
std::optional<std::string> broken_outputs_rule(const std::vector<std::string>& outputs,
                                               const std::vector<std::string>& known);

/// "J", "m", "N s"; empty for a pure number.
std::string unit_of_output(const std::string& output);

/// Collects one output from the rows of a run.
class OutputReading {
 public:
  explicit OutputReading(GridOutput output) : output_(std::move(output)) {}
  void add(const Simulation& simulation, const Measurement& row);
  /// Not a number where there is none.
  double value() const;

 private:
  GridOutput output_;
  int rows_ = 0;
  double first_time_ = 0, last_time_ = 0, last_ = 0, extreme_ = 0, integral_ = 0;
};

}  // namespace cloth
