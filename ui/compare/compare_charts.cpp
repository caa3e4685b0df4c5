#include "compare/compare_charts.h"

#include <algorithm>

#include "charts/live_chart.h"
#include "compare/pane_style.h"

namespace clothlab {
namespace {

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
  return quantity * cloth::max_panes + static_cast<std::size_t>(style);
}

ChartRecord empty_record() {
  ChartRecord record;
  record.samples = SampleSeries(quantities * cloth::max_panes);
  return record;
}

}  // namespace

CompareCharts::CompareCharts(QWidget* parent)
    : ChartArea(empty_record(), TimeView::Span::whole_run, {1600, 1400}, parent) {
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
  std::vector<QString> titles;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    titles.push_back(
        QStringLiteral("%1  %2").arg(curves.names[i], QString::fromStdString(title_of(comparison, i))));
  if (curves == curves_) return name_curves(std::move(titles));
  titles_ = std::move(titles);
  std::vector<int> kept;
  std::copy_if(curves.styles.begin(), curves.styles.end(), std::back_inserter(kept), [this](int style) {
    return std::find(curves_.styles.begin(), curves_.styles.end(), style) != curves_.styles.end();
  });
  curves_ = std::move(curves);
  forgetAllBut(kept);
  makeCharts();
}

/// Deletes the samples of removed panes, so that a new pane of the same letter starts empty.
void CompareCharts::forgetAllBut(const std::vector<int>& styles) {
  ChartRecord record = empty_record();
  std::array<double, quantities * cloth::max_panes> row;
  for (std::size_t i = 0; i < record_.samples.size(); ++i) {
    row.fill(no_value);
    for (std::size_t q = 0; q < quantities; ++q)
      for (const int style : styles) row[column_of(q, style)] = record_.samples.value(column_of(q, style), i);
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
    auto spec = std::make_unique<ChartSpec>();
    spec->key = QString::fromLatin1(all[q].key);
    spec->title = all[q].title;
    spec->unit = all[q].unit;
    spec->from_zero = all[q].from_zero;
    for (std::size_t i = 0; i < curves_.styles.size(); ++i)
      spec->curves.push_back({titles_[i], Source::samples, column_of(q, curves_.styles[i]), all[q].scale,
                              pane_curve(curves_.styles[i]), curves_.names[i]});
    auto* chart = new LiveChart(*spec, q + 1 == quantities, this);
    chart->set_logarithmic(all[q].logarithmic);
    stack_.add(chart);
    specs_.push_back(std::move(spec));
    chart->show();
  }
  setLogarithmicAxes(std::map<QString, bool>(axes_));
  lay_out();
  data_changed();
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
      record_ = empty_record();
      stack_.follow();
    }
    std::array<double, quantities * cloth::max_panes> row;
    for (int style = 0; style < static_cast<int>(cloth::max_panes); ++style) {
      const PaneSample& pane = sample.panes[static_cast<std::size_t>(style)];
      const double values[quantities] = {pane.total_J, pane.max_strain, pane.step_ms, pane.rms_m};
      for (std::size_t q = 0; q < quantities; ++q) row[column_of(q, style)] = values[q];
    }
    record_.samples.append(sample.time_s, row);
  }
  data_changed();
}

std::vector<CsvColumn> CompareCharts::csv_columns() const {
  std::vector<CsvColumn> columns;
  const auto all = chart_quantities();
  for (std::size_t i = 0; i < curves_.styles.size(); ++i)
    for (std::size_t q = 0; q < quantities; ++q)
      columns.push_back({curves_.names[i].toUtf8() + '_' + all[q].column, Source::samples,
                         column_of(q, curves_.styles[i])});
  return columns;
}

void CompareCharts::show_message() {
  const bool begun = record_.samples.size() > 1;
  stack_.charts().front()->set_message(begun ? QString() : tr("Press play to compare the panes"));
}

}  // namespace clothlab
