#include <QFontMetrics>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>

#include "theme/theme.h"
#include "timeline/timeline.h"

namespace clothlab {
namespace {

constexpr double line_height = 6, handle_radius = 7;  // px
constexpr int pages = 10;                             // arrow steps in a page

QFont caption_font(QFont font) {
  font.setPointSizeF(0.85 * font.pointSizeF());
  return font;
}

QString time_text(double time) {
  return TimelineTrack::tr("%1 s").arg(time, 0, 'f', 3);
}

}  // namespace

TimelineTrack::TimelineTrack(QWidget* parent) : QWidget(parent) {
  setObjectName("timelineTrack");
  setAccessibleName(tr("Timeline"));
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setEnabled(false);
  describe();
}

void TimelineTrack::setTimes(double present, double last) {
  if (present == present_ && last == last_) return;
  present_ = present;
  last_ = last;
  setEnabled(last_ > 0);
  describe();
  update();
}

void TimelineTrack::arrive() {
  if (dragging_ || !wanted_) return;
  wanted_.reset();
  update();
}

double TimelineTrack::timeAt(double x) const {
  const double length = std::max(1.0, width() - 2 * handle_radius);
  return last_ * std::clamp((x - handle_radius) / length, 0.0, 1.0);
}

double TimelineTrack::placeOf(double time) const {
  const double part = last_ > 0 ? std::clamp(time / last_, 0.0, 1.0) : 0;
  return handle_radius + part * (width() - 2 * handle_radius);
}

QSize TimelineTrack::sizeHint() const {
  return {320, captionHeight() + static_cast<int>(2 * handle_radius) + 4};
}

int TimelineTrack::captionHeight() const {
  return QFontMetrics(caption_font(font())).height();
}

void TimelineTrack::want(double time) {
  wanted_ = std::clamp(time, 0.0, last_);
  update();
  Q_EMIT timeWanted(*wanted_);
}

void TimelineTrack::describe() {
  setAccessibleDescription(last_ > 0 ? tr("%1 of %2").arg(time_text(present_), time_text(last_))
                                     : tr("Nothing was played yet"));
}

void TimelineTrack::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return event->ignore();
  dragging_ = true;
  cursor_ = event->position().x();
  want(timeAt(*cursor_));
}

void TimelineTrack::mouseMoveEvent(QMouseEvent* event) {
  cursor_ = event->position().x();
  if (dragging_)
    want(timeAt(*cursor_));
  else
    update();
}

void TimelineTrack::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) dragging_ = false;
}

void TimelineTrack::keyPressEvent(QKeyEvent* event) {
  const double arrow = step_ * (event->modifiers() & Qt::ShiftModifier ? pages : 1);
  switch (event->key()) {
    case Qt::Key_Left:
      return want(time() - arrow);
    case Qt::Key_Right:
      return want(time() + arrow);
    case Qt::Key_PageUp:
      return want(time() + pages * step_);
    case Qt::Key_PageDown:
      return want(time() - pages * step_);
    case Qt::Key_Home:
      return want(0);
    case Qt::Key_End:
      return want(last_);
    default:
      event->ignore();
  }
}

void TimelineTrack::leaveEvent(QEvent*) {
  cursor_.reset();
  update();
}

void TimelineTrack::paintEvent(QPaintEvent*) {
  const Theme& t = theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const double middle = captionHeight() + handle_radius + 2;
  const QRectF line(handle_radius, middle - line_height / 2, width() - 2 * handle_radius, line_height);
  const auto bar = [&](double right, const QColor& colour) {
    painter.setBrush(colour);
    painter.drawRoundedRect(QRectF(line.left(), line.top(), right - line.left(), line_height),
                            line_height / 2, line_height / 2);
  };
  bar(line.right(),
      isEnabled() ? blend(t.window, t.accent, 0.35) : t.border);  // what lies later than the handle
  if (!isEnabled()) return;

  const double handle = placeOf(time());
  if (handle > line.left() + 1) bar(handle, t.accent);
  if (cursor_) {
    const double x = placeOf(timeAt(*cursor_));
    painter.setPen(QPen(t.muted_text, 1));
    painter.drawLine(QPointF(x, middle - handle_radius), QPointF(x, middle + handle_radius));
    paintCaption(painter, timeAt(*cursor_), x);
  } else {
    paintCaption(painter, time(), handle);
  }
  painter.setPen(QPen(hasFocus() ? t.text : t.window, 2));
  painter.setBrush(t.accent);
  painter.drawEllipse(QPointF(handle, middle), handle_radius - 1, handle_radius - 1);
}

/// The time over its place, moved inwards where it would stand out.
void TimelineTrack::paintCaption(QPainter& painter, double time, double x) const {
  painter.setFont(caption_font(font()));
  painter.setPen(theme().muted_text);
  const QString text = time_text(time);
  const double half = painter.fontMetrics().horizontalAdvance(text) / 2.0;
  const double left = std::clamp(x - half, 0.0, std::max(0.0, width() - 2 * half));
  painter.drawText(QPointF(left, painter.fontMetrics().ascent()), text);
}

}  // namespace clothlab
