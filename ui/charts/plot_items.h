// What lies inside a plot's axes: the curves, and over them the read-out. Drawn by graphics items of our own
// because a QLineSeries strokes its whole path again, for hit tests, at each new range and each new list of
// points: three charts of Qt Charts alone take 9 to 14 ms of processor time for a frame, these 5 to 6 with
// the axes of Qt Charts (docs/dependencies.md). It cannot break a curve at a gap either.
#pragma once

#include <QFont>
#include <QGraphicsItem>
#include <QPolygonF>
#include <optional>
#include <vector>

#include "charts/chart_record.h"

namespace clothlab {

/// From time and axis coordinate (the value, or its decimal logarithm) to the scene's px and back.
struct PlotMap {
  QRectF plot;
  Range time, y;
  double x_of(double time_s) const { return plot.left() + (time_s - time.low) / time.span() * plot.width(); }
  double y_of(double axis) const { return plot.bottom() - (axis - y.low) / y.span() * plot.height(); }
  double time_at(double x) const { return time.low + (x - plot.left()) / plot.width() * time.span(); }
  double axis_at(double at) const { return y.low + (plot.bottom() - at) / plot.height() * y.span(); }
};

/// One curve ready to be painted: its unbroken pieces and its markers in px.
struct DrawnCurve {
  const CurveSpec* spec = nullptr;
  std::vector<QPolygonF> pieces;
  QPolygonF markers;
};

class CurvesItem : public QGraphicsItem {
 public:
  using QGraphicsItem::QGraphicsItem;
  void set_plot(const QRectF& plot);
  void set_theme(const Theme& colours);
  /// Rebuilds the curves of the samples shown. `shown` has one entry per curve of the spec.
  void build(const ChartRecord& record, const ChartSpec& spec, const std::vector<bool>& shown,
             const PlotMap& map, bool logarithmic);
  void set_limit(std::optional<double> y_px);

  const std::vector<DrawnCurve>& curves() const { return curves_; }
  /// Of measured values, px.
  const QPolygonF& measured() const { return measured_; }
  QRectF boundingRect() const override { return plot_.adjusted(-spacing, -spacing, spacing, spacing); }
  void paint(QPainter* painter, const QStyleOptionGraphicsItem* option, QWidget* widget) override;

 private:
  void add_pieces(DrawnCurve& curve, const PlotMap& map, bool logarithmic);
  void add_measured(const ChartRecord& record, const CurveSpec& curve, const PlotMap& map, bool logarithmic);
  static void add_markers(DrawnCurve& curve, const SampleSeries& series, double phase, const PlotMap& map,
                          bool logarithmic);

  QRectF plot_;
  const Theme* theme_ = nullptr;
  std::vector<DrawnCurve> curves_;
  std::optional<double> limit_y_;
  QPolygonF measured_;
  std::vector<CurvePoint> points_;  ///< scratch
};

/// The values at one sample.
struct ReadOut {
  struct Row {
    const CurveSpec* spec = nullptr;
    QString value;            ///< with its unit
    std::optional<double> y;  ///< axis coordinate of the dot, if it lies on the axis
  };
  double time_s = 0;
  std::vector<Row> rows;
};

class OverlayItem : public QGraphicsItem {
 public:
  using QGraphicsItem::QGraphicsItem;
  void set_area(const QRectF& area);
  void set_look(const Theme& colours, const QFont& font);
  void set_map(const PlotMap& map);
  void set_read_out(std::optional<ReadOut> read_out, bool with_time);
  void set_zoom_box(std::optional<QRectF> box);
  void set_message(const QString& message);  ///< calm text in the middle
  void set_note(const QString& note);        ///< small text in the corner

  const std::optional<ReadOut>& read_out() const { return read_out_; }
  const QString& note() const { return note_; }
  const QString& message() const { return message_; }
  QRectF boundingRect() const override { return area_; }
  void paint(QPainter* painter, const QStyleOptionGraphicsItem* option, QWidget* widget) override;

 private:
  void paint_read_out(QPainter& painter) const;
  void paint_values(QPainter& painter, double x) const;
  void paint_time(QPainter& painter, double x) const;
  void paint_note(QPainter& painter) const;

  QRectF area_;
  PlotMap map_;
  const Theme* theme_ = nullptr;
  QFont font_;
  std::optional<ReadOut> read_out_;
  bool with_time_ = false;
  std::optional<QRectF> zoom_box_;
  QString message_, note_;
};

}  // namespace clothlab
