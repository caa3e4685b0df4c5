#include "analysis/points_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/sensitivity_report.h"
#include "report/html_page.h"

namespace cloth {
namespace {

std::vector<std::string> parameter_names(const PointTable& table) {
  std::vector<std::string> names;
  for (const std::size_t c : table.columns_that(false)) names.push_back(table.columns[c].axis.label);
  return names;
}

std::string failure_sentence(const PointTable& table) {
  const std::size_t failures = table.failures();
  return failures == 0 ? "" : fmt::format("{} of {} runs failed.", failures, table.rows());
}

void add_sensitivities(const PointsAccount& account, HtmlPage& page) {
  const PointTable& table = account.table;
  const std::vector<std::string> names = parameter_names(table);
  if (names.empty()) return;
  for (const std::size_t c : table.columns_that(true)) {
    const PointColumn& output = table.columns[c];
    if (account.design == Design::saltelli)
      add_sensitivity(sobol_indices(output.values, names.size(), account.seed), names, output.axis.label,
                      page);
    if (account.design == Design::morris)
      add_sensitivity(morris_screening(unit_design(Design::morris, account.count, names.size(), account.seed),
                                       output.values, account.seed),
                      names, output.axis.label, output.axis.unit, page);
  }
}

}  // namespace

ParallelCoordinates parallel_plot(const PointsAccount& account) {
  ParallelCoordinates plot{.title = "Every run", .subtitle = account.title, .table = account.table};
  const std::vector<std::size_t> outputs = account.table.columns_that(true);
  if (!outputs.empty()) plot.coloured_by = outputs.front();
  plot.caption = {"A line is a run; it crosses each axis at its value. Names of outputs are bold."};
  return plot;
}

ScatterMatrix scatter_plot(const PointsAccount& account) {
  ScatterMatrix plot{.title = "Every pair of columns", .subtitle = account.title, .table = account.table};
  plot.caption = {
      "Below the diagonal the runs, on it how often values occur, above it Spearman's rank correlation: 1 or "
      "-1 "
      "where one rises or falls whenever the other rises."};
  return plot;
}

ScatterMatrix main_effects_plot(const PointsAccount& account) {
  ScatterMatrix plot{.title = "Main effects", .subtitle = account.title, .table = account.table};
  plot.main_effects = true;
  plot.caption = {
      "The line is the mean of the output over all other parameters. Points that leave it far say that "
      "others "
      "matter too."};
  return plot;
}

LinePlot curve_of_output(const PointsAccount& account, std::size_t output) {
  const PointTable& table = account.table;
  const PointColumn &x = table.columns[table.columns_that(false).front()], &y = table.columns[output];
  LinePlot plot{.title = y.axis.label, .subtitle = account.title, .x = x.axis, .y = y.axis};
  PlotSeries series{.name = y.axis.label};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string note = row < table.notes.size() ? table.notes[row] : "";
    if (std::isfinite(y.values[row]))
      series.points.push_back(
          {.x = x.values[row], .y = y.values[row], .note = note, .tag = static_cast<int>(row)});
    else
      series.failed.push_back({x.values[row], note.empty() ? "no value" : note, static_cast<int>(row)});
  }
  std::stable_sort(series.points.begin(), series.points.end(),
                   [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  plot.series.push_back(std::move(series));
  return plot;
}

void add_points(const PointsAccount& account, HtmlPage& page) {
  const PointTable& table = account.table;
  const std::size_t parameters = table.columns_that(false).size(), outputs = table.columns_that(true).size();
  if (table.rows() == 0) return;
  page.heading("Every run");
  if (const std::string sentence = failure_sentence(table); !sentence.empty())
    page.notice(sentence, Verdict::warn);
  if (table.columns.size() > 1)
    page.figure(
        to_brushed_svg(parallel_plot(account)),
        "Parallel coordinates. Draw along an axis to pick the runs that pass there; a click on the range "
        "takes it away.",
        account.command);
  if (parameters > 1 && outputs > 0)
    page.figure(to_svg(main_effects_plot(account)), "Main effects.", account.command);
  add_sensitivities(account, page);
  if (table.columns.size() > 2 && table.columns.size() <= 12) {
    page.heading("Every pair");
    page.figure(to_svg(scatter_plot(account)), "Scatter matrix.", account.command);
  }
}

std::string points_page(const PointsAccount& account) {
  HtmlPage page(account.title, fmt::format("{} runs over {} parameters.", account.table.rows(),
                                           account.table.columns_that(false).size()));
  add_points(account, page);
  page.heading("How it was made");
  page.machine_facts();
  return page.to_html();
}

}  // namespace cloth
