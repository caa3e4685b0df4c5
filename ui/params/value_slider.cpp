#include "params/value_slider.h"

#include <QKeyEvent>
#include <QPainter>
#include <QStyle>
#include <QStyleOptionSlider>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "theme/theme.h"

namespace clothlab {
namespace {

constexpr int resolution = 10000;

}  // namespace

ValueSlider::ValueSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
  setLayoutDirection(Qt::LeftToRight);  // like an axis of numbers, in every script
  setRange(0, resolution);
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void ValueSlider::setPosition(double position) {
  const QSignalBlocker quiet(this);
  setValue(static_cast<int>(std::lround(std::clamp(position, 0.0, 1.0) * resolution)));
}

double ValueSlider::position() const {
  return static_cast<double>(value()) / resolution;
}

void ValueSlider::setMark(double position) {
  mark_ = position;
  update();
}

QRect ValueSlider::handle() const {
  QStyleOptionSlider option;
  initStyleOption(&option);
  return style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, this);
}

double ValueSlider::positionAt(double x) const {
  const double length = handle().width();
  return std::clamp((x - length / 2) / std::max(1.0, width() - length), 0.0, 1.0);
}

void ValueSlider::begin() {
  if (dragging_) return;
  dragging_ = true;
  Q_EMIT dragBegan();
}

void ValueSlider::end() {
  if (isSliderDown()) setSliderDown(false);
  if (!dragging_) return;
  dragging_ = false;
  Q_EMIT dragEnded();
}

void ValueSlider::goTo(double position) {
  setPosition(position);
  update();
  Q_EMIT moved(position);
}

void ValueSlider::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) {
    event->ignore();
    return;
  }
  const QRect grip = handle();
  const bool on_handle = grip.contains(event->position().toPoint());
  grip_ = on_handle ? event->position().x() - grip.center().x() : 0;
  begin();
  setSliderDown(true);
  if (!on_handle) goTo(positionAt(event->position().x()));
}

void ValueSlider::mouseMoveEvent(QMouseEvent* event) {
  if (isSliderDown()) goTo(positionAt(event->position().x() - grip_));
}

void ValueSlider::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) end();
}

void ValueSlider::keyPressEvent(QKeyEvent* event) {
  const int arrow = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
  const auto step = [&](int steps) {
    begin();
    Q_EMIT stepped(isRightToLeft() ? -steps : steps);
  };
  switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Down:
      return step(-arrow);
    case Qt::Key_Right:
    case Qt::Key_Up:
      return step(arrow);
    case Qt::Key_PageUp:
      return step(10);
    case Qt::Key_PageDown:
      return step(-10);
    case Qt::Key_Home:
      begin();
      return goTo(0);
    case Qt::Key_End:
      begin();
      return goTo(1);
    default:
      event->ignore();
  }
}

void ValueSlider::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat() && !isSliderDown()) end();
  event->ignore();
}

void ValueSlider::focusOutEvent(QFocusEvent* event) {
  if (!isSliderDown()) end();
  QSlider::focusOutEvent(event);
}

void ValueSlider::hideEvent(QHideEvent* event) {
  end();
  QSlider::hideEvent(event);
}

void ValueSlider::wheelEvent(QWheelEvent* event) {
  // The panel always gets wheel events, even if the slider has the focus, so that scrolling the form changes
  // no value.
  event->ignore();
}

void ValueSlider::paintEvent(QPaintEvent* event) {
  const double length = handle().width();
  const double x = length / 2 + mark_ * (width() - length);
  const bool covered = std::abs(mark_ - position()) * (width() - length) < length / 2 + 1;
  if (mark_ >= 0 && isEnabled() && !covered) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    QColor colour = theme().muted_text;
    colour.setAlphaF(0.55f);
    painter.setBrush(colour);
    painter.drawRoundedRect(QRectF(x - 1, height() / 2.0 - 5, 2, 10), 1, 1);
  }
  QSlider::paintEvent(event);
}

}  // namespace clothlab
