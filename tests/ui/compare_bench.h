// The window of a comparison on the display with a hand on it.
#pragma once

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QMouseEvent>
#include <QTabBar>
#include <QToolButton>
#include <QtTest>

#include "main_window/lab_window.h"
#include "params/exact_field.h"
#include "patience.h"
#include "scene/builtin_scenes.h"

namespace clothlab::test {

inline cloth::Comparison small_comparison(const std::vector<std::string>& methods = {"verlet", "rk4"}) {
  cloth::Comparison comparison;
  comparison.scene = cloth::builtin_scene("wind");
  comparison.scene.cloth.columns = comparison.scene.cloth.rows = 9;
  comparison.scene.duration = 0.3;
  comparison.panes = cloth::panes_for(methods);
  comparison.reference = "A";
  return comparison;
}

inline void drag(QWidget* on, QPoint from, QPoint to, Qt::MouseButton button = Qt::LeftButton) {
  QTest::mousePress(on, button, Qt::NoModifier, from);
  for (int part = 1; part <= 8; ++part) {
    const QPointF at = QPointF(from) + (QPointF(to) - QPointF(from)) * part / 8.0;
    QMouseEvent move(QEvent::MouseMove, at, on->mapToGlobal(at), Qt::NoButton, button, Qt::NoModifier);
    QApplication::sendEvent(on, &move);
    QTest::qWait(15);
  }
  QTest::mouseRelease(on, button, Qt::NoModifier, to);
}

/// A comparison's window on the display with a hand on it.
class CompareBench {
 public:
  explicit CompareBench(const cloth::Comparison& comparison = small_comparison()) {
    window.setAsksToSave(false);
    window.show();
    if (!QTest::qWaitForWindowActive(&window, patience)) qFatal("the window was never active");
    window.document().load(comparison);
    window.simulation().settle();
  }

  const WorkerStatus& status() { return window.simulation().status(); }
  const cloth::Comparison& comparison() { return window.document().comparison(); }
  void settle() { window.simulation().settle(); }
  QAction* action(const char* name) { return window.findChild<QAction*>(QLatin1String(name)); }

  template <class Widget>
  Widget* part(std::size_t pane, const char* name) {
    return window.panes().pane(pane).findChild<Widget*>(QLatin1String(name));
  }
  /// From the pane's menu.
  void choose(std::size_t pane, const char* name) { part<QAction>(pane, name)->trigger(); }

  QWidget* editor(const char* path, const char* name) {
    auto* editor =
        window.parameters().findChild<QWidget*>(QStringLiteral("param:%1").arg(QLatin1String(path)));
    return editor ? editor->findChild<QWidget*>(QLatin1String(name)) : nullptr;
  }

  /// Clicks the tab: 0 is what all share, 1 pane A.
  void scope(int tab) {
    auto* tabs = window.findChild<QTabBar*>("scopes");
    QTest::mouseClick(tabs, Qt::LeftButton, Qt::NoModifier, tabs->tabRect(tab).center());
  }

  void type_step(std::size_t pane, const QString& text) {
    auto* field = part<ExactField>(pane, "step");
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, text);
    QTest::keyClick(field, Qt::Key_Return);
  }

  void play_to_the_end() {
    window.findChild<QComboBox*>("speed")->setCurrentText("Fastest");
    QTest::mouseClick(window.findChild<QToolButton*>("playButton"), Qt::LeftButton);
    settle();
    QTRY_VERIFY_WITH_TIMEOUT(!status().playing, 120000);
    settle();
  }

  LabWindow window;
};

}  // namespace clothlab::test
