#include "params/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

std::optional<std::string> broken_number_rule(const ParameterInfo& info, double value) {
  if (!std::isfinite(value)) return "must be a finite number";
  const bool low = info.minimum_excluded ? value <= info.minimum : value < info.minimum;
  if (low || value > info.maximum) return "must be " + range_text(info);
  return std::nullopt;
}

std::string quoted_list(const std::vector<std::string>& words) {
  return fmt::format("\"{}\"", fmt::join(words, "\", \""));
}

std::string words_text(const Words& words) {
  return words.empty() ? "[]" : fmt::format("[{}]", quoted_list(words));
}

struct RuleOf {
  const ParameterInfo& info;

  std::optional<std::string> operator()(double value) const { return broken_number_rule(info, value); }
  std::optional<std::string> operator()(std::int64_t value) const {
    return broken_number_rule(info, static_cast<double>(value));
  }
  std::optional<std::string> operator()(const Vec3& value) const {
    for (int axis = 0; axis < 3; ++axis)
      if (auto rule = broken_number_rule(info, value[axis])) return rule;
    if (info.unit_vector && !(value.norm() > 0)) return "must not be zero: it is a direction";
    return std::nullopt;
  }
  std::optional<std::string> operator()(const std::string& value) const {
    if (info.auto_allowed && value == "auto") return std::nullopt;
    if (info.kind == Kind::choice &&
        std::find(info.choices.begin(), info.choices.end(), value) == info.choices.end())
      return "must be one of " + quoted_list(info.choices);
    return std::nullopt;
  }
  std::optional<std::string> operator()(const Words& value) const {
    if (std::find(info.word_sets.begin(), info.word_sets.end(), value) != info.word_sets.end())
      return std::nullopt;
    std::vector<std::string> sets;
    for (const Words& set : info.word_sets) sets.push_back(words_text(set));
    return fmt::format("must be one of {}", fmt::join(sets, ", "));
  }
};

struct TextOf {
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(const Vec3& v) const { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }
  std::string operator()(const std::string& value) const { return fmt::format("\"{}\"", value); }
  std::string operator()(const Words& value) const { return words_text(value); }
};

}  // namespace

std::optional<std::string> broken_rule(const ParameterInfo& info, const ParameterValue& value) {
  return std::visit(RuleOf{info}, value);
}

std::string range_text(const ParameterInfo& info) {
  const bool below = info.minimum > -infinity, above = info.maximum < infinity;
  std::string text;
  if (below) text = fmt::format("{} {}", info.minimum_excluded ? ">" : ">=", info.minimum);
  if (above) text += fmt::format("{}<= {}", below ? " and " : "", info.maximum);
  return text.empty() ? "any finite number" : text;
}

std::string value_text(const ParameterInfo& info, const ParameterValue& value) {
  const std::string text = std::visit(TextOf{}, value);
  const bool has_unit = !info.unit.empty() && !std::holds_alternative<std::string>(value);
  return has_unit ? text + " " + info.unit : text;
}

}  // namespace cloth
