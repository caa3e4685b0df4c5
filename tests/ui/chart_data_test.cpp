// What the charts keep of a run, what they draw of it, and where their axes have ticks. No widgets.
#include <QtTest>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "charts/chart_record.h"
#include "charts/nice_range.h"
#include "charts/sample_series.h"
#include "charts/time_view.h"
#include "listed_test.h"

namespace clothlab::test::chart_data_test {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

SampleSeries series_of(const std::vector<double>& values, double step_s = 1) {
  SampleSeries series(1);
  for (std::size_t i = 0; i < values.size(); ++i)
    series.append(static_cast<double>(i) * step_s, std::array{values[i]});
  return series;
}

std::vector<double> noise(std::size_t count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> values(count);
  for (double& value : values) value = uniform(generator);
  return values;
}

}  // namespace

class ChartDataTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  // What is kept and what is drawn of it
  void decimation_keeps_every_extreme();
  void rows_after_a_cut_are_gone_and_those_before_it_stay();
  void a_record_that_is_cut_keeps_what_came_before();
  void decimation_of_a_million_points_returns_about_two_per_pixel();
  void decimation_returns_few_points_as_they_are();
  void a_curve_runs_in_time_order_to_both_edges();
  void a_gap_breaks_the_curve_at_any_zoom();
  void a_summary_is_what_a_plain_loop_finds();
  void a_full_series_keeps_its_extremes_its_gaps_and_its_newest_rows();
  void time_never_runs_backwards_in_a_series();
  // Axes
  void a_nice_range_holds_the_data_between_round_numbers();
  void an_automatic_range_does_not_flicker();
  void tick_labels_are_plain_and_differ();
  void a_log_axis_has_ticks_at_any_zoom();
  void the_last_minute_follows_and_the_whole_run_begins_at_its_start();
};

