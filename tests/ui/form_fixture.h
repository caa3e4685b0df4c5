// A form with a document behind it, and the hands to work it with: real keys and mouse events.
#pragma once

#include <QAccessible>
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QMenu>
#include <QPointer>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QToolButton>
#include <QWheelEvent>
#include <QtTest>
#include <cmath>
#include <memory>

#include "params/parameter_panel.h"
#include "params/slider_scale.h"
#include "params/wording.h"
#include "part_of.h"
#include "patience.h"

namespace clothlab::test {

inline cloth::Scene plain_scene() {
  cloth::Scene scene;
  scene.springs = cloth::SpringMaterial{.structural = 500, .shear = 250, .flexion = 50, .damping = 0};
  scene.gravity = cloth::Vec3(0, -9.81, 0);
  scene.deformation = cloth::Deformation{};
  return scene;
}

class FormFixture : public QObject {
 protected:
  std::unique_ptr<LabDocument> document_;
  std::unique_ptr<ParameterPanel> panel_;

  LabDocument& doc() { return *document_; }
  ParameterPanel& panel() { return *panel_; }
  QUndoStack& undo() { return doc().undoStack(); }

  template <class Widget>
  Widget* part(const char* path, const char* name) {
    auto* editor = panel().findChild<QWidget*>(QString("param:") + path);
    return editor ? part_of<Widget>(panel(), *editor, name) : nullptr;
  }
  QLineEdit* field(const char* path) { return part<QLineEdit>(path, "field"); }
  QSlider* slider(const char* path) { return part<QSlider>(path, "slider"); }
  QWidget* section(const char* path) { return panel().findChild<QWidget*>(QString("section:") + path); }
  double structural() { return doc().scene().springs->structural; }

  void type(QLineEdit* into, const QString& text, Qt::Key then = Qt::Key_Return) {
    into->setFocus();
    into->selectAll();
    QTest::keyClicks(into, text);
    QTest::keyClick(into, then);
  }
  static QPoint at(QSlider* slider, double part) {
    return {static_cast<int>(part * (slider->width() - 1)), slider->height() / 2};
  }
  void drag(QSlider* slider, double from, double to) {
    QTest::mousePress(slider, Qt::LeftButton, {}, at(slider, from));
    for (int i = 1; i <= 20; ++i) QTest::mouseMove(slider, at(slider, from + (to - from) * i / 20));
    QTest::mouseRelease(slider, Qt::LeftButton, {}, at(slider, to));
  }
  static void wheel(QWidget* over, int angle) {
    const QPointF middle = over->rect().center();
    QWheelEvent event(middle, over->mapToGlobal(middle), {}, {0, angle}, Qt::NoButton, {}, Qt::NoScrollPhase,
                      false);
    QSpontaneKeyEvent::setSpontaneous(&event);  // only the system's own wheel events go on to the parents
    qApp->notify(over, &event);
  }

  /// Before and after every test.
  void open() {
    document_ = std::make_unique<LabDocument>();
    doc().load(plain_scene());
    panel_ = std::make_unique<ParameterPanel>(doc());
    panel().resize(320, 700);
    panel().show();
    QVERIFY(QTest::qWaitForWindowExposed(panel_.get()));
    panel().activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(panel_.get(), patience));
  }
  void close() {
    panel_.reset();
    document_.reset();
  }
};

}  // namespace clothlab::test
