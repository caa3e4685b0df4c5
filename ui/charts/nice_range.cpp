#include "charts/nice_range.h"

#include <algorithm>
#include <cmath>

#include "geometry/round_numbers.h"
#include "widgets/numbers.h"

namespace clothlab {

namespace {

/// Sixteen decades below the largest value there is only rounding noise.
constexpr double max_automatic_decades = 16;

QString power_of_ten(int exponent) {
  if (exponent >= -3 && exponent <= 3) return number_text(std::pow(10.0, exponent), 4);
  static const QString superscripts = QStringLiteral("⁰¹²³⁴⁵⁶⁷⁸⁹");
  QString label = QStringLiteral("10");
  for (const QChar c : QString::number(exponent))
    label += c == u'-' ? QChar(u'⁻') : superscripts[c.digitValue()];
  return label;
}

void add_multiples(std::vector<Tick>& ticks, Range logarithms, int multiple) {
  for (int decade = static_cast<int>(std::floor(logarithms.low)); decade <= logarithms.high; ++decade) {
    const double value = multiple * std::pow(10.0, decade);
    const double position = std::log10(value);
    if (logarithms.contains(position)) ticks.push_back({position, number_text(value, 2)});
  }
}

}  // namespace

double nice_step(double span, int intervals) {
  if (!(span > 0) || !std::isfinite(span)) return 1;
  return cloth::rounded_up(span / std::max(1, intervals));
}

Range nice_range(Range data, int intervals) {
  // Narrower than what a double tells apart: show the value in the middle of a range of its own size.
  const double size = std::max(std::abs(data.low), std::abs(data.high));
  if (data.span() <= size * 1e-12) {
    if (size == 0) return {0, 1};
    data = {data.low - 0.1 * size, data.high + 0.1 * size};
  }
  const double step = nice_step(data.span(), intervals);
  return {std::floor(data.low / step + 1e-9) * step, std::ceil(data.high / step - 1e-9) * step};
}

std::vector<Tick> linear_ticks(Range range, int intervals) {
  std::vector<Tick> ticks;
  const double step = nice_step(range.span(), intervals);
  const double slack = 1e-6 * step;
  const double first = std::ceil((range.low - slack) / step);
  for (int i = 0; i <= 2 * intervals + 2; ++i) {
    const double position = (first + i) * step;
    if (position > range.high + slack) break;
    // Far from zero a zoom can get so close that neighbouring ticks read the same: one label is enough.
    const QString label = tick_label(position, step);
    if (ticks.empty() || ticks.back().label != label)
      ticks.push_back({std::clamp(position, range.low, range.high), label});
  }
  return ticks;
}

std::vector<Tick> log_ticks(Range logarithms, int intervals) {
  std::vector<Tick> ticks;
  if (logarithms.span() < 0.7) {
    const Range values{std::pow(10.0, logarithms.low), std::pow(10.0, logarithms.high)};
    for (const Tick& tick : linear_ticks(values, intervals))
      ticks.push_back({std::log10(tick.position), tick.label});
    return ticks;
  }
  const int first = static_cast<int>(std::ceil(logarithms.low - 1e-9));
  const int last = static_cast<int>(std::floor(logarithms.high + 1e-9));
  const int stride = std::max(1, (last - first + intervals) / std::max(1, intervals));
  for (int e = first; e <= last; ++e)
    if (e % stride == 0)
      ticks.push_back({std::clamp<double>(e, logarithms.low, logarithms.high), power_of_ten(e)});
  if (logarithms.span() < 2.5 && 3 * logarithms.span() <= intervals) {
    add_multiples(ticks, logarithms, 2);
    add_multiples(ticks, logarithms, 5);
    std::sort(ticks.begin(), ticks.end(),
              [](const Tick& a, const Tick& b) { return a.position < b.position; });
  }
  return ticks;
}

QString tick_label(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return QStringLiteral("0");
  const double size = std::abs(value);
  const int step_exponent = static_cast<int>(std::floor(std::log10(step) + 1e-9));
  if (size < 99999.5 && step_exponent >= -4) return fixed_text(value, std::max(0, -step_exponent));
  const int digits = static_cast<int>(std::floor(std::log10(size) + 1e-9)) - step_exponent + 1;
  return number_text(value, std::clamp(digits, 1, 15));
}

Range StickyRange::linear(Range data, int intervals) {
  const Range fresh = nice_range(data, intervals);
  const bool fits = held_ && !logarithmic_ && range_.low <= data.low && data.high <= range_.high;
  const bool lost_in_it = data.span() < 0.4 * range_.span() && fresh.span() < 0.7 * range_.span();
  if (!fits || lost_in_it) range_ = fresh;
  held_ = true;
  logarithmic_ = false;
  return range_;
}

Range StickyRange::logarithmic(Range positive) {
  Range fresh{std::floor(std::log10(positive.low) + 1e-9), std::ceil(std::log10(positive.high) - 1e-9)};
  fresh.low = std::max(fresh.low, fresh.high - max_automatic_decades);
  if (fresh.span() < 1) fresh.high = fresh.low + 1;
  const bool fits = held_ && logarithmic_ && range_.low <= fresh.low && fresh.high <= range_.high;
  if (!fits || fresh.span() < range_.span() - 2) range_ = fresh;
  held_ = logarithmic_ = true;
  return range_;
}

}  // namespace clothlab
