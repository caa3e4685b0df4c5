// A gauge of the time step divided by the largest one that is stable in every shape of the cloth.
#pragma once

#include <QWidget>

#include "scene/scene.h"

namespace clothlab {

/// What the gauge shows.
struct StabilityReading {
  enum class Level { unlimited, stable, near, unstable, impossible } level = Level::stable;
  double time_step = 0;    ///< s; 0: none
  double stable_step = 0;  ///< s, in every shape; 0 where there is none
  double flat_step = 0;    ///< s, the limit of the flat cloth; between the two some shapes diverge
  bool by_method =
      false;  ///< only if unlimited: true if because of the method, false if because there are no springs
  bool automatic = false;  ///< the step was chosen by "auto"
  double fraction() const { return stable_step > 0 ? time_step / stable_step : 0; }
};

StabilityReading read_stability(const cloth::Scene& scene);

class StabilityGauge : public QWidget {
  Q_OBJECT

 public:
  explicit StabilityGauge(QWidget* parent = nullptr);

  void setReading(const StabilityReading& reading);
  const StabilityReading& reading() const { return reading_; }
  QString text() const;               ///< "0.91 ms, 73 % of the limit"
  QString text_within(int px) const;  ///< the longest form that fits; at least "73 %"

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString explanation() const;

  StabilityReading reading_;
};

}  // namespace clothlab
