// The Studies dock beside everything else: what a user chose stays, what is shown says what it is, nothing is
// cut, and no window waits for a disk.
#include <QCheckBox>
#include <QDockWidget>
#include <QLabel>
#include <QLayout>
#include <QListWidget>
#include <QProgressBar>
#include <QScrollArea>
#include <QStyleOptionViewItem>
#include <thread>

#include "charts/live_chart.h"
#include "dialogs.h"
#include "listed_test.h"
#include "patience.h"
#include "studies/axis_choice.h"
#include "studies_bench.h"
#include "study/study_runs.h"
#include "support/slow_disk.h"

namespace clothlab::test::studies_dock_test {
namespace {

constexpr QSize small_window{1000, 650};
constexpr StudyChoices::Kind every_kind[] = {
    StudyChoices::Kind::sweep,       StudyChoices::Kind::fit,       StudyChoices::Kind::work_precision,
    StudyChoices::Kind::iterations,  StudyChoices::Kind::stability, StudyChoices::Kind::extremes,
    StudyChoices::Kind::convergence, StudyChoices::Kind::validation};

bool is_placed_by_a_layout(const QWidget& widget) {
  const QWidget* parent = widget.parentWidget();
  return parent && parent->layout() && parent->layout()->indexOf(&widget) >= 0;
}

QString described(const QWidget& widget) {
  const QRect at = widget.geometry();
  return QStringLiteral("%1 \"%2\" at %3,%4 %5x%6")
      .arg(widget.metaObject()->className(), widget.objectName())
      .arg(at.x())
      .arg(at.y())
      .arg(at.width())
      .arg(at.height());
}

/// What is cut or overlaps below a widget; empty: nothing. What scrolls up and down may be higher than its
/// place.
QString trouble_below(const QWidget& above) {
  const auto children = above.findChildren<QWidget*>();
  for (const QWidget* one : children) {
    if (!one->isVisible()) continue;
    const QWidget* parent = one->parentWidget();
    if (const auto* area = qobject_cast<const QScrollArea*>(parent->parentWidget()))
      if (area->widget() == one && area->horizontalScrollBarPolicy() == Qt::ScrollBarAlwaysOff &&
          one->width() > parent->width())
        return described(*one) + " is cut at the side";
    if (!is_placed_by_a_layout(*one)) continue;
    if (!parent->rect().contains(one->geometry())) return described(*one) + " is outside";
    const QSize least = one->minimumSizeHint().boundedTo(one->maximumSize());
    if (one->width() < least.width() || one->height() < least.height()) return described(*one) + " is cut";
    for (const QWidget* other : children)
      if (other != one && other->parentWidget() == parent && other->isVisible() &&
          is_placed_by_a_layout(*other) && other->geometry().intersects(one->geometry()))
        return described(*one) + " overlaps " + described(*other);
  }
  return {};
}

struct AxisFields {
  explicit AxisFields(QWidget* axis)
      : parameter(axis->findChild<QComboBox*>("parameter")),
        low(axis->findChild<QLineEdit*>("low")),
        high(axis->findChild<QLineEdit*>("high")),
        count(axis->findChild<QSpinBox*>("count")),
        logarithmic(axis->findChild<QCheckBox*>("logarithmic")) {}

  QStringList values() const {
    return {parameter->currentText(), low->text(), high->text(), count->text(),
            logarithmic->isChecked() ? "log" : "linear"};
  }

  QComboBox* parameter;
  QLineEdit *low, *high;
  QSpinBox* count;
  QCheckBox* logarithmic;
};

void type_into(QLineEdit* field, const QString& text) {
  QTest::mouseClick(field, Qt::LeftButton);
  QTest::keyClick(field, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClicks(field, text);
}

}  // namespace

class DockBench : public StudiesBench {
 public:
  using StudiesBench::StudiesBench;

