#include "compare/compare_charts.h"

#include <algorithm>
#include <utility>

#include "charts/live_chart.h"
#include "compare/pane_style.h"
#include "params/quantity.h"
#include "scene/probe.h"

namespace clothlab {
namespace {

/// Columns of the record: a group for each quantity, a column in it for each pane that there can be, by its
/// style.
constexpr std::size_t quantities = 4;
constexpr std::size_t first_below_probes = 2;  ///< of the quantities

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
  return quantity * cloth::max_panes + static_cast<std::size_t>(style);
}

/// Probes follow the quantities.
std::size_t column_of_probe(std::size_t probe, int style) {
  return column_of(quantities + probe, style);
}

ChartRecord empty_record(std::size_t probes) {
  ChartRecord record;
  record.samples = SampleSeries((quantities + probes) * cloth::max_panes);
  return record;
}

/// Where a column of the one list is in the other; nothing where it is not.
std::vector<std::optional<std::size_t>> places_in(const std::vector<std::string>& list,
                                                  const std::vector<std::string>& of) {
  std::vector<std::optional<std::size_t>> places;
  for (const std::string& column : of) {
    const auto found = std::find(list.begin(), list.end(), column);
    places.emplace_back();
    if (found != list.end()) places.back() = static_cast<std::size_t>(found - list.begin());
  }
  return places;
}

}  // namespace

CompareCharts::CompareCharts(QWidget* parent)
    : ChartArea(empty_record(0), TimeView::Span::whole_run, {1600, 1400}, parent) {
  setObjectName("compareCharts");
}

CompareCharts::~CompareCharts() {
  deleteCharts();  // before the specs
}

void CompareCharts::setPanes(const cloth::Comparison& comparison) {
  Curves curves;
  for (const cloth::Pane& pane : comparison.panes) {
    curves.styles.push_back(style_of(pane));
    curves.names.push_back(QString::fromStdString(pane.name));
  }
  curves.probes = cloth::probe_columns(comparison.scene.probes);
  std::vector<QString> titles;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    titles.push_back(
        QStringLiteral("%1  %2").arg(curves.names[i], QString::fromStdString(title_of(comparison, i))));
  if (curves == curves_) return name_curves(std::move(titles));
  titles_ = std::move(titles);
  const Curves before = std::exchange(curves_, std::move(curves));
  keepSamples(before);
  makeCharts();
  updateGeometry();
}

/// Those of the panes and probes that were there before: a new pane of a removed one's letter starts empty.
void CompareCharts::keepSamples(const Curves& before) {
  ChartRecord record = empty_record(curves_.probes.size());
  const auto places = places_in(before.probes, curves_.probes);
  std::vector<double> row(record.samples.columns());
  for (std::size_t i = 0; i < record_.samples.size(); ++i) {
    std::fill(row.begin(), row.end(), no_value);
    for (const int style : curves_.styles) {
      if (std::find(before.styles.begin(), before.styles.end(), style) == before.styles.end()) continue;
      for (std::size_t q = 0; q < quantities; ++q)
        row[column_of(q, style)] = record_.samples.value(column_of(q, style), i);
      for (std::size_t k = 0; k < places.size(); ++k)
        if (places[k])
          row[column_of_probe(k, style)] = record_.samples.value(column_of_probe(*places[k], style), i);
    }
    record.samples.append(record_.samples.time(i), row);
  }
  record_ = std::move(record);
}

void CompareCharts::deleteCharts() {
  logarithmicAxes();  // as the user chose them
  const std::vector<LiveChart*> charts = stack_.charts();
  stack_.clear();
  qDeleteAll(charts);
  qDeleteAll(names_);
  names_.clear();
  specs_.clear();
}

void CompareCharts::makeCharts() {
  deleteCharts();
  for (std::size_t i = 0; i < curves_.styles.size(); ++i) {
    LegendEntry* entry = names_.emplace_back(new LegendEntry({}, pane_curve(curves_.styles[i]), this));
    entry->setObjectName("compare_name_" + curves_.names[i].toLower());
    connect(entry, &LegendEntry::toggled, this, [this, i](bool on) {
      for (LiveChart* chart : stack_.charts()) chart->show_curve(i, on);
    });
  }
  const auto all = chart_quantities();
  for (std::size_t q = 0; q < quantities; ++q) {
    if (q == first_below_probes) addProbeCharts();
    auto spec = std::make_unique<ChartSpec>();
    spec->key = QString::fromLatin1(all[q].key);
    spec->title = all[q].title;
    spec->unit = all[q].unit;
    spec->from_zero = all[q].from_zero;
    for (std::size_t i = 0; i < curves_.styles.size(); ++i)
      spec->curves.push_back(curveOf(i, column_of(q, curves_.styles[i]), all[q].scale));
    addChart(std::move(spec), q + 1 == quantities, all[q].logarithmic);
  }
  setLogarithmicAxes(std::map<QString, bool>(axes_));
  lay_out();
  data_changed();
}

CurveSpec CompareCharts::curveOf(std::size_t pane, std::size_t column, double scale) const {
  return {titles_[pane],      Source::samples, column, scale, pane_curve(curves_.styles[pane]),
          curves_.names[pane]};
}

