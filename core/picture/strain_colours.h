// The colours of strain, the same as in the window: dark to light at an even pace (equal steps in OKLab,
// Ottosson 2020), from indigo over teal to yellow, so that lightness alone tells the order to every kind of
// colour vision and in print.
#pragma once

#include <array>

#include "picture/image.h"

namespace cloth {

inline constexpr int strain_colour_count = 256;

const std::array<Rgb, strain_colour_count>& strain_colours();

/// The colour of `strain` on a scale from 0 to `scale` (pure numbers); clamped at both ends, the last colour
/// where it is not a number.
Rgb strain_colour(double strain, double scale);

}  // namespace cloth
