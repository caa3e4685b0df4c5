#include "analysis/sensitivity_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/csv.h"

namespace cloth {
namespace {

constexpr double little_spread = 1e-3;  // standard deviation over mean

/// Indices from the largest value down; those without one at the end.
std::vector<std::size_t> from_the_largest(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::isfinite(values[a]) && !(values[a] <= values[b]);
  });
  return order;
}

std::vector<std::size_t> order_of(const SobolIndices& indices) {
  std::vector<double> totals;
  for (const SobolIndex& index : indices.parameters) totals.push_back(index.total.value);
  return from_the_largest(totals);
}

std::vector<std::size_t> order_of(const MorrisScreening& screening) {
  std::vector<double> effects;
  for (const MorrisEffect& effect : screening.parameters) effects.push_back(effect.mu_star.value);
  return from_the_largest(effects);
}

IntervalBar bar_of(const Estimate& estimate) {
  return {estimate.value, estimate.low, estimate.high};
}

HtmlText interval_text(const Estimate& estimate, int digits = 3) {
  return html_number(estimate.low, digits) + " to " + html_number(estimate.high, digits);
}

std::string percent(double part) {
  return fmt::format("{:.0f} %", 100 * part);
}

std::string failure_sentence(const SobolIndices& indices) {
  if (indices.failed == 0) return "";
  return fmt::format(
      "Runs without a value: {}; with their rows {} of {} were left out. If runs fail where the output "
      "would be extreme, the indices are those of the rest.",
      indices.failed, indices.left_out, indices.left_out + indices.rows);
}

std::string unit_text(const std::string& unit) {
  return unit.empty() ? "" : " (" + unit + ")";
}

}  // namespace

LinePlot morris_plot(const MorrisScreening& screening, const std::vector<std::string>& names,
                     const std::string& output, const std::string& unit) {
  LinePlot plot{.title = "Elementary effects on " + output,
                .subtitle = fmt::format("{} trajectories (Morris 1991)", screening.trajectories)};
  plot.x = {.label = "mean magnitude of the effects, mu*", .unit = unit, .low = 0};
  plot.y = {.label = "their standard deviation, sigma", .unit = unit, .low = 0};
  double farthest = 0;
  for (const std::size_t j : order_of(screening)) {
    const MorrisEffect& effect = screening.parameters[j];
    PlotPoint point{
        .x = effect.mu_star.value, .y = effect.sigma, .note = fmt::format("mu {:.4g}", effect.mu)};
    if (std::isfinite(effect.mu_star.low)) {
      point.x_range = {effect.mu_star.low, effect.mu_star.high};
      farthest = std::max(farthest, effect.mu_star.high);
    }
    plot.series.push_back({.name = names[j], .points = {point}, .line = false});
  }
  PlotSeries equal{.name = "sigma = mu*", .style = 12, .markers = false};
  equal.points = {{.x = 0, .y = 0}, {.x = farthest, .y = farthest}};
  if (farthest > 0) plot.series.push_back(equal);
  plot.caption = {
      "To the right: parameters that change the output much; the bars are 95 % intervals. High up: "
      "parameters "
      "whose effect differs from place to place, because it is curved or depends on the others. Near the "
      "origin: parameters that can be kept fixed."};
  return plot;
}

HtmlTable morris_table(const MorrisScreening& screening, const std::vector<std::string>& names,
                       const std::string& unit) {
  HtmlTable table{"Change of the output" + unit_text(unit) +
                      " over the whole range of a parameter, from steps over two thirds of it.",
                  {{"Parameter"}},
                  {}};
  for (const char* head : {"mu*", "95 % interval", "mu", "sigma", "Effects"})
    table.columns.push_back({head, Align::right});
  for (const std::size_t j : order_of(screening)) {
    const MorrisEffect& effect = screening.parameters[j];
    table.rows.push_back(
        {{html_code(names[j]), html_number(effect.mu_star.value), interval_text(effect.mu_star),
          html_number(effect.mu), html_number(effect.sigma), std::to_string(effect.effects)}});
  }
  return table;
}

IntervalBars sobol_plot(const SobolIndices& indices, const std::vector<std::string>& names,
                        const std::string& output) {
  IntervalBars plot{.title = "What " + output + " depends on",
                    .subtitle = fmt::format("Sobol' indices of {} rows, {} runs", indices.rows,
                                            indices.rows * (names.size() + 2))};
  plot.x = {.label = "part of the variance"};
  plot.series = {{"first: alone", {}}, {"total: alone and with others", {}}};
  for (const std::size_t j : order_of(indices)) {
    plot.categories.push_back(names[j]);
    plot.series[0].bars.push_back(bar_of(indices.parameters[j].first));
    plot.series[1].bars.push_back(bar_of(indices.parameters[j].total));
  }
  plot.caption = {
      "The whiskers are 95 % intervals. Where the total index is longer than the first one, the "
      "parameter acts together with others."};
  return plot;
}

HtmlTable sobol_table(const SobolIndices& indices, const std::vector<std::string>& names) {
  HtmlTable table{"Parts of the variance of the output, with 95 % intervals.", {{"Parameter"}}, {}};
  for (const char* head : {"First S", "95 % interval", "Total ST", "95 % interval"})
    table.columns.push_back({head, Align::right});
  for (const std::size_t j : order_of(indices)) {
    const SobolIndex& index = indices.parameters[j];
    table.rows.push_back({{html_code(names[j]), html_number(index.first.value), interval_text(index.first),
                           html_number(index.total.value), interval_text(index.total)}});
  }
  return table;
}

