// How finely and how often the processor draws while something moves: drawings that take long get fewer
// pixels, and where they still do, or where the run is behind the clock, two thirds of the time stay free for
// mouse, keys and simulation. Knows no clock.
#pragma once

namespace clothlab {

class DrawingPace {
 public:
  static constexpr double long_ms = 20;  ///< a drawing that takes longer gives way

  /// After each drawing of something that moves; what it took.
  void drew(double milliseconds);

  /// The picture's width and height as a part of the view's: 1, 0.71 or 0.5.
  double fineness() const { return fineness_; }
  /// For how long nothing is drawn after the last drawing, ms. A run that is behind the clock needs the
  /// processor more than pictures of a slowed motion do.
  double pause(bool run_is_behind) const;

 private:
  double fineness_ = 1, last_ms_ = 0;
  int long_ones_ = 0, short_ones_ = 0;  ///< in a row
};

}  // namespace clothlab
