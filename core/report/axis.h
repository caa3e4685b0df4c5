// Axes of a plot: range, ticks, and the place of a value.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cloth {

enum class AxisScale { linear, logarithmic };

struct Axis {
  std::string label{};
  std::string unit{};  // empty: none
  AxisScale scale = AxisScale::linear;
  std::optional<double> low{}, high{};  // none: from the data; ignored where the scale cannot show it
};

struct Tick {
  double value = 0;
  bool major = true;          // a minor tick has no text
  std::string text{};         // "0.25", "10" or "2×10"
  std::string superscript{};  // "-3" behind a "10"
};

/// Whether an axis can show the value: finite, and positive where logarithmic.
bool can_show(AxisScale scale, double value);

/// An axis with its range settled: always finite, low < high, positive where logarithmic, whatever the data.
class AxisMap {
 public:
  /// The range: the axis' own limits, else all values that can be shown with a little room around them.
  /// `from` and `to` are the places of the low and the high end [px].
  AxisMap(const Axis& axis, std::span<const double> values, double from, double to);

  double low() const { return low_; }
  double high() const { return high_; }
  AxisScale scale() const { return scale_; }

  /// Place of a value that can_show; a value outside the range lies outside the plot.
  double place(double value) const;
  /// The value at a place between the two ends, which a place beyond them counts as.
  double value_at(double place) const;
  bool holds(double value) const { return can_show(scale_, value) && value >= low_ && value <= high_; }

  /// Pixels per unit, or per decade where logarithmic.
  double density() const;
  void set_places(double from, double to) { from_ = from, to_ = to; }

  /// Ascending, all within the range. Labels are at least some `spacing` pixels apart.
  std::vector<Tick> ticks(double spacing) const;

  /// Ticks of a linear axis are multiples of 10^this.
  int tick_exponent() const;

 private:
  void settle(std::span<const double> values, const Axis& axis);
  std::vector<Tick> linear_ticks(double spacing) const;
  std::vector<Tick> logarithmic_ticks(double spacing) const;

  AxisScale scale_;
  double low_ = 0, high_ = 1;
  double from_, to_;
};

/// "run time (s)", "energy (10⁻³ J)".
std::string axis_title(const Axis& axis, int exponent = 0);

}  // namespace cloth
