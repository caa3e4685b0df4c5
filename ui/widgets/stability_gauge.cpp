#include "widgets/stability_gauge.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"
#include "simulation/time_step.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int bar_width = 72, bar_height = 6;  // px
constexpr double bar_maximum = 1.25;           // of the limit, at the bar's right end

QString step_text(double seconds) {
  constexpr int digits = 3;
  return quantity_text(seconds, "s", digits);
}

QString percent_text(const StabilityReading& reading) {
  constexpr long most = 9999;
  return QStringLiteral("%1 %").arg(std::min(std::lround(100 * reading.fraction()), most));
}

QColor level_colour(StabilityReading::Level level) {
  switch (level) {
    case StabilityReading::Level::unlimited:
    case StabilityReading::Level::stable:
      return theme().good;
    case StabilityReading::Level::near:
      return theme().warning;
    case StabilityReading::Level::unstable:
    case StabilityReading::Level::impossible:
      return theme().error;
  }
  return theme().good;
}

}  // namespace

StabilityReading read_stability(const cloth::Scene& scene) {
  using Level = StabilityReading::Level;
  StabilityReading reading;
  reading.automatic = !scene.integrator.time_step.has_value();
  reading.time_step = cloth::resolved_time_step(scene).value_or(0);
  const auto limit = cloth::guaranteed_step(scene.integrator.method, scene);
  if (!limit) {
    reading.level = Level::impossible;
  } else if (std::isinf(*limit)) {
    reading.level = Level::unlimited;
    reading.by_method = cloth::has_stiffness(scene);
  } else {
    reading.stable_step = *limit;
    reading.flat_step = cloth::stable_step(scene.integrator.method, scene).value_or(0);
    reading.level = reading.time_step < reading.stable_step ? Level::stable
                    : reading.time_step < reading.flat_step ? Level::near
                                                            : Level::unstable;
  }
  return reading;
}

StabilityGauge::StabilityGauge(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Stability of the time step"));
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
}

void StabilityGauge::setReading(const StabilityReading& reading) {
  reading_ = reading;
  setToolTip(explanation());
  setAccessibleDescription(text());
  updateGeometry();
  update();
}

QString StabilityGauge::text() const {
  using Level = StabilityReading::Level;
  switch (reading_.level) {
    case Level::impossible:
      return reading_.time_step > 0 ? tr("%1, no step is stable").arg(step_text(reading_.time_step))
                                    : tr("No step is stable");
    case Level::unlimited:
      return (reading_.by_method ? tr("%1, no limit for small motions") : tr("%1, any step is stable"))
          .arg(step_text(reading_.time_step));
    default:
      break;
  }
  return tr("%1, %2 of the limit").arg(step_text(reading_.time_step), percent_text(reading_));
}

QString StabilityGauge::text_within(int px) const {
  QStringList wordings{text()};
  if (reading_.stable_step > 0)
    wordings << QStringLiteral("%1, %2").arg(step_text(reading_.time_step), percent_text(reading_))
             << percent_text(reading_);
  else if (reading_.level == StabilityReading::Level::unlimited)
    wordings << tr("%1, no limit").arg(step_text(reading_.time_step)) << tr("No limit")
             << percent_text(reading_);
  for (const QString& wording : wordings)
    if (fontMetrics().horizontalAdvance(wording) <= px) return wording;
  return fontMetrics().elidedText(wordings.last(), Qt::ElideRight, px);
}

QString StabilityGauge::explanation() const {
  using Level = StabilityReading::Level;
  const QString step = reading_.automatic ? tr("Time step %1, chosen by auto.") : tr("Time step %1.");
  QString text =
      reading_.time_step > 0 ? step.arg(step_text(reading_.time_step)) + QStringLiteral(" ") : QString();
  switch (reading_.level) {
    case Level::impossible:
      text += tr(
          "This method amplifies every motion that is not damped, and the scene has no viscous damping: it "
          "diverges at any step.");
      break;
    case Level::unlimited:
      text += reading_.by_method ? tr("The method is stable at any step while the motion is small, or "
                                      "divides the step by itself. "
                                      "A long step is still less accurate.")
                                 : tr("Nothing in this scene limits the step.");
      break;
    case Level::stable:
      text += tr("The method is stable up to %1 in every shape of this cloth, however stretched.")
                  .arg(step_text(reading_.stable_step));
      break;
    case Level::near:
      text += tr("The method is stable up to %1 in every shape of this cloth, and up to %2 while it is flat "
                 "and at rest: stretched, sheared or crumpled it may diverge at this step.")
                  .arg(step_text(reading_.stable_step), step_text(reading_.flat_step));
      break;
    case Level::unstable:
      text += tr("The method is stable up to %1 in every shape of this cloth: at this step the run will "
                 "diverge.")
                  .arg(step_text(reading_.stable_step));
      break;
  }
  return text;
}

QSize StabilityGauge::sizeHint() const {
  const int widest = fontMetrics().horizontalAdvance(tr("0.000 ms, 100 % of the limit"));
  return {bar_width + spacing + std::max(widest, fontMetrics().horizontalAdvance(text())),
          fontMetrics().height() + spacing};
}

QSize StabilityGauge::minimumSizeHint() const {
  return {bar_width, sizeHint().height()};
}

void StabilityGauge::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setLayoutDirection(Qt::LeftToRight);  // a number comes before its unit in every layout
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF bar(0, (height() - bar_height) / 2.0, bar_width, bar_height);
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().border);
  painter.drawRoundedRect(bar, bar_height / 2.0, bar_height / 2.0);

  const bool over = reading_.level == StabilityReading::Level::impossible;
  const double fraction = over ? bar_maximum : std::min(reading_.fraction(), bar_maximum);
  QRectF filled = bar;
  filled.setWidth(std::max<double>(bar_height, bar.width() * fraction / bar_maximum));
  painter.setBrush(level_colour(reading_.level));
  painter.drawRoundedRect(filled, bar_height / 2.0, bar_height / 2.0);

  const double limit_x = std::round(bar.left() + bar.width() / bar_maximum) + 0.5;
  painter.setPen(QPen(theme().text, 1));
  painter.drawLine(QPointF(limit_x, bar.top() - 3), QPointF(limit_x, bar.bottom() + 3));

  const QRect text_rect = rect().adjusted(bar_width + spacing, 0, 0, 0);
  const bool alarming = reading_.level == StabilityReading::Level::unstable || over;
  painter.setPen(alarming                                          ? theme().error
                 : reading_.level == StabilityReading::Level::near ? theme().warning
                                                                   : theme().text);
  painter.drawText(text_rect, Qt::AlignVCenter | Qt::AlignLeft, text_within(text_rect.width()));
}

}  // namespace clothlab
