// One number from a column of a record.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace cloth {

enum class ColumnReduction { final, max, min, mean };
/// As plans and options have it.
inline constexpr const char* column_reduction_names[] = {"final", "max", "min", "mean"};
inline const char* name_of(ColumnReduction reduction) {
  return column_reduction_names[static_cast<std::size_t>(reduction)];
}
inline std::optional<ColumnReduction> column_reduction_named(std::string_view name) {
  for (std::size_t k = 0; k < std::size(column_reduction_names); ++k)
    if (name == column_reduction_names[k]) return static_cast<ColumnReduction>(k);
  return std::nullopt;
}

/// The last value, the largest, the smallest, or the mean over time of the straight lines between the rows
/// (the last value where no time passes). nullopt without rows, and where a value that counts is not finite.
/// `time` ascends and has the size of `values`.
inline std::optional<double> reduced(std::span<const double> time, std::span<const double> values,
                                     ColumnReduction reduction) {
  if (values.empty() || !std::isfinite(values.back())) return std::nullopt;
  if (reduction == ColumnReduction::final) return values.back();
  double extreme = values.front(), integral = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) return std::nullopt;
    if (reduction == ColumnReduction::min ? values[k] < extreme : values[k] > extreme) extreme = values[k];
    if (k > 0) integral += (time[k] - time[k - 1]) * (values[k - 1] + values[k]) / 2;
  }
  if (reduction != ColumnReduction::mean) return extreme;
  const double passed = time.back() - time.front();
  return passed > 0 ? integral / passed : values.back();
}

/// At a time, on the straight line between the rows around it; outside of them the first or the last value.
inline std::optional<double> value_at(std::span<const double> time, std::span<const double> values,
                                      double at) {
  if (values.empty()) return std::nullopt;
  std::size_t k = 0;
  while (k < time.size() && time[k] < at) ++k;
  double value = values[k == time.size() ? k - 1 : k];
  if (k > 0 && k < time.size())
    value = values[k - 1] + (at - time[k - 1]) / (time[k] - time[k - 1]) * (values[k] - values[k - 1]);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace cloth
