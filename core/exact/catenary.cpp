#include "exact/catenary.h"

#include <cassert>
#include <cmath>

namespace cloth::exact {

Catenary catenary(double length, double span, double rise, double areal_density, double gravity, int steps) {
  assert(span > 0 && length > std::hypot(span, rise));
  // sinh(z)/z = sqrt(length^2 - rise^2)/span for z = span/(2 a)
  const double ratio = std::sqrt((length - rise) * (length + rise)) / span;
  const auto too_long = [&](double z) { return std::log(std::sinh(z) / z / ratio); };
  double high = 1;
  while (too_long(high) <= 0) high *= 2;
  Catenary found;
  const double a = found.parameter = span / (2 * root_between(too_long, 1e-9, high));
  const double x0 = found.lowest_x = span / 2 - a * std::atanh(rise / length);
  found.lowest_y = a * (1 - std::cosh(x0 / a));
  const auto height = [&](double x) { return a * (std::cosh((x - x0) / a) - std::cosh(x0 / a)); };
  const double as_steep_as_chord = x0 + a * std::asinh(rise / span);
  found.sag = rise / span * as_steep_as_chord - height(as_steep_as_chord);
  found.horizontal = areal_density * gravity * a;
  found.left_tension = found.horizontal * std::cosh(x0 / a);
  found.right_tension = found.horizontal * std::cosh((span - x0) / a);
  for (int k = 0; k <= steps; ++k) {
    const double arc = length * k / steps, slope = arc / a - std::sinh(x0 / a);
    const double x = x0 + a * std::asinh(slope);
    found.points.push_back({arc, x, height(x), rightward + std::atan(slope), 1 / (a * (1 + slope * slope))});
  }
  return found;
}

}  // namespace cloth::exact
