#include "sparse/grid_multigrid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/dense_decompositions.h"
#include "geometry/split_mix.h"
#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"
#include "sparse/without_denormals.h"

namespace cloth {
namespace {

std::size_t in_lanes(std::size_t count) {
  return (count + CycleGrid::lanes - 1) / CycleGrid::lanes * CycleGrid::lanes;
}

CycleGrid grid_of(const GridStencils& matrix) {
  // Zeros after a row serve as those before the next.
  const std::size_t stride = in_lanes(static_cast<std::size_t>(matrix.columns())) + CycleGrid::lanes;
  return {matrix.rows(), matrix.columns(), static_cast<std::ptrdiff_t>(stride)};
}

/// Where a row of floats of a grid lies in the rows of particles: visit(particle, at).
template <class Visit>
void for_each_place(const CycleGrid& grid, Visit visit) {
  std::size_t particle = 0;
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c, ++particle) visit(particle, r * grid.stride + c);
}

/// The numbers of neighbours k that are not zero everywhere; and the one that all those between free
/// particles have, if it is one.
struct Neighbour {
  int k = 0;
  bool uniform = true;
  double weight = 0;
};
std::vector<Neighbour> neighbours_of(const GridStencils& matrix) {
  std::vector<Neighbour> all;
  for (int k = 0; k < GridStencils::size; ++k) {
    if (k == GridStencils::middle) continue;
    Neighbour neighbour{.k = k};
    const int down = GridStencils::rows_of(k), right = GridStencils::columns_of(k);
    bool any = false;
    for (int r = std::max(0, -down); r < matrix.rows() - std::max(0, down); ++r)
      for (int c = std::max(0, -right); c < matrix.columns() - std::max(0, right); ++c) {
        const auto i = static_cast<std::size_t>(r * matrix.columns() + c);
        const auto j = static_cast<std::size_t>((r + down) * matrix.columns() + c + right);
        if (!matrix.is_free(i) || !matrix.is_free(j)) continue;
        if (!any) neighbour.weight = matrix(k, i);
        any = true;
        neighbour.uniform = neighbour.uniform && matrix(k, i) == neighbour.weight;
      }
    if (any && (neighbour.weight != 0 || !neighbour.uniform)) all.push_back(neighbour);
  }
  return all;
}

}  // namespace

GridMultigrid::Level::Level(const GridStencils& stencils) : grid(grid_of(stencils)) {
  const std::vector<Neighbour> neighbours = neighbours_of(stencils);
  matrix.uniform = std::all_of(neighbours.begin(), neighbours.end(),
                               [](const Neighbour& neighbour) { return neighbour.uniform; });
  const auto stride = static_cast<std::size_t>(grid.stride);
  const std::size_t before = CycleGrid::margin * stride + CycleGrid::lanes;
  const std::size_t field = before + (static_cast<std::size_t>(grid.rows) + CycleGrid::margin) * stride;
  const std::size_t fields = 12 + (matrix.uniform ? 0 : neighbours.size());
  storage.assign(fields * field, 0.0f);
  float* next = storage.data() + before;
  const auto taken = [&] { return std::exchange(next, next + field); };
  diagonal = taken(), inverse = taken(), free = taken();
  for (CycleField* three : {&x, &b, &r})
    for (float*& one : three->of) one = taken();

  for_each_place(grid, [&](std::size_t i, std::ptrdiff_t place) {
    if (!stencils.is_free(i)) return;
    const double d = stencils(GridStencils::middle, i);
    diagonal[place] = static_cast<float>(d), inverse[place] = static_cast<float>(1 / d), free[place] = 1;
  });
  matrix.diagonal = diagonal;
  for (const Neighbour& neighbour : neighbours) {
    const std::ptrdiff_t offset =
        GridStencils::rows_of(neighbour.k) * grid.stride + GridStencils::columns_of(neighbour.k);
    if (matrix.uniform && offset < 0) continue;
    const auto n = static_cast<std::size_t>(matrix.count++);
    matrix.offset[n] = offset;
    matrix.weight[n] = static_cast<float>(neighbour.weight);
    if (matrix.uniform) continue;
    float* weights = taken();
    matrix.weights[n] = weights;
    for_each_place(grid, [&](std::size_t i, std::ptrdiff_t place) {
      weights[place] = static_cast<float>(stencils(neighbour.k, i));
    });
  }

  // The estimate comes from below; beyond the upper end of the interval the polynomial grows.
  const double most = 1.08 * stencils.largest_scaled_eigenvalue(), least = most / 4;
  for (int step = 0; step < smoothing; ++step)
    scale[static_cast<std::size_t>(step)] = static_cast<float>(
        1 / ((most + least) / 2 +
             (most - least) / 2 * std::cos(std::numbers::pi * (2 * step + 1) / (2 * smoothing))));
}