/// A chart for each value of a probe: its curves are the panes'.
void CompareCharts::addProbeCharts() {
  for (std::size_t k = 0; k < curves_.probes.size(); ++k) {
    const auto words = cloth::words_of_probe_column(curves_.probes[k]);
    if (!words) continue;
    const ProbeAxis axis = probe_axis(curves_.probes[k], words->unit);
    auto spec = std::make_unique<ChartSpec>();
    spec->key = "compare_" + QString::fromStdString(curves_.probes[k]);
    spec->title = QString::fromStdString(words->label);
    if (!axis.unit.isEmpty())
      spec->title +=
          QStringLiteral(" (%1)").arg(QString::fromStdString(cloth::shown_unit(axis.unit.toStdString())));
    spec->unit = axis.unit;
    for (std::size_t i = 0; i < curves_.styles.size(); ++i)
      spec->curves.push_back(curveOf(i, column_of_probe(k, curves_.styles[i]), axis.scale));
    addChart(std::move(spec), false, false);
  }
}

void CompareCharts::addChart(std::unique_ptr<ChartSpec> spec, bool has_time_labels, bool logarithmic) {
  auto* chart = new LiveChart(*spec, has_time_labels, this);
  chart->set_logarithmic(logarithmic);
  stack_.add(chart);
  specs_.push_back(std::move(spec));
  chart->show();
}

/// Another method changes no more than the names: ranges and scales that the user chose stay.
void CompareCharts::name_curves(std::vector<QString> titles) {
  if (titles == titles_) return;
  titles_ = std::move(titles);
  for (const auto& spec : specs_)
    for (std::size_t i = 0; i < titles_.size(); ++i) spec->curves[i].name = titles_[i];
  lay_out();
  data_changed();
}

/// The names above all charts, unless each chart has room for them.
int CompareCharts::lay_out_head() {
  const auto charts = stack_.charts();
  const bool in_charts = std::all_of(charts.begin(), charts.end(), [this](const LiveChart* chart) {
    return chart->has_room_for_names(width());
  });
  for (LiveChart* chart : charts) chart->name_curves(in_charts);
  for (LegendEntry* entry : names_) entry->setVisible(!in_charts);
  return in_charts || names_.empty() ? spacing : lay_out_names();
}

/// As many in a row as there is room for.
int CompareCharts::lay_out_names() {
  constexpr int margin = spacing / 2;
  int x = margin, y = margin, row = 0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    LegendEntry* entry = names_[i];
    entry->setFont(chart_font(font()));
    entry->setName(titles_[i], titles_[i]);
    const QSize wanted = entry->sizeHint().boundedTo({width() - 2 * margin, height()});
    row = wanted.height();
    if (x > margin && x + wanted.width() > width() - margin) {
      x = margin;
      y += row;
    }
    entry->setGeometry({{x, y}, wanted});
    x += wanted.width();
  }
  return y + row + margin;
}

LiveChart* CompareCharts::chart(const QString& key) const {
  for (LiveChart* chart : stack_.charts())
    if (chart->spec().key == key) return chart;
  return nullptr;
}

void CompareCharts::append(const std::vector<CompareSample>& samples) {
  for (const CompareSample& sample : samples) {
    if (sample.is_cut) {
      record_.samples.drop_after(sample.time_s);
      continue;
    }
    if (sample.is_start) {
      record_ = empty_record(curves_.probes.size());
      stack_.follow();
    }
    appendRow(sample);
  }
  data_changed();
}

/// The worker may have other probes than the charts for a moment, after an edit.
void CompareCharts::appendRow(const CompareSample& sample) {
  static const std::vector<std::string> none;
  const std::vector<std::string>& columns = sample.probe_columns ? *sample.probe_columns : none;
  const auto places = places_in(columns, curves_.probes);
  std::vector<double> row(record_.samples.columns(), no_value);
  for (int style = 0; style < static_cast<int>(cloth::max_panes); ++style) {
    const PaneSample& pane = sample.panes[static_cast<std::size_t>(style)];
    const double values[quantities] = {pane.total_J, pane.max_strain, pane.step_ms, pane.rms_m};
    for (std::size_t q = 0; q < quantities; ++q) row[column_of(q, style)] = values[q];
    for (std::size_t k = 0; k < places.size(); ++k)
      if (places[k] && *places[k] < pane.probes.size())
        row[column_of_probe(k, style)] = pane.probes[*places[k]];
  }
  record_.samples.append(sample.time_s, row);
}

std::vector<CsvColumn> CompareCharts::csv_columns() const {
  std::vector<CsvColumn> columns;
  const auto all = chart_quantities();
  for (std::size_t i = 0; i < curves_.styles.size(); ++i) {
    const QByteArray pane = curves_.names[i].toUtf8() + '_';
    const int style = curves_.styles[i];
    for (std::size_t q = 0; q < quantities; ++q)
      columns.push_back({pane + all[q].column, Source::samples, column_of(q, style)});
    for (std::size_t k = 0; k < curves_.probes.size(); ++k)
      columns.push_back(
          {pane + QByteArray::fromStdString(curves_.probes[k]), Source::samples, column_of_probe(k, style)});
  }
  return columns;
}

QSize CompareCharts::minimumSizeHint() const {
  if (curves_.probes.empty()) return least_size();
  const auto charts = static_cast<int>(quantities + curves_.probes.size());
  return {least_size().width(), scrolled_height * charts};
}

void CompareCharts::show_message() {
  const bool begun = record_.samples.size() > 1;
  stack_.charts().front()->set_message(begun ? QString() : tr("Press play to compare the panes"));
}

}  // namespace clothlab
