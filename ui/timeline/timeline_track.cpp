#include <QFontMetrics>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>

#include "theme/theme.h"
#include "timeline/timeline.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double line_height = 6, handle_radius = 7;  // px
constexpr double mark_height = 3, mark_reach = 5;     // px
constexpr int pages = 10;                             // arrow steps in a page
constexpr int most_lines = 6;                         // of a tooltip

QFont caption_font(QFont font) {
  font.setPointSizeF(0.85 * font.pointSizeF());
  return font;
}

/// "Edited (Structural stiffness) at 0.120 s", "Pulled from 0.120 s to 0.300 s".
QString mark_text(const HistoryMark& mark, double step) {
  const auto what = [&] {
    switch (mark.kind) {
      case HistoryMark::Kind::pull:
        return TimelineTrack::tr("Pulled");
      case HistoryMark::Kind::gust:
        return TimelineTrack::tr("Blown");
      case HistoryMark::Kind::pins:
        return TimelineTrack::tr("Pinned or freed");
      case HistoryMark::Kind::edit:
        break;
    }
    return TimelineTrack::tr("Edited (%1)").arg(QString::fromStdString(mark.what));
  };
  if (time_text(mark.from, step) == time_text(mark.to, step))
    return TimelineTrack::tr("%1 at %2").arg(what(), time_text(mark.from, step));
  return TimelineTrack::tr("%1 from %2 to %3")
      .arg(what(), time_text(mark.from, step), time_text(mark.to, step));
}

}  // namespace

TimelineTrack::TimelineTrack(QWidget* parent) : QWidget(parent) {
  setObjectName("timelineTrack");
  setToolTip(tr("Drag or click to go back and forth in the run (Left, Right, Home, End)"));
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
  if (!dragging_) shown_ = last_;
  setEnabled(last_ > 0);
  describe();
  update();
}

void TimelineTrack::setMarks(const Marks& marks) {
  if (marks == marks_) return;
  marks_ = marks;
  update();
}

void TimelineTrack::arrive() {
  if (dragging_ || !wanted_) return;
  wanted_.reset();
  update();
}

double TimelineTrack::timeAt(double x) const {
  const double length = std::max(1.0, width() - 2 * handle_radius);
  return shown_ * std::clamp((x - handle_radius) / length, 0.0, 1.0);
}

double TimelineTrack::placeOf(double time) const {
  const double part = shown_ > 0 ? std::clamp(time / shown_, 0.0, 1.0) : 0;
  return handle_radius + part * (width() - 2 * handle_radius);
}

QRectF TimelineTrack::line() const {
  const double middle = captionHeight() + handle_radius + 2;
  return {handle_radius, middle - line_height / 2, width() - 2 * handle_radius, line_height};
}

QRectF TimelineTrack::placeOf(const HistoryMark& mark) const {
  const double left = placeOf(mark.from), right = placeOf(mark.to);
  return {left - mark_height, line().bottom() + 2, right - left + 2 * mark_height, mark_height};
}

QString TimelineTrack::marksAt(double x) const {
  if (!marks_) return {};
  QStringList lines;
  for (const HistoryMark& mark : *marks_) {
    const QRectF place = placeOf(mark);
    if (x >= place.left() - mark_reach && x <= place.right() + mark_reach) lines << mark_text(mark, step_);
  }
  if (lines.size() > most_lines) {
    const auto more = lines.size() - most_lines + 1;
    lines = lines.first(most_lines - 1) << tr("and %1 more").arg(more);
  }
  return lines.join('\n');
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
  setAccessibleDescription(last_ > 0 ? tr("%1 of %2").arg(time_text(present_, step_), time_text(last_, step_))
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
  if (event->button() != Qt::LeftButton) return;
  dragging_ = false;
  shown_ = last_;
  update();
}

void TimelineTrack::keyPressEvent(QKeyEvent* event) {
  if (!takeKey(*event)) event->ignore();
}

bool TimelineTrack::takeKey(const QKeyEvent& event) {
  const double arrow = step_ * (event.modifiers() & Qt::ShiftModifier ? pages : 1);
  const auto place = [&]() -> std::optional<double> {
    switch (event.key()) {
      case Qt::Key_Left:
        return time() - arrow;
      case Qt::Key_Right:
        return time() + arrow;
      case Qt::Key_PageUp:
        return time() + pages * step_;
      case Qt::Key_PageDown:
        return time() - pages * step_;
      case Qt::Key_Home:
        return 0;
      case Qt::Key_End:
        return last_;
      default:
        return std::nullopt;
    }
  }();
  if (place) want(*place);
  return place.has_value();
}

/// A mark's tooltip names what was done there.
bool TimelineTrack::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto& help = static_cast<const QHelpEvent&>(*event);
  const QString marks = marksAt(help.pos().x());
  if (marks.isEmpty()) return QWidget::event(event);
  const int x = help.pos().x();
  QToolTip::showText(help.globalPos(), marks, this, {x - 2, 0, 4, height()});
  return true;
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
  const QRectF line = this->line();
  const double middle = line.center().y();
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
  paintMarks(painter);
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

/// Short lines below the track, as long as what they stand for.
void TimelineTrack::paintMarks(QPainter& painter) const {
  if (!marks_) return;
  painter.setPen(Qt::NoPen);
  painter.setBrush(blend(theme().window, theme().text, 0.75));
  for (const HistoryMark& mark : *marks_)
    painter.drawRoundedRect(placeOf(mark), mark_height / 2, mark_height / 2);
}

/// The time over its place, moved inwards where it would stand out.
void TimelineTrack::paintCaption(QPainter& painter, double time, double x) const {
  painter.setFont(caption_font(font()));
  painter.setPen(theme().muted_text);
  const QString text = time_text(time, step_);
  const double half = painter.fontMetrics().horizontalAdvance(text) / 2.0;
  const double left = std::clamp(x - half, 0.0, std::max(0.0, width() - 2 * half));
  painter.setLayoutDirection(Qt::LeftToRight);  // the unit stands behind the number in every layout
  painter.drawText(QPointF(left, painter.fontMetrics().ascent()), text);
}

}  // namespace clothlab