void ChartDataTest::decimation_keeps_every_extreme() {
  std::vector<double> values = noise(200'000);
  values[77'777] = 50;
  values[123'456] = -60;
  const SampleSeries series = series_of(values);
  std::vector<CurvePoint> curve;
  for (const int pixels : {1, 3, 100, 640, 1920}) {
    series.query(0, 0, 199'999, pixels, Keep::finite, curve);
    double low = 0, high = 0;
    for (const CurvePoint& point : curve) {
      low = std::min(low, point.value);
      high = std::max(high, point.value);
      QCOMPARE(values[static_cast<std::size_t>(point.time_s)], point.value);  // every point is a recorded one
    }
    QCOMPARE(low, -60.0);
    QCOMPARE(high, 50.0);
  }
  // Not only the two largest: each pixel's own extremes, as far as a bin's border moves to that of a block.
  series.query(0, 0, 200'000, 500, Keep::finite, curve);
  for (int pixel = 0; pixel < 500; ++pixel) {
    double low = 2, high = -2;
    for (int row = pixel * 400 + 100; row < pixel * 400 + 300; ++row) {
      low = std::min(low, values[static_cast<std::size_t>(row)]);
      high = std::max(high, values[static_cast<std::size_t>(row)]);
    }
    double drawn_low = 2, drawn_high = -2;
    for (const CurvePoint& point : curve)
      if (point.time_s >= (pixel - 0.25) * 400 && point.time_s < (pixel + 1.25) * 400) {
        drawn_low = std::min(drawn_low, point.value);
        drawn_high = std::max(drawn_high, point.value);
      }
    QVERIFY(drawn_low <= low && drawn_high >= high);
  }
}

void ChartDataTest::rows_after_a_cut_are_gone_and_those_before_it_stay() {
  const std::vector<double> values = noise(100'000);
  for (const int rows : {0, 1, 7, 8, 9, 512, 4095, 33'333, 99'999, 100'000}) {
    SampleSeries series = series_of(values);
    series.drop_after(rows - 0.5);
    QCOMPARE(series.size(), static_cast<std::size_t>(rows));
    for (int row = rows; row < rows + 5000; ++row) series.append(row, std::array{2.0 * row});
    std::vector<double> expected(values.begin(), values.begin() + rows);
    for (int row = rows; row < rows + 5000; ++row) expected.push_back(2.0 * row);
    const SampleSeries fresh = series_of(expected);
    std::vector<CurvePoint> curve, expected_curve;
    for (const int pixels : {10, 300, 5000}) {
      series.query(0, 0, 200'000, pixels, Keep::finite, curve);
      fresh.query(0, 0, 200'000, pixels, Keep::finite, expected_curve);
      QCOMPARE(curve.size(), expected_curve.size());
      for (std::size_t i = 0; i < curve.size(); ++i) QCOMPARE(curve[i].value, expected_curve[i].value);
    }
  }
}

void ChartDataTest::a_record_that_is_cut_keeps_what_came_before() {
  ChartRecord record;
  std::vector<ChartSample> samples;
  for (int n = 0; n < 100; ++n) samples.push_back({.time_s = 0.01 * n, .kinetic_J = 1.0 * n});
  record.append(samples);
  record.append_draw_time(0.2, 3);
  record.append_draw_time(0.8, 4);
  record.append(std::array{ChartSample{.time_s = 0.305, .is_cut = true}});
  QCOMPARE(record.samples.size(), std::size_t{31});
  QCOMPARE(record.samples.last_time(), 0.01 * 30);
  QCOMPARE(record.draws.size(), std::size_t{1});
  record.append(std::array{ChartSample{.time_s = 0.31, .kinetic_J = -1}});
  QCOMPARE(record.samples.size(), std::size_t{32});
}

void ChartDataTest::decimation_of_a_million_points_returns_about_two_per_pixel() {
  SampleSeries series(1, 2'000'000);
  const std::vector<double> values = noise(1'000'000);
  for (std::size_t i = 0; i < values.size(); ++i)
    series.append(0.01 * static_cast<double>(i), std::array{values[i]});
  std::vector<CurvePoint> curve;
  for (const int pixels : {100, 800, 3000}) {
    series.query(0, 0, 10'000, pixels, Keep::finite, curve);
    QVERIFY(curve.size() >= static_cast<std::size_t>(pixels));
    QVERIFY(curve.size() <= static_cast<std::size_t>(2 * pixels + 8));
  }
}

void ChartDataTest::decimation_returns_few_points_as_they_are() {
  const std::vector<double> values = noise(500);
  std::vector<CurvePoint> curve;
  series_of(values).query(0, -10, 1000, 400, Keep::finite, curve);
  QCOMPARE(curve.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) QCOMPARE(curve[i].value, values[i]);
}

void ChartDataTest::a_curve_runs_in_time_order_to_both_edges() {
  const SampleSeries series = series_of(noise(50'000), 0.01);
  std::vector<CurvePoint> curve;
  for (const auto& [from, to] : {std::pair{100.003, 400.007}, std::pair{123.4561, 123.4569}}) {
    series.query(0, from, to, 300, Keep::finite, curve);
    QVERIFY(curve.front().time_s <= from && curve.back().time_s >= to);
    for (std::size_t i = 1; i < curve.size(); ++i) QVERIFY(curve[i - 1].time_s < curve[i].time_s);
  }
}

void ChartDataTest::a_gap_breaks_the_curve_at_any_zoom() {
  std::vector<double> values(100'000, 1.0);
  for (std::size_t i = 40'000; i < 60'000; ++i)
    values[i] = i % 2 ? missing : std::numeric_limits<double>::infinity();
  const SampleSeries series = series_of(values);
  std::vector<CurvePoint> curve;
  for (const int pixels : {50, 300, 60'000}) {
    series.query(0, 0, 100'000, pixels, Keep::finite, curve);
    int breaks = 0;
    for (const CurvePoint& point : curve) {
      breaks += std::isnan(point.value);
      QVERIFY(!std::isinf(point.value));
    }
    QCOMPARE(breaks, 1);
  }
}

void ChartDataTest::a_summary_is_what_a_plain_loop_finds() {
  std::vector<double> values = noise(5'000);
  for (std::size_t i = 0; i < values.size(); i += 37) values[i] = missing;
  const SampleSeries series = series_of(values);
  for (const auto& [first, last] : {std::pair{0, 4999}, std::pair{1, 4998}, std::pair{63, 65},
                                    std::pair{512, 1024}, std::pair{777, 777}, std::pair{513, 4095}}) {
    double low = 2, high = -2, positive = 2;
    std::size_t gaps = 0, not_positive = 0;
    for (int row = first; row <= last; ++row) {
      const double value = values[static_cast<std::size_t>(row)];
      if (std::isnan(value)) {
        ++gaps;
        continue;
      }
      low = std::min(low, value);
      high = std::max(high, value);
      if (value > 0) positive = std::min(positive, value);
      not_positive += value <= 0;
    }
    const SampleSeries::Summary found = series.summary(0, first, last);
    QCOMPARE(found.gaps, gaps);
    QCOMPARE(found.not_positive, not_positive);
    QVERIFY(found.gaps == static_cast<std::size_t>(last - first + 1) ||
            (found.min == low && found.max == high));
    QVERIFY(std::isnan(found.min_positive) ? positive == 2 : found.min_positive == positive);
  }
}

void ChartDataTest::a_full_series_keeps_its_extremes_its_gaps_and_its_newest_rows() {
  SampleSeries series(2, 1000);
  for (int i = 0; i < 20'000; ++i) {
    const double second = i == 5'000 ? -9 : 0.5;
    series.append(i, std::array{i == 3'000 ? 7.0 : i == 4'000 ? missing : std::sin(i * 0.1), second});
  }
  QVERIFY(series.size() <= 1000);
  QCOMPARE(series.first_time(), 0.0);
  QCOMPARE(series.summary(0, 0, 20'000).max, 7.0);
  QCOMPARE(series.summary(0, 2'990, 3'010).max, 7.0);
  QCOMPARE(series.summary(1, 4'990, 5'010).min, -9.0);
  QCOMPARE(series.summary(0, 0, 20'000).gaps, std::size_t{1});
  for (std::size_t back = 1; back <= 250; ++back)
    QCOMPARE(series.time(series.size() - back), 20'000.0 - static_cast<double>(back));
}

void ChartDataTest::time_never_runs_backwards_in_a_series() {
  SampleSeries series(1);
  QVERIFY(series.append(1, std::array{1.0}));
  QVERIFY(series.append(1, std::array{2.0}));  // an edit while paused
  QVERIFY(!series.append(0.5, std::array{3.0}));
  QVERIFY(!series.append(missing, std::array{3.0}));
  QCOMPARE(series.size(), std::size_t{2});
  QCOMPARE(series.nearest(-5), std::size_t{0});
  QCOMPARE(series.nearest(99), std::size_t{1});
}

void ChartDataTest::a_nice_range_holds_the_data_between_round_numbers() {
  QCOMPARE(nice_range({0.3, 9.2}, 5), (Range{0, 10}));
  QCOMPARE(nice_range({0, 0}, 5), (Range{0, 1}));
  for (const Range data :
       {Range{-3.2e-9, 7e-9}, Range{1e6, 1.00002e6}, Range{5, 5}, Range{-1e12, 3}, Range{-2, -2}}) {
    const Range nice = nice_range(data, 5);
    const double slack = 1e-8 * nice.span();  // far below a pixel
    QVERIFY(nice.low <= data.low + slack && data.high <= nice.high + slack && nice.span() > 0);
    QVERIFY(linear_ticks(nice, 5).size() >= 2 && linear_ticks(nice, 5).size() <= 7);
  }
}

void ChartDataTest::an_automatic_range_does_not_flicker() {
  StickyRange range;
  const Range first = range.linear({0, 9.9}, 5);
  for (int i = 0; i < 100; ++i) QCOMPARE(range.linear({0, 9.0 + 0.9 * std::sin(i)}, 5), first);
  QVERIFY(range.linear({0, 10.1}, 5).high > 10);  // grows at once
  QVERIFY(range.linear({0, 1.0}, 5).high < 2.0);  // and shrinks when the curve would be lost in it
}

void ChartDataTest::tick_labels_are_plain_and_differ() {
  QCOMPARE(tick_label(0.25, 0.05), QString("0.25"));
  QCOMPARE(tick_label(-1e-18, 0.1), QString("0"));
  QCOMPARE(tick_label(1.2e-6, 2e-7), QString("1.2e-6"));
  QCOMPARE(tick_label(1500, 500), QString("1500"));
  for (const Range range : {Range{0, 1e-7}, Range{1e7, 1.5e7}, Range{3600, 3600.002}, Range{-1, 1}}) {
    QStringList labels;
    for (const Tick& tick : linear_ticks(range, 5)) labels << tick.label;
    QCOMPARE(QSet<QString>(labels.begin(), labels.end()).size(), labels.size());
    QVERIFY(labels.size() >= 2);
  }
}

void ChartDataTest::a_log_axis_has_ticks_at_any_zoom() {
  for (double span = 30; span > 2e-3; span /= 1.7)
    for (const double low : {-12.3, -0.95, 0.31, 4.0}) {
      const std::vector<Tick> ticks = log_ticks({low, low + span}, 5);
      QVERIFY2(!ticks.empty() || span < 1, qPrintable(QString::number(span)));
      QVERIFY(ticks.size() <= 12);
      for (const Tick& tick : ticks)
        QVERIFY(tick.position >= low - 1e-9 && tick.position <= low + span + 1e-9);
    }
}

void ChartDataTest::the_last_minute_follows_and_the_whole_run_begins_at_its_start() {
  TimeView view;
  QCOMPARE(view.shown({0, 500}), (Range{440, 500}));
  QCOMPARE(view.shown({0, 3}).low, 0.0);
  QVERIFY(view.shown({0, 3}).high >= 3);
  view.set_span(TimeView::Span::whole_run);
  QCOMPARE(view.shown({0, 500}).low, 0.0);
  QVERIFY(view.shown({0, 500}).high >= 500 && view.shown({0, 500}).high <= 560);
  view.zoom({0, 500}, 100, 0.5);
  QVERIFY(!view.is_live());
  QCOMPARE(view.shown({0, 500}), view.shown({0, 900}));  // it stands still while the run goes on
  for (int i = 0; i < 200; ++i) view.zoom({0, 500}, 100, 0.5);
  QVERIFY(view.shown({0, 500}).span() > 0);
  for (int i = 0; i < 200; ++i) view.zoom({0, 500}, 100, 2);
  QVERIFY(view.shown({0, 500}).span() <= 1000);
  for (int i = 0; i < 200; ++i) view.pan({0, 500}, 1e6);
  QVERIFY(view.shown({0, 500}).low <= 500);  // the run cannot be lost out of sight
}

const Listed listed{"chart_data_test", test_main<ChartDataTest>};

}  // namespace clothlab::test::chart_data_test

#include "chart_data_test.moc"
