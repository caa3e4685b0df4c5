// Under the view: the run so far as a line to scrub on, what playing from here would drop, and the memory
// that the states to go back to take.
#pragma once

#include <QFrame>

#include "bridge/worker_status.h"
#include "timeline/timeline_track.h"

class QAction;
class QLabel;

namespace clothlab {

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

/// "12 MB of 256 MB, 96 states".
QString memory_text(const HistoryStatus& history);

}  // namespace clothlab
