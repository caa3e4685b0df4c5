// What a window remembers for the next one, by real clicks and keys.
#include <QComboBox>
#include <QDir>
#include <QDockWidget>
#include <QMenu>
#include <QSettings>
#include <QTemporaryDir>

#include "charts/live_chart.h"
#include "compare_bench.h"
#include "dialogs.h"
#include "listed_test.h"
#include "main_window/autosave.h"
#include "patience.h"
#include "window_bench.h"

namespace clothlab::test::memory_test {
namespace {

QStringList recent(LabWindow& window) {
  for (QMenu* menu : window.findChildren<QMenu*>())
    if (menu->title() == "Recent") {
      Q_EMIT menu->aboutToShow();
      QStringList entries;
      for (const QAction* action : menu->actions()) entries << action->text();
      return entries;
    }
  return {};
}

}  // namespace

class MemoryTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    QApplication::setQuitOnLastWindowClosed(false);
    apply_theme(*qApp, false);
  }

  void init() { QSettings().clear(); }
  void cleanupTestCase() { QSettings().clear(); }

  void size_docks_speed_and_mode_come_back() {
    {
      WindowBench bench("corners-free");
      bench.window.resize(1200, 760);
      bench.window.findChild<QDockWidget*>("chartsDock")->toggleViewAction()->trigger();
      bench.window.findChild<QComboBox*>("speed")->setCurrentText("2x");
      QTest::keyClick(&bench.window, Qt::Key_S);
      QTest::qWait(100);
      bench.window.close();
    }
    WindowBench again("corners-free");
    QCOMPARE(again.window.size(), QSize(1200, 760));
    QVERIFY(!again.window.findChild<QDockWidget*>("chartsDock")->isVisible());
    QCOMPARE(again.window.findChild<QComboBox*>("speed")->currentText(), QString("2x"));
    QCOMPARE(again.window.view().mode(), ViewMode::strain);
    QVERIFY(again.window.findChild<QAction*>("modeStrain")->isChecked());
    again.settle();
    QCOMPARE(again.status().speed, 2.0);
  }

  void a_logarithmic_axis_stays_where_panes_change_and_comes_back() {
    {
      CompareBench bench;
      LiveChart* chart = bench.window.paneCharts().chart("compare_energy");
      QVERIFY(chart && !chart->is_logarithmic());
      chart->set_logarithmic(true);
      bench.choose(0, "duplicate");
      QVERIFY(bench.window.paneCharts().chart("compare_energy")->is_logarithmic());
      bench.window.close();
    }
    CompareBench again;
    QVERIFY(again.window.paneCharts().chart("compare_energy")->is_logarithmic());
    QVERIFY(again.window.paneCharts().chart("compare_difference")->is_logarithmic());
    QVERIFY(!again.window.paneCharts().chart("compare_strain")->is_logarithmic());
  }

  void recent_files_are_listed_by_kind() {
    QTemporaryDir folder;
    WindowBench bench("corners-free");
    QCOMPARE(recent(bench.window), QStringList("No file was opened yet"));
    const QString scene = folder.filePath("x.scene.json"), session = folder.filePath("x.session.json"),
                  comparison = folder.filePath("x.compare.json");
    QVERIFY(bench.window.saveTo(scene));
    bench.window.saveSession(session);
    bench.settle();
    QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
    QVERIFY(bench.window.saveTo(comparison));
    QCOMPARE(recent(bench.window),
             (QStringList{"Scenes", scene, "Sessions", session, "Comparisons", comparison}));
  }

  void a_dialog_begins_in_the_folder_it_was_last_used_in() {
    QTemporaryDir folder;
    WindowBench bench("corners-free");
    {
      Answers answers;
      answers.type(folder.filePath("one.png"));
      bench.action("savePicture")->trigger();
      QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    }
    Answers answers;
    answers.type("two");
    bench.action("savePicture")->trigger();
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    QVERIFY(QFile::exists(folder.filePath("two.png")));
  }

  void the_theme_that_was_chosen_is_kept() {
    WindowBench bench("corners-free");
    bench.window.findChild<QAction*>("theme:dark")->trigger();
    QVERIFY(theme().dark);
    apply_theme(*qApp, false);
    apply_theme(*qApp);  // as the next start does
    QVERIFY(qEnvironmentVariableIsSet("CLOTHLAB_THEME") || theme().dark);
    choose_theme(*qApp, {});
    apply_theme(*qApp, false);
  }

  void unsaved_changes_are_kept_aside_until_they_are_saved_or_discarded() {
    QDir(Autosave::folder()).removeRecursively();
    WindowBench bench("corners-free");
    bench.window.autosave().setInterval(50);
    QTest::qWait(150);
    QVERIFY(bench.window.autosave().file().isEmpty());  // nothing was changed
    bench.window.document().setParameter("springs.structural", 123.0);
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(bench.window.autosave().file()), patience);
    QVERIFY(Autosave::found().empty());  // its process lives
    const QString kept = bench.window.autosave().file();
    bench.action("undo")->trigger();
    QVERIFY(!QFile::exists(kept));
  }

  void what_a_crash_left_is_offered_and_restored() {
    QDir(Autosave::folder()).removeRecursively();
    QString left;
    {
      CompareBench bench;  // ends without being closed
      bench.window.autosave().setInterval(50);
      bench.window.document().setParameter("springs.structural", 123.0);
      QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(bench.window.autosave().file()), patience);
      left = bench.window.autosave().file();
    }
    QCOMPARE(Autosave::found().size(), size_t(1));
    QCOMPARE(Autosave::found().front().path, left);
    WindowBench bench("corners-free");
    bench.window.offerUnsaved();
    QVERIFY(Autosave::found().empty());  // nobody else offers it until this offer is answered
    QVERIFY2(bench.window.notice().text().contains("without saving"),
             qPrintable(bench.window.notice().text()));
    for (auto* button : bench.window.notice().findChildren<QAbstractButton*>())
      if (button->text() == "Restore") QTest::mouseClick(button, Qt::LeftButton);
    bench.settle();
    QVERIFY(bench.window.document().isComparison() && bench.window.document().isModified());
    QCOMPARE(bench.window.document().scene().springs->structural, 123.0);
    QVERIFY(!QFile::exists(left));
    QVERIFY(QFile::exists(bench.window.autosave().file()));  // this window keeps it at once
    QVERIFY(Autosave::found().empty());
    bench.window.close();
    QVERIFY(!QFile::exists(bench.window.autosave().file()));
  }

  void an_offer_that_is_closed_unanswered_is_made_again_by_the_next_window() {
    QDir(Autosave::folder()).removeRecursively();
    {
      WindowBench ended("corners-free");
      ended.window.document().setParameter("springs.structural", 123.0);
      ended.window.autosave().save();
    }
    WindowBench first("corners-free");
    first.window.offerUnsaved();
    WindowBench second("corners-free");
    second.window.offerUnsaved();
    QVERIFY(second.window.notice().text().isEmpty());
    auto* close = first.window.notice().findChild<QAbstractButton*>("noticeClose");
    QVERIFY(close);
    QTest::mouseClick(close, Qt::LeftButton);
    QTRY_COMPARE_WITH_TIMEOUT(Autosave::found().size(), size_t(1), patience);
    second.window.offerUnsaved();
    QVERIFY(second.window.notice().text().contains("without saving"));
    for (auto* button : second.window.notice().findChildren<QAbstractButton*>())
      if (button->text() == "Discard") QTest::mouseClick(button, Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(QDir(Autosave::folder()).isEmpty(), patience);
  }

  void docks_have_title_bars_to_move_them_by() {
    WindowBench bench("corners-free");
    for (const char* name : {"parametersDock", "chartsDock", "studiesDock", "rankingDock"}) {
      const auto* dock = bench.window.findChild<QDockWidget*>(name);
      QVERIFY(dock && !dock->titleBarWidget());
      QVERIFY(dock->features() & QDockWidget::DockWidgetMovable);
    }
  }
};

const Listed listed{"memory_test", test_main<MemoryTest>};

}  // namespace clothlab::test::memory_test

#include "memory_test.moc"
