// Axis ranges and tick marks at round numbers. No Qt Charts here.
#pragma once

#include <QString>
#include <vector>

namespace clothlab {

struct Range {
  double low = 0, high = 1;
  double span() const { return high - low; }
  bool contains(double x) const { return low <= x && x <= high; }
  bool operator==(const Range&) const = default;
};

struct Tick {
  double position = 0;  ///< in axis coordinates: the value, or its decimal logarithm on a logarithmic axis
  QString label;
  bool operator==(const Tick&) const = default;
};

/// The smallest of 1, 2, 5 times a power of ten that cuts `span` into at most `intervals` pieces.
double nice_step(double span, int intervals);

/// The data's range widened to round numbers; a single value gets a range around it.
Range nice_range(Range data, int intervals);

/// Ticks at round values within a range, and at powers of ten (or 1-2-5, or round values, as a zoom gets
/// closer) within a range of decimal logarithms.
std::vector<Tick> linear_ticks(Range range, int intervals);
std::vector<Tick> log_ticks(Range logarithms, int intervals);

/// A number as an axis writes it whose ticks are `step` apart ("0", "0.25", "1.2e-6").
QString tick_label(double value, double step);

/// An automatic range with hysteresis: it grows at once when the data leave it and shrinks only when they
/// fill less than some 40 % of it, so that labels do not flicker.
class StickyRange {
 public:
  Range linear(Range data, int intervals);
  /// `positive` is the range of the positive data; the result is in decimal logarithms, whole decades.
  Range logarithmic(Range positive);
  void forget() { held_ = false; }

 private:
  Range range_;
  bool held_ = false;
  bool logarithmic_ = false;
};

}  // namespace clothlab
