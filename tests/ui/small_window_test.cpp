// The windows on a small screen: nothing over anything else, nothing cut without a way to read it.
#include <QAbstractButton>
#include <QComboBox>
#include <QDockWidget>
#include <QHelpEvent>
#include <QMenu>
#include <QToolTip>

#include "charts/live_chart.h"
#include "charts/plot_scene.h"
#include "compare_bench.h"
#include "listed_test.h"
#include "params/panel_parts.h"
#include "studies/studies_panel.h"
#include "theme/theme.h"
#include "window_bench.h"

namespace clothlab::test::small_window_test {
namespace {

constexpr QSize small_windows[] = {{1000, 650}, {1100, 700}};

QString described(const QAbstractButton& button, const QRect& at) {
  return QStringLiteral("%1 at %2,%3 %4x%5")
      .arg(button.objectName())
      .arg(at.x())
      .arg(at.y())
      .arg(at.width())
      .arg(at.height());
}

/// What is wrong with the visible buttons below a widget; empty: they lie side by side, whole and inside it.
QString trouble_with_buttons(const QWidget& above) {
  std::vector<std::pair<const QAbstractButton*, QRect>> placed;
  for (const QAbstractButton* button : above.findChildren<QAbstractButton*>()) {
    if (!button->isVisible()) continue;
    const QRect at(button->mapTo(&above, QPoint()), button->size());
    if (!above.rect().contains(at)) return described(*button, at) + " is not inside";
    if (at.width() < button->sizeHint().width()) return described(*button, at) + " is cut";
    for (const auto& [other, there] : placed)
      if (at.intersects(there)) return described(*button, at) + " overlaps " + described(*other, there);
    placed.emplace_back(button, at);
  }
  return placed.empty() ? "no buttons" : QString();
}

void resize_to(QWidget& window, QSize size) {
  window.resize(size);
  QTest::qWait(50);
  QCOMPARE(window.size(), size);  // the window can be that small
}

QString tip_of(QWidget& widget) {
  QHelpEvent help(QEvent::ToolTip, widget.rect().center(), widget.mapToGlobal(widget.rect().center()));
  QApplication::sendEvent(&widget, &help);
  const QString text = QToolTip::text();
  QToolTip::hideText();
  return text;
}

cloth::Comparison panes_of(const std::vector<std::string>& methods) {
  return small_comparison(methods);
}

}  // namespace

class SmallWindowTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void buttons_of_the_charts_lie_side_by_side_data() { sizes_and_looks(); }
  void buttons_of_the_charts_lie_side_by_side() {
    QFETCH(const QSize, size);
    QFETCH(const bool, dark);
    apply_theme(*qApp, dark);
    WindowBench bench("corners-shear");  // with a deformation rate among the curves
    resize_to(bench.window, size);
    ChartPanel& charts = bench.window.charts();
    QVERIFY2(trouble_with_buttons(charts).isEmpty(), qPrintable(trouble_with_buttons(charts)));
    QTest::keyClick(&charts, Qt::Key_Plus);  // away from the run: the way back to it appears
    QVERIFY(charts.findChild<QAbstractButton*>("live")->isVisible());
    QVERIFY2(trouble_with_buttons(charts).isEmpty(), qPrintable(trouble_with_buttons(charts)));
  }

