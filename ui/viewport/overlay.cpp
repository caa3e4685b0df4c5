#include "viewport/overlay.h"

#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "theme/theme.h"
#include "viewport/obstacle_handle.h"
#include "viewport/strain_scale.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

QFont font_of(const QPainter& painter, double scale, QFont::Weight weight) {
  QFont font = painter.font();
  font.setPointSizeF(font.pointSizeF() * scale);
  font.setWeight(weight);
  return font;
}

QColor faded(QColor colour, double opacity) {
  colour.setAlphaF(static_cast<float>(opacity));
  return colour;
}

/// A quiet surface under text, so that it can be read over anything.
void card(QPainter& painter, const QRectF& area, const Theme& theme) {
  painter.setPen(QPen(faded(theme.border, 0.8), 1));
  painter.setBrush(faded(theme.panel, 0.86));
  painter.drawRoundedRect(area.adjusted(0.5, 0.5, -0.5, -0.5), 6, 6);
}

/// The font of notes, and how large a card with a text in it is.
QFont note_font(const QPainter& painter) {
  return font_of(painter, 0.9, QFont::Normal);
}

QSizeF card_size(const QPainter& painter, const QFont& font, const QString& text) {
  const QFontMetricsF metrics(font, painter.device());
  return {metrics.horizontalAdvance(text) + 20, metrics.height() + 8};
}

void text_card(QPainter& painter, const QRectF& area, const Theme& theme, const QFont& font,
               const QColor& colour, const QString& text) {
  card(painter, area, theme);
  painter.setFont(font);
  painter.setPen(colour);
  painter.drawText(area, Qt::AlignCenter, text);
}

QString percent(double strain) {
  return number_text(100 * strain, 4);
}

