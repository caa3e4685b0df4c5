// A window on the display with a hand on it.
#pragma once

#include <QAction>
#include <QApplication>
#include <QImage>
#include <QPainter>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QToolButton>
#include <QtTest>

#include "main_window/lab_window.h"
#include "part_of.h"
#include "patience.h"
#include "theme/theme.h"

namespace clothlab::test {

class WindowBench {
 public:
  explicit WindowBench(const QString& scene = "corners-shear") {
    window.setAsksToSave(false);
    window.view().setAnimated(false);
    window.show();
    if (!QTest::qWaitForWindowActive(&window, patience)) qFatal("the window was never active");
    window.openScene(scene);
    settle();
    if (!window.view().frame()) qFatal("no frame came");
    window.view().frameAll();
    QTest::qWait(50);
  }

  /// Until every command so far is in force and its frames, samples and status have arrived.
  void settle() { window.simulation().settle(); }

  QAction* action(const char* name) { return window.findChild<QAction*>(QLatin1String(name)); }
  const WorkerStatus& status() { return window.simulation().status(); }

  void click(const char* button_name) {
    auto* button = window.findChild<QToolButton*>(QLatin1String(button_name));
    QVERIFY2(button, button_name);
    QTest::mouseClick(button, Qt::LeftButton);
  }

  QWidget* editor(const char* path, const char* part) {
    auto* editor = window.findChild<QWidget*>(QStringLiteral("param:%1").arg(QLatin1String(path)));
    return editor ? part_of<QWidget>(window, *editor, QLatin1String(part)) : nullptr;
  }

  void play_until(double time) {
    settle();
    if (!status().playing) action("play")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(status().time > time, 60000);
  }

  void pause() {
    settle();
    if (action("play")->isChecked()) action("play")->trigger();
    settle();
  }

  /// Where a particle is on the view, in px.
  QPoint pixel_of(int particle) {
    const auto& at = window.view().frame()->positions;
    const auto i = static_cast<std::size_t>(3 * particle);
    const Eigen::Vector4d clip =
        window.view().camera().world_to_screen() * Eigen::Vector4d(at[i], at[i + 1], at[i + 2], 1);
    return {qRound(clip.x() / clip.w()), qRound(clip.y() / clip.w())};
  }

  Eigen::Vector3f position_of(int particle) {
    const auto& at = window.view().frame()->positions;
    const auto i = static_cast<std::size_t>(3 * particle);
    return {at[i], at[i + 1], at[i + 2]};
  }

  /// The window as it is on the display, with what OpenGL draws in its first pane.
  QImage picture() {
    QTest::qWait(300);
    QImage picture = window.grab().toImage();
    QPainter painter(&picture);
    painter.drawImage(window.view().mapTo(&window, QPoint()), window.view().grabPicture());
    return picture;
  }
  /// CLOTHLAB_WRITE_PICTURES=1 makes a picture of the docs anew.
  void write_picture(const char* name) {
    if (qEnvironmentVariableIntValue("CLOTHLAB_WRITE_PICTURES") == 0) return;
    QVERIFY(
        picture().save(QStringLiteral(CLOTHLAB_SOURCE_DIR "/docs/pictures/%1.png").arg(QLatin1String(name))));
  }

  LabWindow window;
};

}  // namespace clothlab::test
