#include "timeline/timeline_keys.h"

#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMenuBar>
#include <QPlainTextEdit>
#include <QTabBar>
#include <QTextEdit>

#include "timeline/timeline.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

template <class... Kinds>
bool is_one_of(const QWidget* widget) {
  return (qobject_cast<const Kinds*>(widget) || ...);
}

bool has_own_use(const QWidget* widget) {
  return is_one_of<QLineEdit, QAbstractSpinBox, QTextEdit, QPlainTextEdit, QComboBox, QAbstractSlider,
                   QAbstractItemView, QTabBar, QMenuBar>(widget) ||
         (widget && widget->property(keeps_arrow_keys).toBool());
}

bool is_key_of_timeline(const QKeyEvent& event) {
  const Qt::KeyboardModifiers modifiers = event.modifiers() & ~Qt::KeypadModifier;
  switch (event.key()) {
    case Qt::Key_Left:
    case Qt::Key_Right:
      return modifiers == Qt::NoModifier || modifiers == Qt::ShiftModifier;
    case Qt::Key_Home:
    case Qt::Key_End:
      return modifiers == Qt::NoModifier;
    default:
      return false;
  }
}

}  // namespace

TimelineKeys::TimelineKeys(TimelineTrack* track) : QObject(track), track_(track) {
  qApp->installEventFilter(this);
}

/// Also from a dock that floats beside the window, but not from a dialog over it.
bool TimelineKeys::isMeant(const QObject* watched) const {
  const auto* widget = qobject_cast<const QWidget*>(watched);
  if (!widget || widget == track_ || !track_->isVisible() || !track_->isEnabled()) return false;
  if (QApplication::activePopupWidget() || QApplication::activeModalWidget()) return false;
  const QWidget* window = widget->window();
  const bool floats = qobject_cast<const QDockWidget*>(window) && window->parentWidget() == track_->window();
  if (window != track_->window() && !floats) return false;
  return !has_own_use(widget) && !has_own_use(window->focusWidget());
}

bool TimelineKeys::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress) return false;
  auto& key = static_cast<QKeyEvent&>(*event);
  return is_key_of_timeline(key) && isMeant(watched) && track_->takeKey(key);
}

}  // namespace clothlab
