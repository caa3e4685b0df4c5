#include "viewport/strain_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clothlab {
namespace {

using Lab = std::array<double, 3>;

/// OKLab to sRGB in [0, 1] (Ottosson 2020, "A perceptual color space for image processing").
QColor srgb(const Lab& lab) {
  const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
  const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
  const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
  const auto encode = [](double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
  };
  return QColor::fromRgbF(encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                          encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                          encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s));
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
  const Lab& p1 = knots[i];
  const Lab& p2 = knots[i + 1];
  const Lab& p0 = knots[i == 0 ? 0 : i - 1];
  const Lab& p3 = knots[std::min(i + 2, knots.size() - 1)];
  Lab p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = 0.5 * (2 * p1[k] + s * (p2[k] - p0[k]) + s * s * (2 * p0[k] - 5 * p1[k] + 4 * p2[k] - p3[k]) +
                  s * s * s * (3 * p1[k] - p0[k] - 3 * p2[k] + p3[k]));
  return p;
}

double distance(const Lab& a, const Lab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::array<QColor, strain_colour_count> make_colours() {
  constexpr int fine = 4096;
  std::vector<Lab> points(fine + 1);
  std::vector<double> length(fine + 1, 0.0);
  for (int i = 0; i <= fine; ++i) {
    const auto k = static_cast<std::size_t>(i);
    points[k] = along_curve(static_cast<double>(i) / fine);
    if (i > 0) length[k] = length[k - 1] + distance(points[k], points[k - 1]);
  }
  std::array<QColor, strain_colour_count> colours;
  std::size_t k = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double wanted = length.back() * static_cast<double>(i) / (strain_colour_count - 1);
    while (k < fine && length[k] < wanted) ++k;
    colours[i] = srgb(points[k]);
  }
  return colours;
}

constexpr double least_range = 1e-3, most_range = 1e3;
constexpr double glide_time = 0.12;    // s, to come 1/e nearer
constexpr double patience = 1.5;       // s, of low strain before the range shrinks
constexpr double low_enough = 0.4;     // of the range
constexpr double rate_in_sight = 4.0;  // a deformation rate up to so many ranges is kept on the bar

}  // namespace

const std::array<QColor, strain_colour_count>& strain_colours() {
  static const std::array<QColor, strain_colour_count> colours = make_colours();
  return colours;
}

QColor strain_colour(double fraction) {
  const double x = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 1.0;
  return strain_colours()[static_cast<std::size_t>(std::lround(x * (strain_colour_count - 1)))];
}

double round_maximum(double value) {
  const double clamped = std::isfinite(value) ? std::clamp(value, least_range, most_range) : most_range;
  const double decade = std::pow(10, std::floor(std::log10(clamped) + 1e-9));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step * decade >= clamped * (1 - 1e-6)) return step * decade;  // strains come in single precision
  return 10 * decade;
}

std::vector<double> round_ticks(double maximum) {
  const double decade = std::pow(10, std::floor(std::log10(maximum / 4)));
  double step = 10 * decade;
  for (const double candidate : {1.0, 2.0, 2.5, 5.0}) {
    if (maximum / (candidate * decade) > 6.5) continue;
    step = candidate * decade;
    break;
  }
  std::vector<double> ticks;
  for (int i = 0; i * step <= maximum * (1 + 1e-9); ++i) ticks.push_back(i * step);
  return ticks;
}

void StrainRange::follow(double largest, double deformation_rate, double seconds) {
  double wanted = round_maximum(largest);
  // A little more than the rate, so that its mark does not sit on the end of the bar.
  if (deformation_rate > 0 && deformation_rate <= rate_in_sight * wanted)
    wanted = std::max(wanted, round_maximum(1.1 * deformation_rate));
  if (!started_) {
    started_ = true;
    target_ = shown_ = wanted;
    return;
  }
  if (wanted > target_) {
    target_ = wanted;
    seconds_below_ = 0;
  } else if (wanted <= low_enough * target_) {
    seconds_below_ += seconds;
    if (seconds_below_ > patience) target_ = wanted, seconds_below_ = 0;
  } else {
    seconds_below_ = 0;
  }
  shown_ += (target_ - shown_) * (1 - std::exp(-seconds / glide_time));
  if (std::abs(shown_ - target_) < 0.005 * target_) shown_ = target_;
}

}  // namespace clothlab