  AxisFields axis(const char* name) { return AxisFields(part<QWidget>(name)); }
  /// Another stiffness, typed into the form of the scene.
  void edit_scene() {
    const cloth::Scene before = window.document().scene();
    auto* field = qobject_cast<QLineEdit*>(editor("springs.structural", "field"));
    QVERIFY(field);
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, "123");
    QTest::keyClick(field, Qt::Key_Return);
    settle();
    QVERIFY(!(window.document().scene() == before));
  }
  bool says_earlier() { return part<QLabel>("studyEarlier")->isVisible(); }
  void run_small_map(const QString& folder) {
    prepare_small_map(folder);
    push("startStudy");
    wait_for_end();
    QTest::qWait(50);
  }
};

class StudiesDockTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
  }
  void cleanup() { QApplication::setLayoutDirection(Qt::LeftToRight); }

  void edits_of_the_scene_leave_what_the_user_chose() {
    DockBench bench("pendulum");
    bench.choose(StudyChoices::Kind::stability);
    const AxisFields x = bench.axis("xAxis"), y = bench.axis("yAxis");
    type_into(x.low, "0.0007");
    type_into(x.high, "0.009");
    type_into(x.count->findChild<QLineEdit*>(), "5");
    QTest::keyClick(y.parameter, Qt::Key_Down);
    QTest::mouseClick(y.logarithmic, Qt::LeftButton, {}, {10, y.logarithmic->height() / 2});
    const QStringList across = x.values(), up = y.values();
    bench.edit_scene();
    QCOMPARE(x.values(), across);
    QCOMPARE(y.values(), up);
    bench.window.document().undoStack().undo();
    QCOMPARE(x.values(), across);
    QCOMPARE(y.values(), up);
  }

  void a_double_click_on_a_cell_leaves_the_axes_of_the_map() {
    DockBench bench("pendulum");
    bench.run_small_map(folder_.filePath("map"));
    const QStringList across = bench.axis("xAxis").values(), up = bench.axis("yAxis").values();
    const QPoint at = bench.plot().placeOf(7).center().toPoint();
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, at);
    bench.settle();
    QCOMPARE(bench.window.document().scene().integrator.method, std::string("rk4"));
    QCOMPARE(bench.axis("xAxis").values(), across);
    QCOMPARE(bench.axis("yAxis").values(), up);
  }

  void methods_of_a_kind_of_study_stay_as_they_were_checked() {
    DockBench bench("pendulum");
    bench.choose(StudyChoices::Kind::work_precision);
    bench.only({"verlet"});
    bench.choose(StudyChoices::Kind::stability);
    bench.choose(StudyChoices::Kind::work_precision);
    auto* list = bench.part<QListWidget>("studyMethods");
    for (int row = 0; row < list->count(); ++row)
      QCOMPARE(list->item(row)->checkState() == Qt::Checked,
               list->item(row)->data(Qt::UserRole).toString() == "verlet");
  }

  void a_study_of_other_values_than_the_forms_is_called_an_earlier_one() {
    DockBench bench("pendulum");
    bench.run_small_map(folder_.filePath("earlier"));
    QVERIFY(!bench.says_earlier());
    auto* periods = bench.part<QSpinBox>("periods");
    QTest::keyClick(periods, Qt::Key_Up);
    QVERIFY(bench.says_earlier());
    QTest::keyClick(periods, Qt::Key_Down);
    QVERIFY(!bench.says_earlier());
    bench.edit_scene();
    QVERIFY(bench.says_earlier());
    while (bench.window.document().undoStack().canUndo()) bench.window.document().undoStack().undo();
    QVERIFY(!bench.says_earlier());
    bench.choose(StudyChoices::Kind::extremes);
    QVERIFY(bench.says_earlier());
  }

  void a_slow_disk_does_not_delay_the_next_study() {
    const QString first = folder_.filePath("slow"), second = folder_.filePath("next");
    DockBench bench("pendulum");
    SlowDisk disk("slow/report.html");
    bench.prepare_small_map(first);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(disk.is_waited_for(), 60000);
    QTRY_VERIFY_WITH_TIMEOUT(bench.part<QPushButton>("startStudy")->isEnabled(), patience);
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), 2 * 3 * 2);
    bench.type("studyFolder", second);
    bench.push("startStudy");
    bench.wait_for_end();
    QVERIFY(disk.is_waited_for());
    QVERIFY(cloth::read_study(second.toStdString()).study);
    disk.let_go();
    bench.panel().stop();
    const cloth::StudyReading reading = cloth::read_study(first.toStdString());
    QVERIFY2(reading.study, reading.problem.c_str());
    QVERIFY(cloth::is_complete(reading.study->table));
  }

  void sessions_that_wait_for_the_disk_when_the_window_closes_are_saved() {
    const QStringList files = {folder_.filePath("one.session.json"), folder_.filePath("two.session.json")};
    SlowDisk disk("one.session.json");
    std::thread disk_in_a_second;
    {
      WindowBench bench("pendulum");
      auto end_of_a_failure = qScopeGuard([&disk] { disk.let_go(); });
      for (const QString& file : files) {
        Answers answers;
        answers.type(file);
        QTest::keyClick(&bench.window, Qt::Key_S, Qt::ControlModifier | Qt::AltModifier);
        QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
        QTRY_VERIFY_WITH_TIMEOUT(disk.is_waited_for(), patience);
      }
      QVERIFY(bench.window.close());
      end_of_a_failure.dismiss();
      disk_in_a_second = std::thread([&disk] {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        disk.let_go();
      });
    }
    disk_in_a_second.join();
    for (const QString& file : files) QVERIFY2(QFile::exists(file), qPrintable(file));
  }

  void opening_the_dock_leaves_the_window_as_large_as_it_is() {
    WindowBench bench("pendulum");
    bench.window.resize(small_window);
    QTest::qWait(100);
    QCOMPARE(bench.window.size(), small_window);
    QTest::keyClick(&bench.window, Qt::Key_T, Qt::ControlModifier);
    QVERIFY(bench.window.studies().isVisible());
    QTest::qWait(200);
    QCOMPARE(bench.window.size(), small_window);
    for (LiveChart* chart : bench.window.charts().findChildren<LiveChart*>())
      QVERIFY2(chart->scene().map().plot.height() >= 20, qPrintable(chart->objectName()));
    bench.window.studies().openFolder(folder_.filePath("map"));
    QTest::qWait(200);
    QCOMPARE(bench.window.size(), small_window);
  }

  void charts_get_their_room_back_when_the_window_grows_again() {
    WindowBench bench("pendulum");
    const QSize pleasant = bench.window.size();
    const QSize before = bench.window.charts().size();
    QTest::keyClick(&bench.window, Qt::Key_T, Qt::ControlModifier);
    bench.window.resize(small_window);
    QTest::qWait(200);
    QVERIFY(bench.window.charts().width() < before.width());
    bench.window.resize(pleasant);
    QTest::qWait(200);
    QCOMPARE(bench.window.charts().width(), before.width());
    bench.window.findChild<QDockWidget*>("studiesDock")->close();
    QTest::qWait(200);
    QCOMPARE(bench.window.charts().size(), before);
  }

  void labels_of_diagrams_are_legible_in_a_small_window() {
    DockBench bench("pendulum");
    bench.window.resize(small_window);
    QTest::qWait(100);
    bench.panel().openFolder(folder_.filePath("map"));
    QTest::qWait(100);
    QVERIFY2(bench.plot().smallestLabel() >= 11, qPrintable(QString::number(bench.plot().smallestLabel())));
    auto* area = bench.part<QScrollArea>("studyPlotArea");
    area->ensureVisible(0, bench.plot().height());
    const QPoint last = bench.plot().placeOf(7).center().toPoint();
    QVERIFY(bench.plot().rect().contains(last));
  }

  void names_of_methods_are_whole() {
    DockBench bench("pendulum");
    bench.window.resize(small_window);
    QTest::qWait(100);
    bench.choose(StudyChoices::Kind::work_precision);
    QTest::qWait(100);
    auto* methods = bench.part<QListWidget>("studyMethods");
    QStyleOptionViewItem option;
    option.initFrom(methods);
    option.features = QStyleOptionViewItem::HasCheckIndicator | QStyleOptionViewItem::HasDisplay;
    for (int row = 0; row < methods->count(); ++row) {
      const QListWidgetItem* item = methods->item(row);
      option.rect = methods->visualItemRect(item);
      option.text = item->text();
      const QRect room = methods->style()->subElementRect(QStyle::SE_ItemViewItemText, &option, methods);
      QVERIFY2(room.width() >= methods->fontMetrics().horizontalAdvance(item->text()),
               qPrintable(QStringLiteral("%1: %2 px").arg(item->text()).arg(room.width())));
      QVERIFY(methods->viewport()->rect().contains(option.rect));
    }
  }

  void fields_of_the_form_begin_at_one_edge() {
    DockBench bench("pendulum");
    for (const auto kind : every_kind) {
      if (kind == StudyChoices::Kind::fit) continue;  // its fields are in a form of their own
      bench.choose(kind);
      QTest::qWait(50);
      QSet<int> edges;
      const QWidget& form = bench.panel().choices();
      for (const QWidget* widget : form.findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly))
        if (widget->isVisible()) edges << widget->x();
      QVERIFY2(edges.size() == 2, qPrintable(QString::number(edges.size())));
    }
  }

  void nothing_is_cut_or_overlaps_data() {
    QTest::addColumn<bool>("reverse");
    QTest::newRow("left to right") << false;
    QTest::newRow("right to left") << true;
  }
  void nothing_is_cut_or_overlaps() {
    QFETCH(const bool, reverse);
    QApplication::setLayoutDirection(reverse ? Qt::RightToLeft : Qt::LeftToRight);
    DockBench bench("pendulum");
    bench.window.resize(small_window);
    QTest::qWait(100);
    QVERIFY(bench.panel().isRightToLeft() == reverse);
    for (const auto kind : every_kind) {
      bench.choose(kind);
      QTest::qWait(50);
      QVERIFY2(trouble_below(bench.panel()).isEmpty(), qPrintable(trouble_below(bench.panel())));
    }
    bench.panel().openFolder(folder_.filePath("map"));
    QTest::qWait(50);
    QVERIFY2(trouble_below(bench.panel()).isEmpty(), qPrintable(trouble_below(bench.panel())));
    QCOMPARE(bench.window.size(), small_window);
  }

 private:
  QTemporaryDir folder_;
};

const Listed listed{"studies_dock_test", test_main<StudiesDockTest>};

}  // namespace clothlab::test::studies_dock_test

#include "studies_dock_test.moc"
