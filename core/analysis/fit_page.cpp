#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/fit_report.h"
#include "fit/identifiability.h"

namespace cloth {
namespace {

Verdict colour_of(FitVerdict verdict) {
  if (verdict == FitVerdict::identified) return Verdict::good;
  return verdict == FitVerdict::uncertain || verdict == FitVerdict::at_bound ? Verdict::warn : Verdict::bad;
}

HtmlText with_unit(HtmlText number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

void add_parameters(const FitAccount& account, HtmlPage& page) {
  HtmlTable table{"Values, with two standard errors to each side.", {{"Parameter"}}, {}};
  for (const char* head : {"Value", "Standard error", "From", "To"})
    table.columns.push_back({head, Align::right});
  table.columns.push_back({"Verdict"});
  table.columns.push_back({"Why"});
  for (std::size_t j = 0; j < account.problem.parameters.size(); ++j) {
    const FitParameter& parameter = account.problem.parameters[j];
    const FittedParameter& found = account.result.parameters[j];
    const bool has_error = std::isfinite(found.standard_error) && found.verdict != FitVerdict::not_fitted;
    table.rows.push_back({{html_code(parameter.name), with_unit(html_number(found.value, 5), parameter.unit),
                           has_error ? html_number(found.standard_error, 2) : HtmlText("none"),
                           has_error ? html_number(found.low, 4) : HtmlText(),
                           has_error ? html_number(found.high, 4) : HtmlText(),
                           HtmlCell(name_of(found.verdict), colour_of(found.verdict)), found.why}});
  }
  page.table(table);
}

HtmlText measured_text(const FitTarget& target) {
  return with_unit(html_number(target.measured, 6) + " ± " + html_number(target.sigma, 2), target.unit);
}

void add_single_targets(const FitAccount& account, HtmlPage& page) {
  HtmlTable table{
      "Measured and simulated values; ± of the simulated ones is what the parameters' uncertainty "
      "makes.",
      {{"Target"}},
      {}};
  for (const char* head : {"Measured", "Simulated", "Difference in sigmas"})
    table.columns.push_back({head, Align::right});
  table.columns.push_back({"Use"});
  for (std::size_t t = 0; t < account.problem.targets.size(); ++t) {
    const bool in_curve =
        std::any_of(account.curves.begin(), account.curves.end(), [t](const FitCurve& curve) {
          return std::find(curve.targets.begin(), curve.targets.end(), t) != curve.targets.end();
        });
    if (in_curve) continue;
    const FitTarget& target = account.problem.targets[t];
    const double simulated = account.result.simulated[t], error = account.result.simulated_error[t];
    const double sigma = target.held_out ? std::hypot(target.sigma, error) : target.sigma;
    const double residual = (simulated - target.measured) / sigma;
    table.rows.push_back(
        {{html_code(target.name), measured_text(target),
          html_number(simulated, 6) + " ± " + html_number(error, 2),
          HtmlCell(html_number(residual, 2), std::abs(residual) > 3 ? Verdict::bad : Verdict::none),
          target.held_out ? "held out: predicted" : "fitted"}});
  }
  if (table.rows.empty()) return;
  page.table(table);
  if (table.rows.size() > 3)
    page.figure(to_svg(residual_plot(account, nullptr)), "Residuals of the single values.", account.command);
}

void add_curves(const FitAccount& account, HtmlPage& page) {
  for (const FitCurve& curve : account.curves) {
    page.figure(to_svg(curve_plot(account, curve)), "Measured and simulated.", account.command);
    page.figure(to_svg(residual_plot(account, &curve)),
                "What is left. Residuals that go up and down together say that the model lacks something.",
                account.command);
  }
}

void add_correlations(const FitAccount& account, HtmlPage& page) {
  const auto& parameters = account.problem.parameters;
  if (parameters.size() < 2) return;
  HtmlTable table{
      "Correlations of the estimates: near 1 or -1, one can make up for the other.", {{"Parameter"}}, {}};
  for (const FitParameter& parameter : parameters)
    table.columns.push_back({html_code(parameter.name), Align::right});
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    HtmlRow row{{html_code(parameters[i].name)}};
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const double value = account.result.correlation[i][j];
      row.cells.push_back(HtmlCell(fmt::format("{:.3f}", value),
                                   i != j && std::abs(value) > 0.95 ? Verdict::warn : Verdict::none));
    }
    table.rows.push_back(row);
  }
  page.table(table);
}

void add_directions(const FitAccount& account, HtmlPage& page) {
  HtmlTable table{
      "Combinations of the parameters, from the best seen to the least: how far the residuals move, "
      "in sigmas, for a step of 1 in the coordinates (a factor of 2.7, or the whole range), and how "
      "sure that makes the combination.",
      {{"Combination"}, {"Singular value", Align::right}, {"Standard deviation", Align::right}, {"Seen"}},
      {}};
  for (const FitDirection& direction : account.result.directions) {
    const double deviation = account.result.error_scale / direction.singular_value;
    table.rows.push_back(
        {{direction.words, html_number(direction.singular_value),
          deviation < 1e6 ? html_number(deviation, 2) : HtmlText("no bound"),
          HtmlCell(direction.seen ? "yes" : "no", direction.seen ? Verdict::none : Verdict::bad)}});
  }
  page.table(table);
}

HtmlText values_text(const std::vector<double>& values) {
  HtmlText text;
  for (const double value : values)
    text = text.empty() ? html_number(value, 4) : text + ", " + html_number(value, 4);
  return text;
}

void add_descents(const FitAccount& account, HtmlPage& page) {
  HtmlTable table{"Descents, from the lowest end up.",
                  {{"Start"}, {"End"}, {"Chi squared", Align::right}, {"Status"}, {"Runs", Align::right}},
                  {}};
  for (const FitDescent& descent : account.result.descents)
    table.rows.push_back(
        {{values_text(descent.start), values_text(descent.end), html_number(descent.chi_squared, 4),
          name_of(descent.status), std::to_string(descent.evaluations)}});
  page.table(table);
}

void add_rule(HtmlPage& page) {
  page.heading("When a parameter is identified", 3);
  page.list(
      {"The fit has converged.",
       fmt::format(
           "It has no part (a component of {} or more) in a combination whose standard deviation is above "
           "{}, a factor of 2.7 or the whole range.",
           smallest_part, largest_seen_deviation),
       "Its value is not at a bound.",
       fmt::format(
           "Its standard error is below {:.0f} % of its value and below {:.3g} % of its range, both in the "
           "coordinate of the fit.",
           100 * largest_relative_error, 100 * largest_part_of_range),
       "No other descent ended elsewhere with a chi squared less than 4 above the best."});
}

}  // namespace

