#include "charts/time_view.h"

#include <algorithm>
#include <cmath>

namespace clothlab {

namespace {

constexpr double live_span_s = 60;
constexpr double shortest_span_s = 1e-5;  // far below any time step, far above what a double loses in an hour

/// The right edge of a run's first minute moves in a few steps, so that the curves do not squeeze at every
/// sample.
double early_end(double elapsed_s) {
  for (const double end : {1.0, 2.0, 5.0, 10.0, 20.0, 30.0})
    if (elapsed_s <= end) return end;
  return live_span_s;
}

}  // namespace

void TimeView::set_span(Span span) {
  span_ = span;
  live_ = true;
}

Range TimeView::shown(Range recorded) const {
  if (!live_) return held_;
  const double elapsed = recorded.span();
  if (elapsed <= live_span_s) return {recorded.low, recorded.low + early_end(elapsed)};
  if (span_ == Span::last_minute) return {recorded.high - live_span_s, recorded.high};
  const double step = nice_step(elapsed, 20);
  return {recorded.low, recorded.low + std::ceil(elapsed / step) * step};
}

void TimeView::zoom(Range recorded, double anchor_s, double factor) {
  const Range now = shown(recorded);
  hold(recorded, {anchor_s + (now.low - anchor_s) * factor, anchor_s + (now.high - anchor_s) * factor});
}

void TimeView::pan(Range recorded, double by_s) {
  const Range now = shown(recorded);
  hold(recorded, {now.low + by_s, now.high + by_s});
}

void TimeView::hold(Range recorded, Range times) {
  const double widest = std::max(1.0, 2 * recorded.span());
  const double span = std::clamp(times.span(), shortest_span_s, widest);
  const double middle = (times.low + times.high) / 2;
  // The middle of the charts stays within the run: a curve cannot be lost out of sight.
  const double centre = std::clamp(middle, recorded.low, std::max(recorded.low, recorded.high));
  held_ = times.span() == span && centre == middle ? times : Range{centre - span / 2, centre + span / 2};
  live_ = false;
}

}  // namespace clothlab
