// The window with the Studies dock open, and the hands that work it.
#pragma once

#include <QComboBox>
#include <QLineEdit>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>

#include "studies/studies_panel.h"
#include "window_bench.h"

namespace clothlab::test {

class StudiesBench : public WindowBench {
 public:
  explicit StudiesBench(const QString& scene) : WindowBench(scene) {
    action("studies")->trigger();
    QTest::qWait(50);
  }
  ~StudiesBench() { panel().stop(); }

  StudiesPanel& panel() { return window.studies(); }
  StudyPlot& plot() { return panel().plot(); }
  template <class Widget>
  Widget* part(const char* name) {
    return panel().findChild<Widget*>(QLatin1String(name));
  }
  void push(const char* button) { QTest::mouseClick(part<QPushButton>(button), Qt::LeftButton); }

  void choose(StudyChoices::Kind kind) {
    auto* box = part<QComboBox>("studyKind");
    QTest::keyClick(box, Qt::Key_Home);
    for (int k = 0; k < static_cast<int>(kind); ++k) QTest::keyClick(box, Qt::Key_Down);
    QCOMPARE(panel().choices().kind(), kind);
  }
  /// Leaves these checked, by clicks on the boxes.
  void only(const QStringList& names, const char* of = "studyMethods") {
    auto* list = part<QListWidget>(of);
    for (int row = 0; row < list->count(); ++row) {
      QListWidgetItem* item = list->item(row);
      const bool wanted = names.contains(item->data(Qt::UserRole).toString());
      if (wanted == (item->checkState() == Qt::Checked)) continue;
      list->scrollToItem(item);
      const QRect box = list->visualItemRect(item);
      QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, {box.left() + 12, box.center().y()});
      QCOMPARE(item->checkState() == Qt::Checked, wanted);
    }
  }
  void type(const char* field, const QString& text) {
    auto* line = part<QLineEdit>(field);
    line->setFocus();
    line->selectAll();
    QTest::keyClicks(line, text);
  }
  void wait_for_end() {
    QTRY_VERIFY_WITH_TIMEOUT(!panel().isRunning() && !part<QProgressBar>("studyProgress")->isVisible(),
                             120000);
  }

  /// 3 x 2 cells of two methods.
  void prepare_small_map(const QString& folder) {
    choose(StudyChoices::Kind::stability);
    only({"verlet", "rk4"});
    auto* x = part<QWidget>("xAxis");
    auto* y = part<QWidget>("yAxis");
    x->findChild<QSpinBox*>("count")->setValue(3);
    y->findChild<QSpinBox*>("count")->setValue(2);
    part<QSpinBox>("periods")->setValue(10);
    type("studyFolder", folder);
  }
};

}  // namespace clothlab::test
