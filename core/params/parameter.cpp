#include "params/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace cloth {
namespace {

/// 4096, but 1e+09: zeros are not counted with ease.
std::string bound_text(double bound) {
  return std::abs(bound) < 1e7 ? fmt::format("{}", bound) : fmt::format("{:g}", bound);
}

/// The model's own range, without physical bounds.
std::string model_range_text(const ParameterInfo& info) {
  const bool below = info.minimum > -infinity, above = info.maximum < infinity;
  std::string text;
  if (below) text = fmt::format("{} {}", info.minimum_excluded ? ">" : ">=", bound_text(info.minimum));
  if (above) text += fmt::format("{}<= {}", below ? " and " : "", bound_text(info.maximum));
  return text.empty() ? "any finite number" : text;
}

bool has_smallest(const ParameterInfo& info) {
  return info.smallest > 0 && info.minimum_excluded && info.minimum == 0;
}

std::optional<std::string> broken_number_rule(const ParameterInfo& info, double value) {
  if (!std::isfinite(value)) return "must be a finite number";
  const bool low = info.minimum_excluded ? value <= info.minimum : value < info.minimum;
  if (low || value > info.maximum) return "must be " + model_range_text(info);
  constexpr const char* reason = ", or sums and numbers of steps could overflow";
  if (value > info.largest) return "must be <= " + bound_text(info.largest) + reason;
  if (value < -info.largest) return "must be >= " + bound_text(-info.largest) + reason;
  if (has_smallest(info) && value < info.smallest) return fmt::format("must be >= {}", info.smallest);
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

ParameterInfo within_physical_bounds(ParameterInfo info) {
  if (has_smallest(info)) info.minimum = info.smallest, info.minimum_excluded = false;
  info.minimum = std::max(info.minimum, -info.largest);
  info.maximum = std::min(info.maximum, info.largest);
  return info;
}

std::string range_text(const ParameterInfo& info) {
  return model_range_text(within_physical_bounds(info));
}

PhysicalBound physical_bound(const std::string& unit) {
  struct OfUnit {
    const char* unit;
    PhysicalBound bound;
  };
  static constexpr OfUnit all[] = {
      {"m", {1e9, 1e-9}},      {"s", {1e9, 1e-15}}, {"kg", {1e12, 1e-12}}, {"N/m", {1e15, 0}},
      {"N s/m", {1e12, 0}},    {"m/s", {1e8, 0}},   {"m/s^2", {1e9, 0}},   {"Hz", {1e9, 0}},
      {"rad", {1e6, 0}},       {"rad/s", {1e9, 0}}, {"deg", {1e9, 0}},     {"", {1e9, 0}},
      {"kg/m^2", {1e9, 1e-9}}, {"N m", {1e15, 0}},  {"N", {1e15, 0}},      {"J", {1e15, 0}},
      {"N s/m^3", {1e12, 0}},  {"1/s", {1e9, 0}},
  };
  const auto found =
      std::find_if(std::begin(all), std::end(all), [&](const OfUnit& known) { return unit == known.unit; });
  assert(found != std::end(all) && "a unit needs its physical bound");
  return found == std::end(all) ? PhysicalBound{0, 0} : found->bound;  // accepts nothing, as tests would find
}

ParameterInfo with_physical_bound(ParameterInfo info) {
  if (info.kind == Kind::choice || info.kind == Kind::words || info.kind == Kind::text) return info;
  const PhysicalBound bound = physical_bound(info.unit);
  if (info.largest == infinity) info.largest = bound.largest;
  if (info.smallest == 0) info.smallest = bound.smallest;
  return info;
}

std::string value_text(const ParameterInfo& info, const ParameterValue& value) {
  const std::string text = std::visit(TextOf{}, value);
  const bool has_unit = !info.unit.empty() && !std::holds_alternative<std::string>(value);
  return has_unit ? text + " " + info.unit : text;
}

}  // namespace cloth
