#include "sparse/aggregation_multigrid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "geometry/dense_decompositions.h"
#include "kernels/instruction_set.h"
#include "sparse/without_denormals.h"

namespace cloth {
namespace {

constexpr std::size_t modes = AggregationKernels::modes, row_width = AggregationKernels::row_width;
constexpr std::size_t padding = AggregationKernels::padding;
constexpr int few_points = 12;  // that a dense inverse is taken for
/// 4/3 over the largest eigenvalue of D^-1 A, which is at most two with springs alone, and with other
/// elements larger, but rarely felt.
constexpr float smoothing = 2.0f / 3;

RowIndex index_of(const SparsePattern& pattern) {
  return {pattern.rows(), pattern.begin.data(), pattern.column.data()};
}

/// Of a positive definite block, of which rows with their columns may be zero and stay so; false where it is
/// not that.
template <int size>
bool invert(const float* block, float* inverse) {
  using Square = Eigen::Matrix<double, size, size>;
  Square matrix = Eigen::Map<const Eigen::Matrix<float, size, size>>(block).template cast<double>();
  for (int k = 0; k < size; ++k)
    if (matrix(k, k) == 0) matrix(k, k) = 1;
  const Eigen::LLT<Square> factors(matrix);
  if (factors.info() != Eigen::Success) return false;
  Square result = factors.solve(Square::Identity());
  for (int k = 0; k < size; ++k)
    if (block[k * size + k] == 0) result(k, k) = 0;
  Eigen::Map<Eigen::Matrix<float, size, size>> to(inverse);
  to = (0.5 * (result + result.transpose())).template cast<float>();
  return to.allFinite();
}

}  // namespace

AggregationLevel AggregationMultigrid::Level::loops() {
  return {index_of(pattern), diagonal.data(), reach,    blocks.data(),
          inverse.data(),    x.data(),        b.data(), r.data()};
}

AggregationTransfer AggregationMultigrid::Level::transfer(Level& coarse) {
  AggregationTransfer t;
  t.prolongator = index_of(prolongator), t.image = index_of(image);
  t.aggregate = aggregates.of.data(), t.basis = basis.data(), t.p = p.data();
  t.row = row.data(), t.place = place.data(), t.sums = sums.data();
  t.coarse = index_of(coarse.pattern), t.coarse_blocks = coarse.blocks.data();
  t.coarse_diagonal = coarse.diagonal.data(), t.mirrored = coarse.mirrored.data();
  return t;
}

const AggregationKernels::Loops& AggregationMultigrid::kernels(const Level& level) {
  const AggregationKernels& all = active_kernels<AggregationKernels>();
  return level.block == 3 ? all.three : all.six;
}

void AggregationMultigrid::set_pattern(Level& level, SparsePattern pattern, std::size_t block) {
  level.pattern = std::move(pattern);
  level.block = block;
  for (int i = 0; i < level.rows(); ++i) {
    level.diagonal.push_back(static_cast<int>(level.pattern.entry(i, i)));
    level.reach = std::max(level.reach, level.pattern.row(i).back() - i);
    for (const int j : level.pattern.row(i))
      level.mirrored.push_back(static_cast<int>(level.pattern.entry(j, i)));
  }
  const std::size_t points = at(level.rows());
  level.blocks.assign(level.pattern.entries() * block * block + padding, 0);
  level.inverse.assign(points * block * block + padding, 0);
  for (std::vector<float>* vector : {&level.x, &level.b, &level.r})
    vector->assign(points * level.width() + padding, 0);
}

/// P has a block where `reach`, a pattern with its diagonal, leads to an aggregate.
void AggregationMultigrid::set_transfer(Level& level, const SparsePattern& graph,
                                        const SparsePattern& reach) {
  level.aggregates = aggregate(graph);
  const int coarse = level.aggregates.count();
  std::vector<int> columns;
  for (int i = 0; i < level.rows(); ++i) {
    columns.clear();
    for (const int j : reach.row(i))
      if (level.aggregates.of[at(j)] >= 0) columns.push_back(level.aggregates.of[at(j)]);
    level.prolongator.add_row(columns);
  }
  level.image = product(level.pattern, level.prolongator);
  level.place.assign(at(coarse), 0);
  const std::size_t wide = level.block * row_width;
  level.p.assign(level.prolongator.entries() * wide + padding, 0);
  level.row.assign(level.image.longest_row() * wide + padding, 0);
  level.basis.assign(at(level.rows()) * wide + padding, 0);
}

void AggregationMultigrid::analyse(int size, const std::vector<Coupling>& couplings,
                                   const std::vector<Coupling>& strong) {
  levels_.assign(1, {});
  set_pattern(levels_.front(), symmetric_pattern(size, couplings), 3);
  upper_.clear(), lower_.clear();
  for (const auto& [i, j] : couplings) {
    upper_.push_back(levels_.front().pattern.entry(i, j));
    lower_.push_back(levels_.front().pattern.entry(j, i));
  }
  SparsePattern graph = symmetric_pattern(size, strong);
  while (levels_.back().rows() > few_points) {
    Level& fine = levels_.back();
    set_transfer(fine, graph, levels_.size() == 1 ? graph : fine.pattern);
    const int coarse = fine.aggregates.count();
    if (coarse == 0) break;
    graph = graph_of(fine.aggregates, graph);
    SparsePattern pattern = product(transposed(fine.prolongator, coarse), fine.image);
    fine.sums.assign(pattern.entries() * AggregationKernels::sum_width, 0);
    set_pattern(levels_.emplace_back(), std::move(pattern), modes);
  }
}

/// Translations, and rotations about the middle of the finest level's points, in units of their extent.
void AggregationMultigrid::set_modes(Level& level, std::span<const double> positions) {
  const std::size_t points = at(level.rows());
  Vec3 middle = Vec3::Zero();
  for (std::size_t i = 0; i < points; ++i) middle += Eigen::Map<const Vec3>(positions.data() + 3 * i);
  if (points > 0) middle /= static_cast<double>(points);
  double extent = 0;
  for (std::size_t i = 0; i < points; ++i)
    extent = std::max(extent, (Eigen::Map<const Vec3>(positions.data() + 3 * i) - middle).norm());
  level.modes.assign(points * 3 * modes, 0);
  for (std::size_t i = 0; i < points; ++i) {
    Vec3 x = Eigen::Map<const Vec3>(positions.data() + 3 * i) - middle;
    if (extent > 0) x /= extent;
    Eigen::Map<Eigen::Matrix<double, 3, modes, Eigen::RowMajor>> of_point(level.modes.data() + 3 * modes * i);
    of_point << 1, 0, 0, 0, x.z(), -x.y(), 0, 1, 0, -x.z(), 0, x.x(), 0, 0, 1, x.y(), -x.x(), 0;
  }
}

bool AggregationMultigrid::invert_diagonal(Level& level) {
  const std::size_t square = level.block * level.block;
  for (std::size_t i = 0; i < at(level.rows()); ++i) {
    const float* block = level.blocks.data() + at(level.diagonal[i]) * square;
    float* inverse = level.inverse.data() + i * square;
    if (!(level.block == 3 ? invert<3>(block, inverse) : invert<modes>(block, inverse))) return false;
  }
  return true;
}

void AggregationMultigrid::coarsen(Level& fine, Level& coarse) {
  orthonormalise(fine.aggregates, fine.block, fine.modes, fine.tentative, coarse.modes);
  for (std::size_t row = 0; row < at(fine.rows()) * fine.block; ++row)
    for (std::size_t c = 0; c < modes; ++c)
      fine.basis[row * row_width + c] = static_cast<float>(fine.tentative[row * modes + c]);
  const AggregationKernels::Loops& loops = kernels(fine);
  loops.smooth(fine.loops(), fine.transfer(coarse), smoothing);
  loops.coarsen(fine.loops(), fine.transfer(coarse));
}

bool AggregationMultigrid::prepare(std::span<const double> diagonal, std::span<const double> coupling_blocks,
                                   std::span<const double> positions) {
  constexpr std::size_t square = 9;
  const WithoutDenormals scope;
  Level& finest = levels_.front();
  std::fill(finest.blocks.begin(), finest.blocks.end(), 0.0f);
  for (std::size_t i = 0; i < at(finest.rows()); ++i)
    for (std::size_t n = 0; n < square; ++n)
      finest.blocks[at(finest.diagonal[i]) * square + n] = static_cast<float>(diagonal[i * square + n]);
  for (std::size_t k = 0; k < upper_.size(); ++k)
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto number = static_cast<float>(coupling_blocks[k * square + 3 * c + r]);
        finest.blocks[upper_[k] * square + 3 * c + r] += number;
        finest.blocks[lower_[k] * square + 3 * r + c] += number;
      }
  set_modes(finest, positions);
  for (std::size_t n = 0; n < levels_.size(); ++n) {
    if (!invert_diagonal(levels_[n])) return false;
    if (n + 1 < levels_.size()) coarsen(levels_[n], levels_[n + 1]);
  }
  return invert_coarsest();
}

