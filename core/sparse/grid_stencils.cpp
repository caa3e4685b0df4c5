#include "sparse/grid_stencils.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geometry/split_mix.h"
#include "sparse/line_interpolation.h"

namespace cloth {
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
  const LineInterpolation of_rows(rows_, rows_ > fewest, Interpolation::linear);
  const LineInterpolation of_columns(columns_, columns_ > fewest, Interpolation::linear);
  const CoarseLine rows = of_rows.line(), columns = of_columns.line();
  GridStencils coarse(rows.coarse, columns.coarse);
  const auto add_from = [&](int row, int column, int r, int c, double weight) {
    const auto fine = static_cast<std::size_t>(r * columns_ + c);
    if (!is_free(fine)) return;
    const auto to = static_cast<std::size_t>(row * coarse.columns_ + column);
    for (int k = 0; k < size; ++k) {
      const double value = (*this)(k, fine);
      if (value == 0) continue;
      const LineWeights &above = rows.parents[r + rows_of(k)], &beside = columns.parents[c + columns_of(k)];
      for (int i = 0; i < above.count; ++i)
        for (int j = 0; j < beside.count; ++j)
          coarse.add(neighbour(above.first + i - row, beside.first + j - column), to,
                     weight * value * above.weight[i] * beside.weight[j]);
    }
  };
  for (int row = 0; row < coarse.rows_; ++row)
    for (int column = 0; column < coarse.columns_; ++column) {
      const LineWeights &down = rows.children[row], &right = columns.children[column];
      for (int i = 0; i < down.count; ++i)
        for (int j = 0; j < right.count; ++j)
          add_from(row, column, down.first + i, right.first + j, down.weight[i] * right.weight[j]);
    }
  return coarse;
}

}  // namespace cloth
