// Recorded samples of several quantities over one time axis, kept so that any stretch of a long run is drawn
// at the cost of its width in pixels: a pyramid of extremes over fixed-size blocks lies above each quantity.
//
// Memory: 8 B per row for the time and 11 B per row and quantity. Full at `capacity` rows (2^20 by
// default: 2.9 h at 100 samples/s, 76 MB for six quantities); then the older half is thinned to its extreme
// rows, so that memory stays bounded, no extreme is ever lost, and every row kept is a row that was recorded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace clothlab {

/// A point of a curve; a NaN value is a break between two pieces of the curve.
struct CurvePoint {
  double time_s = 0;
  double value = 0;
};

/// Which values a curve may show. On a logarithmic axis a value at or below zero is a break like a NaN.
enum class Keep { finite, positive };

class SampleSeries {
 public:
  static constexpr std::size_t default_capacity = std::size_t{1} << 20;

  explicit SampleSeries(std::size_t columns, std::size_t capacity = default_capacity);

  /// One row; `values` has one number per column, NaN or infinite where the quantity is missing. Refused
  /// (false) when the time is not finite or lies before the last row's.
  bool append(double time_s, std::span<const double> values);
  void clear();
  /// Takes out the rows later than a time; those before it stay as they are.
  void drop_after(double time_s);

  std::size_t size() const { return times_.size(); }
  bool empty() const { return times_.empty(); }
  std::size_t columns() const { return columns_.size(); }
  double first_time() const { return times_.front(); }
  double last_time() const { return times_.back(); }
  double time(std::size_t row) const { return times_[row]; }
  double value(std::size_t column, std::size_t row) const { return columns_[column].values[row]; }

  /// The first row at or after a time, and the first row after it.
  std::size_t lower_bound(double time_s) const;
  std::size_t upper_bound(double time_s) const;
  /// The row closest in time; the series must not be empty.
  std::size_t nearest(double time_s) const;

  /// What a stretch of time holds of one quantity; NaN where there is no such value.
  struct Summary {
    double min = std::numeric_limits<double>::quiet_NaN();
    double max = std::numeric_limits<double>::quiet_NaN();
    double min_positive = std::numeric_limits<double>::quiet_NaN();
    std::size_t not_positive = 0;  ///< finite values at or below zero
    std::size_t gaps = 0;          ///< missing values
  };
  Summary summary(std::size_t column, double from_s, double to_s) const;

  /// The curve between two times in time order, with its neighbours just outside: every row when they are
  /// few, else the lowest and the highest row of each of `pixels` equal bins. The bins lie at multiples of
  /// their width, so that a scrolling curve does not shimmer; where a bin holds very many rows, its border
  /// moves by less than a quarter of its width to the border of a block. Costs O(pixels log n).
  void query(std::size_t column, double from_s, double to_s, int pixels, Keep keep,
             std::vector<CurvePoint>& curve) const;

 private:
  using Row = std::uint32_t;
  static constexpr Row no_row = std::numeric_limits<Row>::max();
  static constexpr std::size_t fanout = 8;
  static constexpr std::size_t levels = 6;  // 8^6 = 2^18 rows under one node of the top level

  /// The extremes of a block as rows, because a curve needs to know when they happened.
  struct Node {
    Row min = no_row, max = no_row, min_positive = no_row;
    Row not_positive = 0, gaps = 0;
  };
  struct Column {
    std::vector<double> values;
    std::vector<Node> pyramid[levels];
  };

  static void add_row(const Column& column, std::size_t row, Node& node);
  static void add_node(const Column& column, const Node& part, Node& node);
  static void shorten(Column& column, std::size_t rows);
  static void add_to_pyramid(Column& column, std::size_t row);
  Node fold(const Column& column, std::size_t first, std::size_t last) const;
  std::size_t lower_bound_near(std::size_t first, std::size_t last, std::size_t guess, double time_s) const;
  bool is_gap(const Column& column, std::size_t row, Keep keep) const;
  void thin_older_half();
  void keep_extreme_rows(std::size_t first, std::size_t last, std::vector<std::size_t>& kept) const;

  std::size_t capacity_;
  std::vector<double> times_;
  std::vector<Column> columns_;
};

}  // namespace clothlab
