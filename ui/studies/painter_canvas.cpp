#include "studies/painter_canvas.h"

#include <QPainterPath>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

/// What path_through and marker_path write: M, L, Z, and a full circle in two arcs.
QPainterPath parsed(const std::string& data) {
  QPainterPath path;
  const char* at = data.data();
  const char* const end = at + data.size();
  const auto number = [&] {
    while (at < end && (*at == ' ' || *at == ',')) ++at;
    double value = 0;
    at = std::from_chars(at, end, value).ptr;
    return value;
  };
  while (at < end) {
    const char command = *at++;
    if (command == 'M' || command == 'L') {
      const double x = number(), y = number();
      command == 'M' ? path.moveTo(x, y) : path.lineTo(x, y);
    } else if (command == 'Z') {
      path.closeSubpath();
    } else if (command == 'a') {
      const double radius = number();
      for (int skipped = 0; skipped < 4; ++skipped) number();
      const double dx = number();
      number();
      const QPointF from = path.currentPosition();
      path.arcTo(QRectF(from.x() + std::min(dx, 0.0), from.y() - radius, 2 * radius, 2 * radius),
                 dx > 0 ? 180 : 0, 180);
    } else {
      return path;
    }
  }
  return path;
}

QVector<qreal> pattern_of(cloth::Dash dash) {
  switch (dash) {
    case cloth::Dash::solid:
      return {};
    case cloth::Dash::dashed:
      return {4, 2.5};
    case cloth::Dash::dotted:
      return {1, 2};
    case cloth::Dash::dash_dotted:
      return {5, 2, 1, 2};
  }
  return {};
}

constexpr double least_text = 11;  // px

QFont sized(QFont font, double size, bool bold) {
  font.setPixelSize(std::max(1, static_cast<int>(std::lround(size))));
  font.setBold(bold);
  return font;
}

}  // namespace

QString PlotTouch::text() const {
  return sentence_text(words);
}

PainterCanvas::PainterCanvas(QPainter& painter, const QFont& font, Look look)
    : painter_(painter), font_(font), look_(look) {
  painter_.setRenderHint(QPainter::Antialiasing);
}

QColor PainterCanvas::colour(const cloth::PageColour& colour) const {
  if (look_ == Look::theme) {
    const cloth::PageColours& page = cloth::page_colours();
    const Theme& t = theme();
    if (colour.name == page.surface.name) return t.panel;
    if (colour.name == page.ink.name) return t.text;
    if (colour.name == page.muted.name) return t.muted_text;
    if (colour.name == page.grid.name) return t.grid_line;
  }
  const bool dark = look_ == Look::dark_paper || (look_ == Look::theme && theme().dark);
  return QColor(QString::fromStdString(dark ? colour.dark : colour.light));
}

void PainterCanvas::draw(const QPainterPath& shape, const cloth::SvgStyle& own, const cloth::SvgTip& tip) {
  cloth::SvgStyle style = own;
  if (!style.fill && !style.stroke && !groups_.empty()) {
    style = groups_.back().style;
    style.opacity = own.opacity;
  }
  painter_.save();
  painter_.setOpacity(painter_.opacity() * style.opacity);
  painter_.setBrush(style.fill ? QBrush(colour(*style.fill)) : QBrush(Qt::NoBrush));
  painter_.setPen(Qt::NoPen);
  if (style.stroke) {
    QPen pen(colour(*style.stroke), style.stroke_width);
    pen.setCapStyle(Qt::FlatCap);
    if (const auto pattern = pattern_of(style.dash); !pattern.isEmpty()) pen.setDashPattern(pattern);
    painter_.setPen(pen);
  }
  painter_.drawPath(shape);
  painter_.restore();
  const bool answers = !tip.text.empty() && (groups_.empty() || !groups_.back().untouchable);
  if (answers)
    touches_.push_back(
        {shape.boundingRect(), tip.text, tip.tag, style.fill || tip.tag < 0 ? QPainterPath() : shape});
}

void PainterCanvas::path(const std::string& data, const cloth::SvgStyle& style, const cloth::SvgTip& tip) {
  if (!data.empty()) draw(parsed(data), style, tip);
}

void PainterCanvas::rect(cloth::SvgPoint corner, double width, double height, const cloth::SvgStyle& style,
                         const cloth::SvgTip& tip) {
  QPainterPath shape;
  shape.addRect(corner.x, corner.y, width, height);
  draw(shape, style, tip);
}

void PainterCanvas::marker(cloth::Marker marker, cloth::SvgPoint centre, double radius,
                           const cloth::SvgStyle& style, const cloth::SvgTip& tip) {
  path(cloth::marker_path(marker, centre, radius), style, tip);
}

void PainterCanvas::text(cloth::SvgPoint baseline, const cloth::SvgText& text) {
  QString words = QString::fromStdString(text.text);
  if (look_ == Look::theme) words = localised(words);  // files have decimal points
  const QString raised = QString::fromStdString(text.superscript);
  const QFont font = sized(font_, text.size, text.bold),
              small = sized(font_, std::max(least_text, 0.75 * text.size), text.bold);
  const double width = QFontMetricsF(font).horizontalAdvance(words);
  const double whole = width + (raised.isEmpty() ? 0 : QFontMetricsF(small).horizontalAdvance(raised));
  const double left = text.anchor == cloth::Anchor::start    ? 0
                      : text.anchor == cloth::Anchor::middle ? -whole / 2
                                                             : -whole;
  smallest_text_ =
      std::min(smallest_text_, static_cast<double>(raised.isEmpty() ? font.pixelSize() : small.pixelSize()));
  painter_.save();
  painter_.translate(baseline.x, baseline.y);
  painter_.rotate(text.turn);
  // The layout knows the widths of Helvetica: a wider face is drawn narrower.
  const double room = cloth::text_width(text.text, text.size, text.bold) +
                      cloth::text_width(text.superscript, 0.75 * text.size);
  if (whole > room && room > 0) painter_.scale(room / whole, 1);
  if (text.halo) {
    QPainterPath outline;
    outline.addText(left, 0, font, words);
    if (!raised.isEmpty()) outline.addText(left + width, -0.4 * text.size, small, raised);
    painter_.strokePath(outline, QPen(colour(cloth::page_colours().surface), 3.5, Qt::SolidLine, Qt::RoundCap,
                                      Qt::RoundJoin));
  }
  painter_.setPen(colour(text.colour));
  painter_.setFont(font);
  painter_.drawText(QPointF(left, 0), words);
  if (!raised.isEmpty()) {
    painter_.setFont(small);
    painter_.drawText(QPointF(left + width, -0.4 * text.size), raised);
  }
  painter_.restore();
}

void PainterCanvas::begin_group(const std::string&, const cloth::SvgStyle& style, bool untouchable,
                                bool crisp) {
  groups_.push_back({style, untouchable});
  painter_.save();
  painter_.setOpacity(painter_.opacity() * style.opacity);  // of each shape: SVG's is of the group as a whole
  if (crisp) painter_.setRenderHint(QPainter::Antialiasing, false);
}

void PainterCanvas::end_group() {
  groups_.pop_back();
  painter_.restore();
}

}  // namespace clothlab
