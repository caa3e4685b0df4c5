// Stacked charts with a common time axis: connects their zoom and pan signals, and gives their plots equal
// heights and one left edge.
#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include "charts/chart_record.h"
#include "charts/time_view.h"

class QRect;

namespace clothlab {

class LiveChart;

class ChartStack : public QObject {
  Q_OBJECT
 public:
  /// Charts of this record, which outlives the stack.
  ChartStack(const ChartRecord& record, TimeView::Span span, QObject* parent = nullptr);

  /// Adds a chart below the others. The caller owns the chart and deletes it after `clear`.
  void add(LiveChart* chart);
  void clear() { charts_.clear(); }
  /// The same at a place of the list, and the opposite.
  void insert(std::size_t at, LiveChart* chart);
  void take(LiveChart* chart) { std::erase(charts_, chart); }
  const std::vector<LiveChart*>& charts() const { return charts_; }

  TimeView& time() { return time_; }
  const TimeView& time() const { return time_; }
  Range shown_times() const { return time_.shown(record_.times()); }
  /// Whether the charts follow the run: all of its times, and y ranges of their own choice.
  bool is_live() const;
  void follow();

  /// Lays the charts out in `room` with plots of equal height.
  void lay_out(const QRect& room);
  void draw();
  /// Shows the values at a time; nullopt: hides them.
  void read(std::optional<double> time_s);

 Q_SIGNALS:
  void changed();  ///< the charts must be drawn again
  void hovered(clothlab::LiveChart* chart, std::optional<double> time_s);

 private:
  void connect_chart(LiveChart* chart);

  const ChartRecord& record_;
  TimeView time_;
  std::vector<LiveChart*> charts_;  ///< from top to bottom
  double gutter_ = 0;               ///< px, left of the plots
};

}  // namespace clothlab
