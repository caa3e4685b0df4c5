#include "compare/compare_charts.h"

#include <QEvent>
#include <QPainter>
#include <algorithm>

#include "charts/chart_export.h"
#include "compare/pane_style.h"

namespace clothlab {
namespace {

constexpr int refresh_interval = 34;  // ms
constexpr int chart_gap = spacing / 2;
constexpr double least_gutter = 30, gutter_slack = 12;  // px

/// Columns of the record: a group for each quantity, a column in it for each pane that there can be, by its
/// style.
constexpr std::size_t quantities = 4;

struct Quantity {
  const char* key;
  const char* column;  ///< in files
  QString title, unit;
  double scale;  ///< sample to chart
  bool from_zero, logarithmic;
};

std::array<Quantity, quantities> chart_quantities() {
  return {{{"compare_energy", "total_J", CompareCharts::tr("Total energy (J)"), "J", 1, false, false},
           {"compare_strain", "max_strain", CompareCharts::tr("Maximum strain (%)"), "%", 100, true, false},
           {"compare_step_time", "step_ms", CompareCharts::tr("Step time (ms)"), "ms", 1, false, true},
           {"compare_difference", "rms_difference_m", CompareCharts::tr("RMS difference (mm)"), "mm", 1000,
            false, true}}};
}

std::size_t column_of(std::size_t quantity, int style) {
  return quantity * cloth::most_panes + static_cast<std::size_t>(style);
}

ChartRecord empty_record() {
  ChartRecord record;
  record.samples = SampleSeries(quantities * cloth::most_panes);
  return record;
}

}  // namespace

CompareCharts::CompareCharts(QWidget* parent) : QWidget(parent), record_(empty_record()) {
  setObjectName("compareCharts");
  setAccessibleName(tr("Charts"));
  time_.set_span(TimeView::Span::whole_run);
  timer_.setSingleShot(true);
  timer_.setInterval(refresh_interval);
  connect(&timer_, &QTimer::timeout, this, &CompareCharts::refresh);
}

CompareCharts::~CompareCharts() {
  qDeleteAll(charts_);  // before the specs
}

void CompareCharts::setPanes(const cloth::Comparison& comparison) {
  Curves curves;
  for (const cloth::Pane& pane : comparison.panes) {
    curves.styles.push_back(style_of(pane));
    curves.names.push_back(QString::fromStdString(pane.name));
  }
  if (curves == curves_) return;
  std::vector<int> kept;
  std::copy_if(curves.styles.begin(), curves.styles.end(), std::back_inserter(kept), [this](int style) {
    return std::find(curves_.styles.begin(), curves_.styles.end(), style) != curves_.styles.end();
  });
  curves_ = std::move(curves);
  forgetAllBut(kept);
  makeCharts();
}

/// A pane that went leaves nothing to one that takes its name.
void CompareCharts::forgetAllBut(const std::vector<int>& styles) {
  ChartRecord record = empty_record();
  std::array<double, quantities * cloth::most_panes> row;
  for (std::size_t i = 0; i < record_.samples.size(); ++i) {
    row.fill(PaneSample::none);
    for (std::size_t q = 0; q < quantities; ++q)
      for (const int style : styles) row[column_of(q, style)] = record_.samples.value(column_of(q, style), i);
    record.samples.append(record_.samples.time(i), row);
  }
  record_ = std::move(record);
}

void CompareCharts::makeCharts() {
  qDeleteAll(charts_);
  charts_.clear();
  specs_.clear();
  const auto all = chart_quantities();
  for (std::size_t q = 0; q < quantities; ++q) {
    auto spec = std::make_unique<ChartSpec>();
    spec->key = QString::fromLatin1(all[q].key);
    spec->title = all[q].title;
    spec->unit = all[q].unit;
    spec->from_zero = all[q].from_zero;
    for (std::size_t i = 0; i < curves_.styles.size(); ++i)
      spec->curves.push_back({curves_.names[i], Source::samples, column_of(q, curves_.styles[i]),
                              all[q].scale, pane_curve(curves_.styles[i])});
    auto* chart = new LiveChart(*spec, q + 1 == quantities, this);
    chart->set_logarithmic(all[q].logarithmic);
    connectChart(chart);
    charts_.push_back(chart);
    specs_.push_back(std::move(spec));
    chart->show();
  }
  layOut();
  changeLater();
}

void CompareCharts::connectChart(LiveChart* chart) {
  PlotView* view = &chart->view();
  connect(chart, &LiveChart::changed, this, &CompareCharts::changeLater);
  connect(view, &PlotView::time_zoomed, this, [this](double anchor_s, double factor) {
    time_.zoom(record_.times(), anchor_s, factor);
    changeLater();
  });
  connect(view, &PlotView::time_panned, this, [this](double by_s) {
    time_.pan(record_.times(), by_s);
    changeLater();
  });
  connect(view, &PlotView::y_zoomed, this, [this, chart](double anchor, double factor) {
    chart->zoom_y(anchor, factor);
    changeLater();
  });
  connect(view, &PlotView::y_panned, this, [this, chart](double by) {
    chart->pan_y(by);
    changeLater();
  });
  connect(view, &PlotView::box_chosen, this, [this, chart](Range time, Range y) {
    time_.show(record_.times(), time);
    chart->set_y_range(y);
    changeLater();
  });
  connect(view, &PlotView::reset_wanted, this, &CompareCharts::follow);
  connect(view, &PlotView::y_reset_wanted, this, [this, chart] {
    chart->set_y_range(std::nullopt);
    changeLater();
  });
  connect(view, &PlotView::hovered, this, &CompareCharts::readAt);
}

LiveChart* CompareCharts::chart(const QString& key) const {
  for (LiveChart* chart : charts_)
    if (chart->spec().key == key) return chart;
  return nullptr;
}

void CompareCharts::append(const std::vector<CompareSample>& samples) {
  for (const CompareSample& sample : samples) {
    if (sample.is_start) {
      record_ = empty_record();
      follow();
    }
    std::array<double, quantities * cloth::most_panes> row;
    for (int style = 0; style < static_cast<int>(cloth::most_panes); ++style) {
      const PaneSample& pane = sample.panes[static_cast<std::size_t>(style)];
      const double values[quantities] = {pane.total_J, pane.max_strain, pane.step_ms, pane.rms_m};
      for (std::size_t q = 0; q < quantities; ++q) row[column_of(q, style)] = values[q];
    }
    record_.samples.append(sample.time_s, row);
  }
  changeLater();
}

QString CompareCharts::exportPng(const QString& path, QSize size) {
  refresh();
  return save_png(path, size, {record_, charts_, font()});
}

QString CompareCharts::exportSvg(const QString& path, QSize size) {
  refresh();
  return save_svg(path, size, {record_, charts_, font()});
}

QString CompareCharts::exportCsv(const QString& path) const {
  std::vector<CsvColumn> columns;
  const auto all = chart_quantities();
  for (std::size_t i = 0; i < curves_.styles.size(); ++i)
    for (std::size_t q = 0; q < quantities; ++q)
      columns.push_back({curves_.names[i].toUtf8() + '_' + all[q].column, Source::samples,
                         column_of(q, curves_.styles[i])});
  return save_csv(path, record_, columns, time_.shown(record_.times()));
}

void CompareCharts::saveAs() {
  save_charts_by_dialog(this, [this](const QString& path, const QString& ending) {
    return ending == "png" ? exportPng(path) : ending == "svg" ? exportSvg(path) : exportCsv(path);
  });
}

void CompareCharts::follow() {
  time_.follow();
  for (LiveChart* chart : charts_) chart->set_y_range(std::nullopt);
  changeLater();
}

void CompareCharts::changeLater() {
  if (isVisible() && !timer_.isActive()) timer_.start();
}

void CompareCharts::refresh() {
  if (charts_.empty()) return;
  const Range shown = time_.shown(record_.times());
  double needed = least_gutter;
  for (LiveChart* chart : charts_) needed = std::max(needed, chart->prepare(record_, shown));
  needed += spacing;
  if (needed > gutter_ || needed < gutter_ - gutter_slack) gutter_ = needed;
  for (LiveChart* chart : charts_) chart->draw(record_, gutter_);
  const bool begun = record_.samples.size() > 1;
  charts_.front()->set_message(begun ? QString() : tr("Press play to compare the panes"));
  readAt(cursor_);
}

void CompareCharts::readAt(std::optional<double> time_s) {
  cursor_ = time_s;
  std::optional<double> at;
  if (time_s && !record_.samples.empty()) at = record_.samples.time(record_.samples.nearest(*time_s));
  for (LiveChart* chart : charts_) chart->read(record_, at);
}

/// Equal plots in what is left of the height.
void CompareCharts::layOut() {
  int top = spacing;
  int plots = height() - top - spacing / 2 - static_cast<int>(quantities - 1) * chart_gap;
  for (const LiveChart* chart : charts_) plots -= chart->height_beside_plot(width());
  int left = static_cast<int>(charts_.size());
  for (LiveChart* chart : charts_) {
    const int plot = std::max(10, plots / left--);
    plots -= plot;
    const int height = chart->height_beside_plot(width()) + plot;
    chart->setGeometry(0, top, width(), height);
    top += height + chart_gap;
  }
}

void CompareCharts::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange && event->type() != QEvent::FontChange) return;
  for (LiveChart* chart : charts_) chart->apply_look();
  layOut();
  changeLater();
}

void CompareCharts::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  layOut();
  refresh();
}

void CompareCharts::resizeEvent(QResizeEvent*) {
  layOut();
  if (isVisible()) refresh();
}

void CompareCharts::paintEvent(QPaintEvent*) {
  QPainter(this).fillRect(rect(), theme().panel);
}

}  // namespace clothlab