/// A line that stands out from light and dark alike: a soft dark or light edge under the colour.
void haloed_line(QPainter& painter, const QLineF& line, const QColor& colour, const QColor& halo,
                 double width) {
  painter.setPen(QPen(halo, width + 2, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(line);
  painter.setPen(QPen(colour, width, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(line);
}

QColor halo_of(const Theme& theme) {
  return faded(theme.dark ? QColor(Qt::black) : QColor(Qt::white), 0.65);
}

/// How much of a line (px) lies in a rectangle, to some px.
double length_within(const QPolygonF& line, const QRectF& area) {
  constexpr double stride = 4;
  double within = 0;
  for (qsizetype i = 1; i < line.size(); ++i) {
    const QLineF part(line[i - 1], line[i]);
    for (double s = 0; s < part.length(); s += stride)
      if (area.contains(part.pointAt(s / part.length()))) within += stride;
  }
  return within;
}

/// A label of this size below the handle at `at`, or above its arrows where it would cover more of the way of
/// the keys below; inside the view.
QRectF place_beside_handle(QPointF at, QSizeF label, const QPolygonF& keys, QSizeF view) {
  const double left =
      std::clamp(at.x() - 0.5 * label.width(), 0.0, std::max(0.0, view.width() - label.width()));
  const QRectF below(QPointF(left, at.y() + ObstacleHandle::ring_radius + 10), label);
  const QRectF above(QPointF(left, at.y() - ObstacleHandle::arrow_length - 10 - label.height()), label);
  const bool up = above.top() >= 0 &&
                  (below.bottom() > view.height() || length_within(keys, above) < length_within(keys, below));
  return up ? above : below;
}

/// Beside a particle, to the right and above; where there is no room in the view, or another label, at
/// another side or further away.
QRectF place_beside(QPointF at, QSizeF room, QSizeF view, const std::vector<QRectF>& others) {
  constexpr double gap = 12;
  constexpr int rounds = 8;
  const QRectF whole(QPointF(), view);
  const double right = at.x() + gap, left = at.x() - gap - room.width();
  const double most = std::max(0.0, view.width() - room.width());
  // Where neither side has room for the whole label, it may stand above or below the place.
  for (const bool shifted : {false, true})
    for (int round = 0; round < rounds; ++round) {
      const double further = gap + round * (room.height() + 2);
      for (const double y : {at.y() - further - room.height(), at.y() + further})
        for (const double x : {right, left}) {
          const QRectF area(QPointF(shifted ? std::clamp(x, 0.0, most) : x, y), room);
          const bool is_free = std::none_of(others.begin(), others.end(),
                                            [&](const QRectF& other) { return other.intersects(area); });
          if (is_free && whole.contains(area)) return area;
        }
    }
  return {QPointF(std::clamp(right, 0.0, std::max(0.0, view.width() - room.width())),
                  std::clamp(at.y() + gap, 0.0, std::max(0.0, view.height() - room.height()))),
          room};
}

/// The name in bold, then the values in one line.
QSizeF label_size(const QPainter& painter, const ProbeLabel& label) {
  const QFontMetricsF bold(font_of(painter, 0.9, QFont::DemiBold), painter.device());
  const QFontMetricsF plain(note_font(painter), painter.device());
  return {bold.horizontalAdvance(label.name) + 8 +
              plain.horizontalAdvance(label.values.join(QStringLiteral("  ·  "))) + 20,
          plain.height() + 8};
}

void label_card(QPainter& painter, const QRectF& area, const Theme& theme, const ProbeLabel& label) {
  card(painter, area, theme);
  const QFont bold = font_of(painter, 0.9, QFont::DemiBold), plain = note_font(painter);
  const QFontMetricsF metrics(bold, painter.device());
  painter.setFont(bold);
  painter.setPen(theme.accent);
  painter.drawText(area.adjusted(10, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, label.name);
  painter.setFont(plain);
  painter.setPen(theme.text);
  painter.drawText(area.adjusted(18 + metrics.horizontalAdvance(label.name), 0, 0, 0),
                   Qt::AlignLeft | Qt::AlignVCenter, label.values.join(QStringLiteral("  ·  ")));
}

void arrow(QPainter& painter, const QLineF& line, const QColor& colour, const QColor& halo, double width) {
  haloed_line(painter, line, colour, halo, width);
  const double length = line.length(), head = std::min(11.0, 0.5 * length);
  const QPointF along = (line.p2() - line.p1()) / length, across(-along.y(), along.x());
  QPainterPath tip(line.p2() + 2 * along);
  tip.lineTo(line.p2() - head * along + 0.5 * head * across);
  tip.lineTo(line.p2() - 0.7 * head * along);
  tip.lineTo(line.p2() - head * along - 0.5 * head * across);
  tip.closeSubpath();
  painter.setPen(QPen(halo, 1));
  painter.setBrush(colour);
  painter.drawPath(tip);
}

}  // namespace

void PaintedLayer::lay(QPainter& view, const QRectF& area, const Key& key,
                       const std::function<void(QPainter&)>& paint) {
  const QRect whole = area.toAlignedRect();
  const double ratio = view.device()->devicePixelRatioF();
  if (image_.isNull() || key != key_ || whole != area_ || image_.devicePixelRatio() != ratio) {
    const QSize pixels = (QSizeF(whole.size()) * ratio).toSize();
    if (image_.size() != pixels) image_ = QImage(pixels, QImage::Format_ARGB32_Premultiplied);
    image_.setDevicePixelRatio(ratio);
    image_.fill(Qt::transparent);
    QPainter painter(&image_);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(view.font());
    painter.translate(-whole.topLeft());
    paint(painter);
    key_ = key;
    area_ = whole;
  }
  view.drawImage(whole.topLeft(), image_);
}

void Overlay::forget() {
  for (PaintedLayer* layer : {&bar_, &mode_, &contact_, &brush_, &ring_, &line_, &hint_, &message_})
    layer->forget();
}

void Overlay::colour_bar(QPainter& view, QSizeF size, const Theme& theme, double maximum,
                         double deformation_rate) {
  const QFontMetricsF metrics(font_of(view, 0.9, QFont::Normal), view.device());
  const bool has_rate = deformation_rate >= 0;
  const QString rate_text = has_rate ? tr("Limit %1").arg(percent(deformation_rate)) : QString();
  const double line = metrics.height();
  const double text_width =
      std::max(metrics.horizontalAdvance(tr("Strain [%]")), metrics.horizontalAdvance(rate_text));
  const double card_width = text_width + 34;
  const double height = std::clamp(size.height() - 2 * spacing - 40, 60.0, 230.0);
  const QRectF area(size.width() - card_width - 2 * spacing, size.height() - height - 2 * spacing, card_width,
                    height);
  const auto paint = [&](QPainter& p) {
    card(p, area, theme);
    p.setFont(font_of(p, 0.9, QFont::DemiBold));
    p.setPen(theme.text);
    p.drawText(area.adjusted(12, 7, 0, 0), Qt::AlignLeft | Qt::AlignTop, tr("Strain [%]"));
    p.setFont(font_of(p, 1, QFont::Normal));
    if (has_rate) {
      p.setPen(theme.muted_text);
      p.drawText(area.adjusted(12, 0, 0, -8), Qt::AlignLeft | Qt::AlignBottom, rate_text);
    }

    const QRectF bar(area.left() + 12, area.top() + line + 19, 14,
                     height - line - 34 - (has_rate ? line + 6 : 0));
    paint_colour_scale(p, bar, maximum, area.right() - bar.right() - 14, percent, theme);
    if (has_rate && deformation_rate <= maximum) {
      const double y = bar.bottom() - bar.height() * deformation_rate / maximum;
      haloed_line(p, {bar.left() - 3, y, bar.right() + 3, y}, theme.limit, faded(theme.panel, 0.9), 2);
      QPainterPath mark(QPointF(bar.left() - 2, y));
      mark.lineTo(bar.left() - 8, y - 4.5);
      mark.lineTo(bar.left() - 8, y + 4.5);
      mark.closeSubpath();
      p.setPen(Qt::NoPen);
      p.setBrush(theme.limit);
      p.drawPath(mark);
    }
  };
  bar_.lay(view, area, {maximum, deformation_rate}, paint);
}

void Overlay::mode_name(QPainter& view, const Theme& theme, ViewMode mode, Quantity quantity) {
  const QString name = mode == ViewMode::textured         ? tr("Textured")
                       : mode == ViewMode::wireframe      ? tr("Wireframe")
                       : quantity == Quantity::difference ? tr("Difference")
                                                          : tr("Strain");
  const QFont font = font_of(view, 0.9, QFont::Medium);
  const QRectF area(QPointF(2 * spacing, 2 * spacing), card_size(view, font, name));
  mode_.lay(view, area, {static_cast<double>(mode), static_cast<double>(quantity)},
            [&](QPainter& p) { text_card(p, area, theme, font, theme.muted_text, name); });
  labels_.push_back(area);
}

void Overlay::contact_note(QPainter& view, const Theme& theme, int touches, bool below_mode) {
  const QString note = touches == 1 ? tr("1 touch") : tr("%1 touches").arg(touches);
  const QSizeF size = card_size(view, note_font(view), note);
  const QPointF corner(below_mode ? QPointF(2 * spacing, 3 * spacing + size.height())
                                  : QPointF(spacing, spacing));
  const QRectF area(corner, size);
  contact_.lay(view, area, {static_cast<double>(touches)},
               [&](QPainter& p) { text_card(p, area, theme, note_font(view), theme.text, note); });
  labels_.push_back(area);
}

void Overlay::handle(QPainter& view, const Theme& theme, QPointF at, const std::array<QPointF, 3>& tips,
                     int active) {
  view.save();
  view.setRenderHint(QPainter::Antialiasing);
  const std::array<QColor, 3> colours{theme.dark ? QColor(0xFF, 0x6B, 0x6B) : QColor(0xC9, 0x2A, 0x2A),
                                      theme.dark ? QColor(0x69, 0xDB, 0x7C) : QColor(0x2B, 0x8A, 0x3E),
                                      theme.dark ? QColor(0x74, 0xC0, 0xFC) : QColor(0x18, 0x64, 0xAB)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const QLineF whole(at, tips[axis]);
    constexpr double least = ObstacleHandle::ring_radius + 6;
    if (whole.length() < least) continue;  // it looks along the axis
    const QPointF start = whole.pointAt((ObstacleHandle::ring_radius + 2) / whole.length());
    const bool is_active = active == static_cast<int>(axis) + 1;
    arrow(view, {start, tips[axis]}, colours[axis], halo_of(theme), is_active ? 3.5 : 2);
  }
  view.setBrush(faded(theme.accent, active == 0 ? 0.45 : 0.15));
  view.setPen(QPen(halo_of(theme), 5));
  view.drawEllipse(at, ObstacleHandle::ring_radius, ObstacleHandle::ring_radius);
  view.setPen(QPen(theme.accent, active == 0 ? 3 : 2));
  view.drawEllipse(at, ObstacleHandle::ring_radius, ObstacleHandle::ring_radius);
  view.restore();
}

void Overlay::motion(QPainter& view, QSizeF size, const Theme& theme, const QPolygonF& keys, QPointF at) {
  view.save();
  view.setRenderHint(QPainter::Antialiasing);
  view.setBrush(Qt::NoBrush);
  view.setPen(QPen(halo_of(theme), 4, Qt::SolidLine, Qt::RoundCap));
  view.drawPolyline(keys);
  view.setPen(QPen(theme.accent, 1.5, Qt::DashLine, Qt::FlatCap));
  view.drawPolyline(keys);
  view.setBrush(theme.accent);
  for (const QPointF& key : keys) {
    view.setPen(QPen(halo_of(theme), 1.5));
    view.drawEllipse(key, 3.5, 3.5);
  }
  const QString note = tr("Moves the whole motion");
  const QFont font = note_font(view);
  const QRectF label = place_beside_handle(at, card_size(view, font, note), keys, size);
  text_card(view, label, theme, font, theme.text, note);
  view.restore();
}

void Overlay::brush(QPainter& view, const Theme& theme, const Brush& brush) {
  const QLineF drag(brush.start, brush.cursor);
  const bool has_arrow = brush.blowing && drag.length() > 4;
  const QString speed = tr("%1 m/s").arg(fixed_text(brush.speed, 1));
  const QFont font = font_of(view, 0.9, QFont::DemiBold);
  const QRectF label(brush.cursor + QPointF(14, 14), card_size(view, font, speed));
  const double r = brush.radius + 3;
  QRectF area(brush.cursor - QPointF(r, r), QSizeF(2 * r, 2 * r));
  if (has_arrow) area |= QRectF(brush.start, brush.cursor).normalized().adjusted(-16, -16, 16, 16) | label;
  const PaintedLayer::Key key{brush.cursor.x(), brush.cursor.y(), brush.start.x(),
                              brush.start.y(),  brush.radius,     brush.blowing ? brush.speed : -1};
  brush_.lay(view, area, key, [&](QPainter& p) {
    // The gust's own falloff (cosine of the distance), as a breath of colour.
    QRadialGradient breath(brush.cursor, brush.radius);
    for (int i = 0; i <= 8; ++i)
      breath.setColorAt(i / 8.0,
                        faded(theme.accent, (brush.blowing ? 0.20 : 0.10) * std::cos(i / 8.0 * M_PI_2)));
    p.setBrush(breath);
    p.setPen(QPen(halo_of(theme), 3));
    p.drawEllipse(brush.cursor, brush.radius, brush.radius);
    p.setBrush(Qt::NoBrush);
    p.setPen(QPen(faded(theme.accent, brush.blowing ? 1 : 0.85), 1.5));
    p.drawEllipse(brush.cursor, brush.radius, brush.radius);
    if (!has_arrow) return;
    p.setPen(Qt::NoPen);
    p.setBrush(theme.accent);
    p.drawEllipse(brush.start, 3, 3);
    arrow(p, drag, theme.accent, halo_of(theme), 2);
    text_card(p, label, theme, font, theme.text, speed);
  });
}

void Overlay::ring(QPainter& view, const Theme& theme, QPointF at, Ring ring) {
  const double r = ring == Ring::highlight ? 7 : 9;
  const QRectF area = QRectF(at, QSizeF()).adjusted(-14, -14, 14, 14);
  ring_.lay(view, area, {at.x(), at.y(), static_cast<double>(ring)}, [&](QPainter& p) {
    const QColor colour = ring == Ring::remove ? theme.error : theme.accent;
    p.setBrush(Qt::NoBrush);
    p.setPen(QPen(halo_of(theme), 4.5));
    p.drawEllipse(at, r, r);
    p.setPen(QPen(colour, 2));
    p.drawEllipse(at, r, r);
    if (ring == Ring::remove) {
      const double k = r * M_SQRT1_2;
      haloed_line(p, {at.x() - k, at.y() - k, at.x() + k, at.y() + k}, colour, halo_of(theme), 2);
      haloed_line(p, {at.x() - k, at.y() + k, at.x() + k, at.y() - k}, colour, halo_of(theme), 2);
    } else if (ring == Ring::add) {
      p.setPen(Qt::NoPen);
      p.setBrush(colour);
      p.drawEllipse(at, 3, 3);
    }
  });
}

void Overlay::pull_line(QPainter& view, const Theme& theme, QPointF particle, QPointF cursor) {
  const QRectF area = QRectF(particle, cursor).normalized().adjusted(-8, -8, 8, 8);
  line_.lay(view, area, {particle.x(), particle.y(), cursor.x(), cursor.y()}, [&](QPainter& p) {
    haloed_line(p, {particle, cursor}, theme.accent, halo_of(theme), 1.5);
    p.setPen(QPen(halo_of(theme), 1.5));
    p.setBrush(theme.accent);
    p.drawEllipse(particle, 4, 4);
    p.drawEllipse(cursor, 2.5, 2.5);
  });
}

void Overlay::probe(QPainter& view, QSizeF size, const Theme& theme, const QPolygonF& particles,
                    const ProbeLabel* label) {
  view.save();
  view.setRenderHint(QPainter::Antialiasing);
  view.setBrush(Qt::NoBrush);
  view.setPen(QPen(halo_of(theme), 4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  view.drawPolyline(particles);
  view.setPen(QPen(theme.accent, label ? 2 : 1.5, label ? Qt::SolidLine : Qt::DashLine, Qt::RoundCap));
  view.drawPolyline(particles);
  constexpr qsizetype most_dots = 3;  // of a line only its ends
  for (qsizetype k = 0; k < particles.size(); ++k) {
    if (particles.size() > most_dots && k > 0 && k + 1 < particles.size()) continue;
    view.setBrush(theme.accent);
    view.setPen(QPen(halo_of(theme), 2));
    view.drawEllipse(particles[k], 4.5, 4.5);
  }
  if (label) {
    const QPointF anchor = particles.size() > most_dots ? particles[particles.size() / 2]
                           : particles.size() == 3      ? particles[1]
                                                        : particles.back();
    const QRectF area = place_beside(anchor, label_size(view, *label), size, labels_);
    label_card(view, area, theme, *label);
    labels_.push_back(area);
  }
  view.restore();
}

void Overlay::shape_probe(QPainter& view, const Theme& theme, const ProbeLabel& label) {
  view.save();
  view.setRenderHint(QPainter::Antialiasing);
  const QSizeF room = label_size(view, label);
  const double top = labels_.empty() ? 2 * spacing : labels_.back().bottom() + spacing / 2.0;
  const QRectF area(QPointF(2 * spacing, top), room);
  label_card(view, area, theme, label);
  labels_.push_back(area);
  view.restore();
}

void Overlay::reading(QPainter& view, QSizeF size, const Theme& theme, QPointF at, const QStringList& lines) {
  view.save();
  view.setRenderHint(QPainter::Antialiasing);
  const QString text = lines.join(QStringLiteral("  ·  "));
  const QFont font = note_font(view);
  text_card(view, place_beside(at, card_size(view, font, text), size, {}), theme, font, theme.text, text);
  view.restore();
}

void Overlay::hint(QPainter& view, QSizeF size, const Theme& theme, const QString& text) {
  const QFont font = note_font(view);
  QSizeF room = card_size(view, font, text);
  room.setWidth(std::min(room.width(), size.width() - 2 * spacing));
  const QRectF area(QPointF((size.width() - room.width()) / 2, size.height() - room.height() - 2 * spacing),
                    room);
  hint_.lay(view, area, {static_cast<double>(qHash(text))}, [&](QPainter& p) {
    const QFontMetricsF metrics(font, view.device());
    text_card(p, area, theme, font, theme.text, metrics.elidedText(text, Qt::ElideRight, area.width() - 12));
  });
}

void Overlay::message(QPainter& view, QSizeF size, const Theme& theme, const QString& title,
                      const QString& text) {
  const QRectF area(0, size.height() / 2 - 50, size.width(), 100);
  message_.lay(view, area, {}, [&](QPainter& p) {
    p.setFont(font_of(p, 1.4, QFont::DemiBold));
    p.setPen(theme.text);
    p.drawText(QRectF(area.left(), area.top(), area.width(), 48), Qt::AlignHCenter | Qt::AlignBottom, title);
    p.setFont(font_of(p, 1 / 1.4, QFont::Normal));
    p.setPen(theme.muted_text);
    p.drawText(QRectF(area.left(), area.top() + 54, area.width(), 40), Qt::AlignHCenter | Qt::AlignTop, text);
  });
}

}  // namespace clothlab
