#include "sparse/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace cloth {
namespace {

constexpr std::size_t directions = 4;
constexpr int longest_reach = 2;  // of a grid's springs

struct GridPoint {
  int row, column;
  int along(std::size_t direction) const {
    return direction == 0 ? row : direction == 1 ? column : direction == 2 ? row + column : row - column;
  }
};

/// visit(i, j) for the particles that a spring or a bending element joins; pairs may repeat.
template <class Visit>
void for_each_coupling(const ClothSystem& system, Visit visit) {
  for (const SpringRun& run : system.springs)
    for (int i = run.first; i < run.first + run.count; ++i) visit(i, i + run.offset);
  for_each_bending_pair(system.bending_rows, system.bending, [&](std::size_t i, std::size_t j, double) {
    visit(static_cast<int>(i), static_cast<int>(j));
  });
  for_each_slider_pair(system.sliders, [&](std::size_t i, std::size_t j, double) {
    visit(static_cast<int>(i), static_cast<int>(j));
  });
}

/// Particles with along(direction) in [begin, begin + reach).
struct Separator {
  std::size_t direction;
  int begin;
};

class Dissection {
 public:
  Dissection(int columns, const GridReach& reach) : columns_(columns), reach_(reach) {}

  void run(std::vector<GridPoint> points) {
    const auto separator = find_separator(points);
    if (!separator) return append(points);
    std::vector<GridPoint> before, between, after;
    for (const GridPoint& point : points) {
      const int distance = point.along(separator->direction) - separator->begin;
      (distance < 0                                    ? before
       : distance < reach_.along[separator->direction] ? between
                                                       : after)
          .push_back(point);
    }
    points = {};
    run(std::move(before));
    run(std::move(after));
    append(between);
  }

  std::vector<int> order;

 private:
  /// The separator with the least |S|^2 / (|A| |B|) among those with at least a quarter of the points on
  /// either side; none where separation does not pay.
  std::optional<Separator> find_separator(const std::vector<GridPoint>& points) const {
    constexpr std::size_t indivisible = 6;  // particles
    std::optional<Separator> best;
    if (points.size() <= indivisible) return best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t d = 0; d < directions; ++d) {
      const auto [low, high] = std::minmax_element(
          points.begin(), points.end(),
          [d](const GridPoint& p, const GridPoint& q) { return p.along(d) < q.along(d); });
      const int first = low->along(d), last = high->along(d), width = reach_.along[d];
      std::vector<long> before(static_cast<std::size_t>(last - first + 2), 0);  // particles before each line
      for (const GridPoint& p : points) ++before[static_cast<std::size_t>(p.along(d) - first + 1)];
      for (std::size_t k = 1; k < before.size(); ++k) before[k] += before[k - 1];
      const auto all = static_cast<long>(points.size());
      for (int begin = first + 1; begin + width <= last; ++begin) {
        const long a = before[static_cast<std::size_t>(begin - first)];
        const long b = all - before[static_cast<std::size_t>(begin + width - first)];
        if (4 * std::min(a, b) < all) continue;
        const auto s = static_cast<double>(all - a - b);
        const double cost = s * s / (static_cast<double>(a) * static_cast<double>(b));
        if (cost < least) least = cost, best = Separator{d, begin};
      }
    }
    return best;
  }

  void append(const std::vector<GridPoint>& points) {
    for (const GridPoint& point : points) order.push_back(point.row * columns_ + point.column);
  }

  int columns_;
  GridReach reach_;
};

}  // namespace

GridReach reach_of(const ClothSystem& system) {
  GridReach reach{{1, 1, 1, 1}};
  for_each_coupling(system, [&](int i, int j) {
    const GridPoint step{j / system.columns - i / system.columns, j % system.columns - i % system.columns};
    for (std::size_t d = 0; d < directions; ++d)
      reach.along[d] = std::max(reach.along[d], std::abs(step.along(d)));
  });
  return reach;
}

std::vector<int> nested_dissection(const std::vector<int>& particles, int columns, const GridReach& reach) {
  std::vector<GridPoint> points;
  points.reserve(particles.size());
  for (const int i : particles) points.push_back({i / columns, i % columns});
  Dissection dissection(columns, reach);
  dissection.order.reserve(particles.size());
  dissection.run(std::move(points));
  return std::move(dissection.order);
}

std::vector<int> minimum_degree(int size, const std::vector<Coupling>& couplings) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(2 * couplings.size() + static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [i, j] : couplings) entries.emplace_back(i, j, 1), entries.emplace_back(j, i, 1);
  Matrix pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  const auto& indices = permutation.indices();
  return {indices.data(), indices.data() + indices.size()};
}

std::vector<int> elimination_order(const ClothSystem& system) {
  std::vector<int> free, unknown(system.pinned.size(), -1);
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    if (system.pinned[i]) continue;
    unknown[i] = static_cast<int>(free.size());
    free.push_back(static_cast<int>(i));
  }
  const GridReach reach = reach_of(system);
  if (*std::max_element(reach.along.begin(), reach.along.end()) <= longest_reach)
    return nested_dissection(free, system.columns, reach);

  std::vector<Coupling> couplings;
  for_each_coupling(system, [&](int i, int j) {
    const int a = unknown[static_cast<std::size_t>(i)], b = unknown[static_cast<std::size_t>(j)];
    if (a >= 0 && b >= 0) couplings.emplace_back(a, b);
  });
  std::vector<int> order = minimum_degree(static_cast<int>(free.size()), couplings);
  for (int& k : order) k = free[static_cast<std::size_t>(k)];
  return order;
}

}  // namespace cloth
