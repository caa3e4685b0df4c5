// Contours of values on a grid.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace cloth {

using ContourPoint = std::pair<double, double>;

/// Lines along which the bilinear interpolant of the values passes `level`, by marching squares (Lorensen and
/// Cline 1987, in the plane), linear along edges. values[iy * x.size() + ix]; a cell with a corner that is
/// not finite has none. x and y ascend.
std::vector<std::vector<ContourPoint>> contour_lines(std::span<const double> x, std::span<const double> y,
                                                     std::span<const double> values, double level);

}  // namespace cloth
