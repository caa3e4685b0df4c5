#include "viewport/drawing_pace.h"

#include <algorithm>
#include <numbers>

namespace clothlab {
namespace {

constexpr double short_ms = 0.4 * DrawingPace::long_ms;  // with twice the pixels it is not long
constexpr double longest_pause_ms = 200;                 // a drawing that something else held up is no reason
constexpr int in_a_row = 3;                              // nor is a single one a reason for other pixels
constexpr double coarsest = 0.5, finer = std::numbers::sqrt2;

}  // namespace

void DrawingPace::drew(double milliseconds) {
  const bool is_long = milliseconds > long_ms, is_short = milliseconds < short_ms;
  last_ms_ = milliseconds;
  long_ones_ = is_long ? long_ones_ + 1 : 0;
  short_ones_ = is_short ? short_ones_ + 1 : 0;
  if (long_ones_ < in_a_row && short_ones_ < in_a_row) return;
  fineness_ = std::clamp(is_long ? fineness_ / finer : fineness_ * finer, coarsest, 1.0);
  if (fineness_ > 0.99) fineness_ = 1;  // exactly, after roots
  long_ones_ = short_ones_ = 0;
}

double DrawingPace::pause(bool run_is_behind) const {
  return run_is_behind || last_ms_ > long_ms ? std::min(2 * last_ms_, longest_pause_ms) : 0;
}

}  // namespace clothlab
