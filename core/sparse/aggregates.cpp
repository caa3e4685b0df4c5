#include "sparse/aggregates.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"

namespace cloth {
namespace {

constexpr std::size_t mode_count = 6, translations = 3;

/// The rows of some points as one tall matrix, column by column.
class Tall {
 public:
  void read(std::span<const int> points, std::size_t block, const std::vector<double>& modes) {
    height_ = points.size() * block;
    numbers_.resize(height_ * mode_count);
    for (std::size_t p = 0; p < points.size(); ++p)
      for (std::size_t r = 0; r < block; ++r)
        for (std::size_t c = 0; c < mode_count; ++c)
          numbers_[c * height_ + p * block + r] = modes[(at(points[p]) * block + r) * mode_count + c];
  }
  void write(std::span<const int> points, std::size_t block, std::vector<double>& basis) const {
    for (std::size_t p = 0; p < points.size(); ++p)
      for (std::size_t r = 0; r < block; ++r)
        for (std::size_t c = 0; c < mode_count; ++c)
          basis[(at(points[p]) * block + r) * mode_count + c] = numbers_[c * height_ + p * block + r];
  }
  double dot(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < height_; ++k) sum += numbers_[a * height_ + k] * numbers_[b * height_ + k];
    return sum;
  }
  double norm(std::size_t c) const { return std::sqrt(dot(c, c)); }
  void scale(std::size_t c, double factor) {
    for (std::size_t k = 0; k < height_; ++k) numbers_[c * height_ + k] *= factor;
  }
  void subtract(std::size_t from, double factor, std::size_t what) {
    for (std::size_t k = 0; k < height_; ++k)
      numbers_[from * height_ + k] -= factor * numbers_[what * height_ + k];
  }

 private:
  std::size_t height_ = 0;
  std::vector<double> numbers_;
};

/// Gram and Schmidt's process, modified. What rotations leave beside translations and earlier rotations is
/// nothing where it is small against the largest: points in a line do not turn about it.
void orthonormalise_columns(Tall& tall, double* coarse) {
  constexpr double independent = 1e-3;
  double largest = 0;
  for (std::size_t c = 0; c < mode_count; ++c) {
    if (c == translations)
      for (std::size_t k = c; k < mode_count; ++k) largest = std::max(largest, tall.norm(k));
    const double norm = tall.norm(c);
    const bool is_new = norm > independent * largest;
    coarse[c * mode_count + c] = is_new ? norm : 0;
    tall.scale(c, is_new ? 1 / norm : 0);
    if (!is_new) continue;
    for (std::size_t k = c + 1; k < mode_count; ++k) {
      const double part = tall.dot(c, k);
      coarse[c * mode_count + k] = part;
      tall.subtract(k, part, c);
    }
  }
}

}  // namespace

Aggregates aggregate(const SparsePattern& graph) {
  constexpr int none = -1;
  Aggregates result;
  int count = 0;
  result.of.assign(at(graph.rows()), none);
  const auto is_free = [&](int i) { return result.of[at(i)] == none; };
  for (int i = 0; i < graph.rows(); ++i) {
    const std::span<const int> row = graph.row(i);
    const bool has_neighbours = std::any_of(row.begin(), row.end(), [&](int j) { return j != i; });
    if (!has_neighbours || !is_free(i) || !std::all_of(row.begin(), row.end(), is_free)) continue;
    for (const int j : row) result.of[at(j)] = count;
    result.of[at(i)] = count++;
  }
  const std::vector<int> first = result.of;
  for (int i = 0; i < graph.rows(); ++i)
    for (const int j : graph.row(i))
      if (is_free(i) && first[at(j)] != none) result.of[at(i)] = first[at(j)];
  std::vector<std::vector<int>> members(at(count));
  for (int i = 0; i < graph.rows(); ++i)
    if (!is_free(i)) members[at(result.of[at(i)])].push_back(i);
  for (std::vector<int>& of_aggregate : members) result.members.add_row(of_aggregate);
  return result;
}

SparsePattern graph_of(const Aggregates& aggregates, const SparsePattern& graph) {
  std::vector<Coupling> couplings;
  for (int i = 0; i < graph.rows(); ++i)
    for (const int j : graph.row(i)) {
      const int a = aggregates.of[at(i)], b = aggregates.of[at(j)];
      if (a >= 0 && b > a) couplings.emplace_back(a, b);
    }
  return symmetric_pattern(aggregates.count(), couplings);
}

void orthonormalise(const Aggregates& aggregates, std::size_t block, const std::vector<double>& modes,
                    std::vector<double>& basis, std::vector<double>& coarse) {
  basis.assign(modes.size(), 0);
  coarse.assign(at(aggregates.count()) * mode_count * mode_count, 0);
  Tall tall;
  for (int a = 0; a < aggregates.count(); ++a) {
    const std::span<const int> points = aggregates.members.row(a);
    tall.read(points, block, modes);
    orthonormalise_columns(tall, coarse.data() + at(a) * mode_count * mode_count);
    tall.write(points, block, basis);
  }
}

}  // namespace cloth
