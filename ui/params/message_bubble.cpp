#include "params/message_bubble.h"

#include <QApplication>
#include <QEvent>
#include <QLayout>
#include <QScrollArea>

#include "params/panel_parts.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

/// What scrolls with the row.
QWidget* content_around(QWidget& row) {
  QWidget* around = &row;
  while (QWidget* up = around->parentWidget()) {
    if (auto* area = qobject_cast<QScrollArea*>(up->parentWidget()); area && area->viewport() == up)
      return around;
    if (up->isWindow()) return up;
    around = up;
  }
  return around;
}

}  // namespace

MessageBubble::MessageBubble(QWidget& row, const QLayout& control)
    : QLabel(&row), row_(row), control_(control) {
  setObjectName("rule");
  setProperty("bubble", true);
  setProperty("row", row.objectName());
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setWordWrap(true);
  setTextFormat(Qt::PlainText);
  setContentsMargins(spacing / 2, spacing / 4, spacing / 2, spacing / 4);
  hide();
}

void MessageBubble::say(Level level, const QString& text) {
  set_style_property(*this, "state", level == Level::error ? "error" : "warning");
  if (this->text().isEmpty()) {
    row_.installEventFilter(this);
    connect(qApp, &QApplication::focusChanged, this, &MessageBubble::followFocus);
  }
  setText(text);
  appear();
}

void MessageBubble::withdraw() {
  if (text().isEmpty()) return;
  row_.removeEventFilter(this);
  disconnect(qApp, nullptr, this, nullptr);
  clear();
  hide();
}

void MessageBubble::appear() {
  if (QWidget* content = content_around(row_); parentWidget() != content) {
    parentWidget()->removeEventFilter(this);
    setParent(content);
    content->installEventFilter(this);
    row_.installEventFilter(this);
  }
  place();
  setVisible(row_.isVisible() || !row_.window()->isVisible());
  raise();
}

/// Above the control, over the row's title; below it where there is no room or none in sight.
void MessageBubble::place() {
  const QWidget* content = parentWidget();
  const QRect row(0, control_.geometry().top(), row_.width(), control_.geometry().height());
  const QRect control(row_.mapTo(content, row.topLeft()), row.size());
  constexpr int gap = 2;  // px
  const int tall = heightForWidth(control.width());
  const int above = control.top() - gap - tall;
  const bool fits_above = above >= content->visibleRegion().boundingRect().top();
  setGeometry(control.left(), fits_above ? above : control.bottom() + 1 + gap, control.width(), tall);
}

bool MessageBubble::isInRow(const QWidget* widget) const {
  return widget && (widget == &row_ || row_.isAncestorOf(widget));
}

void MessageBubble::followFocus(const QWidget* old, const QWidget* now) {
  if (isInRow(now))
    appear();
  else if (now && !isInRow(old))
    hide();
}

bool MessageBubble::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Enter:
    case QEvent::Show:
      if (watched == &row_) appear();
      break;
    case QEvent::Leave:
      if (watched == &row_ && !isInRow(QApplication::focusWidget())) hide();
      break;
    case QEvent::Hide:
      if (watched == &row_) hide();
      break;
    case QEvent::Resize:
    case QEvent::LayoutRequest:
      if (isVisible()) QMetaObject::invokeMethod(this, &MessageBubble::place, Qt::QueuedConnection);
      break;
    default:
      break;
  }
  return QLabel::eventFilter(watched, event);
}

}  // namespace clothlab
