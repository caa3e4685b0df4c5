// The charts' panel: how it is laid out, read, zoomed and reset. Real wheel and mouse events on real widgets;
// nothing here depends on how fast the machine is.
#include <QAbstractButton>
#include <QFile>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QTimer>
#include <algorithm>

#include "chart_bench.h"
#include "listed_test.h"
#include "patience.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab::test::chart_test {

namespace {

/// Rows of the exported table, its header apart.
qsizetype exported_rows(Panel& panel) {
  const QTemporaryDir folder;
  const QString path = folder.filePath("rows.csv");
  QFile file(path);
  if (!panel.exportCsv(path).isEmpty() || !file.open(QIODevice::ReadOnly)) return -1;
  return file.readAll().count('\n') - 1;
}

qsizetype running_timers(const Panel& panel) {
  const auto timers = panel.findChildren<QTimer*>(Qt::FindDirectChildrenOnly);
  return std::count_if(timers.begin(), timers.end(), [](const QTimer* timer) { return timer->isActive(); });
}

}  // namespace

class ChartTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void plot_areas_are_aligned();
  void all_charts_share_one_time_range();
  void a_log_axis_never_sees_a_value_at_or_below_zero();
  void the_wheel_zooms_time_in_all_charts_about_the_pointer();
  void the_wheel_over_the_values_zooms_one_y_axis();
  void a_drag_pans_in_time_and_stops_following();
  void a_right_drag_zooms_into_its_box();
  void double_click_returns_to_live();
  void the_live_button_shows_only_away_from_live();
  void zoom_then_log_then_linear_keeps_the_data();
  void the_read_out_names_the_nearest_sample();
  void a_legend_entry_hides_its_curve_and_the_range_follows();
  void the_deformation_rate_is_a_line_of_its_own();
  void values_of_the_size_of_rounding_have_no_axis_of_their_own_unless_wanted();
  void a_reset_clears_the_curves();
  void a_hidden_panel_draws_nothing_and_catches_up();
  void an_empty_panel_says_what_to_do();
  void a_change_of_palette_changes_the_colours();
  void a_tiny_panel_survives();
};

void ChartTest::plot_areas_are_aligned() {
  Bench bench;
  std::vector<ChartSample> samples = run_of(20);
  for (ChartSample& s : samples) s.kinetic_J *= -1.2345e5;  // long labels in one chart only
  bench.panel.append(samples);
  for (const QSize size : {QSize(520, 600), QSize(380, 700), QSize(1200, 420), QSize(360, 420)}) {
    bench.panel.resize(size);
    bench.settle();
    QList<QRect> plots;
    for (const char* key : {"energy", "strain", "frame_time"}) {
      const QRectF plot = bench.map(key).plot;
      plots << QRect(bench.chart(key).view().mapTo(&bench.panel, plot.topLeft().toPoint()),
                     plot.size().toSize());
      QVERIFY(plot.width() > size.width() * 0.6);
    }
    for (const QRect& plot : plots) {
      QCOMPARE(plot.left(), plots.front().left());
      QCOMPARE(plot.right(), plots.front().right());
      QVERIFY(std::abs(plot.height() - plots.front().height()) <= 1);
      QVERIFY(plot.height() > 30);
    }
  }
}

void ChartTest::all_charts_share_one_time_range() {
  Bench bench;
  bench.fill(100);
  QCOMPARE(bench.frame("strain").time, bench.frame("energy").time);
  QCOMPARE(bench.frame("frame_time").time, bench.frame("energy").time);
  QCOMPARE(bench.panel.shownTimes().high, 100.0);
  QCOMPARE(bench.panel.shownTimes().low, 40.0);
  bench.panel.setTimeSpan(Panel::TimeSpan::whole_run);
  QCOMPARE(bench.panel.shownTimes().low, 0.0);
}

void ChartTest::a_log_axis_never_sees_a_value_at_or_below_zero() {
  Bench bench;
  std::vector<ChartSample> samples = run_of(40);
  int skipped = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].elastic_J = samples[i].gravity_J = samples[i].total_J = 1;
    samples[i].kinetic_J = i % 50 < 10 ? (i % 2 ? 0.0 : -1.0) : 1e-3;
    skipped += i % 50 < 10;
  }
  bench.panel.append(samples);
  bench.chart("energy").set_logarithmic(true);
  bench.settle();
  const DrawnCurve& kinetic_curve = bench.chart("energy").scene().curves().curves().front();
  QVERIFY(kinetic_curve.pieces.size() >= 8);  // broken, not drawn along the axis
  for (const QPolygonF& piece : kinetic_curve.pieces)
    for (const QPointF& point : piece) {
      QVERIFY(std::isfinite(point.y()));
      QVERIFY(bench.map("energy")
                  .plot.adjusted(-1, -1, 1, 1)
                  .contains(QPointF(bench.middle("energy").x(), point.y())));
    }
  QVERIFY(bench.chart("energy").scene().overlay().note().startsWith(QString("%1 points").arg(skipped)));
  bench.chart("energy").set_logarithmic(false);
  bench.settle();
  QVERIFY(bench.chart("energy").scene().overlay().note().isEmpty());
}

