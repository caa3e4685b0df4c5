#include <QPainter>
#include <algorithm>

#include "compare/pane_grid.h"
#include "theme/theme.h"
#include "viewport/strain_scale.h"

namespace clothlab {
namespace {

constexpr int bar_width = 14, label_room = 60;  // px

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
  return {std::max(bar_width + label_room, widest) + 2 * spacing, 300};
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
  paint_colour_scale(
      painter, bar, maximum_, label_room,
      [this](double value) { return QString::number(factor_ * value, 'g', 3); }, theme());
  if (limit_ < 0 || limit_ > maximum_) return;
  painter.setPen(QPen(theme().limit, 2));
  const double y = bar.bottom() - bar.height() * limit_ / maximum_;
  painter.drawLine(QPointF(bar.left() - 3, y), QPointF(bar.right() + 3, y));
}

}  // namespace clothlab
