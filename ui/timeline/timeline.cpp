#include "timeline/timeline.h"

#include <QHBoxLayout>
#include <QLabel>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

QString size_text(std::size_t bytes) {
  const double megabytes = static_cast<double>(bytes) / (1 << 20);
  return Timeline::tr("%1 MB").arg(megabytes, 0, 'f', megabytes < 9.95 ? 1 : 0);
}

/// "12 MB of 256 MB, 96 states".
QString memory_text(const HistoryStatus& history) {
  return Timeline::tr("%1 of %2, %n state(s)", nullptr, static_cast<int>(history.states))
      .arg(size_text(history.bytes), Timeline::tr("%1 MB").arg(history.max_bytes >> 20))
      .replace("(s)", history.states == 1 ? "" : "s");
}

}  // namespace

Timeline::Timeline(QAction* play_again, QWidget* parent)
    : QFrame(parent),
      track_(new TimelineTrack(this)),
      later_(muted(named("timelineLater", new QLabel(this)))),
      memory_(muted(named("timelineMemory", new QLabel(this)))) {
  setObjectName("timeline");
  track_->setToolTip(tr("Drag or click to go back and forth in the run (Left, Right, Home, End)"));
  memory_->setToolTip(tr("States kept to go back to; the steps between them are computed again"));
  auto* row =
      spaced(new QHBoxLayout(this), spacing, {spacing, spacing / 2, spacing + spacing / 2, spacing / 2});
  row->addWidget(make_action_button(play_again, this));
  row->addWidget(track_, 1);
  row->addWidget(later_);
  row->addWidget(memory_);
  showStatus({}, true);
}

void Timeline::showStatus(const WorkerStatus& status, bool arrived) {
  const HistoryStatus& history = status.history;
  track_->setTimes(status.time, history.last_time);
  if (arrived) track_->arrive();
  const bool has_later = status.step < history.last_step;
  later_->setVisible(has_later);
  later_->setText(status.playing_again
                      ? tr("Playing again")
                      : tr("Play drops the later %1 s").arg(history.last_time - status.time, 0, 'f', 2));
  memory_->setText(history.last_step > 0 ? memory_text(history) : tr("Play to fill the timeline"));
}

}  // namespace clothlab
