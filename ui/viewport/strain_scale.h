// The colours of strain and the range they stand for.
#pragma once

#include <QColor>
#include <QRectF>
#include <QString>
#include <array>
#include <functional>
#include <vector>

#include "picture/strain_colours.h"
#include "theme/theme.h"

class QPainter;

namespace clothlab {

using cloth::strain_colour_count;

/// The engine's strain colours, from no strain to the largest.
const std::array<QColor, strain_colour_count>& strain_colours();

/// The colour at `fraction` of the range; clamped to [0, 1].
QColor strain_colour(double fraction);

/// The top of the colour bar. It follows the largest strain upwards at once, settles on round numbers, and
/// comes down only after the strain has stayed well below for a while, so that the colours mean the same from
/// frame to frame.
class StrainRange {
 public:
  static constexpr double least_strain = 1e-3;

  /// The bar never ends below `least`.
  explicit StrainRange(double least = least_strain) : least_(least), target_(10 * least), shown_(target_) {}

  /// `largest` strain now (pure number), the scene's deformation rate (negative: none), `seconds` since last
  /// time.
  void follow(double largest, double deformation_rate, double seconds);
  void reset() { *this = StrainRange(least_); }

  double maximum() const { return shown_; }  ///< what the colours use now
  double target() const { return target_; }  ///< the round number it glides to
  bool settled() const { return shown_ == target_; }

 private:
  double least_, target_, shown_;
  double seconds_below_ = 0;
  bool started_ = false;
};

/// The least of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below `value` or `least`.
double round_maximum(double value, double least = StrainRange::least_strain);

/// Four to seven round ticks from 0 up to `maximum`.
std::vector<double> round_ticks(double maximum);

/// The colours from 0 at the bottom of `bar` to `maximum` at its top, with round ticks to its right; their
/// texts are at most `room` px wide.
void paint_colour_scale(QPainter& painter, const QRectF& bar, double maximum, double room,
                        const std::function<QString(double)>& text_of, const Theme& theme);

}  // namespace clothlab
