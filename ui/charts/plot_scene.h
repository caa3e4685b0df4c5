// One chart's picture, drawn by Qt Charts (axes, grid, labels) and our own curves. It lives in a view or, for
// an exported picture, by itself. This header stays inside ui/charts.
#pragma once

#include <QGraphicsScene>

#include "charts/plot_items.h"

class QCategoryAxis;
class QChart;

namespace clothlab {

/// What one drawing of a chart shows.
struct PlotFrame {
  Range time;     ///< s
  Range y{0, 1};  ///< axis coordinates: the chart's unit, or its decimal logarithm
  bool logarithmic = false;
  std::vector<Tick> time_ticks, y_ticks;
  std::vector<bool> shown;  ///< per curve of the spec
  bool limit_shown = true;
};

class PlotScene : public QGraphicsScene {
 public:
  /// Only the lowest chart has `time_labels`; `on_screen` keeps the painted curves while only the read-out
  /// moves.
  PlotScene(const ChartSpec& spec, bool time_labels, bool on_screen);

  void set_look(const Theme& colours, const QFont& font);
  /// The size of the whole picture and, in it, of the plot without its labels (px).
  void set_geometry(QSizeF size, const QRectF& plot);
  void show(const ChartRecord& record, const PlotFrame& frame);

  const ChartSpec& spec() const { return spec_; }
  const PlotMap& map() const { return map_; }
  const PlotFrame& frame() const { return frame_; }
  const CurvesItem& curves() const { return *curves_; }
  OverlayItem& overlay() { return *overlay_; }

 protected:
  void drawBackground(QPainter* painter, const QRectF& rect) override;

 private:
  void note_skipped_points(const ChartRecord& record);

  const ChartSpec& spec_;
  bool time_labels_;
  QChart* chart_;
  QCategoryAxis* time_axis_;
  QCategoryAxis* y_axis_;
  CurvesItem* curves_;
  OverlayItem* overlay_;
  QColor field_, title_colour_;
  PlotMap map_;
  PlotFrame frame_;
};

inline constexpr int plot_right_margin = 12;  ///< px
/// How far the labels of the highest and the lowest value stick out of the plot (px).
double label_overhang(const QFont& font);
/// Height below the lowest plot for the time labels and the axis title (px), and what the labels of some
/// ticks need left of it.
double time_axis_height(const QFont& font);
double label_width(const std::vector<Tick>& ticks, const QFont& font);

}  // namespace clothlab
