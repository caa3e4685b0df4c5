// ClothView: mouse and keyboard input.
#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>
#include <cmath>

#include "viewport/cloth_view.h"
#include "viewport/picking.h"

namespace clothlab {
namespace {

constexpr double least_brush_radius = 8, max_brush_radius = 1000;  // px

}  // namespace

void ClothView::setTool(Tool tool) {
  if (tool == tool_) return;
  endGesture();
  forgetProbeClicks();
  tool_ = tool;
  updateHover();
  repaintOver();
  Q_EMIT toolChanged(tool);
}

void ClothView::setBrushRadius(double pixels) {
  const double radius = std::clamp(pixels, least_brush_radius, max_brush_radius);
  if (radius == brush_radius_) return;
  brush_radius_ = radius;
  repaintOver();
}

std::optional<int> ClothView::pick(QPointF at) const {
  if (!frame_ || !frame_->has_cloth()) return std::nullopt;
  return pick_particle(*frame_, camera_, as_vector(at));
}

QPointF ClothView::screenPoint(int particle) const {
  const Eigen::Vector2d p = camera_.project(particle_position(*frame_, particle));
  return {p.x(), p.y()};
}

bool ClothView::brushShown() const {
  if (gesture_ == Gesture::brush) return true;
  return gesture_ == Gesture::none && cursor_inside_ && (tool_ == Tool::brush || shift_held_);
}

void ClothView::updateHover() {
  if (gesture_ != Gesture::none) return;
  std::optional<int> found;
  updateHandle();
  if (cursor_inside_ && !brushShown()) found = pick(cursor_);
  if (found != hovered_) {
    hovered_ = found;
    repaintOver();
  }
  updateCursor();
}

void ClothView::updateCursor() {
  Qt::CursorShape shape = Qt::ArrowCursor;
  if (gesture_ == Gesture::pull)
    shape = Qt::ClosedHandCursor;
  else if (gesture_ == Gesture::pan || gesture_ == Gesture::obstacle)
    shape = Qt::SizeAllCursor;
  else if (gesture_ == Gesture::orbit)
    shape = Qt::ArrowCursor;
  else if (brushShown())
    shape = Qt::CrossCursor;
  else if (handle_part_ != ObstacleHandle::Part::none)
    shape = Qt::SizeAllCursor;
  else if (hovered_)
    shape = tool_ == Tool::pull ? Qt::OpenHandCursor : Qt::PointingHandCursor;
  if (cursor().shape() != shape) setCursor(shape);
}

// ---- gestures

void ClothView::mousePressEvent(QMouseEvent* event) {
  if (!hasOpenGl()) return event->ignore();
  if (gesture_ != Gesture::none) return;  // one button at a time
  cursor_ = gesture_start_ = event->position();
  cursor_inside_ = true;
  const Qt::KeyboardModifiers modifiers = event->modifiers();
  if (event->button() == Qt::LeftButton) {
    startLeftGesture(cursor_, modifiers);
  } else if (event->button() == Qt::MiddleButton) {
    gesture_ = modifiers & Qt::ShiftModifier ? Gesture::pan : Gesture::orbit;
  } else if (event->button() == Qt::RightButton) {
    gesture_ = modifiers & Qt::ControlModifier ? Gesture::pan : Gesture::orbit;
  } else {
    return event->ignore();
  }
  gesture_button_ = event->button();
  updateCursor();
  repaintOver();
}

void ClothView::startLeftGesture(QPointF at, Qt::KeyboardModifiers modifiers) {
  if (modifiers & Qt::AltModifier) {
    gesture_ = Gesture::orbit;
    return;
  }
  if (tool_ == Tool::brush || modifiers & Qt::ShiftModifier) {
    gesture_ = Gesture::brush;
    return;
  }
  if (startObstacleMove(at)) return;
  grabbed_ = pick(at);
  if (!grabbed_) {
    gesture_ = Gesture::orbit;
  } else if (tool_ == Tool::pin || tool_ == Tool::probe) {
    gesture_ = Gesture::click;
  } else {
    gesture_ = Gesture::pull;
    grab_point_ = particle_position(*frame_, *grabbed_);
    sendPull();
  }
}

void ClothView::mouseMoveEvent(QMouseEvent* event) {
  if (!hasOpenGl()) return event->ignore();
  const QPointF by = event->position() - cursor_;
  cursor_ = event->position();
  cursor_inside_ = rect().contains(cursor_.toPoint());
  shift_held_ = event->modifiers() & Qt::ShiftModifier;
  if (gesture_ == Gesture::click &&
      (cursor_ - gesture_start_).manhattanLength() >= QApplication::startDragDistance())
    gesture_ = Gesture::orbit;  // not a click after all
  switch (gesture_) {
    case Gesture::none:
      updateHover();
      break;
    case Gesture::orbit:
    case Gesture::pan:
      moveCamera(by);
      break;
    case Gesture::pull:
      sendPull();
      break;
    case Gesture::obstacle:
      sendObstacleMove();
      break;
    case Gesture::brush:
      sendBrush();
      break;
    case Gesture::click:
      break;
  }
  if (gesture_ != Gesture::none || brushShown()) repaintOver();
}

void ClothView::mouseReleaseEvent(QMouseEvent* event) {
  if (gesture_ == Gesture::none || event->button() != gesture_button_) return event->ignore();
  const std::optional<int> clicked = gesture_ == Gesture::click ? grabbed_ : std::nullopt;
  endGesture();
  updateHover();
  if (clicked && tool_ == Tool::pin) Q_EMIT pinToggled(*clicked);
  if (clicked && tool_ == Tool::probe && sheetFits()) clickProbe(*clicked);
}

void ClothView::endGesture() {
  const Gesture ended = std::exchange(gesture_, Gesture::none);
  grabbed_.reset();
  updateCursor();
  repaintOver();
  if (ended == Gesture::pull) Q_EMIT pullEnded();
  if (ended == Gesture::brush) Q_EMIT brushEnded();
  if (ended == Gesture::obstacle) Q_EMIT obstacleMoveEnded(handle_->obstacle, obstacle_move_kept_);
}

void ClothView::moveCamera(QPointF by) {
  flight_.stop();
  camera_moved_ = true;
  if (gesture_ == Gesture::pan)
    camera_.pan(by.x(), by.y());
  else
    camera_.orbit(by.x(), by.y());
  Q_EMIT cameraMoved(camera_.pose());
}

void ClothView::sendPull() {
  Q_EMIT pullChanged({*grabbed_, camera_.on_screen_plane(as_vector(cursor_), grab_point_)});
}

void ClothView::sendBrush() {
  const QPointF drag = cursor_ - gesture_start_;
  cloth::BrushGust gust;
  gust.velocity = brush_speed_per_pixel * (drag.x() * camera_.right() - drag.y() * camera_.up());
  gust.world_to_screen = camera_.world_to_screen();
  gust.cursor = as_vector(cursor_);
  gust.radius = brush_radius_;
  Q_EMIT brushChanged(gust);
}

void ClothView::wheelEvent(QWheelEvent* event) {
  if (!hasOpenGl()) return event->ignore();
  // Alt turns a wheel sideways on some desktops.
  const QPoint angle = event->angleDelta();
  const double notches = (angle.y() != 0 ? angle.y() : angle.x()) / 120.0;
  event->accept();
  if (notches == 0) return;
  if (gesture_ == Gesture::brush || event->modifiers() & Qt::ShiftModifier) {
    setBrushRadius(brush_radius_ * std::pow(1.12, notches));
    if (gesture_ == Gesture::brush) sendBrush();
    return;
  }
  if (gesture_ == Gesture::pull || gesture_ == Gesture::obstacle)
    return;  // its plane belongs to this distance
  flight_.stop();
  camera_moved_ = true;
  camera_.zoom(std::pow(1.18, notches), as_vector(event->position()));
  Q_EMIT cameraMoved(camera_.pose());
  updateHover();
  redraw();
}

// ---- coming and going

void ClothView::followShift(bool held) {
  if (shift_held_ == held) return;
  shift_held_ = held;
  updateHover();
  repaintOver();
}

/// Shift shows the brush while the cursor is over the view, whichever widget has the keyboard.
bool ClothView::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress || event->type() == QEvent::KeyRelease) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->key() == Qt::Key_Shift) followShift(event->type() == QEvent::KeyPress);
    if (key->key() == Qt::Key_Escape && gesture_ == Gesture::obstacle) {
      cancelObstacleMove();
      return true;
    }
    if (event->type() == QEvent::KeyPress && key->key() == Qt::Key_Escape && !probe_clicks_.empty()) {
      forgetProbeClicks();
      return true;
    }
  }
  return QWidget::eventFilter(watched, event);
}

void ClothView::enterEvent(QEnterEvent* event) {
  QWidget::enterEvent(event);
  if (!hasOpenGl()) return;
  qApp->installEventFilter(this);
  cursor_inside_ = true;
  cursor_ = event->position();
  shift_held_ = QGuiApplication::queryKeyboardModifiers() & Qt::ShiftModifier;
  updateHover();
  repaintOver();
}

void ClothView::leaveEvent(QEvent* event) {
  QWidget::leaveEvent(event);
  qApp->removeEventFilter(this);
  cursor_inside_ = shift_held_ = false;
  updateHover();
  repaintOver();
}

void ClothView::hideEvent(QHideEvent* event) {
  qApp->removeEventFilter(this);
  endGesture();
  cursor_inside_ = false;
  hovered_.reset();
  QWidget::hideEvent(event);
}

}  // namespace clothlab
