#include "sparse/grid_stencils.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geometry/split_mix.h"

namespace cloth {
namespace {

/// Interpolation along a line of `fine` points from `coarse` ones.
struct LineWeights {
  int fine = 0, coarse = 0;

  bool halves() const { return coarse < fine; }
  /// The first and the last fine point that takes from `from`.
  int first(int from) const { return halves() ? std::max(0, 2 * from - 1) : from; }
  int last(int from) const { return halves() ? std::min(fine - 1, 2 * from + 1) : from; }
  /// The first and the last coarse point that `to` takes from.
  int first_parent(int to) const { return halves() ? to / 2 : to; }
  int last_parent(int to) const { return halves() ? std::min((to + 1) / 2, coarse - 1) : to; }
  double weight(int to) const { return first_parent(to) == last_parent(to) ? 1 : 0.5; }
};

int halved(int points, int fewest) {
  return points > fewest ? (points + 1) / 2 : points;
}

}  // namespace

bool GridStencils::add_coupling(std::size_t i, std::size_t j, double value) {
  const int a = static_cast<int>(i), b = static_cast<int>(j);
  const int down = b / columns_ - a / columns_, right = b % columns_ - a % columns_;
  if (std::abs(down) > reach || std::abs(right) > reach) return false;
  add(neighbour(down, right), i, value);
  add(neighbour(-down, -right), j, value);
  return true;
}

void GridStencils::multiply(const std::vector<double>& x, std::vector<double>& product) const {
  product.assign(count(), 0.0);
  for (int k = 0; k < size; ++k) {
    const int down = rows_of(k), right = columns_of(k);
    const int first = std::max(0, -right), last = columns_ - std::max(0, right);
    for (int r = std::max(0, -down); r < rows_ - std::max(0, down); ++r)
      for (int c = first; c < last; ++c) {
        const auto to = static_cast<std::size_t>(r * columns_ + c);
        product[to] += (*this)(k, to) * x[static_cast<std::size_t>((r + down) * columns_ + c + right)];
      }
  }
}

double GridStencils::largest_scaled_eigenvalue() const {
  constexpr int iterations = 30;
  std::vector<double> x(count()), product;
  SplitMix random(3);
  for (double& number : x) number = random.number();
  double eigenvalue = 1;
  for (int n = 0; n < iterations; ++n) {
    multiply(x, product);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < count(); ++i) {
      before += x[i] * x[i];
      x[i] = is_free(i) ? product[i] / (*this)(middle, i) : 0;
      after += x[i] * x[i];
    }
    if (!(after > 0)) return eigenvalue;
    eigenvalue = std::sqrt(after / before);
    const double scale = 1 / std::sqrt(after);
    for (double& number : x) number *= scale;
  }
  return eigenvalue;
}

GridStencils GridStencils::coarsened(int fewest) const {
  GridStencils coarse(halved(rows_, fewest), halved(columns_, fewest));
  const LineWeights down{rows_, coarse.rows_}, right{columns_, coarse.columns_};
  const auto add_from = [&](int row, int column, int r, int c) {
    const auto fine = static_cast<std::size_t>(r * columns_ + c);
    if (!is_free(fine)) return;
    const double weight = down.weight(r) * right.weight(c);
    const auto to = static_cast<std::size_t>(row * coarse.columns_ + column);
    for (int k = 0; k < size; ++k) {
      const double value = (*this)(k, fine);
      if (value == 0) continue;
      const int r2 = r + rows_of(k), c2 = c + columns_of(k);
      const double product = weight * value * down.weight(r2) * right.weight(c2);
      for (int row2 = down.first_parent(r2); row2 <= down.last_parent(r2); ++row2)
        for (int column2 = right.first_parent(c2); column2 <= right.last_parent(c2); ++column2)
          coarse.add(neighbour(row2 - row, column2 - column), to, product);
    }
  };
  for (int row = 0; row < coarse.rows_; ++row)
    for (int column = 0; column < coarse.columns_; ++column)
      for (int r = down.first(row); r <= down.last(row); ++r)
        for (int c = right.first(column); c <= right.last(column); ++c) add_from(row, column, r, c);
  return coarse;
}

}  // namespace cloth
