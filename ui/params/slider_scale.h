// Converts between a parameter's value and its slider's position. No widget.
#pragma once

#include "params/parameter.h"

namespace clothlab {

/// Positions run from 0 (left) to 1. Linear, or logarithmic where declared; a logarithmic slider that starts
/// at 0 keeps its left end for exactly 0 and spans five decades after it.
class SliderScale {
 public:
  explicit SliderScale(const cloth::ParameterInfo& info);

  /// The value at a position: a round number (three digits or so) that the declaration accepts.
  double value_at(double position) const;

  /// The position of a value; values outside the slider's range are clamped to its ends.
  double position_of(double value) const;

  /// The value `steps` steps up or down: about a hundredth of a linear range, the second digit of a
  /// logarithmic value. It may leave the slider's range, never the accepted one.
  double stepped(double value, int steps) const;

 private:
  double one_step(double value, int direction) const;

  double low_, high_;  ///< slider's range
  double minimum_, maximum_;
  bool minimum_excluded_;
  bool logarithmic_, has_zero_, whole_;
  double floor_;  ///< smallest positive value of a logarithmic slider
};

}  // namespace clothlab
