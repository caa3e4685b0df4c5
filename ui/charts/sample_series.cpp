#include "charts/sample_series.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace clothlab {

SampleSeries::SampleSeries(std::size_t columns, std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 64)), columns_(columns) {
  assert(columns > 0 && capacity < no_row);
}

bool SampleSeries::append(double time_s, std::span<const double> values) {
  assert(values.size() == columns_.size());
  if (!std::isfinite(time_s) || (!times_.empty() && time_s < times_.back())) return false;
  if (times_.size() >= capacity_) thin_older_half();
  const std::size_t row = times_.size();
  times_.push_back(time_s);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    columns_[c].values.push_back(values[c]);
    add_to_pyramid(columns_[c], row);
  }
  return true;
}

void SampleSeries::clear() {
  times_.clear();
  for (Column& column : columns_) {
    column.values.clear();
    for (auto& level : column.pyramid) level.clear();
  }
}

void SampleSeries::drop_after(double time_s) {
  const std::size_t rows = upper_bound(time_s);
  if (rows == size()) return;
  times_.resize(rows);
  for (Column& column : columns_) shorten(column, rows);
}

/// Whole blocks stay; the last one of each level is made again from the rows that it keeps.
void SampleSeries::shorten(Column& column, std::size_t rows) {
  column.values.resize(rows);
  std::size_t width = 1;
  for (auto& level : column.pyramid) {
    width *= fanout;
    level.resize((rows + width - 1) / width);
    if (rows % width == 0) continue;
    level.back() = Node{};
    for (std::size_t row = rows / width * width; row < rows; ++row) add_row(column, row, level.back());
  }
}

std::size_t SampleSeries::lower_bound(double time_s) const {
  return static_cast<std::size_t>(std::lower_bound(times_.begin(), times_.end(), time_s) - times_.begin());
}

std::size_t SampleSeries::upper_bound(double time_s) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time_s) - times_.begin());
}

std::size_t SampleSeries::nearest(double time_s) const {
  assert(!times_.empty());
  const std::size_t after = lower_bound(time_s);
  if (after == 0) return 0;
  if (after == times_.size()) return after - 1;
  return times_[after] - time_s < time_s - times_[after - 1] ? after : after - 1;
}

void SampleSeries::add_row(const Column& column, std::size_t row, Node& node) {
  const double value = column.values[row];
  const Row r = static_cast<Row>(row);
  if (!std::isfinite(value)) {
    ++node.gaps;
    return;
  }
  if (node.min == no_row || value < column.values[node.min]) node.min = r;
  if (node.max == no_row || value > column.values[node.max]) node.max = r;
  if (value <= 0)
    ++node.not_positive;
  else if (node.min_positive == no_row || value < column.values[node.min_positive])
    node.min_positive = r;
}

void SampleSeries::add_node(const Column& column, const Node& part, Node& node) {
  const auto& v = column.values;
  if (part.min != no_row && (node.min == no_row || v[part.min] < v[node.min])) node.min = part.min;
  if (part.max != no_row && (node.max == no_row || v[part.max] > v[node.max])) node.max = part.max;
  if (part.min_positive != no_row &&
      (node.min_positive == no_row || v[part.min_positive] < v[node.min_positive]))
    node.min_positive = part.min_positive;
  node.not_positive += part.not_positive;
  node.gaps += part.gaps;
}

void SampleSeries::add_to_pyramid(Column& column, std::size_t row) {
  std::size_t block = row;
  for (auto& level : column.pyramid) {
    block /= fanout;
    if (block == level.size()) level.emplace_back();
    add_row(column, row, level[block]);
  }
}

/// The rows first <= row < last: single rows up to a block's border, ever larger blocks, and down again.
SampleSeries::Node SampleSeries::fold(const Column& column, std::size_t first, std::size_t last) const {
  Node node;
  std::size_t row = first;
  while (row < last) {
    std::size_t width = 1;
    std::size_t level = 0;  // 0: the row itself; k: pyramid[k - 1]
    while (level < levels && row % (width * fanout) == 0 && row + width * fanout <= last) {
      width *= fanout;
      ++level;
    }
    if (level == 0)
      add_row(column, row, node);
    else
      add_node(column, column.pyramid[level - 1][row / width], node);
    row += width;
  }
  return node;
}

SampleSeries::Summary SampleSeries::summary(std::size_t column, double from_s, double to_s) const {
  const Column& data = columns_[column];
  const Node node = fold(data, lower_bound(from_s), upper_bound(to_s));
  Summary result;
  if (node.min != no_row) result.min = data.values[node.min];
  if (node.max != no_row) result.max = data.values[node.max];
  if (node.min_positive != no_row) result.min_positive = data.values[node.min_positive];
  result.not_positive = node.not_positive;
  result.gaps = node.gaps;
  return result;
}

bool SampleSeries::is_gap(const Column& column, std::size_t row, Keep keep) const {
  const double value = column.values[row];
  return !std::isfinite(value) || (keep == Keep::positive && value <= 0);
}

