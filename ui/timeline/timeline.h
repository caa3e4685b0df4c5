// The timeline below the view: the run so far with a handle to move in it, the part that playing from here
// would delete, and the memory of the stored states.
#pragma once

#include <QFrame>
#include <QWidget>
#include <optional>

#include "bridge/worker_status.h"

class QAction;
class QLabel;

namespace clothlab {

/// The track of the timeline: the run so far from left to right, and a handle at the present time, moved by
/// mouse and keys.
class TimelineTrack : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineTrack(QWidget* parent = nullptr);

  /// Times in s. `last` 0: nothing has been computed yet, and the track is disabled.
  void setTimes(double present, double last);
  /// The time (s) of an arrow key; Page Up, Page Down and Shift with an arrow move ten times as far.
  void setStep(double seconds) { step_ = seconds; }
  /// Called when the worker has reached the requested time: the handle follows the run again, except during a
  /// drag.
  void arrive();

  /// The handle's time (s): the requested time, else the present one.
  double time() const { return wanted_.value_or(present_); }
  double timeAt(double x) const;  ///< time (s) at a horizontal position (px)
  double placeOf(double time) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {120, sizeHint().height()}; }

 Q_SIGNALS:
  void timeWanted(double time);  ///< s; requested by the user, repeatedly during a drag

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  void want(double time);
  void describe();
  int captionHeight() const;
  void paintCaption(QPainter& painter, double time, double x) const;

  double present_ = 0, last_ = 0;  ///< s
  double step_ = 0.01;             ///< s
  bool dragging_ = false;
  std::optional<double> wanted_;  ///< s; requested and not reached yet
  std::optional<double> cursor_;  ///< px, of the mouse over the track
};

class Timeline : public QFrame {
  Q_OBJECT

 public:
  /// `play_again` is shown as a button.
  explicit Timeline(QAction* play_again, QWidget* parent = nullptr);

  /// `arrived`: the worker has carried out all commands sent.
  void showStatus(const WorkerStatus& status, bool arrived);

  TimelineTrack& track() { return *track_; }

 private:
  TimelineTrack* track_;
  QLabel* later_;
  QLabel* memory_;
};

}  // namespace clothlab
