#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/fit_report.h"
#include "io/csv.h"
#include "params/quantity.h"
#include "report/text_table.h"

namespace cloth {
namespace {

using Json = nlohmann::ordered_json;

/// null where it is no number, as JSON has none.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

/// As many digits as the error leaves sure, and two of the error's.
std::string value_and_error(const FittedParameter& parameter, const std::string& unit) {
  if (!std::isfinite(parameter.value)) return "none";
  if (!std::isfinite(parameter.standard_error) || !(parameter.standard_error > 0))
    return with_unit(shown_number(parameter.value, 5), unit);
  const double size = std::max(std::abs(parameter.value), parameter.standard_error);
  const int digits =
      2 + static_cast<int>(std::floor(std::log10(size)) - std::floor(std::log10(parameter.standard_error)));
  return with_unit(fmt::format("{} ± {}", shown_number(parameter.value, std::min(digits, 9)),
                               shown_number(parameter.standard_error, 2)),
                   unit);
}

double residual_of(const FitAccount& account, std::size_t t) {
  const FitTarget& target = account.problem.targets[t];
  return (account.result.simulated[t] - target.measured) / target.sigma;
}

/// Its x in the curve that it is a point of; not a number without one.
double place_of(const FitAccount& account, std::size_t t) {
  for (const FitCurve& curve : account.curves)
    for (std::size_t k = 0; k < curve.targets.size(); ++k)
      if (curve.targets[k] == t) return curve.at[k];
  return NAN;
}

TextTable parameter_table(const FitAccount& account) {
  TextTable table{{{"Parameter"}, {"Value"}, {"Two standard errors"}, {"Verdict"}}, {}};
  for (std::size_t j = 0; j < account.problem.parameters.size(); ++j) {
    const FitParameter& parameter = account.problem.parameters[j];
    const FittedParameter& found = account.result.parameters[j];
    table.rows.push_back(
        {parameter.name, value_and_error(found, parameter.unit),
         found.verdict == FitVerdict::unseen || found.verdict == FitVerdict::not_fitted
             ? ""
             : with_unit(shown_number(found.low, 4) + " to " + shown_number(found.high, 4), parameter.unit),
         name_of(found.verdict)});
  }
  return table;
}

TextTable target_table(const FitAccount& account) {
  TextTable table{
      {{"Target"}, {"Measured", true}, {"Sigma", true}, {"Simulated", true}, {"In sigmas", true}, {""}}, {}};
  for (std::size_t t = 0; t < account.result.simulated.size(); ++t) {
    const FitTarget& target = account.problem.targets[t];
    if (std::isfinite(place_of(account, t))) continue;
    table.rows.push_back({target.name, with_unit(shown_number(target.measured, 6), target.unit),
                          shown_number(target.sigma, 3), shown_number(account.result.simulated[t], 6),
                          fmt::format("{:+.2f}", residual_of(account, t)),
                          target.held_out ? "held out" : ""});
  }
  return table;
}

Json parameters_json(const FitAccount& account) {
  Json all = Json::array();
  for (std::size_t j = 0; j < account.problem.parameters.size(); ++j) {
    const FitParameter& parameter = account.problem.parameters[j];
    const FittedParameter& found = account.result.parameters[j];
    all.push_back({{"path", parameter.name},
                   {"unit", parameter.unit},
                   {"value", number_or_null(found.value)},
                   {"standard_error", number_or_null(found.standard_error)},
                   {"low", number_or_null(found.low)},
                   {"high", number_or_null(found.high)},
                   {"bounds", {parameter.low, parameter.high}},
                   {"verdict", name_of(found.verdict)},
                   {"why", found.why}});
  }
  return all;
}

Json targets_json(const FitAccount& account) {
  Json all = Json::array();
  for (std::size_t t = 0; t < account.problem.targets.size(); ++t) {
    const FitTarget& target = account.problem.targets[t];
    Json one{{"target", target.name},
             {"unit", target.unit},
             {"measured", target.measured},
             {"sigma", target.sigma},
             {"held_out", target.held_out}};
    if (const double at = place_of(account, t); std::isfinite(at)) one["at"] = at;
    if (t < account.result.simulated.size()) {
      one["simulated"] = number_or_null(account.result.simulated[t]);
      one["simulated_error"] = number_or_null(account.result.simulated_error[t]);
    }
    all.push_back(one);
  }
  return all;
}

/// Everything that is known, as JSON.
Json whole_json(const FitAccount& account) {
  const FitResult& result = account.result;
  Json directions = Json::array(), descents = Json::array();
  for (const FitDirection& direction : result.directions)
    directions.push_back({{"singular_value", number_or_null(direction.singular_value)},
                          {"direction", direction.direction},
                          {"seen", direction.seen},
                          {"words", direction.words}});
  for (const FitDescent& descent : result.descents)
    descents.push_back({{"status", name_of(descent.status)},
                        {"start", descent.start},
                        {"end", descent.end},
                        {"chi_squared", number_or_null(descent.chi_squared)},
                        {"runs", descent.evaluations}});
  return {{"format", fit_format},
          {"title", account.title},
          {"command", account.command},
          {"method", name_of(account.options.method)},
          {"status", name_of(result.status)},
          {"identified", result.all_identified()},
          {"parameters", parameters_json(account)},
          {"targets", targets_json(account)},
          {"sigmas_known", account.problem.sigmas_known},
          {"chi_squared", number_or_null(result.chi_squared)},
          {"degrees_of_freedom", result.degrees},
          {"error_scale", result.error_scale},
          {"correlation", result.correlation},
          {"directions", directions},
          {"descents", descents},
          {"cautions", result.cautions},
          {"runs", result.evaluations},
          {"failed_runs", result.failed}};
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string conclusion_of(const FitResult& result, const std::vector<FitParameter>& parameters) {
  if (result.status == FitStatus::no_start) return "The model has no value at any of the starts.";
  if (result.status == FitStatus::stopped) return "The fit was stopped before its end.";
  std::vector<std::string> known, others;
  for (std::size_t j = 0; j < parameters.size(); ++j)
    (result.parameters[j].verdict == FitVerdict::identified ? known : others).push_back(parameters[j].name);
  if (others.empty()) return "The data identify " + fmt::format("{}.", fmt::join(known, ", "));
  if (known.empty()) return "The data identify none of the parameters.";
  return fmt::format("The data identify {}, but not {}.", fmt::join(known, ", "), fmt::join(others, ", "));
}

std::string fit_text(const FitAccount& account) {
  const FitResult& result = account.result;
  std::string text = to_text(parameter_table(account));
  const TextTable targets = target_table(account);
  if (!targets.rows.empty()) text += "\n" + to_text(targets);
  text += "\n" + conclusion_of(result, account.problem.parameters) + "\n";
  for (std::size_t j = 0; j < result.parameters.size(); ++j)
    if (const std::string& why = result.parameters[j].why; !why.empty())
      text += account.problem.parameters[j].name + ": " + why + "\n";
  for (const std::string& caution : result.cautions) text += caution + "\n";
  text += fmt::format("{} runs, {} failed", result.evaluations, result.failed);
  if (result.degrees > 0)
    text +=
        fmt::format("; chi squared {:.4g} with {} degrees of freedom", result.chi_squared, result.degrees);
  return text + "\n";
}

std::string fit_json(const FitAccount& account) {
  return text_of(whole_json(account));
}

std::string fit_index(const FitAccount& account, const std::vector<FileDigest>& files) {
  Json json{{"program", "clothlab"}, {"kind", "identify"}};
  json.update(whole_json(account));
  json["files"] = digests_json(files);
  return text_of(json);
}

std::string parameters_csv(const FitAccount& account) {
  CsvTable table{{"parameter", "unit", "value", "low", "high", "standard_error", "verdict"}, {}};
  for (std::size_t j = 0; j < account.problem.parameters.size(); ++j) {
    const FittedParameter& found = account.result.parameters[j];
    table.rows.push_back({account.problem.parameters[j].name, account.problem.parameters[j].unit,
                          csv_number(found.value), csv_number(found.low), csv_number(found.high),
                          csv_number(found.standard_error), name_of(found.verdict)});
  }
  return csv_text(table, "\n");
}

std::string targets_csv(const FitAccount& account) {
  CsvTable table{
      {"target", "unit", "at", "measured", "sigma", "simulated", "simulated_error", "residual", "held_out"},
      {}};
  for (std::size_t t = 0; t < account.result.simulated.size(); ++t) {
    const FitTarget& target = account.problem.targets[t];
    const double at = place_of(account, t);
    table.rows.push_back({target.name, target.unit, std::isfinite(at) ? csv_number(at) : "",
                          csv_number(target.measured), csv_number(target.sigma),
                          csv_number(account.result.simulated[t]),
                          csv_number(account.result.simulated_error[t]), csv_number(residual_of(account, t)),
                          target.held_out ? "1" : "0"});
  }
  return csv_text(table, "\n");
}

}  // namespace cloth
