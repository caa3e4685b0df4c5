#include "exact/heavy_strip.h"

#include <cmath>

#include "exact/bessel_zero.h"

namespace cloth::exact {

HeavyCantilever heavy_cantilever(double gamma) {
  // From the tip to the clamp, seen upside down: the weight is negative and the tip is at a small angle.
  constexpr int steps = 8000;
  const ElasticaLoad load{0, 0, -gamma};
  const auto from_tip = [](double log_angle) { return ElasticaPoint{0, 0, 0, std::exp(log_angle), 0}; };
  const auto clamp_beyond_horizontal = [&](double log_angle) {
    return end_of_elastica(from_tip(log_angle), load, 1, steps).angle - rightward;
  };
  // The angle grows by less than exp(2/3 sqrt(Gamma)) as long as it is small.
  double high = std::log(rightward) - 2.0 / 3 * std::sqrt(gamma) - 0.5;
  while (clamp_beyond_horizontal(high) <= 0) high += 0.5;
  const double log_angle = root_between(clamp_beyond_horizontal, high - 0.5, high);

  std::vector<ElasticaPoint> seen = integrate_elastica(from_tip(log_angle), load, 1, steps);
  const ElasticaPoint clamp = seen.back();
  HeavyCantilever found;
  found.droop = -clamp.y;
  found.width = clamp.x;
  found.droop_over_width = found.droop / found.width;
  found.tip_angle = rightward - seen.front().angle;
  for (auto it = seen.rbegin(); it != seen.rend(); ++it)
    found.points.push_back({1 - it->arc, clamp.x - it->x, clamp.y - it->y, it->angle, -it->curvature});
  return found;
}

double gamma_of_chord(double angle) {
  const auto beyond = [&](double log_gamma) {
    return std::atan(heavy_cantilever(std::exp(log_gamma)).droop_over_width) - angle;
  };
  double high = 0;
  while (beyond(high) < 0) high += 1;
  double low = high - 1;
  while (beyond(low) > 0) low -= 1;
  return std::exp(root_between(beyond, low, high));
}

double bending_length(double bending, double areal_density, double gravity) {
  return std::cbrt(bending / (areal_density * gravity));
}

double astm_bending_length(double overhang) {
  static const double ratio = std::cbrt(gamma_of_chord(astm_chord));
  return overhang / ratio;
}

double self_buckling_gamma() {
  const double zero = first_bessel_zero(-1.0 / 3);
  return 9.0 / 4 * zero * zero;
}

double lateral_buckling_gamma(double twist_over_bending) {
  return 6 * first_bessel_zero(-1.0 / 6) * std::sqrt(2 * twist_over_bending);
}

}  // namespace cloth::exact
