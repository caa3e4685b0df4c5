#include "params/range_slider.h"

#include <QKeyEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int handle_width = 14, handle_height = 20;  // px
constexpr int handle_resolution = 10000;

}  // namespace

/// Painted as a pointer onto the groove. Its value is for screen readers; the slider has the position.
class RangeHandle : public QSlider {
 public:
  RangeHandle(RangeSlider& slider, RangeSlider::End end)
      : QSlider(Qt::Horizontal, &slider), slider_(slider), end_(end) {
    setRange(0, handle_resolution);
    setFixedSize(handle_width, handle_height);
    setFocusPolicy(Qt::StrongFocus);
    setCursor(Qt::SizeHorCursor);
  }

 protected:
  void paintEvent(QPaintEvent*) override {
    const Theme& t = theme();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const bool left = end_ == RangeSlider::End::from;
    const double middle = width() / 2.0, top = 3, bottom = height() - 3.0;
    const double outer = left ? middle - 5 : middle + 5;
    // Flat towards what is in the range, pointed away from it.
    const QPolygonF shape({{middle, top}, {middle, bottom}, {outer, bottom - 4}, {outer, top + 4}});
    painter.setPen(
        QPen(hasFocus() ? t.text : t.accent, hasFocus() ? 2 : 1, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setBrush(isEnabled() ? (underMouse() ? blend(t.accent, t.text, 0.16) : t.accent)
                                 : t.disabled_text);
    painter.drawPolygon(shape);
  }
  void mousePressEvent(QMouseEvent* event) override {
    if (event->button() != Qt::LeftButton) return event->ignore();
    grip_ = event->position().x() - width() / 2.0;
    raise();
    slider_.begin();
    setSliderDown(true);
  }
  void mouseMoveEvent(QMouseEvent* event) override {
    if (isSliderDown()) slider_.drag(end_, mapToParent(event->position()).x() - grip_);
  }
  void mouseReleaseEvent(QMouseEvent* event) override {
    if (event->button() != Qt::LeftButton) return;
    setSliderDown(false);
    slider_.end();
  }
  void keyPressEvent(QKeyEvent* event) override {
    const int arrow = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
    int steps = 0;
    switch (event->key()) {
      case Qt::Key_Left:
      case Qt::Key_Down:
        steps = -arrow;
        break;
      case Qt::Key_Right:
      case Qt::Key_Up:
        steps = arrow;
        break;
      case Qt::Key_PageUp:
        steps = 10;
        break;
      case Qt::Key_PageDown:
        steps = -10;
        break;
      case Qt::Key_Home:
      case Qt::Key_End:
        slider_.begin();
        Q_EMIT slider_.moved(end_, event->key() == Qt::Key_End ? 1 : 0);
        return;
      default:
        return event->ignore();
    }
    slider_.begin();
    Q_EMIT slider_.stepped(end_, steps);
  }
  void keyReleaseEvent(QKeyEvent* event) override {
    if (!event->isAutoRepeat() && !isSliderDown()) slider_.end();
    event->ignore();
  }
  void focusOutEvent(QFocusEvent* event) override {
    if (!isSliderDown()) slider_.end();
    QSlider::focusOutEvent(event);
  }
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }  // the panel scrolls

 private:
  RangeSlider& slider_;
  RangeSlider::End end_;
  double grip_ = 0;
};

RangeSlider::RangeSlider(const QString& label, QWidget* parent) : QWidget(parent) {
  setLayoutDirection(Qt::LeftToRight);  // like an axis of numbers, in every script
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  for (const End end : {End::from, End::to}) {
    auto* handle = new RangeHandle(*this, end);
    handle->setObjectName(end == End::from ? "rangeFrom" : "rangeTo");
    handle->setAccessibleName(end == End::from ? tr("%1: the range begins").arg(label)
                                               : tr("%1: the range ends").arg(label));
    handle->setProperty(keeps_arrow_keys, true);
    handles_[static_cast<int>(end)] = handle;
  }
}

QSlider* RangeSlider::handle(End end) const {
  return handles_[static_cast<int>(end)];
}

double RangeSlider::xOf(double position) const {
  return handle_width / 2.0 + position * std::max(1, width() - handle_width);
}

double RangeSlider::positionAt(double x) const {
  return std::clamp((x - handle_width / 2.0) / std::max(1, width() - handle_width), 0.0, 1.0);
}

void RangeSlider::setPositions(double from, double to) {
  positions_[0] = from;
  positions_[1] = to;
  place();
}

void RangeSlider::setMark(double position) {
  mark_ = position;
  update();
}

void RangeSlider::place() {
  for (int k = 0; k < 2; ++k) {
    const QSignalBlocker quiet(handles_[k]);
    handles_[k]->setValue(static_cast<int>(std::lround(positions_[k] * handle_resolution)));
    handles_[k]->move(qRound(xOf(positions_[k]) - handle_width / 2.0), (height() - handle_height) / 2);
  }
  update();
}

void RangeSlider::begin() {
  if (dragging_) return;
  dragging_ = true;
  Q_EMIT dragBegan();
}

void RangeSlider::end() {
  if (!dragging_) return;
  dragging_ = false;
  Q_EMIT dragEnded();
}

/// One end does not pass the other.
void RangeSlider::drag(End end, double x) {
  const double other = positions_[end == End::from ? 1 : 0];
  const double at = positionAt(x), gap = 1.0 / std::max(1, width());
  Q_EMIT moved(end, end == End::from ? std::min(at, other - gap) : std::max(at, other + gap));
}

/// A press beside the handles takes the nearer one there.
void RangeSlider::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return event->ignore();
  const double x = event->position().x();
  const End end = std::abs(x - xOf(positions_[0])) <= std::abs(x - xOf(positions_[1])) ? End::from : End::to;
  pressed_ = handles_[static_cast<int>(end)];
  pressed_->setFocus(Qt::MouseFocusReason);
  begin();
  drag(end, x);
}

void RangeSlider::mouseMoveEvent(QMouseEvent* event) {
  if (pressed_) drag(pressed_ == handles_[0] ? End::from : End::to, event->position().x());
}

void RangeSlider::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !pressed_) return;
  pressed_ = nullptr;
  end();
}

void RangeSlider::resizeEvent(QResizeEvent*) {
  place();
}

void RangeSlider::paintEvent(QPaintEvent*) {
  const Theme& t = theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const double middle = height() / 2.0;
  const auto bar = [&](double from, double to, const QColor& colour) {
    painter.setBrush(colour);
    painter.drawRoundedRect(QRectF(from, middle - 2, to - from, 4), 2, 2);
  };
  bar(handle_width / 2.0, width() - handle_width / 2.0, blend(t.panel, t.text, t.dark ? 0.20 : 0.16));
  bar(xOf(positions_[0]), xOf(positions_[1]), isEnabled() ? t.accent : t.disabled_text);
  if (mark_ < 0) return;
  painter.setBrush(t.muted_text);
  painter.drawRoundedRect(QRectF(xOf(mark_) - 1, middle - 6, 2, 12), 1, 1);
}

}  // namespace clothlab
