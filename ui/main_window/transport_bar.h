// Below the view: play, step, reset, speed; how time goes; the stability gauge; record.
#pragma once

#include <QFrame>
#include <optional>

#include "bridge/worker_status.h"
#include "widgets/reading.h"
#include "widgets/stability_gauge.h"

class QAction;
class QComboBox;

namespace clothlab {

class TransportBar : public QFrame {
  Q_OBJECT

 public:
  /// The actions as buttons, the first one, to play, the largest; and room for the widest texts of time and
  /// rate.
  TransportBar(const QList<QAction*>& actions, const QString& widest_time, const QString& widest_rate,
               QWidget* parent);

  void showStatus(const WorkerStatus& status);
  void showStatus(const CompareStatus& status);
  /// For a newly opened scene: one that is over in the blink of an eye begins slowed down, and the next one
  /// of usual length goes back to the speed of before.
  void suitDuration(double seconds);
  StabilityGauge& gauge() { return *gauge_; }

 Q_SIGNALS:
  void speedChosen(double factor);  ///< simulated seconds per second; infinity: as fast as it goes

 private:
  void fillSpeeds();

  QComboBox* speed_;
  std::optional<int> speed_before_;  ///< the row that was chosen before a short scene
  Reading* time_;
  Reading* rate_;
  Reading* recording_;
  StabilityGauge* gauge_;
};

}  // namespace clothlab
