// A symmetric matrix on the particles of a grid whose couplings reach two rows and two columns at most, and
// what it becomes on every second row and column.
#pragma once

#include <cstdint>
#include <vector>

namespace cloth {

class GridStencils {
 public:
  static constexpr int reach = 2, side = 2 * reach + 1, size = side * side, middle = size / 2;

  /// Zero everywhere. Particle r * columns + c.
  GridStencils(int rows, int columns)
      : rows_(rows), columns_(columns), numbers_(static_cast<std::size_t>(size) * count(), 0.0) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  std::size_t count() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_); }

  /// The number in the row of `particle` and the column of its neighbour k = (rows down + reach) * side +
  /// columns right + reach.
  double operator()(int k, std::size_t particle) const { return numbers_[index(k, particle)]; }
  void add(int k, std::size_t particle, double value) { numbers_[index(k, particle)] += value; }
  /// Adds to the diagonal; and, for i != j, to (i, j) and (j, i). False, and nothing added, where i and j lie
  /// too far apart.
  void add_to_diagonal(std::size_t particle, double value) { add(middle, particle, value); }
  bool add_coupling(std::size_t i, std::size_t j, double value);
  /// Without a diagonal: fixed, out of the matrix.
  bool is_free(std::size_t particle) const { return (*this)(middle, particle) > 0; }

  static int rows_of(int k) { return k / side - reach; }
  static int columns_of(int k) { return k % side - reach; }
  static int neighbour(int rows, int columns) { return (rows + reach) * side + columns + reach; }

  /// product = A x; fixed particles, and those outside, count as zero.
  void multiply(const std::vector<double>& x, std::vector<double>& product) const;
  /// The largest eigenvalue of D^-1 A, D its diagonal, estimated from below by power iteration.
  double largest_scaled_eigenvalue() const;
  /// P^T A P with bilinear interpolation P from every second row and column; a direction with no more than
  /// `fewest` stays as it is. On an even number the last one has its only neighbour's value. P is zero where
  /// fixed.
  GridStencils coarsened(int fewest) const;

 private:
  std::size_t index(int k, std::size_t particle) const {
    return static_cast<std::size_t>(k) * count() + particle;
  }

  int rows_, columns_;
  std::vector<double> numbers_;
};

}  // namespace cloth
