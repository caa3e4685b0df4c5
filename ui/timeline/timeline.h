// Under the view: the run so far as a line to scrub on, what playing from here would drop, and the memory
// that the states to go back to take.
#pragma once

#include <QFrame>
#include <QWidget>
#include <optional>

#include "bridge/worker_status.h"

class QAction;
class QLabel;

namespace clothlab {

/// The line of the timeline: the run so far from left to right, and a handle at the present time that mouse
/// and keys move.
class TimelineTrack : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineTrack(QWidget* parent = nullptr);

  /// Times in s. `last` 0: nothing was played yet, and there is nowhere to go.
  void setTimes(double present, double last);
  /// What an arrow key goes, in s; Page Up and Page Down and Shift with an arrow go ten times as far.
  void setStep(double seconds) { step_ = seconds; }
  /// The worker is where it was sent: the handle follows the run again, unless the mouse holds it.
  void arrive();

  /// Where the handle is, in s: where it was dragged to, or else the present.
  double time() const { return wanted_.value_or(present_); }
  double timeAt(double x) const;  ///< s, for a place in px
  double placeOf(double time) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {120, sizeHint().height()}; }

 Q_SIGNALS:
  void timeWanted(double time);  ///< s, by a person; again and again during a drag

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
  std::optional<double> wanted_;  ///< s: sent for and not reached yet
  std::optional<double> cursor_;  ///< px, of the mouse over the track
};

class Timeline : public QFrame {
  Q_OBJECT

 public:
  /// `play_again` is shown as a button.
  explicit Timeline(QAction* play_again, QWidget* parent = nullptr);

  /// `arrived`: nothing that the window has sent is still on the way.
  void showStatus(const WorkerStatus& status, bool arrived);

  TimelineTrack& track() { return *track_; }

 private:
  TimelineTrack* track_;
  QLabel* later_;
  QLabel* memory_;
};

}  // namespace clothlab
