// The scene's probes in a comparison: a chart for each of their values, a curve in it for each pane.
#include <QScrollArea>
#include <QScrollBar>

#include "charts/live_chart.h"
#include "compare/compare_charts.h"
#include "compare/lockstep.h"
#include "compare_bench.h"
#include "io/csv.h"
#include "io/text_file.h"
#include "listed_test.h"
#include "scene/probe.h"
#include "support/files.h"
#include "theme/theme.h"

namespace clothlab::test::compare_probes_test {
namespace {

using cloth::Probe;
using cloth::ProbeMeasure;

const Probe low{.name = "low", .measure = ProbeMeasure::lowest_point};
const Probe corner{.name = "corner", .measure = ProbeMeasure::particle, .particles = {{8, 8}}};
const Probe bend{.name = "bend", .measure = ProbeMeasure::angle, .particles = {{0, 0}, {4, 4}, {8, 8}}};

cloth::Comparison probed(const std::vector<Probe>& probes) {
  cloth::Comparison comparison = small_comparison({"verlet", "rk4", "implicit-euler"});
  comparison.scene.probes = probes;
  return comparison;
}

}  // namespace

class CompareProbesTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void each_value_of_a_probe_has_a_chart_with_a_curve_for_each_pane() {
    CompareBench bench(probed({low, bend}));
    CompareCharts& charts = bench.window.paneCharts();
    const auto columns = cloth::probe_columns(bench.comparison().scene.probes);
    for (const std::string& column : columns) {
      const LiveChart* chart = charts.chart("compare_" + QString::fromStdString(column));
      QVERIFY2(chart, column.c_str());
      QCOMPARE(chart->spec().curves.size(), std::size_t{3});
      QVERIFY(chart->isVisible());
    }
    QCOMPARE(charts.chart("compare_probe.bend.angle_rad")->spec().unit, QString("°"));
  }

  void the_curves_are_what_the_panes_measure() {
    QTemporaryDir folder;
    CompareBench bench(probed({low, corner}));
    bench.play_to_the_end();
    const QString file = folder.filePath("charts.csv");
    QCOMPARE(bench.window.paneCharts().exportCsv(file), QString());
    std::string text;
    cloth::read_text_file(file.toStdString(), text);
    const cloth::CsvTable table = cloth::parse_csv(text);
    cloth::LockStep alone(bench.comparison());
    const auto columns = cloth::probe_columns(bench.comparison().scene.probes);
    for (std::int64_t k = 1; k <= alone.last_index(); ++k) QVERIFY(alone.advance(k));
    for (std::size_t pane = 0; pane < 3; ++pane)
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const std::string name = std::string(1, "ABC"[pane]) + '_' + columns[k];
        const std::vector<double> values = cloth::test::column_of(table, name);
        QVERIFY2(!values.empty(), name.c_str());
        QCOMPARE(values.back(), alone.lane(pane).measurement.probes[k]);
      }
  }

  void a_probe_that_is_added_or_taken_out_leaves_the_other_curves_as_they_are() {
    CompareBench bench(probed({low}));
    CompareCharts& charts = bench.window.paneCharts();
    bench.play_to_the_end();
    const std::size_t rows = charts.record().samples.size();
    QVERIFY(rows > 10);
    const auto last = [&](const char* key, std::size_t pane) {
      const CurveSpec& curve = charts.chart(key)->spec().curves[pane];
      return charts.record().samples.value(curve.column, rows - 1);
    };
    const double energy = last("compare_energy", 2), lowest = last("compare_probe.low.height_m", 1);
    QVERIFY(std::isfinite(energy) && std::isfinite(lowest));
    bench.scope(0);
    QCOMPARE(bench.window.document().addProbe(corner), QString());
    bench.settle();
    QVERIFY(charts.chart("compare_probe.corner.x_m"));
    QCOMPARE(charts.record().samples.size(), rows);
    QCOMPARE(last("compare_energy", 2), energy);
    QCOMPARE(last("compare_probe.low.height_m", 1), lowest);
    QVERIFY(std::isnan(last("compare_probe.corner.x_m", 1)));  // it was not measured then
    bench.action("undo")->trigger();
    bench.settle();
    QVERIFY(!charts.chart("compare_probe.corner.x_m"));
    QCOMPARE(last("compare_probe.low.height_m", 1), lowest);
  }

  void more_charts_than_there_is_height_for_scroll_and_stay_legible() {
    CompareBench bench(probed({low, corner, bend}));
    bench.window.resize(1300, 700);
    QTest::qWait(100);
    CompareCharts& charts = bench.window.paneCharts();
    auto* area = qobject_cast<QScrollArea*>(charts.parentWidget()->parentWidget());
    QVERIFY(area && area->verticalScrollBar()->isVisible());
    for (const char* key : {"compare_energy", "compare_probe.corner.x_m", "compare_difference"})
      QVERIFY2(charts.chart(key)->height() >= 60, key);
    area->ensureWidgetVisible(charts.chart("compare_difference"));
    QVERIFY(!charts.chart("compare_difference")->visibleRegion().isEmpty());
    bench.window.document().load(probed({}));
    bench.settle();
    QTest::qWait(100);
    QVERIFY(!area->verticalScrollBar()->isVisible());
  }
};

const Listed listed{"compare_probes_test", test_main<CompareProbesTest>};

}  // namespace clothlab::test::compare_probes_test

#include "compare_probes_test.moc"