bool GridMultigrid::prepare(GridStencils matrix) {
  kernels_ = &active_kernels<CycleKernels>();
  levels_.clear();
  free_.assign(matrix.count(), 0.0);
  for (std::size_t i = 0; i < matrix.count(); ++i) {
    if (!std::isfinite(matrix(GridStencils::middle, i)) || matrix(GridStencils::middle, i) < 0) return false;
    free_[i] = matrix.is_free(i) ? 1 : 0;
  }
  matrix.multiply(free_, row_sums_);
  sum_ = 0;
  for (std::size_t i = 0; i < matrix.count(); ++i) sum_ += row_sums_[i] *= free_[i];
  row_.assign(2 * CycleGrid::lanes + in_lanes(static_cast<std::size_t>(matrix.columns())), 0.0f);
  for (;;) {
    levels_.emplace_back(matrix);
    if (matrix.rows() <= fewest && matrix.columns() <= fewest) return invert_coarsest(matrix);
    matrix = matrix.coarsened(fewest);
  }
}

bool GridMultigrid::invert_coarsest(const GridStencils& matrix) {
  const auto size = static_cast<Eigen::Index>(matrix.count());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (int r = 0; r < matrix.rows(); ++r)
    for (int c = 0; c < matrix.columns(); ++c) {
      const auto i = static_cast<std::size_t>(r * matrix.columns() + c);
      if (!matrix.is_free(i)) {
        dense(r * matrix.columns() + c, r * matrix.columns() + c) = 1;
        continue;
      }
      for (int k = 0; k < GridStencils::size; ++k)
        if (const double value = matrix(k, i); value != 0)
          dense(r * matrix.columns() + c,
                (r + GridStencils::rows_of(k)) * matrix.columns() + c + GridStencils::columns_of(k)) = value;
    }
  const std::optional<Eigen::MatrixXd> inverse = positive_inverse(dense);
  if (!inverse) return false;
  coarsest_.assign(inverse->data(), inverse->data() + inverse->size());  // symmetric
  return true;
}

void GridMultigrid::smooth(Level& level, int step) {
  kernels_->relax(level.grid, level.matrix, level.inverse, level.scale[static_cast<std::size_t>(step)],
                  level.b, level.x, level.r);
  std::swap(level.x, level.r);
}

void GridMultigrid::cycle(std::size_t number) {
  if (number + 1 == levels_.size()) return solve_coarsest();
  Level &level = levels_[number], &coarse = levels_[number + 1];
  float* row = row_.data() + CycleGrid::lanes;
  kernels_->begin(level.grid, level.inverse, level.scale[0], level.b, level.x);
  for (int step = 1; step < smoothing; ++step) smooth(level, step);
  kernels_->residual(level.grid, level.matrix, level.free, level.b, level.x, level.r);
  kernels_->restrict_to(level.grid, coarse.grid, coarse.free, level.r, coarse.b, row);
  cycle(number + 1);
  kernels_->prolong(level.grid, coarse.grid, level.free, coarse.x, level.x, row);
  for (int step = smoothing; step-- > 0;) smooth(level, step);
}

void GridMultigrid::solve_coarsest() {
  Level& level = levels_.back();
  const std::size_t size = static_cast<std::size_t>(level.grid.rows * level.grid.columns);
  for (int q = 0; q < 3; ++q) {
    const float* b = level.b.of[q];
    float* x = level.x.of[q];
    for_each_place(level.grid, [&](std::size_t i, std::ptrdiff_t to) {
      double sum = 0;
      for_each_place(level.grid, [&](std::size_t j, std::ptrdiff_t from) {
        sum += coarsest_[i * size + j] * static_cast<double>(b[from]);
      });
      x[to] = level.free[to] * static_cast<float>(sum);
    });
  }
}

