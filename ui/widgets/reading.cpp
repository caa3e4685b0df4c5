#include "widgets/reading.h"

#include <QPainter>

#include "theme/theme.h"

namespace clothlab {

Reading::Reading(const QString& widest, Look look, QWidget* parent)
    : QWidget(parent), widest_(widest), look_(look) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
}

void Reading::setText(const QString& text) {
  if (text == text_) return;
  text_ = text;
  setAccessibleName(text);
  update();
}

QFont Reading::textFont() const {
  QFont shown = font();
  shown.setBold(look_ == Look::bold);
  return shown;
}

QSize Reading::sizeHint() const {
  const QFontMetrics metrics(textFont());
  return {metrics.horizontalAdvance(widest_) + 1 + spacing, metrics.height()};  // it rounds
}

void Reading::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setLayoutDirection(Qt::LeftToRight);  // a number comes before its unit in every layout
  painter.setFont(textFont());
  painter.setPen(look_ == Look::muted ? theme().muted_text : theme().text);
  const QRect inside = rect().adjusted(spacing / 2, 0, -spacing / 2, 0);
  painter.drawText(inside, Qt::AlignVCenter | Qt::AlignLeft,
                   painter.fontMetrics().elidedText(text_, Qt::ElideRight, inside.width()));
}

}  // namespace clothlab
