#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/table_reader.h"
#include "io/text_file.h"
#include "params/quantity.h"
#include "scene/scene_parameters.h"
#include "simulation/recorder.h"
#include "study/identify/identify.h"
#include "study/run_output.h"
#include "study/study_axis.h"

namespace cloth {
namespace {

constexpr double usual_factor = 10;  // of the scene's value, to each side

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == by)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// The number that the scene has at a path, with its declaration; or what is wrong.
struct SceneNumber {
  double value = 0;
  ParameterInfo info{};
};
std::variant<SceneNumber, std::string> number_at(const Scene& scene, const std::string& path) {
  const std::string at = path == all_stiffnesses_path ? "springs.structural" : path;
  const auto parameter = find_parameter(scene, at);
  if (!parameter) return "is not a parameter that this scene has";
  const ParameterValue value = parameter->get(scene);
  if (const double* number = std::get_if<double>(&value)) return SceneNumber{*number, parameter->info};
  if (const auto* number = std::get_if<std::int64_t>(&value))
    return SceneNumber{static_cast<double>(*number), parameter->info};
  return "is not a number in this scene";
}

/// The range that is asked for, or the usual one around the value; "" or the rule that is broken.
std::string choose_range(const std::vector<std::string>& parts, const SceneNumber& number,
                         VariedParameter& varied) {
  if (parts.size() == 3) {
    for (const auto& [text, end] : {std::pair{parts[1], &varied.low}, {parts[2], &varied.high}}) {
      const Quantity quantity = quantity_from(text, number.info.unit);
      if (!quantity.ok()) return text + ": " + quantity.rule;
      *end = quantity.value;
    }
  } else {
    if (!(number.value > 0)) return "has no value above 0 to take a range around: give one, PATH:LOW:HIGH";
    const ParameterInfo bounds = within_physical_bounds(number.info);
    varied.low = std::max(number.value / usual_factor, bounds.minimum);
    varied.high = std::min(number.value * usual_factor, bounds.maximum);
  }
  return varied.low < varied.high ? "" : "its range must go up";
}

/// Where the standard deviation begins, and how long the sign before it is.
std::pair<std::size_t, std::size_t> sigma_sign(const std::string& text) {
  for (const char* sign : {"±", "+-", "+/-"})
    if (const std::size_t at = text.find(sign); at != std::string::npos)
      return {at, std::string(sign).size()};
  return {std::string::npos, 0};
}

std::string unknown_column(const Scene& scene) {
  return fmt::format("must be one of {}, alone or with {}", fmt::join(output_sources(scene), ", "),
                     fmt::join(output_endings(), ", "));
}

/// The value and its standard deviation; "" or the rule that is broken.
std::string read_measured(const std::string& text, ColumnTarget& target) {
  const std::string unit = unit_of_output(target.column);
  const auto [sign, length] = sigma_sign(text);
  const Quantity value = quantity_from(text.substr(0, sign), unit);
  if (!value.ok()) return value.rule;
  target.measured = value.value;
  if (sign == std::string::npos) return "";
  const Quantity sigma = quantity_from(text.substr(sign + length), unit);
  if (!sigma.ok()) return "its standard deviation " + sigma.rule;
  if (!(sigma.value > 0)) return "its standard deviation must be above 0";
  target.sigma = sigma.value;
  return "";
}

/// The columns that have names of the record, with their standard deviations.
std::vector<FittedCurve> curves_of(TableReader& table, const CsvTable& csv, const Scene& scene) {
  const std::vector<std::string> known = output_sources(scene);
  const std::vector<double> times = table.column("time_s");
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (times[k] < 0 || times[k] > scene.duration * (1 + 1e-9))
      table.add("time_s", fmt::format("{} s", times[k]),
                fmt::format("must be from 0 to the scene's duration, {} s", scene.duration), k);
    if (k > 0 && times[k] <= times[k - 1])
      table.add("time_s", fmt::format("{} s", times[k]), "must be after the one before", k);
  }
  std::vector<FittedCurve> curves;
  for (const std::string& name : csv.header) {
    const bool is_sigma =
        name.ends_with("_sigma") &&
        std::find(csv.header.begin(), csv.header.end(), name.substr(0, name.size() - 6)) != csv.header.end();
    if (name == "time_s" || is_sigma) continue;
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      table.add(name, "", fmt::format("must be one of {}", fmt::join(known, ", ")));
      continue;
    }
    FittedCurve curve{.column = name, .times = times, .values = table.column(name)};
    if (table.has(name + "_sigma")) curve.sigmas = table.column(name + "_sigma");
    for (std::size_t k = 0; k < curve.sigmas.size(); ++k)
      if (!(curve.sigmas[k] > 0))
        table.add(name + "_sigma", fmt::format("{}", curve.sigmas[k]), "must be above 0", k);
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace

std::variant<VariedParameter, Problem> parse_vary(const std::string& text, const Scene& scene) {
  const std::vector<std::string> parts = split(text, ':');
  const auto problem = [&](const std::string& rule) {
    return Problem{.path = parts[0], .value = "", .rule = rule, .place = "--vary"};
  };
  if (parts.size() != 1 && parts.size() != 3) return problem("must be PATH or PATH:LOW:HIGH");
  const auto found = number_at(scene, parts[0]);
  if (const auto* rule = std::get_if<std::string>(&found)) return problem(*rule);
  const auto& number = std::get<SceneNumber>(found);
  VariedParameter varied{.path = parts[0], .unit = number.info.unit};
  varied.is_whole = number.info.kind == Kind::integer;
  if (const std::string rule = choose_range(parts, number, varied); !rule.empty()) return problem(rule);
  for (const double end : {varied.low, varied.high}) {
    Scene changed = scene;
    if (auto broken = set_number(changed, varied.path, end, "--vary")) return *broken;
  }
  varied.start = std::clamp(number.value, varied.low, varied.high);
  return varied;
}

std::variant<ColumnTarget, Problem> parse_target(const std::string& text, const Scene& scene,
                                                 const std::string& option) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto problem = [&](const std::string& rule) {
    return Problem{.path = name, .value = "", .rule = rule, .place = option};
  };
  if (equals == std::string::npos)
    return problem("must be SOURCE=VALUE or SOURCE:max=VALUE (:min, :mean), each also with ±SIGMA");
  const RunOutput output = parse_output(name);
  ColumnTarget target{.column = output.of, .over = output.reduce};
  const std::vector<std::string> known = output_sources(scene);
  if (std::find(known.begin(), known.end(), target.column) == known.end())
    return problem(unknown_column(scene));
  if (const std::string rule = read_measured(text.substr(equals + 1), target); !rule.empty())
    return problem(rule);
  return target;
}

std::variant<std::vector<FittedCurve>, std::vector<Problem>> read_curves(const std::string& file,
                                                                         const Scene& scene) {
  std::string text;
  if (const auto error = read_text_file(file, text))
    return std::vector{Problem{.path = "", .value = "", .rule = error->message, .place = file}};
  const CsvTable csv = parse_csv(text);
  std::vector<Problem> problems;
  TableReader table(csv, file, problems);
  if (!table.is_whole()) return problems;
  if (!table.has("time_s")) {
    table.add("", "", "must have a column time_s, and columns with names of the record");
    return problems;
  }
  std::vector<FittedCurve> curves = curves_of(table, csv, scene);
  if (curves.empty() && problems.empty()) table.add("", "", "has no column beside time_s");
  if (!problems.empty()) return problems;
  return curves;
}

}  // namespace cloth
