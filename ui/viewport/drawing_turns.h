// Schedules software rendering: one view draws in each event of the GUI thread, in turn, so that an input
// event waits for at most one drawing.
#pragma once

#include <QDeadlineTimer>
#include <QObject>
#include <QTimer>
#include <deque>

namespace clothlab {

class DrawingTurns : public QObject {
  Q_OBJECT

 public:
  /// The interface of a view that has something to draw.
  class Drawer {
   public:
    virtual void takeTurn() = 0;

   protected:
    ~Drawer() = default;
  };

  /// One for all views of the application.
  static DrawingTurns& ofTheApplication();

  /// Queues `drawer` for one turn in a later event; has no effect if it is queued already.
  void ask(Drawer* drawer);
  /// Removes `drawer` from the queue.
  void leave(Drawer* drawer);
  /// No turn begins for so long: other events go first.
  void leaveFree(double milliseconds);

  /// Whether what the views show is computed slower than it is to be shown, see DrawingPace.
  bool runIsBehind() const { return run_is_behind_; }
  void setRunIsBehind(bool on) { run_is_behind_ = on; }

 private:
  explicit DrawingTurns(QObject* parent);
  void next();
  void startTimer();

  std::deque<Drawer*> waiting_;
  QDeadlineTimer free_until_;
  bool run_is_behind_ = false;
  QTimer timer_;  ///< runs only while a drawer is queued
};

}  // namespace clothlab