void ChartTest::the_wheel_zooms_time_in_all_charts_about_the_pointer() {
  Bench bench;
  bench.fill(50);
  const QPoint at = bench.middle("strain");
  const double under_pointer = bench.map("strain").time_at(at.x());
  const Range before = bench.frame("strain").time;
  const Range y_before = bench.frame("strain").y;
  bench.wheel("strain", at, 2);
  QVERIFY(bench.frame("energy").time.span() < before.span() * 0.7);
  QCOMPARE(bench.frame("energy").time, bench.frame("strain").time);
  QVERIFY(std::abs(bench.map("strain").time_at(at.x()) - under_pointer) < 1e-9);
  QCOMPARE(bench.frame("strain").y, y_before);
  QVERIFY(!bench.panel.isLive());
  bench.wheel("strain", at, -2);
  QVERIFY(std::abs(bench.frame("energy").time.span() - before.span()) < 1e-9);
}

void ChartTest::the_wheel_over_the_values_zooms_one_y_axis() {
  Bench bench;
  bench.fill(50);
  const PlotFrame energy = bench.frame("energy"), strain = bench.frame("strain");
  bench.wheel("energy", bench.on_y_axis("energy"), 1);
  QVERIFY(bench.frame("energy").y.span() < energy.y.span());
  QCOMPARE(bench.frame("energy").time, energy.time);
  QCOMPARE(bench.frame("strain").y, strain.y);
  const double span = bench.frame("energy").y.span();
  bench.wheel("energy", bench.middle("energy"), 1, Qt::ControlModifier);
  QVERIFY(bench.frame("energy").y.span() < span);
  for (int i = 0; i < 300; ++i) bench.chart("energy").zoom_y(0.1, i < 150 ? 0.5 : 3);
  bench.settle();
  QVERIFY(std::isfinite(bench.frame("energy").y.span()) && bench.frame("energy").y.span() > 0);
}

void ChartTest::a_drag_pans_in_time_and_stops_following() {
  Bench bench;
  bench.fill(100);
  QSignalSpy live(&bench.panel, &Panel::liveChanged);
  const Range before = bench.frame("energy").time;
  const QPoint at = bench.middle("energy");
  bench.drag("energy", at, at + QPoint(100, 0));
  const double expected = before.low - 100 * before.span() / bench.map("energy").plot.width();
  QVERIFY(std::abs(bench.frame("frame_time").time.low - expected) < 1e-9);
  QCOMPARE(live.count(), 1);
  QCOMPARE(live.front().front().toBool(), false);
  const auto held = bench.panel.shownTimes();
  bench.panel.append(std::array{sample_at(110)});
  bench.settle();
  QCOMPARE(bench.panel.shownTimes(), held);
}

void ChartTest::a_right_drag_zooms_into_its_box() {
  Bench bench;
  bench.fill(50);
  const PlotMap map = bench.map("strain");
  const QPoint from = map.plot.topLeft().toPoint() + QPoint(60, 20), to = from + QPoint(120, 50);
  bench.drag("strain", from, to, Qt::RightButton);
  const Range time = bench.frame("energy").time, y = bench.frame("strain").y;
  QVERIFY(std::abs(time.low - map.time_at(from.x())) < 1e-9 &&
          std::abs(time.high - map.time_at(to.x())) < 1e-9);
  QVERIFY(std::abs(y.high - map.axis_at(from.y())) < 1e-9 && std::abs(y.low - map.axis_at(to.y())) < 1e-9);
  bench.drag("strain", from, from + QPoint(2, 2), Qt::RightButton);  // a slip zooms nowhere
  QCOMPARE(bench.frame("strain").y, y);
}

void ChartTest::double_click_returns_to_live() {
  Bench bench;
  bench.fill(100);
  const PlotFrame live = bench.frame("energy");
  bench.wheel("energy", bench.middle("energy"), 4);
  bench.wheel("energy", bench.on_y_axis("energy"), 3);
  QVERIFY(!bench.panel.isLive());
  QTest::mouseDClick(bench.canvas("strain"), Qt::LeftButton, {}, bench.middle("strain"));
  bench.settle();
  QVERIFY(bench.panel.isLive());
  QCOMPARE(bench.frame("energy").time, live.time);
  QCOMPARE(bench.frame("energy").y, live.y);
  bench.wheel("energy", bench.on_y_axis("energy"), 3);
  QTest::mouseDClick(bench.canvas("energy"), Qt::LeftButton, {}, bench.on_y_axis("energy"));
  bench.settle();
  QCOMPARE(bench.frame("energy").y, live.y);
}