bool AggregationMultigrid::invert_coarsest() {
  const Level& level = levels_.back();
  coarsest_.clear();
  if (level.rows() > few_points || level.rows() == 0) return true;
  const auto block = static_cast<Eigen::Index>(level.block), numbers = block * level.rows();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(numbers, numbers);
  for (int i = 0; i < level.rows(); ++i)
    for (const int j : level.pattern.row(i))
      dense.block(block * i, block * j, block, block) =
          Eigen::Map<const Eigen::MatrixXf>(
              level.blocks.data() + level.pattern.entry(i, j) * level.block * level.block, block, block)
              .cast<double>();
  const double largest = dense.diagonal().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return false;
  for (Eigen::Index k = 0; k < numbers; ++k)  // modes left out, and what single precision may have lost
    dense(k, k) = dense(k, k) == 0 ? largest : dense(k, k) * (1 + 1e-6);
  const std::optional<Eigen::MatrixXd> inverse = positive_inverse(dense);
  if (!inverse) return false;
  coarsest_.assign(inverse->data(), inverse->data() + inverse->size());
  return true;
}

void AggregationMultigrid::solve_coarsest() {
  Level& level = levels_.back();
  if (coarsest_.empty()) {
    kernels(level).descend(level.loops());
    return kernels(level).ascend(level.loops());
  }
  const std::size_t numbers = at(level.rows()) * level.block;
  const auto place = [&](std::size_t k) { return k / level.block * level.width() + k % level.block; };
  for (std::size_t k = 0; k < numbers; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < numbers; ++j)
      sum += coarsest_[k * numbers + j] * static_cast<double>(level.b[place(j)]);
    level.x[place(k)] = static_cast<float>(sum);
  }
}

void AggregationMultigrid::cycle(std::size_t number) {
  if (number + 1 == levels_.size()) return solve_coarsest();
  Level &level = levels_[number], &coarse = levels_[number + 1];
  const AggregationKernels::Loops& loops = kernels(level);
  loops.descend(level.loops());
  loops.restrict_residual(level.loops(), level.transfer(coarse), coarse.b.data());
  cycle(number + 1);
  loops.add_correction(level.loops(), level.transfer(coarse), coarse.x.data());
  loops.ascend(level.loops());
}

void AggregationMultigrid::solve(std::span<const double> residual, std::span<double> correction) {
  const WithoutDenormals scope;
  Level& finest = levels_.front();
  const std::size_t points = at(finest.rows()), width = finest.width();
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t c = 0; c < 3; ++c) finest.b[width * i + c] = static_cast<float>(residual[3 * i + c]);
  cycle(0);
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t c = 0; c < 3; ++c) correction[3 * i + c] = static_cast<double>(finest.x[width * i + c]);
}

}  // namespace cloth