std::vector<std::string> sentences_of(const SobolIndices& indices, const std::vector<std::string>& names,
                                      const std::string& output) {
  std::vector<std::string> sentences, nothing;
  const std::vector<std::size_t> order = order_of(indices);
  if (indices.rows < 2 || order.empty() || !std::isfinite(indices.parameters[order[0]].total.value)) {
    sentences.push_back(output + (indices.rows < 2 ? " has no two whole rows of runs to compare."
                                                   : " is the same in every run: nothing decides it."));
  } else {
    const SobolIndex& most = indices.parameters[order[0]];
    sentences.push_back(fmt::format("{} decides most: {} of the variance of {} alone, {} with others.",
                                    names[order[0]], percent(most.first.value), output,
                                    percent(most.total.value)));
    double alone = 0;
    for (const SobolIndex& index : indices.parameters) alone += index.first.value;
    if (1 - alone > 0.05)
      sentences.push_back(
          fmt::format("{} of the variance come from parameters acting together.", percent(1 - alone)));
    for (const std::size_t j : order)
      if (indices.parameters[j].total.high < 0.01) nothing.push_back(names[j]);
    if (!nothing.empty())
      sentences.push_back(fmt::format("{} can be fixed anywhere in {} range: less than 1 % of the variance.",
                                      fmt::join(nothing, ", "), nothing.size() == 1 ? "its" : "their"));
  }
  if (const double part = std::sqrt(indices.variance) / std::abs(indices.mean); part < little_spread)
    sentences.push_back(fmt::format(
        "{} hardly varies: its standard deviation is {:.2g} of its mean. The indices then say what "
        "decides a difference that may be one of rounding or of a tolerance.",
        output, part));
  if (const std::string failures = failure_sentence(indices); !failures.empty())
    sentences.push_back(failures);
  return sentences;
}

std::vector<std::string> sentences_of(const MorrisScreening& screening, const std::vector<std::string>& names,
                                      const std::string& output) {
  std::vector<std::string> sentences;
  const std::vector<std::size_t> order = order_of(screening);
  const double most = order.empty() ? NAN : screening.parameters[order[0]].mu_star.value;
  if (!(most > 0)) {
    sentences.push_back("No parameter has an effect on " + output + " that could be had.");
  } else {
    sentences.push_back(fmt::format("{} changes {} most.", names[order[0]], output));
    std::vector<std::string> little;
    for (const std::size_t j : order)
      if (screening.parameters[j].mu_star.high < 0.05 * most) little.push_back(names[j]);
    if (!little.empty())
      sentences.push_back(fmt::format("{} change{} it by less than a twentieth of that.",
                                      fmt::join(little, ", "), little.size() == 1 ? "s" : ""));
  }
  if (screening.failed > 0)
    sentences.push_back(
        fmt::format("Runs without a value: {}; the effects beside them are left out.", screening.failed));
  return sentences;
}

void add_sensitivity(const SobolIndices& indices, const std::vector<std::string>& names,
                     const std::string& output, HtmlPage& page) {
  page.heading("What " + output + " depends on");
  for (const std::string& sentence : sentences_of(indices, names, output)) page.paragraph(sentence);
  page.figure(to_svg(sobol_plot(indices, names, output)),
              "Sobol' indices: first ones after Saltelli et al. 2010, total ones after Jansen 1999.");
  page.table(sobol_table(indices, names));
}

void add_sensitivity(const MorrisScreening& screening, const std::vector<std::string>& names,
                     const std::string& output, const std::string& unit, HtmlPage& page) {
  page.heading("What changes " + output);
  for (const std::string& sentence : sentences_of(screening, names, output)) page.paragraph(sentence);
  page.figure(to_svg(morris_plot(screening, names, output, unit)), "Elementary effects after Morris 1991.");
  page.table(morris_table(screening, names, unit));
}

std::string sobol_csv(const SobolIndices& indices, const std::vector<std::string>& names) {
  CsvTable table{{"parameter", "s", "s_low", "s_high", "st", "st_low", "st_high"}, {}};
  for (std::size_t j = 0; j < names.size(); ++j) {
    table.rows.push_back({names[j]});
    for (const Estimate& index : {indices.parameters[j].first, indices.parameters[j].total})
      for (const double value : {index.value, index.low, index.high})
        table.rows.back().push_back(csv_number(value));
  }
  return csv_text(table, "\n");
}

std::string morris_csv(const MorrisScreening& screening, const std::vector<std::string>& names) {
  CsvTable table{{"parameter", "mu", "mu_star", "mu_star_low", "mu_star_high", "sigma", "effects"}, {}};
  for (std::size_t j = 0; j < names.size(); ++j) {
    const MorrisEffect& effect = screening.parameters[j];
    table.rows.push_back({names[j]});
    for (const double value :
         {effect.mu, effect.mu_star.value, effect.mu_star.low, effect.mu_star.high, effect.sigma})
      table.rows.back().push_back(csv_number(value));
    table.rows.back().push_back(std::to_string(effect.effects));
  }
  return csv_text(table, "\n");
}

}  // namespace cloth