/// The first row of [first, last) at or after a time, looked for in ever wider steps around a good guess.
std::size_t SampleSeries::lower_bound_near(std::size_t first, std::size_t last, std::size_t guess,
                                           double time_s) const {
  std::size_t low = std::min(guess, last), high = low;
  for (std::size_t step = 4; low > first && times_[low - 1] >= time_s; step *= 2)
    low -= std::min(step, low - first);
  for (std::size_t step = 4; high < last && times_[high] < time_s; step *= 2)
    high += std::min(step, last - high);
  const auto begin = times_.begin();
  return static_cast<std::size_t>(std::lower_bound(begin + static_cast<std::ptrdiff_t>(low),
                                                   begin + static_cast<std::ptrdiff_t>(high), time_s) -
                                  begin);
}

void SampleSeries::query(std::size_t column, double from_s, double to_s, int pixels, Keep keep,
                         std::vector<CurvePoint>& curve) const {
  curve.clear();
  if (empty() || pixels <= 0 || !(to_s > from_s)) return;
  const Column& data = columns_[column];
  std::size_t row = lower_bound(from_s);
  std::size_t last = upper_bound(to_s);
  if (row > 0) --row;
  if (last < size()) ++last;

  const auto add = [&](std::size_t r) { curve.push_back({times_[r], data.values[r]}); };
  const auto add_break = [&](std::size_t r) {
    if (!curve.empty() && !std::isnan(curve.back().value))
      curve.push_back({times_[r], std::numeric_limits<double>::quiet_NaN()});
  };
  if (last - row <= 2 * static_cast<std::size_t>(pixels)) {
    for (; row < last; ++row) is_gap(data, row, keep) ? add_break(row) : add(row);
    return;
  }
  // The neighbours outside lead the curve to the plot's edges; only the rows between the times are put into
  // bins.
  const std::size_t beyond = last;
  if (times_[last - 1] > to_s) --last;
  if (row < last && times_[row] < from_s) {
    if (!is_gap(data, row, keep)) add(row);
    ++row;
  }
  const double width = (to_s - from_s) / pixels;
  std::size_t grain = 1;
  while (grain * fanout * 4 * static_cast<std::size_t>(pixels) <= last - row) grain *= fanout;
  std::size_t rows_in_bin = (last - row) / static_cast<std::size_t>(pixels);
  while (row < last) {
    const double bin_end = (std::floor(times_[row] / width) + 1) * width;
    const std::size_t end = lower_bound_near(row, last, row + rows_in_bin, bin_end);
    rows_in_bin = end - row;
    const std::size_t next = std::min(last, (std::max(row + 1, end) + grain - 1) / grain * grain);
    const Node node = fold(data, row, next);
    Row low = keep == Keep::positive ? node.min_positive : node.min;
    Row high = node.max;
    if (high != no_row && is_gap(data, high, keep)) high = no_row;
    // A gap inside one pixel cannot be seen; one that reaches over the pixel's border breaks the curve there.
    if (is_gap(data, row, keep)) add_break(row);
    if (low != no_row && high != no_row) {
      if (low > high) std::swap(low, high);
      add(low);
      if (high != low) add(high);
    }
    if (is_gap(data, next - 1, keep)) add_break(next - 1);
    row = next;
  }
  if (last < beyond && !is_gap(data, last, keep)) add(last);
}

void SampleSeries::keep_extreme_rows(std::size_t first, std::size_t last,
                                     std::vector<std::size_t>& kept) const {
  std::vector<std::size_t> rows;
  for (const Column& column : columns_) {
    const Node node = fold(column, first, last);
    for (const Row row : {node.min, node.max, node.min_positive})
      if (row != no_row) rows.push_back(row);
    for (std::size_t row = first; node.gaps > 0 && row < last; ++row)
      if (is_gap(column, row, Keep::finite)) {  // the first one keeps the break in the curve
        rows.push_back(row);
        break;
      }
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  kept.insert(kept.end(), rows.begin(), rows.end());
}

/// At most four of a group's rows stay per column, of eight: the older half shrinks to half of itself or
/// less.
void SampleSeries::thin_older_half() {
  const std::size_t group = 8 * columns_.size();
  const std::size_t half = size() / 2;
  std::vector<std::size_t> kept;
  for (std::size_t first = 0; first < half; first += group)
    keep_extreme_rows(first, std::min(first + group, half), kept);
  for (std::size_t row = half; row < size(); ++row) kept.push_back(row);

  for (std::size_t i = 0; i < kept.size(); ++i) times_[i] = times_[kept[i]];
  times_.resize(kept.size());
  for (Column& column : columns_) {
    for (std::size_t i = 0; i < kept.size(); ++i) column.values[i] = column.values[kept[i]];
    column.values.resize(kept.size());
    for (auto& level : column.pyramid) level.clear();
    for (std::size_t row = 0; row < kept.size(); ++row) add_to_pyramid(column, row);
  }
}

}  // namespace clothlab
