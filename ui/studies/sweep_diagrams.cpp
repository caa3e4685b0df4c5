#include "studies/sweep_diagrams.h"

#include <algorithm>
#include <cmath>

#include "scene/probe.h"
#include "study/run_output.h"
#include "study/study_axis.h"
#include "sweep/sweep_account.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_report.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

/// Parallel coordinates show no more rows than this, and reading a table of more takes longer than a look.
constexpr std::size_t most_table_rows = 20'000;

/// Of the engine's map: the colours of values, before those of runs that failed or have none.
constexpr int classes_of_values = 9;

/// Columns and measures without their units, for a person.
QString source_words(const std::string& of) {
  if (const auto probe = cloth::words_of_probe_column(of)) return QString::fromStdString(probe->label);
  QString name = QString::fromStdString(of);
  for (const char* unit : {"_J", "_Ns", "_m", "_s"})
    if (name.endsWith(QLatin1String(unit))) name.chop(static_cast<qsizetype>(qstrlen(unit)));
  return name.replace('_', ' ');
}

bool is_fine(const cloth::PointRow& row, std::size_t output) {
  return row.status == cloth::PointStatus::finished && std::isfinite(row.outputs[output]);
}

/// Words and unit of the output where the engine has its name.
void name_output(cloth::Axis& axis, const cloth::RunOutput& output) {
  axis.label = output_words(output).toStdString();
  axis.unit = output_unit(output);
}

cloth::LinePlot curve_of(const SweepView& view, std::size_t output) {
  cloth::LinePlot plot = curve_plot(view.folder, view.results, output);
  name_output(plot.y, view.folder.plan.outputs[output]);
  plot.title = plot.y.label;
  plot.series.front().name = plot.y.label;
  return plot;
}

cloth::HeatMap map_of(const SweepView& view, std::size_t output) {
  cloth::HeatMap map = output_map(view.folder, view.results, output);
  const cloth::RunOutput& of = view.folder.plan.outputs[output];
  map.title = output_words(of).toStdString();
  if (const std::string unit = output_unit(of); !unit.empty()) map.title += " (" + unit + ")";
  cloth::HeatPanel& panel = map.panels.front();
  panel.title = map.title;
  // A contour is to be seen, not to be pointed at: it lies over the runs.
  for (cloth::OverlayCurve& curve : panel.curves) curve.label.clear();
  // The last classes, of runs without a value, take room in the legend where there are none.
  int last = classes_of_values - 1;
  for (const cloth::HeatCell& cell : panel.cells) last = std::max(last, cell.class_index);
  map.classes.resize(std::min(map.classes.size(), static_cast<std::size_t>(last) + 1));
  return map;
}

cloth::ParallelCoordinates parallel_of(const SweepView& view, std::size_t output) {
  const cloth::SweepPlan& plan = view.folder.plan;
  cloth::ParallelCoordinates plot;
  plot.title = output_words(plan.outputs[output]).toStdString();
  plot.table = points_table(view.folder, view.results, most_table_rows);
  const std::vector<std::size_t> outputs = plot.table.columns_that(true);
  for (std::size_t k = 0; k < outputs.size(); ++k)
    name_output(plot.table.columns[outputs[k]].axis, plan.outputs[k]);
  plot.coloured_by = outputs[output];
  return plot;
}

}  // namespace

QString output_words(const cloth::RunOutput& output) {
  const QString of = source_words(output.of);
  switch (output.reduce) {
    case cloth::Reduction::final_value:
      return QObject::tr("%1 at the end").arg(of);
    case cloth::Reduction::maximum:
      return QObject::tr("%1, largest").arg(of);
    case cloth::Reduction::minimum:
      return QObject::tr("%1, smallest").arg(of);
    case cloth::Reduction::mean:
      return QObject::tr("%1, mean").arg(of);
    case cloth::Reduction::first_above:
      return QObject::tr("first time of %1 above %2").arg(of, number_text(output.bound, 4));
    case cloth::Reduction::first_below:
      return QObject::tr("first time of %1 below %2").arg(of, number_text(output.bound, 4));
    case cloth::Reduction::stays_below:
      return QObject::tr("time from which %1 stays below %2").arg(of, number_text(output.bound, 4));
    case cloth::Reduction::rms:
      return QObject::tr("%1, off the measured curve").arg(of);
  }
  return of;
}

std::string output_unit(const cloth::RunOutput& output) {
  if (has_bound(output.reduce)) return "s";
  return cloth::unit_of_output(output.of);
}

QStringList sweep_diagram_names(const SweepView& view) {
  QStringList names;
  for (const cloth::RunOutput& output : view.folder.plan.outputs) names << output_words(output);
  return names;
}

std::optional<Diagram> sweep_diagram(const SweepView& view, std::size_t output) {
  const auto& rows = view.results.rows;
  const cloth::SweepPlan& plan = view.folder.plan;
  if (rows.empty()) return std::nullopt;
  if (has_curves(plan)) return curve_of(view, output);
  // Colours and axes come from values.
  if (std::none_of(rows.begin(), rows.end(), [&](const auto& row) { return is_fine(row, output); }))
    return std::nullopt;
  if (has_maps(plan)) return map_of(view, output);
  return parallel_of(view, output);
}

QString point_words(const cloth::SweepPlan& plan, std::int64_t point) {
  const auto values = cloth::SweepPoints(plan).values(point);
  QStringList words;
  std::size_t k = 0;
  for (const std::string& path : paths_of(plan)) {
    const cloth::ParameterValue& value = values[k++];
    const cloth::Axis axis = plot_axis({.path = path}, plan.scene);
    const auto number = cloth::number_of(value);
    words << QStringLiteral("%1 = %2").arg(
        QString::fromStdString(axis.label),
        number ? quantity_text(*number, axis.unit, 4) : QString::fromStdString(cloth::csv_value(value)));
  }
  return words.join(", ");
}

}  // namespace clothlab
