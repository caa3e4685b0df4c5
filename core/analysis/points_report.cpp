#include "analysis/points_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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
  return failures == 0 ? "" : fmt::format("Runs without a value: {} of {}.", failures, table.rows());
}

SobolIndices sobol_of(const PointsAccount& account, const PointColumn& output, std::size_t parameters) {
  return sobol_indices(output.values, parameters, account.seed);
}

MorrisScreening morris_of(const PointsAccount& account, const PointColumn& output, std::size_t parameters) {
  return morris_screening(unit_design(Design::morris, account.count, parameters, account.seed), output.values,
                          account.seed);
}

void add_sensitivities(const PointsAccount& account, HtmlPage& page) {
  const PointTable& table = account.table;
  const std::vector<std::string> names = parameter_names(table);
  if (names.empty()) return;
  for (const std::size_t c : table.columns_that(true)) {
    const PointColumn& output = table.columns[c];
    if (account.design == Design::saltelli)
      add_sensitivity(sobol_of(account, output, names.size()), names, output.axis.label, page);
    if (account.design == Design::morris)
      add_sensitivity(morris_of(account, output, names.size()), names, output.axis.label, output.axis.unit,
                      page);
  }
}

void add_sensitivity_files(const PointsAccount& account, std::vector<PointsFile>& files) {
  const PointTable& table = account.table;
  const std::vector<std::string> names = parameter_names(table);
  if (names.empty() || !(account.design == Design::saltelli || account.design == Design::morris)) return;
  const std::string prefix = account.design == Design::saltelli ? "sobol" : "morris";
  std::vector<std::string> taken;
  for (const std::size_t c : table.columns_that(true)) {
    const PointColumn& output = table.columns[c];
    const std::string &label = output.axis.label, &unit = output.axis.unit;
    std::string picture, numbers;
    if (account.design == Design::saltelli) {
      const SobolIndices indices = sobol_of(account, output, names.size());
      picture = to_svg(sobol_plot(indices, names, label)), numbers = sobol_csv(indices, names);
    } else {
      const MorrisScreening screening = morris_of(account, output, names.size());
      picture = to_svg(morris_plot(screening, names, label, unit)), numbers = morris_csv(screening, names);
    }
    const std::string stem = file_stem(prefix, label, taken);
    files.push_back({stem + ".svg", std::move(picture)});
    files.push_back({stem + ".csv", std::move(numbers)});
  }
}

bool has_main_effects(const PointTable& table) {
  return table.columns_that(false).size() > 1 && !table.columns_that(true).empty();
}

/// Panels of more columns would be too small to read.
bool has_scatter(const PointTable& table) {
  return table.columns.size() > 2 && table.columns.size() <= 12;
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
  if (has_main_effects(table))
    page.figure(to_svg(main_effects_plot(account)), "Main effects.", account.command);
  add_sensitivities(account, page);
  if (has_scatter(table)) {
    page.heading("Every pair");
    page.figure(to_svg(scatter_plot(account)), "Scatter matrix.", account.command);
  }
}

std::string file_stem(const std::string& prefix, const std::string& name, std::vector<std::string>& taken) {
  std::string stem = prefix + "-";
  for (const char c : name) stem += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  std::string free = stem;
  for (int k = 2; std::find(taken.begin(), taken.end(), free) != taken.end(); ++k)
    free = fmt::format("{}-{}", stem, k);
  taken.push_back(free);
  return free;
}

std::vector<PointsFile> points_files(const PointsAccount& account) {
  const PointTable& table = account.table;
  std::vector<PointsFile> files;
  if (table.rows() == 0) return files;
  if (table.columns.size() > 1)
    files.push_back({"parallel-coordinates.svg", to_brushed_svg(parallel_plot(account))});
  if (has_main_effects(table)) files.push_back({"main-effects.svg", to_svg(main_effects_plot(account))});
  if (has_scatter(table)) files.push_back({"scatter-matrix.svg", to_svg(scatter_plot(account))});
  add_sensitivity_files(account, files);
  return files;
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