void ChartTest::the_live_button_shows_only_away_from_live() {
  Bench bench;
  bench.fill(100);
  auto* button = bench.panel.findChild<QAbstractButton*>("live");
  QVERIFY(!button->isVisible());
  bench.wheel("energy", bench.middle("energy"), 1);
  QVERIFY(button->isVisible());
  QTest::mouseClick(button, Qt::LeftButton);
  QVERIFY(!button->isVisible());
  QVERIFY(bench.panel.isLive());
}

void ChartTest::zoom_then_log_then_linear_keeps_the_data() {
  Bench bench;
  bench.fill(100);
  bench.wheel("energy", bench.middle("energy"), 3);
  bench.wheel("energy", bench.middle("energy"), 2, Qt::ControlModifier);
  const PlotFrame zoomed = bench.frame("energy");
  QVERIFY(zoomed.y.low > 0);
  const auto pieces = bench.chart("energy").scene().curves().curves().front().pieces;
  auto* log = bench.panel.findChild<QAbstractButton*>("energy_log");
  QTest::mouseClick(log, Qt::LeftButton);
  bench.settle();
  QVERIFY(bench.chart("energy").is_logarithmic());
  QCOMPARE(bench.frame("energy").time, zoomed.time);
  QVERIFY(std::abs(bench.frame("energy").y.low - std::log10(zoomed.y.low)) < 1e-9);  // the zoom holds
  bench.wheel("energy", bench.middle("energy"), 1, Qt::ControlModifier);
  bench.wheel("energy", bench.middle("energy"), -1, Qt::ControlModifier);
  QTest::mouseClick(log, Qt::LeftButton);
  bench.settle();
  QVERIFY(std::abs(bench.frame("energy").y.low - zoomed.y.low) < 1e-9);
  QCOMPARE(bench.chart("energy").scene().curves().curves().front().pieces.size(), pieces.size());
  bench.panel.goLive();
  bench.panel.setTimeSpan(Panel::TimeSpan::whole_run);
  QCOMPARE(exported_rows(bench.panel), static_cast<qsizetype>(run_of(100).size()));
}

void ChartTest::the_read_out_names_the_nearest_sample() {
  Bench bench;
  bench.fill(40);
  bench.panel.appendDrawTime(20.02, 7.25);
  bench.settle();
  const PlotMap& map = bench.map("strain");
  bench.hover("strain", {map.x_of(20.03), map.plot.center().y()});
  for (const char* key : {"energy", "strain", "frame_time"}) {
    const auto& read_out = bench.chart(key).scene().overlay().read_out();
    QVERIFY(read_out.has_value());
    QCOMPARE(read_out->time_s, run_of(40)[200].time_s);  // its own time, not the pointer's
  }
  const ChartSample expected = run_of(40)[200];
  const auto& energy = bench.chart("energy").scene().overlay().read_out()->rows;
  QCOMPARE(energy.size(), std::size_t{4});
  QCOMPARE(energy[0].value, quantity_text(expected.kinetic_J, "J", 4));
  QCOMPARE(bench.chart("strain").scene().overlay().read_out()->rows[0].value,
           quantity_text(100 * expected.max_strain, "%", 4));
  QCOMPARE(bench.chart("frame_time").scene().overlay().read_out()->rows[1].value, QString("7.25 ms"));
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(&bench.chart("strain").view(), &leave);
  QVERIFY(!bench.chart("energy").scene().overlay().read_out());
}

void ChartTest::a_legend_entry_hides_its_curve_and_the_range_follows() {
  Bench bench;
  std::vector<ChartSample> samples = run_of(30);
  for (ChartSample& s : samples) s.total_J = 1e4;
  bench.panel.append(samples);
  bench.settle();
  QVERIFY(bench.frame("energy").y.high >= 1e4);
  auto* entry = bench.panel.findChild<QAbstractButton*>("energy_total");
  QTest::mouseClick(entry, Qt::LeftButton);
  bench.settle();
  QCOMPARE(bench.chart("energy").scene().curves().curves().size(), std::size_t{3});
  QVERIFY(bench.frame("energy").y.high < 100);
  QTest::mouseClick(entry, Qt::LeftButton);
  bench.settle();
  QCOMPARE(bench.chart("energy").scene().curves().curves().size(), std::size_t{4});
}

void ChartTest::the_deformation_rate_is_a_line_of_its_own() {
  Bench bench;
  bench.fill(10);
  auto* entry = bench.panel.findChild<QAbstractButton*>("strain_deformation_rate");
  QVERIFY(!entry->isVisible());
  bench.panel.setDeformationRate(0.5);
  bench.settle();
  QVERIFY(entry->isVisible());
  QVERIFY(bench.frame("strain").y.high >= 50);  // percent, and the axis makes room for it
  bench.panel.setDeformationRate(std::nullopt);
  bench.settle();
  QVERIFY(!entry->isVisible());
  QVERIFY(bench.frame("strain").y.high < 50);
}

