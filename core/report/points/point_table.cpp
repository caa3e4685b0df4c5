#include "report/points/point_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/plot_parts.h"

namespace cloth {
namespace {

/// From 1 on; equal values share the mean of theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return values[i] < values[k]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = (static_cast<double>(i + end) + 1) / 2;
    i = end;
  }
  return ranks;
}

/// Pearson's.
double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  const auto count = static_cast<double>(a.size());
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i] / count, mean_b += b[i] / count;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a[i] - mean_a, y = b[i] - mean_b;
    aa += x * x, bb += y * y, ab += x * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool PointTable::failed(std::size_t row) const {
  return std::any_of(columns.begin(), columns.end(), [row](const PointColumn& column) {
    return column.is_output && !std::isfinite(column.values[row]);
  });
}

std::size_t PointTable::failures() const {
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows(); ++row) count += failed(row) ? 1 : 0;
  return count;
}

std::vector<std::size_t> PointTable::columns_that(bool are_outputs) const {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].is_output == are_outputs) found.push_back(c);
  return found;
}

std::string PointTable::text_of(std::size_t row) const {
  std::string text = row < notes.size() ? notes[row] : "run " + std::to_string(row + 1);
  for (const PointColumn& column : columns)
    text += "\n" + (std::isfinite(column.values[row]) ? value_line(column.axis, column.values[row])
                                                      : column.axis.label + ": no value");
  return text;
}

std::vector<std::size_t> PointTable::some_rows(std::size_t most) const {
  std::vector<std::size_t> some;
  const std::size_t all = rows(), count = std::min(all, most);
  for (std::size_t k = 0; k < count; ++k) some.push_back(k * all / count);
  return some;
}

AxisMap map_of(const PointColumn& column, double from, double to) {
  return AxisMap(column.axis, column.values, from, to);
}

std::vector<std::string> column_title(const PointColumn& column, double width) {
  return wrapped(axis_title(column.axis, map_of(column, 0, 1).tick_exponent()), small_size, width);
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) x.push_back(a[i]), y.push_back(b[i]);
  if (x.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return correlation_of(ranks_of(x), ranks_of(y));
}

}  // namespace cloth
