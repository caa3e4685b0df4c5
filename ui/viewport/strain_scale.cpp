#include "viewport/strain_scale.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "geometry/round_numbers.h"

namespace clothlab {
namespace {

constexpr double max_range = 1e3;
constexpr double glide_time = 0.12;    // s, to come 1/e nearer
constexpr double patience = 1.5;       // s, of low strain before the range shrinks
constexpr double low_enough = 0.4;     // of the range
constexpr double rate_in_sight = 4.0;  // a deformation rate up to so many ranges is kept on the bar

}  // namespace

const std::array<QColor, strain_colour_count>& strain_colours() {
  static const auto colours = [] {
    std::array<QColor, strain_colour_count> converted;
    std::transform(cloth::strain_colours().begin(), cloth::strain_colours().end(), converted.begin(),
                   [](const cloth::Rgb& c) { return QColor(c.red, c.green, c.blue); });
    return converted;
  }();
  return colours;
}

QColor strain_colour(double fraction) {
  const double x = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 1.0;
  return strain_colours()[static_cast<std::size_t>(std::lround(x * (strain_colour_count - 1)))];
}

double round_maximum(double value, double least) {
  const double clamped = std::isfinite(value) ? std::clamp(value, least, max_range) : max_range;
  constexpr double slack = 1e-6;  // strains come in single precision
  return cloth::rounded_up(clamped, {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}, slack);
}

std::vector<double> round_ticks(double maximum) {
  const double step = cloth::rounded_up(maximum / 6.5, {1.0, 2.0, 2.5, 5.0});
  std::vector<double> ticks;
  for (int i = 0; i * step <= maximum * (1 + 1e-9); ++i) ticks.push_back(i * step);
  return ticks;
}

void paint_colour_scale(QPainter& painter, const QRectF& bar, double maximum, double room,
                        const std::function<QString(double)>& text_of, const Theme& theme) {
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  for (int i = 0; i <= 32; ++i) gradient.setColorAt(i / 32.0, strain_colour(i / 32.0));
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 2, 2);
  const double line = painter.fontMetrics().height();
  for (const double tick : round_ticks(maximum)) {
    const double y = bar.bottom() - bar.height() * tick / maximum;
    painter.setPen(QPen(theme.muted_text, 1));
    painter.drawLine(QPointF(bar.right() + 3, y), QPointF(bar.right() + 7, y));
    painter.setPen(theme.text);
    painter.drawText(QRectF(bar.right() + 11, y - line / 2, room, line), Qt::AlignLeft | Qt::AlignVCenter,
                     text_of(tick));
  }
}

void StrainRange::follow(double largest, double deformation_rate, double seconds) {
  double wanted = round_maximum(largest, least_);
  // A little more than the rate, so that its mark does not sit on the end of the bar.
  if (deformation_rate > 0 && deformation_rate <= rate_in_sight * wanted)
    wanted = std::max(wanted, round_maximum(1.1 * deformation_rate, least_));
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
