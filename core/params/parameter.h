// The declaration of a parameter. Forms, JSON, the JSON Schema, `--set`, chart labels and the reference page
// are made from it; no other code repeats a parameter's unit, range or wording.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace cloth {

using Vec3 = Eigen::Vector3d;
using Words = std::vector<std::string>;

/// A key under a dotted path: "cloth" and "rows" are "cloth.rows"; under none it is the path itself.
inline std::string joined_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// number -> double, integer -> int64, vector -> Vec3, choice/text -> string, words -> Words.
using ParameterValue = std::variant<double, std::int64_t, Vec3, std::string, Words>;

enum class Kind { number, integer, vector, choice, words, text };
enum class Scale { linear, logarithmic };

/// Whether an edit acts on the running simulation at its next step or needs a new start.
enum class EditCost { live, restart };

inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct ParameterInfo {
  std::string key{};      ///< last part of the dotted path
  std::string label{};    ///< in a form or on an axis, sentence case
  std::string unit{};     ///< SI, empty for a pure number
  std::string doc{};      ///< one sentence: what it means
  std::string formula{};  ///< optional: where it enters the model
  Kind kind = Kind::number;
  EditCost cost = EditCost::live;
  Scale scale = Scale::linear;
  double minimum = -infinity;  ///< accepted values, per component for vectors
  double maximum = infinity;
  bool minimum_excluded = false;  ///< value > minimum rather than >=
  double largest = infinity;      ///< physical bound on the magnitude; that of the unit if not declared
  double smallest = 0;            ///< likewise, of values that may not be 0: where minimum is an excluded 0
  bool unit_vector = false;       ///< a direction: any length but zero, normalised when used
  double slider_minimum = 0;      ///< the range of the form's slider, 0 to 1 unless declared
  double slider_maximum = 1;
  bool auto_allowed = false;           ///< the word "auto" is a value too
  std::vector<std::string> choices{};  ///< Kind::choice
  std::vector<Words> word_sets{};      ///< Kind::words: the combinations that are allowed
};

/// The largest and smallest magnitudes that are accepted for a unit. Beyond them sums of squares, times and
/// numbers of steps could overflow doubles and integers. `smallest` applies to lengths, times and masses that
/// may not be 0; it is 0 for other units.
struct PhysicalBound {
  double largest, smallest;
};
PhysicalBound physical_bound(const std::string& unit);

/// `info` with the bound of its unit where it declares none itself.
ParameterInfo with_physical_bound(ParameterInfo info);

/// The rule that `value` breaks, in words ("must be >= 0"), or nothing.
std::optional<std::string> broken_rule(const ParameterInfo& info, const ParameterValue& value);

/// The range that is left within the physical bounds, as minimum and maximum; for schemas.
ParameterInfo within_physical_bounds(ParameterInfo info);

/// The accepted values in words, for tooltips and the reference page ("> 0", ">= 0 and <= 1", "any").
std::string range_text(const ParameterInfo& info);

/// A value with its unit, shortest form that reads back to the same number ("-3 N/m").
std::string value_text(const ParameterInfo& info, const ParameterValue& value);

/// A parameter of an Owner struct.
template <class Owner>
struct Field {
  ParameterInfo info;
  std::function<ParameterValue(const Owner&)> get;
  std::function<void(Owner&, const ParameterValue&)> set;
};

template <class Owner>
using Fields = std::vector<Field<Owner>>;

}  // namespace cloth
