#include "charts/curve_style.h"

#include <QPainter>
#include <QPen>
#include <QPolygonF>

namespace clothlab {

void paint_marker(QPainter& painter, QPointF at, Marker marker, const QColor& fill, const QColor& rim,
                  double radius) {
  if (marker == Marker::none) return;
  painter.setPen(QPen(rim, 1));
  painter.setBrush(fill);
  const double r = radius;
  if (marker == Marker::circle) {
    painter.drawEllipse(at, r, r);
  } else if (marker == Marker::square) {
    const double s = 0.88 * r;  // looks as large as the circle
    painter.drawRect(QRectF(at.x() - s, at.y() - s, 2 * s, 2 * s));
  } else if (marker == Marker::diamond) {
    const double d = 1.2 * r;
    painter.drawPolygon(
        QPolygonF({{at.x(), at.y() - d}, {at.x() + d, at.y()}, {at.x(), at.y() + d}, {at.x() - d, at.y()}}));
  } else {
    const double w = 1.15 * r;
    painter.drawPolygon(QPolygonF(
        {{at.x(), at.y() - 1.15 * r}, {at.x() + w, at.y() + 0.85 * r}, {at.x() - w, at.y() + 0.85 * r}}));
  }
}

void paint_swatch(QPainter& painter, const QRectF& rect, const CurveStyle& style, const Theme& theme,
                  bool shown) {
  const QColor colour = shown ? theme.*style.colour : theme.disabled_text;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  QPen pen(colour, style.width + 0.5, style.line, Qt::FlatCap);
  if (style.line == Qt::DashLine) pen.setDashPattern({2.5, 1.5});
  painter.setPen(pen);
  const double y = rect.center().y();
  painter.drawLine(QPointF(rect.left(), y), QPointF(rect.right(), y));
  paint_marker(painter, rect.center(), style.marker, colour, theme.panel, 3.5);
  painter.restore();
}

}  // namespace clothlab
