// How a curve looks in its plot, its legend entry and the read-out: colour and marker or dash, so that curves
// are told apart without colour as well.
#pragma once

#include <QColor>
#include <QPointF>
#include <QRectF>

#include "theme/theme.h"

class QPainter;

namespace clothlab {

enum class Marker { none, circle, square, triangle, diamond };

struct CurveStyle {
  QColor Theme::*colour = nullptr;
  Marker marker = Marker::none;
  double width = 1.5;  ///< logical px
  Qt::PenStyle line = Qt::SolidLine;
};

/// A marker of half-size `radius`, filled, with a thin rim in the plot's colour that sets it off from its
/// curve.
void paint_marker(QPainter& painter, QPointF at, Marker marker, const QColor& fill, const QColor& rim,
                  double radius);

/// A short piece of the curve across `rect`, greyed when the curve is hidden.
void paint_swatch(QPainter& painter, const QRectF& rect, const CurveStyle& style, const Theme& theme,
                  bool shown);

}  // namespace clothlab