void ChartTest::values_of_the_size_of_rounding_have_no_axis_of_their_own_unless_wanted() {
  Bench bench;
  std::vector<ChartSample> samples = run_of(20);
  for (ChartSample& s : samples) s.max_strain *= 1e-15;
  bench.panel.append(samples);
  bench.settle();
  QCOMPARE(bench.frame("strain").y, (Range{0, 1}));
  bench.chart("strain").set_y_range(Range{0, 2e-14});
  bench.settle();
  const QImage picture = bench.canvas("strain")->grab().toImage();
  const QRect plot = bench.map("strain").plot.toRect();
  const auto ink = [&](const QRect& where) {
    int count = 0;
    for (int y = where.top(); y <= where.bottom(); ++y)
      for (int x = where.left(); x <= where.right(); ++x)
        count += std::abs(picture.pixelColor(x, y).lightness() - theme().panel.lightness()) > 40;
    return count;
  };
  const std::vector<Tick>& ticks = bench.frame("strain").y_ticks;
  QVERIFY(ticks.size() >= 3);
  for (const Tick& tick : ticks) {
    const int y = qRound(bench.map("strain").y_of(tick.position));
    QVERIFY2(ink({0, y - 4, plot.left() - 4, 8}) > 5, qPrintable(tick.label + " stands beside its value"));
  }
  QVERIFY2(ink({plot.right() + 2, plot.top(), picture.width() - plot.right() - 3, plot.height()}) == 0,
           "nothing beyond the plot");
}

void ChartTest::a_reset_clears_the_curves() {
  Bench bench;
  bench.fill(100);
  bench.panel.appendDrawTime(99, 5);
  bench.wheel("energy", bench.middle("energy"), 4);
  bench.panel.append(std::array{sample_at(0), sample_at(0.1)});
  bench.settle();
  QVERIFY(bench.panel.isLive());
  QCOMPARE(bench.panel.shownTimes().low, 0.0);
  QVERIFY(bench.panel.shownTimes().high <= 2);
  QCOMPARE(exported_rows(bench.panel), 2);
  bench.panel.clear();
  bench.settle();
  for (const DrawnCurve& curve : bench.chart("energy").scene().curves().curves())
    QVERIFY(curve.pieces.empty());
}

void ChartTest::a_hidden_panel_draws_nothing_and_catches_up() {
  Bench bench;
  bench.fill(10);
  const Range before = bench.frame("energy").time;
  bench.panel.hide();
  bench.panel.append(std::array{sample_at(200)});
  bench.chart("strain").set_logarithmic(true);
  QCOMPARE(running_timers(bench.panel), 0);
  QTest::qWait(100);
  QCOMPARE(bench.frame("energy").time, before);
  bench.panel.show();
  QVERIFY(QTest::qWaitForWindowExposed(&bench.panel));
  QCOMPARE(bench.frame("energy").time.high, 200.0);
  QVERIFY(bench.frame("strain").logarithmic);
  bench.panel.append(std::array{sample_at(201)});
  QVERIFY(running_timers(bench.panel) > 0);
  QTRY_COMPARE_WITH_TIMEOUT(running_timers(bench.panel), 0, patience);  // drawn, and idle again
  QCOMPARE(bench.frame("energy").time.high, 201.0);
}

void ChartTest::an_empty_panel_says_what_to_do() {
  Bench bench;
  QVERIFY(bench.chart("strain").scene().overlay().message().contains("Press play"));
  bench.fill(1);
  QVERIFY(bench.chart("strain").scene().overlay().message().isEmpty());
}

void ChartTest::a_change_of_palette_changes_the_colours() {
  apply_theme(*qApp, false);
  Bench bench;
  bench.fill(20);
  const auto ground = [&bench] {
    const QPoint corner = bench.map("energy").plot.topRight().toPoint() + QPoint(-6, 6);
    return bench.chart("energy").view().grab().toImage().pixelColor(corner);
  };
  QCOMPARE(ground(), light_theme().field);
  apply_theme(*qApp, true);
  bench.settle();
  QCOMPARE(ground(), dark_theme().field);
  apply_theme(*qApp, false);
}

void ChartTest::a_tiny_panel_survives() {
  Bench bench;
  bench.fill(70);
  for (const QSize size : {QSize(280, 300), QSize(60, 60), QSize(1, 1), QSize(2000, 90)}) {
    bench.panel.resize(size);
    bench.settle();
    bench.panel.grab();
  }
}

const Listed listed{"chart_test", test_main<ChartTest>};

}  // namespace clothlab::test::chart_test

#include "chart_test.moc"
