#include "cloth/mesh_order.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

#include "geometry/at.h"

namespace cloth {
namespace {

/// Neighbours of each particle, as rows of one list.
struct Neighbours {
  std::vector<int> begin, list;

  int degree(int i) const { return begin[at(i) + 1] - begin[at(i)]; }
  template <class Visit>
  void for_each(int i, Visit visit) const {
    for (int k = begin[at(i)]; k < begin[at(i) + 1]; ++k) visit(list[at(k)]);
  }
};

/// How many springs each particle has, from `counts` on.
void count_springs(const ClothSystem& system, int* counts) {
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    ++counts[i], ++counts[j];
  });
}

Neighbours neighbours_of(const ClothSystem& system) {
  const std::size_t particles = system.mass.size();
  Neighbours n;
  n.begin.assign(particles + 1, 0);
  count_springs(system, n.begin.data() + 1);
  std::partial_sum(n.begin.begin(), n.begin.end(), n.begin.begin());
  n.list.resize(at(n.begin.back()));
  std::vector<int> next(n.begin.begin(), n.begin.end() - 1);
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    n.list[at(next[i]++)] = static_cast<int>(j);
    n.list[at(next[j]++)] = static_cast<int>(i);
  });
  for (std::size_t i = 0; i < particles; ++i)
    std::sort(n.list.begin() + n.begin[i], n.list.begin() + n.begin[i + 1],
              [&](int a, int b) { return std::tuple(n.degree(a), a) < std::tuple(n.degree(b), b); });
  return n;
}

/// Breadth first from `start`, neighbours of low degree first: appends to `order` and notes in `level`, which
/// must be -1 throughout the part, how many springs away each is.
void visit_part(const Neighbours& neighbours, int start, std::vector<int>& level, std::vector<int>& order) {
  level[at(start)] = 0;
  std::size_t next = order.size();
  order.push_back(start);
  for (; next < order.size(); ++next) {
    const int i = order[next];
    neighbours.for_each(i, [&](int j) {
      if (level[at(j)] >= 0) return;
      level[at(j)] = level[at(i)] + 1;
      order.push_back(j);
    });
  }
}

/// A pseudoperipheral particle (George and Liu 1979): repeatedly the farthest particle of least degree, while
/// the distance increases.
int end_of_a_long_path(const Neighbours& neighbours, int start, std::vector<int>& level) {
  std::vector<int> part;
  for (int longest = -1;;) {
    part.clear();
    visit_part(neighbours, start, level, part);
    const int length = level[at(part.back())];
    int farthest = part.back();
    for (const int i : part)
      if (level[at(i)] == length && neighbours.degree(i) < neighbours.degree(farthest)) farthest = i;
    for (const int i : part) level[at(i)] = -1;
    if (length <= longest) return start;
    longest = length;
    start = farthest;
  }
}

}  // namespace

ParticleOrder small_bandwidth_order(const ClothSystem& system) {
  const Neighbours neighbours = neighbours_of(system);
  std::vector<int> level(system.mass.size(), -1);
  ParticleOrder order;
  order.reserve(level.size());
  for (int i = 0; i < static_cast<int>(level.size()); ++i)
    if (level[at(i)] < 0) visit_part(neighbours, end_of_a_long_path(neighbours, i, level), level, order);
  std::reverse(order.begin(), order.end());
  return order;
}

ParticleOrder order_for_sweeps(const ClothSystem& system) {
  constexpr std::size_t window = 64;
  std::vector<int> springs(system.mass.size());
  count_springs(system, springs.data());
  ParticleOrder order = small_bandwidth_order(system);
  for (std::size_t begin = 0; begin < order.size(); begin += window)
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
                     order.begin() + static_cast<std::ptrdiff_t>(std::min(begin + window, order.size())),
                     [&](int a, int b) { return springs[at(a)] < springs[at(b)]; });
  return order;
}

ParticleOrder inverse_of(const ParticleOrder& order) {
  ParticleOrder inverse(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) inverse[at(order[k])] = static_cast<int>(k);
  return inverse;
}

int bandwidth_of(const ClothSystem& system) {
  int bandwidth = 0;
  for (const SpringRun& run : system.springs) bandwidth = std::max(bandwidth, std::abs(run.offset));
  return bandwidth;
}

}  // namespace cloth
