#include "timeline/timeline.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QStackedLayout>
#include <algorithm>

#include "theme/theme.h"
#include "timeline/timeline_keys.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int pleasant_track = 200;  // px

QString size_text(std::size_t bytes) {
  const double megabytes = static_cast<double>(bytes) / (1 << 20);
  return Timeline::tr("%1 MB").arg(fixed_text(megabytes, megabytes < 9.95 ? 1 : 0));
}

/// "12 MB of 256 MB, 96 states".
QString memory_text(const HistoryStatus& history) {
  return Timeline::tr("%1 of %2, %n state(s)", nullptr, static_cast<int>(history.states))
      .arg(size_text(history.bytes), Timeline::tr("%1 MB").arg(history.max_bytes >> 20))
      .replace("(s)", history.states == 1 ? "" : "s");
}

QString later_text(double seconds) {
  return Timeline::tr("Play drops the later %1").arg(quantity_text(seconds, "s", 3));
}

QString nothing_text() {
  return Timeline::tr("Play to fill the timeline");
}

}  // namespace

Timeline::Timeline(QAction* play_again, QWidget* parent)
    : QFrame(parent),
      track_(new TimelineTrack(this)),
      text_(new QWidget(this)),
      later_(muted(named("timelineLater", new QLabel(text_)))),
      memory_(muted(named("timelineMemory", new QLabel(text_)))) {
  setObjectName("timeline");
  memory_->setToolTip(tr("States kept to go back to; the steps between them are computed again"));
  auto* either = spaced(new QStackedLayout(text_), 0);
  either->addWidget(memory_);
  either->addWidget(later_);
  auto* row =
      spaced(new QHBoxLayout(this), spacing, {spacing, spacing / 2, spacing + spacing / 2, spacing / 2});
  row->addWidget(make_action_button(play_again, this));
  row->addWidget(track_, 1);
  row->addWidget(text_);
  new TimelineKeys(track_);
  suitFont();
  showStatus({}, true);
}

void Timeline::showStatus(const WorkerStatus& status, bool arrived) {
  const HistoryStatus& history = status.history;
  track_->setTimes(status.time, history.last_time);
  track_->setMarks(history.marks);
  if (arrived) track_->arrive();
  const QString memory = history.last_step > 0 ? memory_text(history) : nothing_text();
  memory_->setText(memory);
  later_->setText(status.playing_again ? tr("Playing again") : later_text(history.last_time - status.time));
  later_->setToolTip(tr("Kept: %1").arg(memory));
  static_cast<QStackedLayout*>(text_->layout())
      ->setCurrentWidget(status.step < history.last_step ? later_ : memory_);
}

/// As wide as the longest text that is to be expected, so that no text moves the track.
void Timeline::suitFont() {
  HistoryStatus full;
  full.states = 8888;
  full.bytes = full.max_bytes = std::size_t{888} << 20;
  int widest = 0;
  for (const QString& text : {memory_text(full), later_text(888.88), nothing_text()})
    widest = std::max(widest, memory_->fontMetrics().horizontalAdvance(text));
  text_->setFixedWidth(widest + spacing);
  suitWidth();
}

QSize Timeline::minimumSizeHint() const {
  const QSize all = layout()->minimumSize();
  return {all.width() - (text_->isHidden() ? 0 : text_->width() + layout()->spacing()), all.height()};
}

void Timeline::suitWidth() {
  const int beside = minimumSizeHint().width() - track_->minimumSizeHint().width();
  text_->setVisible(width() >= beside + pleasant_track + layout()->spacing() + text_->minimumWidth());
}

void Timeline::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  suitWidth();
}

void Timeline::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) suitFont();
}

}  // namespace clothlab
