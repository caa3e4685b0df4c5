#include "study/study_axis.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "scene/scene_cloth.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

template <class Number>
bool read(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && !text.empty();
}

/// The rule that the axis' own numbers break, or nothing.
std::string broken_axis_rule(const StudyAxis& axis) {
  if (!std::isfinite(axis.low) || !std::isfinite(axis.high)) return "must have finite ends";
  if (!(axis.low < axis.high)) return "must begin below its end";
  if (axis.scale == AxisScale::logarithmic && !(axis.low > 0))
    return "must begin above 0 where it is logarithmic";
  if (axis.count < 2 || axis.count > max_axis_values)
    return fmt::format("must have 2 to {} values", max_axis_values);
  return {};
}

std::optional<Problem> scale_stiffnesses(Scene& scene, double value, const std::string& option) {
  const Problem problem{
      .path = all_stiffnesses_path, .value = fmt::format("{} N/m", value), .rule = {}, .place = option};
  const auto broken = [&](const char* rule) {
    Problem found = problem;
    found.rule = rule;
    return found;
  };
  if (!(value >= 0)) return broken("must be >= 0");
  const double present = leading_stiffness(scene);
  if (!(present > 0)) return broken("needs a scene with structural springs or a material that stretches");
  scale_stiffness(scene, value / present);
  (scene.material ? scene.material->stretch_warp : scene.springs->structural) = value;  // without rounding
  return std::nullopt;
}

}  // namespace

std::variant<StudyAxis, Problem> parse_axis(const std::string& text, const std::string& option) {
  const Problem malformed{.path = {},
                          .value = {},
                          .rule = text +
                                  ": must be PATH=LOW:HIGH:COUNT or PATH=LOW:HIGH:COUNT:log, for example "
                                  "springs.structural=10:1000:12:log",
                          .place = option};
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return malformed;
  StudyAxis axis{.path = text.substr(0, equals)};
  const std::vector<std::string> parts = parts_of(text.substr(equals + 1), ':');
  if (parts.size() < 3 || parts.size() > 4) return malformed;
  if (!read(parts[0], axis.low) || !read(parts[1], axis.high) || !read(parts[2], axis.count))
    return malformed;
  if (parts.size() == 4) {
    if (parts[3] != "log" && parts[3] != "lin") return malformed;
    if (parts[3] == "log") axis.scale = AxisScale::logarithmic;
  }
  const std::string rule = broken_axis_rule(axis);
  if (!rule.empty())
    return Problem{
        .path = axis.path, .value = text.substr(equals + 1), .rule = "the axis " + rule, .place = option};
  return axis;
}

std::vector<double> values_of(const StudyAxis& axis) {
  std::vector<double> values;
  for (int k = 0; k < axis.count; ++k) {
    const double t = static_cast<double>(k) / (axis.count - 1);
    values.push_back(axis.scale == AxisScale::logarithmic ? axis.low * std::pow(axis.high / axis.low, t)
                                                          : axis.low + t * (axis.high - axis.low));
  }
  values.front() = axis.low;
  values.back() = axis.high;
  return values;
}

Axis plot_axis(const StudyAxis& axis, const Scene& scene) {
  if (axis.path == all_stiffnesses_path)
    return {.label = scene.material ? "Stretch stiffness along the warp, others in proportion"
                                    : "Structural stiffness, others in proportion",
            .unit = "N/m",
            .scale = axis.scale};
  const auto parameter = find_parameter(scene, axis.path);
  if (!parameter) return {.label = axis.path, .scale = axis.scale};
  return {.label = parameter->info.label, .unit = parameter->info.unit, .scale = axis.scale};
}

std::optional<Problem> set_number(Scene& scene, const std::string& path, double value,
                                  const std::string& option) {
  if (path == all_stiffnesses_path) return scale_stiffnesses(scene, value, option);
  const auto parameter = find_parameter(scene, path);
  if (!parameter)
    return Problem{
        .path = path, .value = {}, .rule = "is not a parameter that this scene has", .place = option};
  const ParameterInfo& info = parameter->info;
  if (info.kind != Kind::number && info.kind != Kind::integer)
    return Problem{.path = path, .value = {}, .rule = "is not a number", .place = option};
  const ParameterValue typed =
      info.kind == Kind::integer ? ParameterValue(std::int64_t(std::llround(value))) : ParameterValue(value);
  if (const auto rule = broken_rule(info, typed))
    return Problem{.path = path, .value = value_text(info, typed), .rule = *rule, .place = option};
  parameter->set(scene, typed);
  return std::nullopt;
}

}  // namespace cloth
