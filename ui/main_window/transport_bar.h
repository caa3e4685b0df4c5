// The bar below the view: play, step, reset, speed, simulated time and rate, stability gauge, record.
#pragma once

#include <QFrame>
#include <optional>

#include "bridge/worker_status.h"
#include "widgets/reading.h"
#include "widgets/stability_gauge.h"

class QAction;
class QComboBox;
class QToolButton;

namespace clothlab {

class TransportBar : public QFrame {
  Q_OBJECT

 public:
  /// Shows the actions as buttons, the first one (play) larger.
  TransportBar(const QList<QAction*>& actions, QWidget* parent);

  void showStatus(const WorkerStatus& status);
  /// Called for a newly opened scene: selects a lower speed if its duration is very short; for the next
  /// longer scene restores the previous speed.
  void suitDuration(double seconds);
  double speed() const;          ///< as chosen
  void setSpeed(double factor);  ///< nothing if it is not offered
  StabilityGauge& gauge() { return *gauge_; }

 Q_SIGNALS:
  void speedChosen(double factor);  ///< simulated seconds per second; infinity: as fast as possible

 private:
  void fillSpeeds();
  void makePrimary(QToolButton& button);
  QString rateText(const WorkerStatus& status) const;

  QComboBox* speed_;
  std::optional<int> speed_before_;  ///< the row that was selected before a short scene
  Reading* time_;
  Reading* rate_;
  Reading* recording_;
  StabilityGauge* gauge_;
};

}  // namespace clothlab
