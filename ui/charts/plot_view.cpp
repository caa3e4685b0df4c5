#include "charts/plot_view.h"

#include <QApplication>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace clothlab {

namespace {

constexpr double wheel_notch = 120;   // Qt's eighths of a degree in one notch
constexpr double notch_factor = 0.8;  // one notch towards the screen shows 80 % of the range
constexpr double pixel_notch = 40;    // a touch pad's px that count as a notch
constexpr double smallest_box_px = 4;

double notches(const QWheelEvent& event, bool sideways) {
  const QPoint angle = event.angleDelta();
  if (angle.isNull()) return (sideways ? event.pixelDelta().x() : event.pixelDelta().y()) / pixel_notch;
  return (sideways ? angle.x() : angle.y()) / wheel_notch;
}

}  // namespace

PlotView::PlotView(PlotScene* scene, QWidget* parent) : QWidget(parent), scene_(scene) {
  setFocusPolicy(Qt::NoFocus);
  setMouseTracking(true);
  setContextMenuPolicy(Qt::PreventContextMenu);  // the right button draws the zoom box
  connect(scene, &QGraphicsScene::changed, this, [this] { update(); });
}

void PlotView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF whole(QPointF(0, 0), QSizeF(size()));
  scene_->render(&painter, whole, whole, Qt::IgnoreAspectRatio);
}

QString PlotView::help() {
  return tr(
      "<p style='white-space:pre'>"
      "Wheel: zoom the time axis of all charts\n"
      "Ctrl + wheel, or wheel over the values at the left: zoom that axis\n"
      "Drag: pan in time; over the values: pan that axis\n"
      "Right-drag or Shift + drag: zoom into a box\n"
      "Double-click: back to live; over the values: automatic range\n"
      "Arrows, +, −, Home: pan, zoom, back to live</p>");
}

void PlotView::wheelEvent(QWheelEvent* event) {
  const PlotMap& map = scene_->map();
  const QPointF at = event->position();
  // Alt swaps the wheel's axes on some platforms; a sideways wheel or Shift pans in time.
  const bool sideways = std::abs(event->angleDelta().x()) > std::abs(event->angleDelta().y());
  const double amount = notches(*event, sideways);
  const double factor = std::pow(notch_factor, amount);
  if (over_y_axis(at) || (event->modifiers() & Qt::ControlModifier))
    Q_EMIT y_zoomed(map.axis_at(std::clamp(at.y(), map.plot.top(), map.plot.bottom())), factor);
  else if (sideways || (event->modifiers() & Qt::ShiftModifier))
    Q_EMIT time_panned(-amount * 0.1 * map.time.span());
  else
    Q_EMIT time_zoomed(map.time_at(std::min(at.x(), map.plot.right())), factor);
  event->accept();
}

void PlotView::mousePressEvent(QMouseEvent* event) {
  const bool left = event->button() == Qt::LeftButton;
  if (drag_ != Drag::none || (!left && event->button() != Qt::RightButton)) return;
  drag_ = Drag::pressed;
  pressed_at_ = last_ = event->position();
  on_y_axis_ = over_y_axis(pressed_at_);
  wants_box_ = !on_y_axis_ && (!left || box_mode_ || (event->modifiers() & Qt::ShiftModifier));
  event->accept();
}

void PlotView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position();
  if (drag_ == Drag::pressed &&
      (at - pressed_at_).manhattanLength() >= std::min(QApplication::startDragDistance(), 4)) {
    drag_ = wants_box_ ? Drag::box : Drag::pan;
    if (drag_ == Drag::pan) setCursor(on_y_axis_ ? Qt::SizeVerCursor : Qt::ClosedHandCursor);
    Q_EMIT hovered(std::nullopt);
  }
  if (drag_ == Drag::pan || drag_ == Drag::box) {
    drag_to(at);
  } else {
    setCursor(over_y_axis(at) ? Qt::SizeVerCursor : Qt::ArrowCursor);
    const QRectF& plot = scene_->map().plot;
    const bool inside = plot.left() <= at.x() && at.x() <= plot.right();
    Q_EMIT hovered(inside ? std::optional(scene_->map().time_at(at.x())) : std::nullopt);
  }
  event->accept();
}

void PlotView::drag_to(QPointF at) {
  const PlotMap& map = scene_->map();
  if (drag_ == Drag::box) {
    scene_->overlay().set_zoom_box(QRectF(pressed_at_, at).normalized() & map.plot);
    return;
  }
  const QPointF by = at - last_;
  last_ = at;
  if (!on_y_axis_ && by.x() != 0) Q_EMIT time_panned(-by.x() / map.plot.width() * map.time.span());
  if (on_y_axis_ && by.y() != 0) Q_EMIT y_panned(by.y() / map.plot.height() * map.y.span());
}

void PlotView::mouseReleaseEvent(QMouseEvent* event) {
  if (drag_ == Drag::box) finish_box(event->position());
  end_drag();
  event->accept();
}

void PlotView::finish_box(QPointF at) {
  const PlotMap& map = scene_->map();
  const QRectF box = QRectF(pressed_at_, at).normalized() & map.plot;
  if (box.width() < smallest_box_px || box.height() < smallest_box_px) return;  // too small to be intended
  Q_EMIT box_chosen({map.time_at(box.left()), map.time_at(box.right())},
                    {map.axis_at(box.bottom()), map.axis_at(box.top())});
}

void PlotView::end_drag() {
  drag_ = Drag::none;
  scene_->overlay().set_zoom_box(std::nullopt);
  setCursor(Qt::ArrowCursor);
}

void PlotView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  end_drag();
  if (over_y_axis(event->position()))
    Q_EMIT y_reset_wanted();
  else
    Q_EMIT reset_wanted();
  event->accept();
}

void PlotView::leaveEvent(QEvent* event) {
  Q_EMIT hovered(std::nullopt);
  QWidget::leaveEvent(event);
}

}  // namespace clothlab
