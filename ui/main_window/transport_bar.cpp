#include "main_window/transport_bar.h"

#include <QAction>
#include <QComboBox>
#include <QHBoxLayout>
#include <QToolButton>
#include <limits>
#include <utility>

#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double as_fast_as_possible = std::numeric_limits<double>::infinity();

}  // namespace

TransportBar::TransportBar(const QList<QAction*>& actions, QWidget* parent)
    : QFrame(parent),
      speed_(new QComboBox(this)),
      time_(new Reading("000.000 s of 00.00 s", Reading::Look::bold, this)),
      rate_(new Reading("000 000 steps/s, 0.00x real time", Reading::Look::muted, this)),
      recording_(new Reading("000 000 rows", Reading::Look::plain, this)),
      gauge_(new StabilityGauge(this)) {
  setObjectName("transportBar");
  auto* row = spaced(new QHBoxLayout(this), spacing / 2, {spacing, spacing / 2, spacing, spacing / 2});
  for (QAction* action : actions) {
    QToolButton* button = make_action_button(action, this);
    if (action == actions.constFirst()) makePrimary(*button);
    row->addWidget(button);
  }
  row->addSpacing(spacing);
  row->addWidget(speed_);
  row->addSpacing(spacing);
  time_->setToolTip(tr("Simulated time"));
  row->addWidget(time_);
  rate_->setToolTip(tr("Steps per second of the clock, and simulated seconds per second"));
  row->addWidget(rate_, 1);
  row->addWidget(recording_);
  row->addSpacing(spacing);
  row->addWidget(gauge_);

  fillSpeeds();
  showStatus(WorkerStatus{});
}

void TransportBar::makePrimary(QToolButton& button) {
  button.setProperty("primary", true);
  button.setIconSize({24, 24});
  const auto dress = [&button, action = button.defaultAction()] {
    button.setIcon(icon_on_accent(action->icon().name()));
  };
  connect(button.defaultAction(), &QAction::changed, &button, dress);  // after the button took the action's
  dress();
}

void TransportBar::fillSpeeds() {
  speed_->setObjectName("speed");
  speed_->setToolTip(tr("Speed: simulated seconds per second"));
  speed_->setAccessibleName(tr("Speed"));
  for (const double factor : {0.01, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0})
    speed_->addItem(tr("%1x").arg(number_text(factor, 3)), factor);
  speed_->addItem(tr("Fastest"), as_fast_as_possible);
  speed_->setCurrentIndex(4);
  connect(speed_, &QComboBox::currentIndexChanged, this,
          [this](int index) { Q_EMIT speedChosen(speed_->itemData(index).toDouble()); });
}

/// Not the lower one for a short scene.
double TransportBar::speed() const {
  return speed_->itemData(speed_before_.value_or(speed_->currentIndex())).toDouble();
}

void TransportBar::setSpeed(double factor) {
  if (const int index = speed_->findData(factor); index >= 0) speed_->setCurrentIndex(index);
}

void TransportBar::suitDuration(double seconds) {
  constexpr double blink = 0.2;  // s
  constexpr int slowest = 0;
  if (seconds < blink) {
    if (!speed_before_) speed_before_ = speed_->currentIndex();
    speed_->setCurrentIndex(slowest);
  } else if (speed_before_) {
    speed_->setCurrentIndex(*std::exchange(speed_before_, std::nullopt));
  }
}

void TransportBar::showStatus(const WorkerStatus& status) {
  const QString time =
      time_text(status.time, status.comparison ? status.comparison->scene.record.interval : 1);
  if (status.is_comparison() && status.time <= status.duration)  // else played on beyond its end
    time_->setText(tr("%1 of %2").arg(time, quantity_text(status.duration, "s", 4)));
  else
    time_->setText(time);
  rate_->setText(rateText(status));
  recording_->setVisible(status.recording);
  if (status.recording)
    recording_->setText(tr("%1 rows").arg(count_text(static_cast<double>(status.recorded_rows))));
}

QString TransportBar::rateText(const WorkerStatus& status) const {
  if (status.divergence) return status.divergence->pinched ? tr("Stopped: pinched") : tr("Stopped: diverged");
  if (status.playing && status.is_comparison())
    return tr("%1x real time").arg(fixed_text(status.real_time_factor, 2));
  if (status.playing && status.steps_per_second > 0)
    return tr("%1 steps/s, %2x real time")
        .arg(count_text(status.steps_per_second), fixed_text(status.real_time_factor, 2));
  if (status.playing) return tr("Running");
  if (status.step == 0) return tr("Ready");
  if (!status.is_comparison())
    return tr("Paused after %1 steps").arg(count_text(static_cast<double>(status.step)));
  return status.time >= status.duration ? tr("Finished") : tr("Paused");
}

}  // namespace clothlab