  void what_has_no_room_above_the_charts_is_in_a_menu() {
    apply_theme(*qApp, false);
    WindowBench bench;
    resize_to(bench.window, {1000, 650});
    ChartPanel& charts = bench.window.charts();
    auto* more = charts.findChild<QAbstractButton*>("chart_more");
    auto* box = charts.findChild<QAbstractButton*>("zoom_box");
    auto* menu = charts.findChild<QMenu*>("chart_menu");
    QVERIFY(more && more->isVisible() && menu);
    QTest::mouseClick(more, Qt::LeftButton);
    QVERIFY(menu->isVisible());
    QStringList entries;
    for (const QAction* entry : menu->actions()) entries << entry->objectName();
    for (const char* name : {"zoom_box", "save_charts", "chart_help"}) {
      const bool shown = charts.findChild<QAbstractButton*>(QLatin1String(name))->isVisible();
      QVERIFY2(shown != entries.contains("menu:" + QLatin1String(name)), name);
    }
    if (QAction* entry = menu->findChild<QAction*>("menu:zoom_box")) {
      QVERIFY(entry->isCheckable() && !entry->isChecked());
      QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(entry).center());
      QVERIFY(box->isChecked());
    }
    menu->close();
    resize_to(bench.window, {1400, 800});
    bench.window.resizeDocks({bench.window.findChild<QDockWidget*>("chartsDock")}, {500}, Qt::Horizontal);
    QTest::qWait(50);
    QVERIFY(!more->isVisible() && box->isVisible());
  }

  void buttons_above_the_view_lie_side_by_side_data() { sizes_and_looks(); }
  void buttons_above_the_view_lie_side_by_side() {
    QFETCH(const QSize, size);
    QFETCH(const bool, dark);
    apply_theme(*qApp, dark);
    WindowBench bench("spikes");  // whose hierarchy of boxes has a field there
    resize_to(bench.window, size);
    auto* bar = bench.window.findChild<QWidget*>("viewBar");
    auto* level = bench.window.findChild<QWidget*>("boxLevel");
    QVERIFY(level->isVisible() && level->width() >= level->sizeHint().width());
    QVERIFY2(trouble_with_buttons(*bar).isEmpty(), qPrintable(trouble_with_buttons(*bar)));
    QVERIFY(bench.action("savePicture")->isEnabled() && bench.action("frameAll")->isEnabled());
    bench.window.resize(1500, 900);
    QTest::qWait(50);
    for (const char* name : {"cameraButton", "frameAllButton", "savePictureButton"})
      QVERIFY2(bar->findChild<QWidget*>(QLatin1String(name))->isVisible(), name);
  }

  void a_comparisons_charts_keep_their_buttons_apart_data() { sizes_and_looks(); }
  void a_comparisons_charts_keep_their_buttons_apart() {
    QFETCH(const QSize, size);
    QFETCH(const bool, dark);
    apply_theme(*qApp, dark);
    CompareBench bench(panes_of({"verlet", "semi-implicit-euler", "rk4", "implicit-midpoint"}));
    resize_to(bench.window, size);
    const CompareCharts& charts = bench.window.paneCharts();
    QVERIFY2(trouble_with_buttons(charts).isEmpty(), qPrintable(trouble_with_buttons(charts)));
  }

  void a_comparison_opens_in_a_small_window_without_making_it_larger() {
    apply_theme(*qApp, false);
    WindowBench bench("corners-free");
    resize_to(bench.window, {1000, 650});
    for (const std::size_t panes : {2U, 3U, 4U}) {
      QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);  // Ctrl+D adds a pane
      if (panes > 2) bench.window.document().duplicatePane(0);
      bench.settle();
      QTest::qWait(100);
      QCOMPARE(bench.window.panes().paneCount(), panes);
      QCOMPARE(bench.window.size(), QSize(1000, 650));
    }
    bench.window.openComparison("report-methods");
    bench.settle();
    QTest::qWait(100);
    QCOMPARE(bench.window.size(), QSize(1000, 650));
  }

  void a_panes_method_is_whole_or_its_tooltip_is_data() { sizes_and_looks(); }
  void a_panes_method_is_whole_or_its_tooltip_is() {
    QFETCH(const QSize, size);
    QFETCH(const bool, dark);
    apply_theme(*qApp, dark);
    CompareBench bench(panes_of({"verlet", "semi-implicit-euler", "rk4", "implicit-midpoint"}));
    resize_to(bench.window, size);
    for (std::size_t pane = 0; pane < 4; ++pane) {
      auto* method = bench.part<QuietCombo>(pane, "method");
      const QString shown = method->shownText(), whole = method->currentText();
      QVERIFY(method->width() >= method->widthFor(shown));
      if (shown == whole) continue;
      QVERIFY2(shown.size() > 4 && shown.endsWith(u'…'), qPrintable(shown));
      QVERIFY2(whole.startsWith(shown.chopped(1).trimmed()), qPrintable(shown));
      QVERIFY2(tip_of(*method).contains(whole), qPrintable(tip_of(*method)));
    }
  }

  void a_new_window_has_no_button_that_a_scene_does_not_need() {
    const LabWindow window;
    QVERIFY(window.findChild<QWidget*>("modeDifferenceButton")->isHidden());
  }

  void studies_of_a_comparison_leave_the_window_as_large_as_it_is_data() {
    QTest::addColumn<bool>("by_menu");
    QTest::addRow("by their key") << false;
    QTest::addRow("from the menu View") << true;
  }
  void studies_of_a_comparison_leave_the_window_as_large_as_it_is() {
    QFETCH(const bool, by_menu);
    apply_theme(*qApp, false);
    CompareBench bench(panes_of({"verlet", "semi-implicit-euler", "rk4", "implicit-midpoint"}));
    resize_to(bench.window, {1000, 650});
    auto* dock = bench.window.findChild<QDockWidget*>("studiesDock");
    if (by_menu)
      dock->toggleViewAction()->trigger();
    else
      QTest::keyClick(&bench.window, Qt::Key_T, Qt::ControlModifier);
    QTest::qWait(200);
    QCOMPARE(bench.window.size(), QSize(1000, 650));
    QVERIFY(bench.window.studies().isVisible());
    for (std::size_t pane = 0; pane < 4; ++pane)  // which has the rows of gauge and difference
      QVERIFY(bench.window.panes().pane(pane).view().height() >= 60);
    const CompareCharts& charts = bench.window.paneCharts();
    for (const char* key : {"compare_energy", "compare_strain", "compare_step_time", "compare_difference"}) {
      LiveChart* chart = charts.chart(key);
      QVERIFY2(charts.rect().contains(chart->geometry()), key);
      QVERIFY2(chart->scene().map().plot.height() >= 10, key);
    }
    dock->toggleViewAction()->trigger();
    QTest::qWait(50);
    QVERIFY(!bench.window.studies().isVisible());
    resize_to(bench.window, {1500, 900});
    QVERIFY(bench.part<QWidget>(0, "difference")->isVisible() && bench.part<QWidget>(0, "cost")->isVisible());
  }

  void a_roomy_pane_has_its_step_beside_the_method_and_a_narrow_one_below() {
    apply_theme(*qApp, false);
    CompareBench bench;
    auto* method = bench.part<QWidget>(0, "method");
    auto* step = bench.part<QWidget>(0, "step");
    resize_to(bench.window, {1000, 650});
    QVERIFY(step->y() > method->geometry().bottom());
    QVERIFY(step->isVisible());
    resize_to(bench.window, {1400, 800});
    QVERIFY(step->geometry().center().y() == method->geometry().center().y());
    QVERIFY(step->x() > method->geometry().right());
  }

 private:
  static void sizes_and_looks() {
    QTest::addColumn<QSize>("size");
    QTest::addColumn<bool>("dark");
    for (const QSize size : small_windows)
      for (const bool dark : {false, true})
        QTest::addRow("%dx%d %s", size.width(), size.height(), dark ? "dark" : "light") << size << dark;
  }
};

const Listed listed{"small_window_test", test_main<SmallWindowTest>};

}  // namespace clothlab::test::small_window_test

#include "small_window_test.moc"
