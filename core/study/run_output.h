// One number of a run: a column of its record or a measure of its shape, at the end or reduced over the rows
// of the record. Sweeps, fits, convergence and validation read their runs so.
//
//     OutputReducer peak(parse_output("max_strain:max"));
//     options.row = [&](const Simulation& simulation, const Measurement& row) { peak.add(simulation, row); };
//     peak.result()
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace cloth {

/// `mean`: over time, by the trapezium rule. `first_above`, `first_below`: the time in s at which the value
/// first passes the bound, linear between rows. `stays_below`: the time from which on it is below the bound
/// to the end, likewise; of kinetic energy the time to rest. `rms`: root mean square of the difference to a
/// measured curve, at the times of that curve.
enum class Reduction { final_value, maximum, minimum, mean, first_above, first_below, stays_below, rms };
const std::vector<std::string>& reduction_names();
const std::string& name_of(Reduction reduction);
/// Whether the reduction is of a bound.
bool has_bound(Reduction reduction);

/// A measured curve: times in s, ascending, and values in the unit of what it is held against.
struct MeasuredCurve {
  std::string file{};  ///< that it was read from, for messages
  std::vector<double> times{}, values{};
};

struct RunOutput {
  std::string name{};  ///< of its column in tables; parse_output leaves it empty
  std::string of{};    ///< a column of record.csv or a shape measure
  Reduction reduce = Reduction::final_value;
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< s: rows outside are left out
  double bound = 0;                                               ///< where the reduction has one
  MeasuredCurve measured{};                                       ///< of rms
};

/// "max_strain" at the end; "max_strain:max", ":min" and ":mean" over the rows of the record, that at t = 0
/// too.
RunOutput parse_output(const std::string& text);
/// The endings that parse_output knows beside the end: ":max", ":min", ":mean".
const std::vector<std::string>& output_endings();

/// Measures of the shape, by the names that outputs call them by, with their units.
struct ShapeMeasure {
  const char* name;
  const char* unit;
  const char* doc;
};
const std::vector<ShapeMeasure>& shape_measures();

/// What an output of a simulation can be of: the columns of its record.csv but the time of a step, which is
/// of the machine, then the shape measures; sag and droop_ratio only where particles are pinned.
std::vector<std::string> output_sources(const Simulation& simulation);
/// The same of a scene. Precondition: find_problems(scene) is empty.
std::vector<std::string> output_sources(const Scene& scene);

/// What these sources hold at a row of the record, in their order; not a number where there is none.
std::vector<double> output_values(const std::vector<std::string>& sources, const Simulation& simulation,
                                  const Measurement& row);
double value_of_output(const std::string& source, const Simulation& simulation, const Measurement& row);

/// The rule that outputs as parse_output takes them break; nothing if each is of one of `known` and none is
/// there twice.
std::optional<std::string> broken_outputs_rule(const std::vector<std::string>& outputs,
                                               const std::vector<std::string>& known);

/// Of "elastic_J" or "elastic_J:max": "J"; empty for a pure number.
std::string unit_of_output(const std::string& output);

/// Takes the rows of a run one by one.
class OutputReducer {
 public:
  explicit OutputReducer(RunOutput output) : output_(std::move(output)) {}

  const RunOutput& output() const { return output_; }

  void add(double time, double value);
  /// The output's own source at this row.
  void add(const Simulation& simulation, const Measurement& row);

  /// Not a number where the rows do not say: no row in the window, a bound that was never passed, a run that
  /// ended before the measured curve; and where a value that counts was none.
  double result() const;

 private:
  void add_measured(double time, double value);
  void add_crossing(double time, double value);

  RunOutput output_;
  bool any_ = false, found_ = false;
  double time_before_ = 0, value_before_ = 0;
  double result_ = 0;
  double integral_ = 0, length_ = 0;
  std::size_t next_ = 0;  ///< of the measured times
  double squares_ = 0;
};

}  // namespace cloth