double GridMultigrid::convergence_factor() {
  const WithoutDenormals scope;
  constexpr int before = 4, measured = 8;
  Level& finest = levels_.front();
  SplitMix random(7);
  double factor = 0;
  std::vector<float> e[3];
  for (std::vector<float>& one : e) {
    one.resize(free_.size());
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = static_cast<float>(free_[i] * random.number());
  }
  double product[3] = {1, 1, 1};
  for (int n = 0; n < before + measured; ++n) {
    // x = e, b = 0: the residual of the error becomes the right-hand side of its correction.
    for (int q = 0; q < 3; ++q)
      for_each_place(finest.grid, [&](std::size_t i, std::ptrdiff_t place) {
        finest.x.of[q][place] = e[q][i], finest.b.of[q][place] = 0;
      });
    kernels_->residual(finest.grid, finest.matrix, finest.free, finest.b, finest.x, finest.r);
    std::swap(finest.b, finest.r);
    cycle(0);
    for (int q = 0; q < 3; ++q) {
      double old = 0, now = 0;
      for_each_place(finest.grid, [&](std::size_t i, std::ptrdiff_t place) {
        old += static_cast<double>(e[q][i]) * static_cast<double>(e[q][i]);
        e[q][i] += finest.x.of[q][place];
        now += static_cast<double>(e[q][i]) * static_cast<double>(e[q][i]);
      });
      if (!(old > 0) || !(now > 0)) continue;
      if (n >= before) product[q] *= std::sqrt(now / old);
      const auto scale = static_cast<float>(1 / std::sqrt(now));
      for (float& number : e[q]) number *= scale;
    }
  }
  for (const double one : product) factor = std::max(factor, std::pow(one, 1.0 / measured));
  return factor;
}

void GridMultigrid::solve(const Vec3Field& b, Vec3Field& x) {
  const WithoutDenormals scope;
  Level& finest = levels_.front();
  const double* given[3] = {b.x(), b.y(), b.z()};
  double* wanted[3] = {x.x(), x.y(), x.z()};
  const auto columns = static_cast<std::size_t>(finest.grid.columns);
  for (int q = 0; q < 3; ++q)
    for (int r = 0; r < finest.grid.rows; ++r) {
      const double* from = given[q] + static_cast<std::size_t>(r) * columns;
      float* to = finest.b.of[q] + r * finest.grid.stride;
      for (std::size_t c = 0; c < columns; ++c) to[c] = static_cast<float>(from[c]);
    }
  cycle(0);
  for (int q = 0; q < 3; ++q)
    for (int r = 0; r < finest.grid.rows; ++r) {
      const float* from = finest.x.of[q] + r * finest.grid.stride;
      double* to = wanted[q] + static_cast<std::size_t>(r) * columns;
      for (std::size_t c = 0; c < columns; ++c) to[c] = static_cast<double>(from[c]);
    }
  correct_constant(b, x);
}

/// With 1 on the free particles: x += 1 (1^T (b - A x)) / (1^T A 1).
void GridMultigrid::correct_constant(const Vec3Field& b, Vec3Field& x) const {
  const VectorKernels& vectors = active_kernels<VectorKernels>();
  const double* given[3] = {b.x(), b.y(), b.z()};
  double* wanted[3] = {x.x(), x.y(), x.z()};
  const std::size_t count = free_.size();
  for (int q = 0; q < 3; ++q) {
    const double missing =
        vectors.dot(free_.data(), given[q], count) - vectors.dot(row_sums_.data(), wanted[q], count);
    if (sum_ > 0) vectors.add_multiple(missing / sum_, free_.data(), wanted[q], count);
  }
}

std::size_t GridMultigrid::memory() const {
  std::size_t bytes = (coarsest_.size() + free_.size() + row_sums_.size()) * sizeof(double);
  for (const Level& level : levels_) bytes += level.storage.size() * sizeof(float);
  return bytes;
}

}  // namespace cloth
