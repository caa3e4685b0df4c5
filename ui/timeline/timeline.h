// The timeline below the view: the run so far with a handle to move in it, the part that playing from here
// would delete, marks where something was done, and the memory of the stored states.
#pragma once

#include <QFrame>
#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "bridge/worker_status.h"

class QAction;
class QKeyEvent;
class QLabel;

namespace clothlab {

/// The track of the timeline: the run so far from left to right, and a handle at the present time, moved by
/// mouse and keys. During a drag the track shows the same stretch of time, whatever the run does.
class TimelineTrack : public QWidget {
  Q_OBJECT

 public:
  using Marks = std::shared_ptr<const std::vector<HistoryMark>>;

  explicit TimelineTrack(QWidget* parent = nullptr);

  /// Times in s. `last` 0: nothing has been computed yet, and the track is disabled.
  void setTimes(double present, double last);
  /// Where something was pulled, blown, pinned or edited.
  void setMarks(const Marks& marks);
  /// The time (s) of an arrow key; Page Up, Page Down and Shift with an arrow move ten times as far.
  void setStep(double seconds) { step_ = seconds; }
  /// Called when the worker has reached the requested time: the handle follows the run again, except during a
  /// drag.
  void arrive();
  /// Moves as the key says; false if it says nothing.
  bool takeKey(const QKeyEvent& event);

  /// The handle's time (s): the requested time, else the present one.
  double time() const { return wanted_.value_or(present_); }
  double timeAt(double x) const;  ///< time (s) at a horizontal position (px)
  double placeOf(double time) const;
  /// What was done there, a line each; empty: nothing.
  QString marksAt(double x) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {120, sizeHint().height()}; }

 Q_SIGNALS:
  void timeWanted(double time);  ///< s; requested by the user, repeatedly during a drag

 protected:
  bool event(QEvent* event) override;
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
  QRectF line() const;
  QRectF placeOf(const HistoryMark& mark) const;
  void paintMarks(QPainter& painter) const;
  void paintCaption(QPainter& painter, double time, double x) const;

  double present_ = 0, last_ = 0;  ///< s
  double shown_ = 0;               ///< s, at the right end: last_, or during a drag what it was before
  double step_ = 0.01;             ///< s
  bool dragging_ = false;
  std::optional<double> wanted_;  ///< s; requested and not reached yet
  std::optional<double> cursor_;  ///< px, of the mouse over the track
  Marks marks_;
};

/// The track, and beside it a text whose place depends on the width of the timeline alone: there is one in a
/// wide timeline and none in a narrow one.
class Timeline : public QFrame {
  Q_OBJECT

 public:
  /// `play_again` is shown as a button.
  explicit Timeline(QAction* play_again, QWidget* parent = nullptr);

  /// `arrived`: the worker has carried out all commands sent.
  void showStatus(const WorkerStatus& status, bool arrived);

  TimelineTrack& track() { return *track_; }

  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void suitFont();
  void suitWidth();

  TimelineTrack* track_;
  QWidget* text_;  ///< one of the two
  QLabel* later_;
  QLabel* memory_;
};

}  // namespace clothlab
