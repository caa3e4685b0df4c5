// A chart panel on the screen for the window tests, with the handles that a hand would take hold of.
#pragma once

#include <QApplication>
#include <QMouseEvent>
#include <QWheelEvent>
#include <QtTest>
#include <array>
#include <cmath>
#include <vector>

#include "charts/chart_panel.h"
#include "charts/live_chart.h"

namespace clothlab::test {

using Panel = ChartPanel;

inline ChartSample sample_at(double time_s) {
  ChartSample s;
  s.time_s = time_s;
  s.kinetic_J = 5 + 4 * std::sin(time_s);
  s.elastic_J = 0.1 * time_s;
  s.gravity_J = 3 - std::sin(time_s);
  s.total_J = s.kinetic_J + s.elastic_J + s.gravity_J;
  s.max_strain = 0.1 * (1 - std::exp(-time_s / 3));
  s.step_ms = 1.5 + 0.1 * std::cos(9 * time_s);
  return s;
}

inline std::vector<ChartSample> run_of(double seconds, double step_s = 0.1) {
  std::vector<ChartSample> samples;
  for (int i = 0; i * step_s <= seconds; ++i) samples.push_back(sample_at(i * step_s));
  return samples;
}

/// A panel on the screen, with the handles that a hand would take hold of.
struct Bench {
  Panel panel;
  explicit Bench(QSize size = {520, 600}) {
    panel.resize(size);
    panel.show();
    if (!QTest::qWaitForWindowExposed(&panel)) qFatal("the panel was never exposed");
  }
  LiveChart& chart(const char* key) { return *panel.findChild<LiveChart*>(QLatin1String(key)); }
  QWidget* canvas(const char* key) { return &chart(key).view(); }
  const PlotFrame& frame(const char* key) { return chart(key).scene().frame(); }
  const PlotMap& map(const char* key) { return chart(key).scene().map(); }
  QPoint middle(const char* key) { return map(key).plot.center().toPoint(); }
  QPoint on_y_axis(const char* key) { return {8, middle(key).y()}; }

  /// A direct question for what is drawn, whatever the timers have done so far.
  void settle() {
    QTest::qWait(1);
    QResizeEvent same(panel.size(), panel.size());
    QApplication::sendEvent(&panel, &same);
  }
  void wheel(const char* key, QPoint at, int notches, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QWheelEvent event(at, canvas(key)->mapToGlobal(QPointF(at)), {}, {0, 120 * notches}, Qt::NoButton,
                      modifiers, Qt::NoScrollPhase, false);
    QApplication::sendEvent(canvas(key), &event);
    settle();
  }
  void drag(const char* key, QPoint from, QPoint to, Qt::MouseButton button = Qt::LeftButton) {
    QTest::mousePress(canvas(key), button, {}, from);
    for (int i = 1; i <= 4; ++i) {
      const QPointF at = from + (to - from) * i / 4.0;
      QMouseEvent move(QEvent::MouseMove, at, canvas(key)->mapToGlobal(at), Qt::NoButton, button, {});
      QApplication::sendEvent(canvas(key), &move);
      settle();
    }
    QTest::mouseRelease(canvas(key), button, {}, to);
    settle();
  }
  void hover(const char* key, QPointF at) {
    QMouseEvent move(QEvent::MouseMove, at, canvas(key)->mapToGlobal(at), Qt::NoButton, Qt::NoButton, {});
    QApplication::sendEvent(canvas(key), &move);
  }
  void fill(double seconds) {
    panel.append(run_of(seconds));
    settle();
  }
};

}  // namespace clothlab::test
