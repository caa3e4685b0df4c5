#include "picture/strain_colours.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cloth {
namespace {

using Lab = std::array<double, 3>;

/// OKLab to sRGB (Ottosson 2020).
Rgb srgb(const Lab& lab) {
  const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
  const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
  const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
  const auto encode = [](double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * encoded));
  };
  return {encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Lab from_polar(double lightness, double chroma, double hue_degrees) {
  const double h = hue_degrees * std::numbers::pi / 180;
  return {lightness, chroma * std::cos(h), chroma * std::sin(h)};
}

/// A smooth curve through the chosen colours (Catmull and Rom), t in [0, 1].
Lab along_curve(double t) {
  static const std::array<Lab, 7> knots{from_polar(0.30, 0.130, 287),  from_polar(0.39, 0.130, 275),
                                        from_polar(0.50, 0.110, 250),  from_polar(0.615, 0.100, 205),
                                        from_polar(0.735, 0.125, 163), from_polar(0.85, 0.160, 122),
                                        from_polar(0.94, 0.160, 103)};
  const double last = static_cast<double>(knots.size()) - 1;
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(t * last), 0.0, last - 1));
  const double s = t * last - static_cast<double>(i);
  const Lab &p0 = knots[i == 0 ? 0 : i - 1], &p1 = knots[i], &p2 = knots[i + 1];
  const Lab& p3 = knots[std::min(i + 2, knots.size() - 1)];
  Lab p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = 0.5 * (2 * p1[k] + s * (p2[k] - p0[k]) + s * s * (2 * p0[k] - 5 * p1[k] + 4 * p2[k] - p3[k]) +
                  s * s * s * (3 * p1[k] - p0[k] - 3 * p2[k] + p3[k]));
  return p;
}

std::array<Rgb, strain_colour_count> make_colours() {
  constexpr int fine = 4096;
  std::vector<Lab> points(fine + 1);
  std::vector<double> length(fine + 1, 0.0);
  for (std::size_t k = 0; k <= fine; ++k) {
    points[k] = along_curve(static_cast<double>(k) / fine);
    if (k == 0) continue;
    const Lab &a = points[k - 1], &b = points[k];
    length[k] = length[k - 1] + std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  std::array<Rgb, strain_colour_count> colours;
  std::size_t k = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double wanted = length.back() * static_cast<double>(i) / (strain_colour_count - 1);
    while (k < fine && length[k] < wanted) ++k;
    colours[i] = srgb(points[k]);
  }
  return colours;
}

}  // namespace

const std::array<Rgb, strain_colour_count>& strain_colours() {
  static const std::array<Rgb, strain_colour_count> colours = make_colours();
  return colours;
}

Rgb strain_colour(double strain, double scale) {
  const double fraction = strain / scale;
  const double x = std::isnan(fraction) ? 1.0 : std::clamp(fraction, 0.0, 1.0);
  return strain_colours()[static_cast<std::size_t>(std::lround(x * (strain_colour_count - 1)))];
}

}  // namespace cloth
