#include "report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/round_numbers.h"

namespace cloth {
namespace {

constexpr double room = 0.04;          // of the range, beyond the data on either side
constexpr double least_decades = 0.8;  // holds two of 1, 2, 5 times a power of ten
constexpr double largest = 1e300, smallest = 1e-300;

double logarithm(AxisScale scale, double value) {
  return scale == AxisScale::logarithmic ? std::log10(value) : value;
}

std::string superscript_of(int number) {
  static constexpr std::array digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : fmt::format("{}", number)) text += c == '-' ? "⁻" : digits[std::size_t(c - '0')];
  return text;
}

}  // namespace

bool can_show(AxisScale scale, double value) {
  if (!std::isfinite(value) || std::abs(value) > largest) return false;
  return scale == AxisScale::linear || value >= smallest;
}

AxisMap::AxisMap(const Axis& axis, std::span<const double> values, double from, double to)
    : scale_(axis.scale), from_(from), to_(to) {
  settle(values, axis);
}

void AxisMap::settle(std::span<const double> values, const Axis& axis) {
  const bool logs = scale_ == AxisScale::logarithmic;
  double low = 0, high = 0;
  bool any = false;
  for (const double value : values) {
    if (!can_show(scale_, value)) continue;
    low = any ? std::min(low, value) : value, high = any ? std::max(high, value) : value;
    any = true;
  }
  if (!any) low = logs ? 0.1 : 0, high = logs ? 10 : 1;
  const bool fixed_low = axis.low && can_show(scale_, *axis.low);
  const bool fixed_high = axis.high && can_show(scale_, *axis.high);
  if (fixed_low) low = *axis.low;
  if (fixed_high) high = *axis.high;
  if (low > high) std::swap(low, high);

  double a = logarithm(scale_, low), b = logarithm(scale_, high);
  const double least = logs ? least_decades : std::max(1e-9 * std::max(std::abs(a), std::abs(b)), smallest);
  const bool narrow = b - a < least;
  const double wider = !narrow  ? room * (b - a)
                       : logs   ? (least - (b - a)) / 2
                       : a == 0 ? 1
                                : 0.1 * std::abs(a);
  if (!fixed_low || narrow) a -= wider;
  if (!fixed_high || narrow) b += wider;
  if (logs) a = std::max(a, -305.0), b = std::min(b, 305.0);  // room must not leave the doubles
  // Energy and time do not begin below zero only because there is room.
  if (!logs && !fixed_low && low >= 0 && a < 0 && high > 0) a = 0;
  low_ = logs ? std::pow(10, a) : a, high_ = logs ? std::pow(10, b) : b;
}

double AxisMap::place(double value) const {
  const double a = logarithm(scale_, low_), b = logarithm(scale_, high_);
  return from_ + (logarithm(scale_, value) - a) / (b - a) * (to_ - from_);
}

double AxisMap::value_at(double place) const {
  const double part = (place - from_) / (to_ - from_);
  if (!(part > 0)) return low_;
  if (part >= 1) return high_;
  const double a = logarithm(scale_, low_), b = logarithm(scale_, high_);
  const double at = a + part * (b - a);
  return scale_ == AxisScale::logarithmic ? std::pow(10, at) : at;
}

double AxisMap::density() const {
  return std::abs(to_ - from_) / (logarithm(scale_, high_) - logarithm(scale_, low_));
}

std::vector<Tick> AxisMap::ticks(double spacing) const {
  return scale_ == AxisScale::linear ? linear_ticks(spacing) : logarithmic_ticks(spacing);
}

int AxisMap::tick_exponent() const {
  if (scale_ == AxisScale::logarithmic) return 0;
  const double size = std::max(std::abs(low_), std::abs(high_));
  if (size < 1e9 && size > 1 && high_ - low_ < 1e-3 * size) return 0;  // 1000002 says more than 1.000002
  const int exponent = int(std::floor(std::log10(size)));
  return exponent > 4 || exponent < -3 ? exponent : 0;
}

std::vector<Tick> AxisMap::linear_ticks(double spacing) const {
  const double step = rounded_up((high_ - low_) / std::max(1.0, std::abs(to_ - from_) / spacing));
  const int exponent = tick_exponent();
  const double unit = std::pow(10, exponent);
  const int decimals = std::max(0, -int(std::floor(std::log10(step / unit) + 1e-9)));
  std::vector<Tick> ticks;
  const double first = std::ceil(low_ / step - 1e-9), last = std::floor(high_ / step + 1e-9);
  for (double i = first; i <= last && ticks.size() < 200; ++i) {
    const double value = std::clamp(i * step, low_, high_);
    std::string text = fmt::format("{:.{}f}", i * step / unit, std::min(decimals, 12));
    if (i == 0) text = fmt::format("{:.{}f}", 0.0, std::min(decimals, 12));
    if (text[0] == '-') text = "−" + text.substr(1);
    ticks.push_back({value, true, text, ""});
  }
  return ticks;
}

std::vector<Tick> AxisMap::logarithmic_ticks(double spacing) const {
  const double a = std::log10(low_), b = std::log10(high_);
  const int first = int(std::ceil(a - 1e-9)), last = int(std::floor(b + 1e-9));
  const int stride = std::max(1, int(std::ceil(spacing / density())));  // decades between two labels
  // Fewer than two decades in the range: label 2 and 5 too where there is room, or there would be no label.
  const bool few = last - first < 1 && (last < first || density() * std::log10(2) >= 0.6 * spacing);
  std::vector<Tick> ticks;
  for (int n = int(std::floor(a)); n <= last; ++n)
    for (int factor = 1; factor < 10; ++factor) {
      const double value = factor * std::pow(10, n);
      if (value < low_ * (1 - 1e-9) || value > high_ * (1 + 1e-9)) continue;
      const bool major = factor == 1 ? n % stride == 0 : few && (factor == 2 || factor == 5);
      if (factor > 1 && !major && (density() < 28 || (density() < 70 && factor != 2 && factor != 5)))
        continue;
      Tick tick{std::clamp(value, low_, high_), major, "", ""};
      if (major) {
        tick.text = factor == 1 ? "10" : fmt::format("{}×10", factor);
        tick.superscript = fmt::format("{}{}", n < 0 ? "−" : "", std::abs(n));
      }
      ticks.push_back(tick);
    }
  return ticks;
}

std::string axis_title(const Axis& axis, int exponent) {
  std::string unit = axis.unit;
  if (exponent != 0) unit = "10" + superscript_of(exponent) + (unit.empty() ? "" : " " + unit);
  if (unit.empty()) return axis.label;
  return axis.label.empty() ? unit : axis.label + " (" + unit + ")";
}

}  // namespace cloth
