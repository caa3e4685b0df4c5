// What a sweep keeps of a run: a column of its record, or a measure of its shape, reduced to one number.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace cloth {

/// `first_above`, `first_below`: the time in s at which the value first passes the bound, linear between
/// rows. `rms`: root mean square of the difference to a measured curve, at the times of that curve. `mean`:
/// over time, by the trapezium rule.
enum class Reduction { final_value, maximum, minimum, mean, first_above, first_below, rms };
const std::vector<std::string>& reduction_names();
const std::string& name_of(Reduction reduction);

/// A measured curve: times in s, ascending, and values in the unit of what it is held against.
struct MeasuredCurve {
  std::string file{};  ///< that it was read from, for messages
  std::vector<double> times{}, values{};
};

struct SweepOutput {
  std::string name{};
  std::string of{};  ///< a column of record.csv or a shape measure
  Reduction reduce = Reduction::final_value;
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< s: rows outside are left out
  double bound = 0;                                               ///< of first_above and first_below
  MeasuredCurve measured{};                                       ///< of rms
};

/// Measures of the shape, by the names that outputs call them by, with their units.
struct ShapeMeasure {
  const char* name;
  const char* unit;
  const char* doc;
};
const std::vector<ShapeMeasure>& shape_measures();

/// The names of all that an output of this simulation can be of.
std::vector<std::string> output_sources(const Simulation& simulation);

/// What the columns `names` hold at the present row, in their order; not a number where there is none.
std::vector<double> output_values(const std::vector<std::string>& names, const Simulation& simulation,
                                  const Measurement& row);

/// Takes the rows of a run one by one.
class OutputReducer {
 public:
  explicit OutputReducer(const SweepOutput& output) : output_(&output) {}

  void add(double time, double value);

  /// Not a number where the rows do not say: no row in the window, a bound that was never passed, a run that
  /// ended before the measured curve.
  double result() const;

 private:
  void add_measured(double time, double value);
  void add_crossing(double time, double value);

  const SweepOutput* output_;
  bool any_ = false, found_ = false;
  double time_before_ = 0, value_before_ = 0;
  double result_ = 0;
  double integral_ = 0, length_ = 0;
  std::size_t next_ = 0;  ///< of the measured times
  double squares_ = 0;
};

}  // namespace cloth
