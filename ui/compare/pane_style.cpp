#include "compare/pane_style.h"

#include <QPainter>
#include <algorithm>

namespace clothlab {
namespace {

constexpr int marker_radius = 5, icon_size = 16;  // px

}  // namespace

CurveStyle pane_curve(int style) {
  static const CurveStyle styles[] = {{&Theme::pane_a, Marker::circle, 1.8},
                                      {&Theme::pane_b, Marker::square, 1.8},
                                      {&Theme::pane_c, Marker::triangle, 1.8},
                                      {&Theme::pane_d, Marker::diamond, 1.8}};
  return styles[std::clamp(style, 0, 3)];
}

QColor pane_colour(int style) {
  return theme().*pane_curve(style).colour;
}

PaneBadge::PaneBadge(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  QFont bold = font();
  bold.setWeight(QFont::Bold);
  bold.setPointSizeF(1.15 * bold.pointSizeF());
  setFont(bold);
}

void PaneBadge::setPane(int style, const QString& name) {
  style_ = style;
  name_ = name;
  setAccessibleName(tr("Pane %1").arg(name));
  update();
}

QSize PaneBadge::sizeHint() const {
  return {2 * marker_radius + spacing + fontMetrics().horizontalAdvance(QStringLiteral("W")) + 2, 28};
}

void PaneBadge::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor colour = pane_colour(style_);
  paint_marker(painter, QPointF(marker_radius + 1, height() / 2.0), pane_curve(style_).marker, colour,
               theme().panel, marker_radius);
  painter.setPen(theme().text);
  painter.drawText(rect().adjusted(2 * marker_radius + spacing / 2 + 2, 0, 0, 0),
                   Qt::AlignVCenter | Qt::AlignLeft, name_);
}

QIcon pane_icon(int style) {
  QPixmap picture(2 * icon_size, 2 * icon_size);
  picture.setDevicePixelRatio(2);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  paint_marker(painter, QPointF(icon_size / 2.0, icon_size / 2.0), pane_curve(style).marker,
               pane_colour(style), theme().panel, marker_radius);
  painter.end();
  return QIcon(picture);
}

}  // namespace clothlab
