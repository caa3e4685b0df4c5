// Which stretch of simulated time the charts show: following the run, or where the user has zoomed and panned
// to.
#pragma once

#include "charts/nice_range.h"

namespace clothlab {

class TimeView {
 public:
  enum class Span { last_minute, whole_run };

  Span span() const { return span_; }
  bool is_live() const { return live_; }
  /// Choosing a span goes back to following the run.
  void set_span(Span span);
  void follow() { live_ = true; }

  /// The times shown (s) of a run that has been recorded from `recorded.low` to `recorded.high`.
  Range shown(Range recorded) const;

  /// Each of these stops following. A factor below 1 zooms in; the anchor's place on the screen does not
  /// move.
  void zoom(Range recorded, double anchor_s, double factor);
  void pan(Range recorded, double by_s);
  void show(Range recorded, Range times) { hold(recorded, times); }

 private:
  void hold(Range recorded, Range times);

  Span span_ = Span::last_minute;
  bool live_ = true;
  Range held_;
};

}  // namespace clothlab
