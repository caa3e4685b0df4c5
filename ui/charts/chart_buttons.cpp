#include "charts/chart_buttons.h"

#include <QFontMetrics>
#include <QPainter>
#include <algorithm>

namespace clothlab {

namespace {

constexpr int button_padding = spacing * 3 / 4;
constexpr int swatch_width = 18;
constexpr int swatch_gap = spacing / 2;
constexpr int entry_padding = spacing / 2;

}  // namespace

QFont chart_font(const QFont& window_font) {
  QFont font = window_font;
  if (font.pointSizeF() > 0)
    font.setPointSizeF(std::max(7.5, font.pointSizeF() - 0.75));
  else
    font.setPixelSize(std::max(10, font.pixelSize() - 1));
  return font;
}

FlatButton::FlatButton(const QString& text, QWidget* parent) : QAbstractButton(parent) {
  setText(text);
  setAccessibleName(text);
  setFocusPolicy(Qt::TabFocus);
  setAttribute(Qt::WA_Hover);
  setCursor(Qt::ArrowCursor);
}

QSize FlatButton::sizeHint() const {
  const QFontMetrics metrics(font());
  return {metrics.horizontalAdvance(text()) + 2 * button_padding, metrics.height() + spacing / 2};
}

void FlatButton::setEmphasised(bool emphasised) {
  emphasised_ = emphasised;
  update();
}

void FlatButton::paint_ground(QPainter& painter, bool raised, bool outlined) const {
  const Theme& colours = theme();
  painter.setRenderHint(QPainter::Antialiasing);
  QColor ground = colours.accent;
  ground.setAlphaF(raised ? 0.18F : 0.0F);
  if (isEnabled() && underMouse()) {
    if (!raised) ground = colours.border;
    ground.setAlphaF(raised ? 0.26F : 0.45F);
  }
  const QRectF box = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
  painter.setPen(hasFocus()            ? QPen(colours.accent, 1)
                 : outlined && !raised ? QPen(colours.border, 1)
                                       : QPen(Qt::NoPen));
  painter.setBrush(ground);
  painter.drawRoundedRect(box, spacing / 2.0, spacing / 2.0);
}

void FlatButton::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const Theme& colours = theme();
  paint_ground(painter, isChecked() || emphasised_, isCheckable());
  painter.setPen(!isEnabled()                 ? colours.disabled_text
                 : isChecked() || emphasised_ ? colours.text
                                              : colours.muted_text);
  painter.drawText(rect(), Qt::AlignCenter, text());
}

LegendEntry::LegendEntry(const QString& name, const CurveStyle& style, QWidget* parent)
    : FlatButton(name, parent), style_(style) {
  setCheckable(true);
  setChecked(true);
  setToolTip(tr("Click to hide or show %1").arg(name.toLower()));
}

void LegendEntry::setName(const QString& text, const QString& name) {
  setText(text);
  setAccessibleName(name);
  setToolTip(tr("Click to hide or show %1").arg(name));
  update();
}

int LegendEntry::width_of(const QString& name, const QFont& font) {
  return 2 * entry_padding + swatch_width + swatch_gap + QFontMetrics(font).horizontalAdvance(name);
}

QSize LegendEntry::sizeHint() const {
  return {width_of(text(), font()), QFontMetrics(font()).height() + spacing / 2};
}

void LegendEntry::paint(QPainter& painter, const QRect& rect, const QString& name, const CurveStyle& style,
                        bool shown, const Theme& colours) {
  const QRectF swatch(rect.left() + entry_padding, rect.top(), swatch_width, rect.height());
  paint_swatch(painter, swatch, style, colours, shown);
  painter.setPen(shown ? colours.text : colours.disabled_text);
  const QRect beside = rect.adjusted(entry_padding + swatch_width + swatch_gap, 0, 0, 0);
  painter.drawText(beside, Qt::AlignLeft | Qt::AlignVCenter,
                   painter.fontMetrics().elidedText(name, Qt::ElideRight, beside.width()));
}

void LegendEntry::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  paint_ground(painter, false, false);
  paint(painter, rect(), text(), style_, isChecked(), theme());
}

}  // namespace clothlab
