#include <cmath>

#include "io/csv.h"
#include "study/validation/validation_report.h"

namespace cloth {
namespace {

std::vector<std::string> drape_fields(const std::optional<DrapeFacts>& drape) {
  if (!drape) return {"", "", ""};
  return {std::to_string(drape->folds), csv_number(drape->amplitude), csv_number(drape->cells_above)};
}

std::string parameter_field(const ValidationRow& row) {
  if (!row.parameter_text.empty()) return row.parameter_text;
  return row.parameter_name.empty() ? std::string() : csv_number(row.parameter);
}

}  // namespace

std::vector<std::vector<std::string>> lines_of(const ValidationRow& row) {
  std::vector<std::vector<std::string>> lines;
  std::vector<ValidationValue> grids = row.grids;
  if (grids.empty()) grids.emplace_back();
  const auto add = [&](const std::string& cells, const std::vector<std::string>& found) {
    lines.push_back({row.protocol, row.parameter_name, parameter_field(row), row.quantity, row.source,
                     row.method, row.is_measured ? "" : csv_number(row.exact),
                     row.band ? csv_number(row.band->low) : "", row.band ? csv_number(row.band->high) : "",
                     cells});
    lines.back().insert(lines.back().end(), found.begin(), found.end());
  };
  for (const ValidationValue& grid : grids) {
    const bool is_last = &grid == &grids.back(), is_found = grid.cells > 0;
    std::vector<std::string> found{
        is_found ? csv_number(grid.value) : "",
        is_found && !row.is_measured ? csv_number(grid.error) : "",
        grid.distance > 0 ? csv_number(grid.distance) : "",
        is_last && std::isfinite(row.order()) ? csv_number(row.order()) : "",
        ""};
    for (std::string& field : drape_fields(grid.drape)) found.push_back(std::move(field));
    found.push_back(is_last ? row.failure : "");
    add(is_found ? std::to_string(grid.cells) : "", found);
  }
  for (const SeedValue& seed : row.seeds) {
    std::vector<std::string> found{csv_number(seed.value), "", "", "", std::to_string(seed.seed)};
    for (std::string& field : drape_fields(seed.drape)) found.push_back(std::move(field));
    found.emplace_back();
    add(std::to_string(row.seed_cells), found);
  }
  return lines;
}

CsvTable table_of(const ValidationStudy& study) {
  CsvTable table{{"protocol", "parameter_name", "parameter", "quantity", "source", "method", "exact", "low",
                  "high", "cells", "value", "relative_error", "rms_distance", "order", "seed",
                  "folds", "amplitude_m", "cells_that_lock", "failure"},
                 {}};
  for (const ValidationRow& row : study.rows)
    for (std::vector<std::string>& line : lines_of(row)) table.rows.push_back(std::move(line));
  return table;
}

std::vector<std::vector<std::string>> point_lines(const ValidationRow& row) {
  std::vector<std::vector<std::string>> lines;
  for (const Eigen::Vector2d& point : row.shown)
    lines.push_back({row.protocol, parameter_field(row), csv_number(point.x()), csv_number(point.y())});
  return lines;
}

CsvTable points_table(const ValidationStudy& study) {
  CsvTable table{{"protocol", "parameter", "x", "y"}, {}};
  for (const ValidationRow& row : study.rows)
    for (std::vector<std::string>& line : point_lines(row)) table.rows.push_back(std::move(line));
  return table;
}

std::string curve_csv(const StripCurve& curve) {
  CsvTable table{{"arc", "x", "y"}, {}};
  for (const exact::ElasticaPoint& point : curve.points)
    table.rows.push_back({csv_number(point.arc), csv_number(point.x), csv_number(point.y)});
  return csv_text(table, "\r\n");
}

}  // namespace cloth
