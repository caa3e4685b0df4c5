#include "params/slider_scale.h"

#include <algorithm>
#include <cmath>

namespace clothlab {
namespace {

constexpr double decades_above_zero = 1e-5;  ///< of the maximum: where a logarithmic slider from 0 begins
constexpr double zero_gap = 0.04;            ///< the part of it that stands for 0

/// `value` as a multiple of 10^exponent, without the dust that multiplying by 0.1 leaves.
double rounded_to(double value, int exponent) {
  const double power = std::pow(10.0, std::abs(exponent));
  return exponent < 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

int decade_of(double value) {
  // 1000 must be of decade 3 although log10(1000) may come out just below.
  return static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
}

}  // namespace

SliderScale::SliderScale(const cloth::ParameterInfo& info)
    : low_(info.slider_minimum),
      high_(std::max(info.slider_maximum, info.slider_minimum)),
      minimum_(info.minimum),
      maximum_(info.maximum),
      minimum_excluded_(info.minimum_excluded),
      logarithmic_(info.scale == cloth::Scale::logarithmic && info.slider_maximum > 0),
      has_zero_(logarithmic_ && info.slider_minimum <= 0 && !(info.minimum_excluded && info.minimum >= 0)),
      whole_(info.kind == cloth::Kind::integer),
      floor_(low_ > 0 ? low_
             : whole_ ? std::min(1.0, high_)
                      : high_ * decades_above_zero) {}

double SliderScale::value_at(double position) const {
  position = std::clamp(position, 0.0, 1.0);
  if (!logarithmic_) {
    const double range = high_ - low_;
    if (!(range > 0)) return low_;
    const int exponent = decade_of(range / 200);
    const double value = rounded_to(low_ + position * range, whole_ ? std::max(0, exponent) : exponent);
    const bool outside = minimum_excluded_ && value <= minimum_;
    return outside ? minimum_ + std::pow(10.0, exponent)
                   : std::clamp(std::clamp(value, low_, high_), minimum_, maximum_);
  }
  const double start = has_zero_ ? zero_gap : 0;
  if (has_zero_ && position < start / 2) return 0;
  const double part = std::clamp((position - start) / (1 - start), 0.0, 1.0);
  const double raw = floor_ * std::pow(high_ / floor_, part);
  const int exponent = decade_of(raw) - 2;
  const double value = rounded_to(raw, whole_ ? std::max(0, exponent) : exponent);
  return std::clamp(std::clamp(value, floor_, high_), minimum_, maximum_);
}

double SliderScale::position_of(double value) const {
  if (!logarithmic_) return high_ > low_ ? std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) : 0.0;
  const double start = has_zero_ ? zero_gap : 0;
  if (value <= 0) return 0;
  const double part = std::log(value / floor_) / std::log(high_ / floor_);
  return start + (1 - start) * std::clamp(part, 0.0, 1.0);
}

double SliderScale::one_step(double value, int direction) const {
  int exponent = 0;
  if (logarithmic_) {
    if (value == 0) return direction > 0 ? floor_ : std::max(0.0, minimum_);
    if (direction < 0 && has_zero_ && value <= floor_) return 0;
    exponent = decade_of(value) - 1;
    // Down from 100 comes 99, as up from 99 comes 100: a step down and a step up cancel.
    if (direction < 0 && std::abs(value) <= std::pow(10.0, exponent + 1)) --exponent;
  } else {
    exponent = high_ > low_ ? decade_of((high_ - low_) / 50) : 0;
  }
  if (whole_) exponent = std::max(0, exponent);
  const double next = rounded_to(value + direction * std::pow(10.0, exponent), exponent);
  if (minimum_excluded_ && next <= minimum_) return value;
  return std::clamp(next, minimum_, maximum_);
}

double SliderScale::stepped(double value, int steps) const {
  for (int i = 0; i < std::abs(steps); ++i) value = one_step(value, steps > 0 ? 1 : -1);
  return value;
}

}  // namespace clothlab
