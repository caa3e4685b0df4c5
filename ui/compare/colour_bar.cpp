#include "compare/colour_bar.h"

#include <QPainter>
#include <algorithm>

#include "theme/theme.h"
#include "viewport/strain_scale.h"

namespace clothlab {
namespace {

constexpr int bar_width = 14, tick_length = 4, label_room = 56;  // px

}  // namespace

void ColourBar::showRange(const QString& title, double maximum, double factor, double limit) {
  if (title == title_ && maximum == maximum_ && factor == factor_ && limit == limit_) return;
  title_ = title;
  maximum_ = maximum;
  factor_ = factor;
  limit_ = limit;
  setAccessibleName(title_);
  setToolTip(tr("The same colour is the same value in all panes"));
  update();
}

QSize ColourBar::sizeHint() const {
  const int widest = fontMetrics().horizontalAdvance(tr("Difference"));
  return {std::max(bar_width + tick_length + label_room, widest) + 2 * spacing, 300};
}

void ColourBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const int line = fontMetrics().height();
  painter.setPen(theme().text);
  const QRect head(spacing / 2, spacing, width() - spacing, 2 * line);
  painter.drawText(head, Qt::AlignLeft | Qt::AlignTop, QString(title_).replace(' ', '\n'));

  const QRectF bar(spacing / 2.0, head.bottom() + spacing + line / 2.0, bar_width,
                   height() - head.bottom() - 2 * spacing - line);
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  for (int i = 0; i <= 32; ++i) gradient.setColorAt(i / 32.0, strain_colour(i / 32.0));
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 2, 2);
  const auto y_of = [&](double value) { return bar.bottom() - bar.height() * value / maximum_; };
  for (const double tick : round_ticks(maximum_)) {
    const double y = y_of(tick);
    painter.setPen(theme().muted_text);
    painter.drawLine(QPointF(bar.right() + 2, y), QPointF(bar.right() + 2 + tick_length, y));
    painter.setPen(theme().text);
    painter.drawText(QRectF(bar.right() + tick_length + 6, y - line / 2.0, label_room, line),
                     Qt::AlignLeft | Qt::AlignVCenter, QString::number(factor_ * tick, 'g', 3));
  }
  if (limit_ < 0 || limit_ > maximum_) return;
  painter.setPen(QPen(theme().limit, 2));
  painter.drawLine(QPointF(bar.left() - 3, y_of(limit_)), QPointF(bar.right() + 3, y_of(limit_)));
}

}  // namespace clothlab
