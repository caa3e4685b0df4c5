#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/validation/validation_report.h"

namespace cloth {
namespace {

std::string label_of(const ValidationRow& row) {
  if (!row.parameter_text.empty()) return row.parameter_text;
  return row.parameter_name.empty() ? "" : fmt::format("{} {:g}", row.parameter_name, row.parameter);
}

bool is_drawn_with_all(const ValidationRow& row) {
  return row.promise == Promise::second_order || row.promise == Promise::error;
}

bool has_curve(const ValidationStudy& study, const std::string& protocol) {
  return std::any_of(study.expected.begin(), study.expected.end(), [&](const ValidationRow& row) {
    return row.protocol == protocol && !row.curve.points.empty();
  });
}

/// A shape looks like itself: as many pixels to a length along both axes.
void set_equal_scales(const std::vector<PlotPoint>& points, LinePlot& plot) {
  Eigen::Array2d low(points.front().x, points.front().y), high = low;
  for (const PlotPoint& point : points) {
    low = low.min(Eigen::Array2d(point.x, point.y));
    high = high.max(Eigen::Array2d(point.x, point.y));
  }
  plot.width = 830, plot.plot_height = 480;
  constexpr double beside = 350, margin = 1.1;  // px of labels and legend; around the shape
  const Eigen::Array2d frame(plot.width - beside, plot.plot_height);
  const double pixel = margin * ((high - low) / frame).maxCoeff();
  const Eigen::Array2d middle = (low + high) / 2, reach = pixel * frame / 2;
  plot.x = {.label = "x over the length", .low = middle.x() - reach.x(), .high = middle.x() + reach.x()};
  plot.y = {.label = "y over the length", .low = middle.y() - reach.y(), .high = middle.y() + reach.y()};
}

}  // namespace

LinePlot curve_plot(const ValidationRow& row) {
  LinePlot plot{.title = row.protocol, .subtitle = label_of(row)};
  PlotSeries exact{.name = "exact: " + row.source, .markers = false};
  constexpr int segments = 200;
  for (int k = 0; k <= segments; ++k) {
    const Eigen::Vector2d point = point_at(row.curve, static_cast<double>(k) / segments);
    exact.points.push_back({point.x(), point.y()});
  }
  PlotSeries found{.name = fmt::format("found with {} cells", row.shown.size() - 1), .line = false};
  for (const Eigen::Vector2d& point : row.shown) found.points.push_back({point.x(), point.y()});
  set_equal_scales(exact.points, plot);
  plot.series = {std::move(exact), std::move(found)};
  return plot;
}

/// All rows of a protocol that have a curve: each as a line, and what was found as points in its colour.
LinePlot curves_plot(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  LinePlot plot{.title = protocol, .subtitle = "exact curves, and what was found with 20 cells"};
  std::vector<PlotPoint> all;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k].protocol != protocol || rows[k].curve.points.empty()) continue;
    LinePlot one = curve_plot(rows[k]);
    const int style = static_cast<int>(plot.series.size() / 2);
    one.series[0].name = label_of(rows[k]), one.series[1].name.clear();
    for (PlotSeries& series : one.series) {
      series.style = style;
      all.insert(all.end(), series.points.begin(), series.points.end());
      if (series.markers && scene_of(rows[k]))
        for (PlotPoint& point : series.points) point.tag = static_cast<int>(k);
      plot.series.push_back(std::move(series));
    }
  }
  if (!all.empty()) set_equal_scales(all, plot);
  return plot;
}

/// The largest error of what each protocol promises, on each grid.
LinePlot all_errors_plot(const ValidationStudy& study) {
  LinePlot plot{
      .title = "Materials against exact solutions",
      .subtitle = "largest relative error of what each protocol promises, against the cells along the strip"};
  plot.x = {.label = "cells", .scale = AxisScale::logarithmic};
  plot.y = {.label = "relative error", .scale = AxisScale::logarithmic};
  plot.triangles = {{-2, "order 2"}};
  for (const std::string& protocol : study.protocols) {
    PlotSeries series{.name = protocol};
    for (const int cells : validation_cells) {
      double largest = 0;
      for (const ValidationRow& row : study.rows)
        for (const ValidationValue& grid : row.grids)
          if (row.protocol == protocol && grid.cells == cells && is_drawn_with_all(row))
            largest = std::max(largest, std::abs(grid.error));
      if (largest > 0) series.points.push_back({static_cast<double>(cells), largest});
    }
    if (!series.points.empty()) plot.series.push_back(std::move(series));
  }
  const auto is_exact = [](const ValidationRow& row) { return row.promise == Promise::exact; };
  if (std::any_of(study.expected.begin(), study.expected.end(), is_exact))
    plot.caption = {"The picture frame has no error but rounding's, and is not drawn here."};
  return plot;
}

/// Where there is no exact value: what was found on each grid.
LinePlot values_plot(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  LinePlot plot{.title = protocol, .subtitle = rows.empty() ? "" : rows.front().quantity};
  plot.x = {.label = "cells across", .scale = AxisScale::logarithmic};
  plot.y = {.label = "value"};
  for (const ValidationRow& row : rows) {
    if (row.protocol != protocol || row.grids.empty()) continue;
    PlotSeries series{.name = label_of(row)};
    for (const ValidationValue& grid : row.grids)
      series.points.push_back({static_cast<double>(grid.cells), grid.value});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

LinePlot error_plot(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  const bool is_measured = std::any_of(rows.begin(), rows.end(), [&](const ValidationRow& row) {
    return row.protocol == protocol && row.is_measured;
  });
  if (is_measured) return values_plot(protocol, rows);
  LinePlot plot{.title = protocol, .subtitle = "relative error against the cells along the strip"};
  plot.x = {.label = "cells", .scale = AxisScale::logarithmic};
  plot.y = {.label = "relative error", .scale = AxisScale::logarithmic};
  const bool is_exact = std::any_of(rows.begin(), rows.end(), [&](const ValidationRow& row) {
    return row.protocol == protocol && row.promise == Promise::exact;
  });
  if (!is_exact) plot.triangles = {{-2, "order 2"}};
  for (const ValidationRow& row : rows) {
    if (row.protocol != protocol || row.grids.empty()) continue;
    PlotSeries series{.name = row.parameter_name.empty() ? protocol : label_of(row),
                      .detail = std::isfinite(row.order()) ? fmt::format("order {:.2f}", row.order()) : ""};
    const int tag = scene_of(row) ? static_cast<int>(&row - rows.data()) : -1;
    for (const ValidationValue& grid : row.grids)
      series.points.push_back({.x = static_cast<double>(grid.cells),
                               .y = std::abs(grid.error),
                               .note = fmt::format("value {:.7g}, exact {:.7g}", grid.value, row.exact),
                               .tag = tag});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::vector<std::string> diagram_names(const ValidationStudy& study) {
  std::vector<std::string> names{"all protocols"};
  for (const std::string& protocol : study.protocols) {
    names.push_back(protocol + ": errors");
    if (has_curve(study, protocol)) names.push_back(protocol + ": curves");
  }
  return names;
}

LinePlot study_plot(const ValidationStudy& study, std::size_t which) {
  if (which == 0) return all_errors_plot(study);
  for (const std::string& protocol : study.protocols) {
    if (--which == 0) return error_plot(protocol, study.rows);
    if (has_curve(study, protocol) && --which == 0) return curves_plot(protocol, study.rows);
  }
  return all_errors_plot(study);
}

}  // namespace cloth
