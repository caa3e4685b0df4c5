#include "charts/plot_items.h"

#include <QFontMetricsF>
#include <QPaintEngine>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "widgets/numbers.h"

namespace clothlab {

namespace {

constexpr double marker_distance_px = 96;
constexpr double marker_radius_px = 3.2;
constexpr double edge_px = 5;  // no half markers at the sides
/// Far outside any plot, near enough for the painter's fixed-point arithmetic.
constexpr double far_px = 8000;

double axis_coordinate(double value, bool logarithmic) {
  return logarithmic ? std::log10(value) : value;
}

/// Leaves out the points of a curve that lie within a quarter of a pixel of the line through their
/// neighbours: the fewer pieces a smooth curve is drawn in, the faster and the cleaner its joins.
QPolygonF without_needless_points(const QPolygonF& points) {
  constexpr double tolerance_px = 0.25;
  QPolygonF kept;
  kept.reserve(points.size());
  double lowest = 0,
         highest = 0;  // slopes of the lines from the last kept point that miss none of those since
  for (qsizetype i = 0; i < points.size(); ++i) {
    const QPointF step = kept.isEmpty() ? QPointF() : points[i] - kept.back();
    const bool first_since = kept.isEmpty() || points[i - 1] == kept.back();
    const double slope = step.x() > 0 ? step.y() / step.x() : 0;
    if (!first_since && step.x() > 0 && slope >= lowest && slope <= highest) {
      lowest = std::max(lowest, (step.y() - tolerance_px) / step.x());
      highest = std::min(highest, (step.y() + tolerance_px) / step.x());
      continue;
    }
    if (i > 0 && !first_since) kept << points[i - 1];
    if (kept.isEmpty()) {
      kept << points[i];
      continue;
    }
    const QPointF from_kept = points[i] - kept.back();
    if (from_kept.x() <= 0) {
      if (points[i] != kept.back()) kept << points[i];
      continue;
    }
    lowest = (from_kept.y() - tolerance_px) / from_kept.x();
    highest = (from_kept.y() + tolerance_px) / from_kept.x();
  }
  if (!points.isEmpty() && points.back() != kept.back()) kept << points.back();
  return kept;
}

/// A curve with more samples than pixels goes up and down within each column of pixels. As one path that is
/// slow to paint, some 50 ms for a noisy curve, since its self-crossings are all resolved; line by line it
/// takes a tenth of that; and with the steep lines filled as upright bars of whole pixels a tenth again, for
/// hardly another look.
void paint_dense(QPainter& painter, const QPolygonF& piece) {
  constexpr double widest_px = 1.5, least_height_px = 3;
  const int width = std::max(1, qRound(painter.pen().widthF()));
  QList<QLineF> lines;
  QList<QRect> bars;
  for (qsizetype i = 1; i < piece.size(); ++i) {
    const QPointF from = piece[i - 1], to = piece[i];
    const double low = std::min(from.y(), to.y()), high = std::max(from.y(), to.y());
    if (std::abs(to.x() - from.x()) > widest_px || high - low < least_height_px) {
      lines << QLineF(from, to);
      continue;
    }
    const int left = static_cast<int>(std::floor((from.x() + to.x() - width) / 2 + 0.5));
    const int top = static_cast<int>(std::floor(low)), bottom = static_cast<int>(std::ceil(high));
    bars << QRect(left, top, width, bottom - top);
  }
  painter.drawLines(lines);
  const QPen pen = painter.pen();
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setPen(Qt::NoPen);
  painter.setBrush(pen.color());
  painter.drawRects(bars);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(pen);
  painter.setRenderHint(QPainter::Antialiasing);
}

/// A file gets one path all the same.
void paint_piece(QPainter& painter, const QPolygonF& piece) {
  constexpr qsizetype long_piece = 128;
  const bool on_pixels = painter.paintEngine()->type() == QPaintEngine::Raster;
  if (piece.size() == 1)
    painter.drawPoint(piece.front());
  else if (on_pixels && piece.size() > long_piece)
    paint_dense(painter, piece);
  else
    painter.drawPolyline(piece);
}

QColor see_through(QColor colour, float alpha) {
  colour.setAlphaF(alpha);
  return colour;
}

}  // namespace

void CurvesItem::set_plot(const QRectF& plot) {
  prepareGeometryChange();
  plot_ = plot;
}

void CurvesItem::set_theme(const Theme& colours) {
  theme_ = &colours;
  update();
}

void CurvesItem::set_limit(std::optional<double> y_px) {
  limit_y_ = y_px;
  update();
}

void CurvesItem::build(const ChartRecord& record, const ChartSpec& spec, const std::vector<bool>& shown,
                       const PlotMap& map, bool logarithmic) {
  curves_.clear();
  measured_.clear();
  const int pixels = std::max(1, static_cast<int>(map.plot.width()));
  for (std::size_t i = 0; i < spec.curves.size(); ++i) {
    if (!shown[i]) continue;
    const CurveSpec& curve = spec.curves[i];
    add_measured(record, curve, map, logarithmic);
    const SampleSeries& series = curve.series(record);
    series.query(curve.column, map.time.low, map.time.high, pixels,
                 logarithmic ? Keep::positive : Keep::finite, points_);
    DrawnCurve& drawn = curves_.emplace_back(DrawnCurve{&curve, {}, {}});
    add_pieces(drawn, map, logarithmic);
    const double phase = (static_cast<double>(i) + 0.5) / static_cast<double>(spec.curves.size());
    if (curve.style.marker != Marker::none) add_markers(drawn, series, phase, map, logarithmic);
  }
  update();
}

void CurvesItem::add_measured(const ChartRecord& record, const CurveSpec& curve, const PlotMap& map,
                              bool logarithmic) {
  if (curve.source != Source::samples || record.measured_column() != curve.column) return;
  const MeasuredDots& dots = *record.measured;
  for (std::size_t k = 0; k < dots.times.size(); ++k) {
    const double value = dots.values[k] * curve.scale;
    if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
    const QPointF at(map.x_of(dots.times[k]), map.y_of(axis_coordinate(value, logarithmic)));
    if (map.plot.adjusted(-edge_px, -edge_px, edge_px, edge_px).contains(at)) measured_ << at;
  }
}

void CurvesItem::add_pieces(DrawnCurve& curve, const PlotMap& map, bool logarithmic) {
  bool broken = true;
  for (const CurvePoint& point : points_) {
    if (std::isnan(point.value)) {
      broken = true;
      continue;
    }
    if (broken) curve.pieces.emplace_back();
    broken = false;
    const double y = map.y_of(axis_coordinate(point.value * curve.spec->scale, logarithmic));
    const double x = map.x_of(point.time_s);
    curve.pieces.back() << QPointF(std::clamp(x, -far_px, far_px), std::clamp(y, -far_px, far_px));
  }
  for (QPolygonF& piece : curve.pieces) piece = without_needless_points(piece);
}

/// Markers sit on recorded samples near fixed times, so that they travel with a scrolling curve.
void CurvesItem::add_markers(DrawnCurve& curve, const SampleSeries& series, double phase, const PlotMap& map,
                             bool logarithmic) {
  if (series.empty() || map.plot.width() <= 0) return;
  const double px_per_s = map.plot.width() / map.time.span();
  const double step = nice_step(marker_distance_px / px_per_s, 1);
  const double first = std::floor(map.time.low / step) - 1;
  const int count = static_cast<int>(map.time.span() / step) + 3;
  for (int i = 0; i < count; ++i) {
    const double wanted = (first + i + phase) * step;
    const std::size_t row = series.nearest(wanted);
    const double value = series.value(curve.spec->column, row) * curve.spec->scale;
    if (std::abs(series.time(row) - wanted) > step / 4 || !std::isfinite(value)) continue;
    if (logarithmic && value <= 0) continue;
    const QPointF at(map.x_of(series.time(row)), map.y_of(axis_coordinate(value, logarithmic)));
    if (map.plot.adjusted(edge_px, 0, -edge_px, 0).contains(at)) curve.markers << at;
  }
}

void CurvesItem::paint(QPainter* painter, const QStyleOptionGraphicsItem*, QWidget*) {
  painter->save();
  painter->setClipRect(plot_.adjusted(-1, -1, 1, 1));
  painter->setRenderHint(QPainter::Antialiasing);
  // The last curve, the sum of the others, lies below them; so do all lines below the markers.
  for (auto curve = curves_.rbegin(); curve != curves_.rend(); ++curve) {
    const CurveStyle& style = curve->spec->style;
    painter->setPen(QPen(theme_->*style.colour, style.width, style.line, Qt::FlatCap, Qt::BevelJoin));
    for (const QPolygonF& piece : curve->pieces) paint_piece(*painter, piece);
  }
  if (limit_y_) {  // over the curve, which often lies on it for long
    QPen pen(theme_->*limit_spec().style.colour, limit_spec().style.width);
    pen.setDashPattern({5, 3});
    painter->setPen(pen);
    painter->drawLine(QPointF(plot_.left(), *limit_y_), QPointF(plot_.right(), *limit_y_));
  }
  painter->setClipping(false);  // a marker on the plot's lower edge is drawn whole
  for (const DrawnCurve& curve : curves_)
    for (const QPointF& at : curve.markers)
      paint_marker(*painter, at, curve.spec->style.marker, theme_->*curve.spec->style.colour, theme_->field,
                   marker_radius_px);
  painter->setPen(QPen(theme_->text, 1.3));
  painter->setBrush(Qt::NoBrush);
  for (const QPointF& at : measured_) painter->drawEllipse(at, marker_radius_px, marker_radius_px);
  painter->restore();
}

void OverlayItem::set_area(const QRectF& area) {
  prepareGeometryChange();
  area_ = area;
}

void OverlayItem::set_look(const Theme& colours, const QFont& font) {
  theme_ = &colours;
  font_ = font;
  update();
}

void OverlayItem::set_map(const PlotMap& map) {
  map_ = map;
  update();
}

void OverlayItem::set_read_out(std::optional<ReadOut> read_out, bool with_time) {
  read_out_ = std::move(read_out);
  with_time_ = with_time;
  update();
}

void OverlayItem::set_zoom_box(std::optional<QRectF> box) {
  zoom_box_ = box;
  update();
}

void OverlayItem::set_message(const QString& message) {
  if (message == message_) return;
  message_ = message;
  update();
}

void OverlayItem::set_note(const QString& note) {
  if (note == note_) return;
  note_ = note;
  update();
}

void OverlayItem::paint(QPainter* painter, const QStyleOptionGraphicsItem*, QWidget*) {
  painter->save();
  painter->setFont(font_);
  painter->setRenderHint(QPainter::Antialiasing);
  constexpr int wrapped = Qt::AlignCenter | Qt::TextWordWrap;
  const QRectF inside = map_.plot.adjusted(spacing, 0, -spacing, 0);
  if (!message_.isEmpty() && painter->boundingRect(inside, wrapped, message_).height() <= inside.height()) {
    painter->setPen(theme_->muted_text);
    painter->drawText(inside, wrapped, message_);
  }
  if (!note_.isEmpty()) paint_note(*painter);
  if (read_out_) paint_read_out(*painter);
  if (zoom_box_) {
    painter->setPen(QPen(theme_->accent, 1));
    painter->setBrush(see_through(theme_->accent, 0.15F));
    painter->drawRect(zoom_box_->adjusted(0.5, 0.5, -0.5, -0.5));
  }
  painter->restore();
}

void OverlayItem::paint_note(QPainter& painter) const {
  const QFontMetricsF metrics(font_);
  QRectF box(0, 0, metrics.horizontalAdvance(note_) + spacing, metrics.height() + 2);
  box.moveBottomLeft(map_.plot.bottomLeft() + QPointF(spacing / 2.0, -spacing / 2.0));
  painter.setPen(Qt::NoPen);
  painter.setBrush(see_through(theme_->field, 0.85F));
  painter.drawRoundedRect(box, 3, 3);
  painter.setPen(theme_->muted_text);
  painter.drawText(box, Qt::AlignCenter, note_);
}

void OverlayItem::paint_read_out(QPainter& painter) const {
  const double x = map_.x_of(read_out_->time_s);
  if (x < map_.plot.left() - 0.5 || x > map_.plot.right() + 0.5) return;
  painter.setPen(QPen(see_through(theme_->text, 0.55F), 1));
  const double crisp = std::floor(x) + 0.5;
  painter.drawLine(QPointF(crisp, map_.plot.top()), QPointF(crisp, map_.plot.bottom()));
  for (const ReadOut::Row& row : read_out_->rows) {
    if (!row.y || !map_.y.contains(*row.y) || row.spec->style.line != Qt::SolidLine) continue;
    painter.setPen(QPen(theme_->field, 1.5));
    painter.setBrush(theme_->*row.spec->style.colour);
    painter.drawEllipse(QPointF(x, map_.y_of(*row.y)), 3.5, 3.5);
  }
  paint_values(painter, x);
  if (with_time_) paint_time(painter, x);
}

void OverlayItem::paint_values(QPainter& painter, double x) const {
  const QFontMetricsF metrics(font_);
  double names = 0, values = 0;
  for (const ReadOut::Row& row : read_out_->rows) {
    names = std::max(names, metrics.horizontalAdvance(row.spec->name));
    values = std::max(values, metrics.horizontalAdvance(row.value));
  }
  if (values == 0) return;
  constexpr double swatch = 14, gap = spacing, pad = spacing * 0.75;
  const double line = std::floor(metrics.height()) + 1;
  QRectF box(0, 0, std::ceil(2 * pad + swatch + gap / 2 + names + gap + values),
             static_cast<double>(read_out_->rows.size()) * line + pad);
  // On the side of the line that has more room.
  const bool left = x > map_.plot.center().x();
  box.moveTop(std::floor(std::clamp(map_.plot.top() + spacing / 2.0, area_.top(),
                                    std::max(area_.top(), area_.bottom() - box.height()))));
  box.moveLeft(std::floor(left ? x - spacing - box.width() : x + spacing) + 0.5);
  painter.setPen(QPen(theme_->border, 1));
  painter.setBrush(see_through(theme_->panel, 0.92F));
  painter.drawRoundedRect(box.translated(0, 0.5), spacing / 2.0, spacing / 2.0);
  double y = box.top() + pad / 2;
  for (const ReadOut::Row& row : read_out_->rows) {
    const QRectF text(box.left() + pad, y, box.width() - 2 * pad, line);
    paint_swatch(painter, QRectF(text.left(), y, swatch, line), row.spec->style, *theme_, true);
    painter.setPen(theme_->muted_text);
    painter.drawText(text.adjusted(swatch + gap / 2, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter,
                     row.spec->name);
    painter.setPen(theme_->text);
    painter.drawText(text, Qt::AlignRight | Qt::AlignVCenter, row.value);
    y += line;
  }
}

/// The sample's own time, on the time axis.
void OverlayItem::paint_time(QPainter& painter, double x) const {
  const QFontMetricsF metrics(font_);
  const QString text = quantity_text(read_out_->time_s, "s", 9);
  QRectF box(0, 0, metrics.horizontalAdvance(text) + spacing * 1.5, metrics.height() + 3);
  box.moveTop(map_.plot.bottom() + 3);
  box.moveLeft(
      std::clamp(x - box.width() / 2, area_.left(), std::max(area_.left(), area_.right() - box.width())));
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme_->accent);
  painter.drawRoundedRect(box, 3, 3);
  painter.setPen(theme_->accent_text);
  painter.drawText(box, Qt::AlignCenter, text);
}

}  // namespace clothlab
