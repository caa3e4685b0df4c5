#include "viewport/drawing_turns.h"

#include <QCoreApplication>
#include <QPointer>
#include <algorithm>

namespace clothlab {

DrawingTurns& DrawingTurns::ofTheApplication() {
  static QPointer<DrawingTurns> turns;
  if (!turns) turns = new DrawingTurns(QCoreApplication::instance());
  return *turns;
}

DrawingTurns::DrawingTurns(QObject* parent) : QObject(parent) {
  timer_.setSingleShot(true);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &DrawingTurns::next);
}

void DrawingTurns::ask(Drawer* drawer) {
  if (std::find(waiting_.begin(), waiting_.end(), drawer) != waiting_.end()) return;
  waiting_.push_back(drawer);
  if (!timer_.isActive()) startTimer();
}

void DrawingTurns::leave(Drawer* drawer) {
  std::erase(waiting_, drawer);
  if (waiting_.empty()) timer_.stop();
}

void DrawingTurns::leaveFree(double milliseconds) {
  if (milliseconds <= 0) return;
  free_until_.setRemainingTime(static_cast<qint64>(milliseconds), Qt::PreciseTimer);
  if (timer_.isActive()) startTimer();
}

/// Without a pause: behind the mouse and the keys that have come meanwhile.
void DrawingTurns::startTimer() {
  timer_.start(static_cast<int>(free_until_.remainingTime()));
}

void DrawingTurns::next() {
  if (waiting_.empty()) return;
  Drawer* drawer = waiting_.front();
  waiting_.pop_front();
  drawer->takeTurn();  // which may ask again, behind the others
  if (!waiting_.empty()) startTimer();
}

}  // namespace clothlab
