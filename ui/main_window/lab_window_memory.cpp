// LabWindow: what it remembers from one start to the next: its geometry, docks and bars, the way of drawing,
// logarithmic axes and the speed. Kept in QSettings when a window is closed.
#include <QDockWidget>
#include <QSettings>

#include "main_window/lab_window.h"

namespace clothlab {
namespace {

constexpr int layout_version = 1;  // of docks and bars; another one is not restored

QVariantMap as_map(const std::map<QString, bool>& axes) {
  QVariantMap map;
  for (const auto& [key, logarithmic] : axes) map[key] = logarithmic;
  return map;
}

std::map<QString, bool> as_axes(const QVariantMap& map) {
  std::map<QString, bool> axes;
  for (const auto& [key, logarithmic] : map.asKeyValueRange()) axes[key] = logarithmic.toBool();
  return axes;
}

}  // namespace

void LabWindow::remember() {
  QSettings settings;
  settings.beginGroup("window");
  settings.setValue("geometry", saveGeometry());
  settings.setValue("layout", saveState(layout_version));
  for (const auto [dock, width] : wanted_widths_.asKeyValueRange())
    settings.setValue("width/" + dock->objectName(), width);
  settings.setValue("comparisonWidths", shows_comparison_);
  settings.setValue("mode", static_cast<int>(grid_->mode()));
  settings.setValue("speed", transport_->speed());
  settings.setValue("logarithmic", as_map(charts_->logarithmicAxes()));
  settings.setValue("logarithmicOfPanes", as_map(pane_charts_->logarithmicAxes()));
}

void LabWindow::recall() {
  QSettings settings;
  settings.beginGroup("window");
  if (!settings.contains("geometry")) return;
  if (all().size() == 1)
    restoreGeometry(settings.value("geometry").toByteArray());  // else one over the other
  restoreState(settings.value("layout").toByteArray(), layout_version);
  for (QDockWidget* dock : {parameters_dock_, charts_dock_})
    wanted_widths_[dock] = settings.value("width/" + dock->objectName()).toInt();
  shows_comparison_ = settings.value("comparisonWidths").toBool();
  grid_->setMode(static_cast<ViewMode>(settings.value("mode").toInt()));
  transport_->setSpeed(settings.value("speed").toDouble());
  charts_->setLogarithmicAxes(as_axes(settings.value("logarithmic").toMap()));
  pane_charts_->setLogarithmicAxes(as_axes(settings.value("logarithmicOfPanes").toMap()));
}

}  // namespace clothlab
