// The list of edits that Edit, Undo history opens.
#include <QDialog>
#include <QTest>
#include <QUndoView>

#include "listed_test.h"
#include "window_bench.h"

namespace clothlab::test::undo_history_test {

class UndoHistoryTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void a_click_goes_to_an_edit() {
    WindowBench bench;
    LabDocument& document = bench.window.document();
    const double first = document.scene().springs->structural;
    document.setParameter("springs.structural", 111.0);
    document.setParameter("springs.shear", 22.0);
    document.setParameter("springs.structural", 333.0);
    bench.action("undoHistory")->trigger();
    auto* dialog = bench.window.findChild<QDialog*>("undoHistory");
    QVERIFY(dialog && dialog->isVisible());
    auto* list = dialog->findChild<QUndoView*>("edits");
    const auto click = [&](int row) {
      const QRect place = list->visualRect(list->model()->index(row, 0));
      QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, place.center());
    };
    QCOMPARE(list->model()->rowCount(), 4);
    click(1);
    QCOMPARE(document.scene().springs->structural, 111.0);
    QVERIFY(document.scene().springs->shear != 22.0);
    click(0);
    QCOMPARE(document.scene().springs->structural, first);
    click(3);
    QCOMPARE(document.scene().springs->structural, 333.0);
    bench.action("undoHistory")->trigger();
    QCOMPARE(bench.window.findChildren<QDialog*>("undoHistory").size(), 1);
  }
};

const Listed listed{"undo_history_test", test_main<UndoHistoryTest>};

}  // namespace clothlab::test::undo_history_test

#include "undo_history_test.moc"