std::string fit_page(const FitAccount& account) {
  const FitResult& result = account.result;
  HtmlPage page("Identified: " + account.title,
                "Parameters from measured values: the best ones, how sure they are, and what the data cannot "
                "tell.");
  page.notice(conclusion_of(result, account.problem.parameters),
              result.all_identified() ? Verdict::good : Verdict::warn);
  for (const std::string& caution : result.cautions) page.notice(caution, Verdict::warn);
  page.heading("Parameters");
  add_parameters(account, page);
  if (!result.simulated.empty()) {
    page.heading("Measured and simulated");
    add_curves(account, page);
    add_single_targets(account, page);
    page.heading("What the data can tell");
    add_directions(account, page);
    add_correlations(account, page);
    add_rule(page);
  }
  page.heading("How it was made");
  if (!result.descents.empty()) add_descents(account, page);
  page.facts(
      {{"Method", account.options.method == FitMethod::derivative_free
                      ? "Subplex, without derivatives (Rowan 1990; NLopt)"
                      : "Levenberg-Marquardt in the parameters' logarithms, slopes by central differences"},
       {"Chi squared",
        html_number(result.chi_squared, 5) + fmt::format(", {} degrees of freedom", result.degrees)},
       {"Runs", fmt::format("{}, of which {} failed", result.evaluations, result.failed)},
       {"Time taken", fmt::format("{:.3g} s", account.wall)}});
  page.machine_facts();
  return page.to_html();
}

}  // namespace cloth
