#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/fit_report.h"
#include "io/json_entry.h"
#include "io/json_locator.h"
#include "io/json_syntax.h"
#include "io/text_file.h"
#include "params/parameter.h"

namespace cloth {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double most_runs = 1e9;

/// `otherwise` stands for what JSON has no number for.
double number_of(const JsonEntry& entry, double otherwise) {
  return entry.is_null() ? otherwise : entry.number();
}

/// One of a list of names, as its index.
template <class Choice, std::size_t count>
Choice choice_of(const JsonEntry& entry, const char* const (&names)[count]) {
  const std::string text = entry.text();
  const auto found = std::find(std::begin(names), std::end(names), text);
  if (found == std::end(names))
    throw entry.bad(fmt::format("must be one of {}", fmt::join(std::begin(names), std::end(names), ", ")));
  return static_cast<Choice>(found - std::begin(names));
}

void read_parameter(const JsonEntry& entry, FitAccount& account) {
  FitParameter& asked = account.problem.parameters.emplace_back();
  asked.name = entry.at("path").text();
  asked.unit = entry.at("unit").text();
  const std::vector<JsonEntry> bounds = entry.at("bounds").entries();
  if (bounds.size() != 2 || !(bounds[0].number() < bounds[1].number()))
    throw entry.at("bounds").bad("must be two ascending numbers");
  asked.low = bounds[0].number(), asked.high = bounds[1].number();
  asked.scale = asked.low > 0 ? FitScale::logarithmic : FitScale::linear;
  FittedParameter& found = account.result.parameters.emplace_back();
  found.value = number_of(entry.at("value"), no_value);
  found.standard_error = number_of(entry.at("standard_error"), infinity);
  found.low = number_of(entry.at("low"), no_value);
  found.high = number_of(entry.at("high"), no_value);
  found.verdict = choice_of<FitVerdict>(entry.at("verdict"), fit_verdict_names);
  found.why = entry.at("why").text();
}

/// Targets with a place are points of the curve of their name.
void read_target(const JsonEntry& entry, FitAccount& account) {
  const std::size_t index = account.problem.targets.size();
  FitTarget& target = account.problem.targets.emplace_back();
  target.name = entry.at("target").text();
  target.unit = entry.at("unit").text();
  target.measured = entry.at("measured").number();
  target.sigma = entry.at("sigma").number();
  if (!(target.sigma > 0)) throw entry.at("sigma").bad("must be more than 0");
  target.held_out = entry.at("held_out").flag();
  if (entry.has("simulated")) {
    account.result.simulated.push_back(number_of(entry.at("simulated"), no_value));
    account.result.simulated_error.push_back(number_of(entry.at("simulated_error"), infinity));
  }
  if (account.result.simulated.size() != (account.result.simulated.empty() ? 0 : index + 1))
    throw entry.bad("must have a simulated value where others have one");
  if (!entry.has("at")) return;
  auto& curves = account.curves;
  auto curve = std::find_if(curves.begin(), curves.end(),
                            [&](const FitCurve& known) { return known.name == target.name; });
  if (curve == curves.end())
    curve = curves.insert(curves.end(), {.name = target.name,
                                         .x = {.label = "time", .unit = "s"},
                                         .y = {.label = target.name, .unit = target.unit}});
  curve->targets.push_back(index);
  curve->at.push_back(entry.at("at").number());
}

FitAccount account_from(const JsonEntry& root) {
  if (root.at("format").text() != fit_format)
    throw root.at("format").bad(fmt::format("must be \"{}\"", fit_format));
  FitAccount account{.title = root.at("title").text(), .command = root.at("command").text()};
  FitResult& result = account.result;
  account.options.method = choice_of<FitMethod>(root.at("method"), fit_method_names);
  result.status = choice_of<FitStatus>(root.at("status"), fit_status_names);
  for (const JsonEntry& entry : root.at("parameters").entries()) read_parameter(entry, account);
  for (const JsonEntry& entry : root.at("targets").entries()) read_target(entry, account);
  account.problem.sigmas_known = !root.has("sigmas_known") || root.at("sigmas_known").flag();
  result.chi_squared = number_of(root.at("chi_squared"), infinity);
  result.degrees = root.at("degrees_of_freedom").whole<int>(-most_runs, most_runs);
  result.error_scale = number_of(root.at("error_scale"), no_value);
  result.cautions = root.at("cautions").texts();
  result.evaluations = root.at("runs").whole<std::size_t>(0, most_runs);
  result.failed = root.at("failed_runs").whole<std::size_t>(0, most_runs);
  return account;
}

}  // namespace

FitReading read_fit(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / fit_index_name;
  std::string text;
  if (const auto error = read_text_file(file, text)) return {std::nullopt, error->text()};
  if (const auto problem = syntax_problem(text, file.string())) return {std::nullopt, problem->text()};
  try {
    const auto json = nlohmann::ordered_json::parse(text);
    return {account_from(JsonEntry(json)), {}};
  } catch (BadJsonEntry& bad) {
    locate_json(text).put_in_place(bad.problem, file.string());
    return {std::nullopt, bad.problem.text()};
  }
}

}  // namespace cloth
