#include "sweep/sweep_account.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/study_axis.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_report.h"

namespace cloth {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// A column of the table: one path of an axis, by its place among all paths of the plan.
struct ParameterColumn {
  const SweepAxis* axis;
  std::size_t path_in_axis, path_in_plan;
  std::vector<std::string> words{};  ///< of values that are no numbers: what 0, 1, ... stand for
};

ParameterColumn column_of(const SweepAxis& axis, std::size_t path_in_axis, std::size_t path_in_plan) {
  ParameterColumn column{&axis, path_in_axis, path_in_plan};
  for (const auto& row : axis.values) {
    if (number_of(row[path_in_axis])) continue;
    const std::string word = csv_value(row[path_in_axis]);
    if (std::find(column.words.begin(), column.words.end(), word) == column.words.end())
      column.words.push_back(word);
  }
  return column;
}

/// Of an axis whose parameters take their values together the first one stands for all; a table's columns
/// have nothing to do with each other.
std::vector<ParameterColumn> columns_of(const SweepPlan& plan) {
  std::vector<ParameterColumn> columns;
  std::size_t first = 0;
  for (const SweepAxis& axis : plan.axes) {
    const std::size_t shown = plan.design == SweepDesign::points ? axis.paths.size() : 1;
    for (std::size_t k = 0; k < shown; ++k) columns.push_back(column_of(axis, k, first + k));
    first += axis.paths.size();
  }
  return columns;
}

Axis axis_of(const SweepPlan& plan, const ParameterColumn& column) {
  const SweepAxis& axis = *column.axis;
  Axis shown = plot_axis({.path = axis.paths[column.path_in_axis], .scale = axis.scale}, plan.scene);
  if (plan.design != SweepDesign::points && axis.paths.size() > 1)
    shown.label += fmt::format(" (with {} more)", axis.paths.size() - 1);
  for (std::size_t k = 0; k < column.words.size(); ++k)
    shown.label += fmt::format("{}{} {}", k == 0 ? ": " : ", ", k, column.words[k]);
  return shown;
}

double number_in(const ParameterColumn& column, const ParameterValue& value) {
  if (const auto number = number_of(value)) return *number;
  const auto found = std::find(column.words.begin(), column.words.end(), csv_value(value));
  return static_cast<double>(found - column.words.begin());
}

std::optional<Design> sensitivity_design(SweepDesign design) {
  if (design == SweepDesign::saltelli) return Design::saltelli;
  if (design == SweepDesign::morris) return Design::morris;
  return std::nullopt;
}

std::string note_of(const PointRow& row) {
  const std::string point = fmt::format("point {}", row.point);
  return row.status == PointStatus::finished
             ? point
             : fmt::format("{}: {}: {}", point, name_of(row.status), row.cause);
}

void add_row(PointTable& table, const std::vector<ParameterColumn>& columns, const SweepPoints& points,
             std::int64_t point, const PointRow* row) {
  const std::vector<ParameterValue> values = points.values(point);
  for (std::size_t c = 0; c < columns.size(); ++c)
    table.columns[c].values.push_back(number_in(columns[c], values[columns[c].path_in_plan]));
  for (std::size_t c = columns.size(); c < table.columns.size(); ++c)
    table.columns[c].values.push_back(
        row && row->status == PointStatus::finished ? row->outputs[c - columns.size()] : no_value);
  table.tags.push_back(static_cast<int>(point));
  table.notes.push_back(row ? note_of(*row) : fmt::format("point {}: not there yet", point));
}

PointTable empty_table(const SweepPlan& plan, const std::vector<ParameterColumn>& columns) {
  PointTable table;
  for (const ParameterColumn& column : columns) table.columns.push_back({.axis = axis_of(plan, column)});
  for (const RunOutput& output : plan.outputs)
    table.columns.push_back({.axis = {.label = output.name}, .is_output = true});
  return table;
}

}  // namespace

bool has_points(const SweepPlan& plan) {
  const bool is_sample = plan.design != SweepDesign::grid && plan.design != SweepDesign::points;
  return columns_of(plan).size() > 2 || plan.design == SweepDesign::points ||
         (is_sample && plan.axes.size() > 1);
}

PointTable points_table(const SweepFolder& folder, const SweepResults& results, std::size_t most) {
  const std::vector<ParameterColumn> columns = columns_of(folder.plan);
  PointTable table = empty_table(folder.plan, columns);
  const SweepPoints points(folder.plan);
  const std::size_t stride = (results.rows.size() + most - 1) / std::max<std::size_t>(most, 1);
  for (std::size_t r = 0; r < results.rows.size(); r += std::max<std::size_t>(stride, 1))
    add_row(table, columns, points, results.rows[r].point, &results.rows[r]);
  return table;
}

PointsAccount points_account(const SweepFolder& folder, const SweepResults& results) {
  const SweepPlan& plan = folder.plan;
  PointsAccount account{.title = plan.title.empty() ? plan.scene.title : plan.title};
  account.design = sensitivity_design(plan.design);
  account.count = static_cast<std::size_t>(plan.samples);
  account.seed = plan.seed;
  if (!account.design) {
    account.table = points_table(folder, results);
    return account;
  }
  const std::vector<ParameterColumn> columns = columns_of(plan);
  account.table = empty_table(plan, columns);
  const SweepPoints points(plan);
  auto next = results.rows.begin();
  for (std::int64_t point = 0; point < results.points; ++point) {
    const bool is_there = next != results.rows.end() && next->point == point;
    add_row(account.table, columns, points, point, is_there ? &*next++ : nullptr);
  }
  return account;
}

}  // namespace cloth
