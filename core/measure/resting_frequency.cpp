#include "measure/resting_frequency.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cloth {
namespace {

struct RestingSpring {
  int i, j;
  double stiffness;  ///< N/m
  Vec3 direction;    ///< 0: without length
};

std::vector<RestingSpring> springs_at_rest(const ClothSystem& system) {
  std::vector<RestingSpring> springs;
  for (const SpringRun& run : system.springs)
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      const Vec3 d = system.start[static_cast<std::size_t>(j)] - system.start[static_cast<std::size_t>(i)];
      const double length = d.norm();
      springs.push_back({i, j, run.stiffness, length > 0 ? Vec3(d / length) : Vec3(0, 0, 0)});
    }
  return springs;
}

/// The numbers of each particle's springs, one particle after the other.
struct SpringsOfParticles {
  std::vector<int> begin, list;

  SpringsOfParticles(const std::vector<RestingSpring>& springs, std::size_t particles)
      : begin(particles + 1, 0) {
    for (const RestingSpring& s : springs)
      for (const int end : {s.i, s.j}) ++begin[static_cast<std::size_t>(end) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    list.resize(static_cast<std::size_t>(begin.back()));
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (std::size_t k = 0; k < springs.size(); ++k)
      for (const int end : {springs[k].i, springs[k].j})
        list[static_cast<std::size_t>(next[static_cast<std::size_t>(end)]++)] = static_cast<int>(k);
  }
};

}  // namespace

double resting_frequency(const ClothSystem& system) {
  const std::vector<RestingSpring> springs = springs_at_rest(system);
  const SpringsOfParticles meeting(springs, system.mass.size());
  double largest = 0;
  for (const RestingSpring& e : springs) {
    double sum = 0;
    for (const int end : {e.i, e.j}) {
      const auto particle = static_cast<std::size_t>(end);
      double stiffness = 0;
      for (int k = meeting.begin[particle]; k < meeting.begin[particle + 1]; ++k) {
        const RestingSpring& f = springs[static_cast<std::size_t>(meeting.list[static_cast<std::size_t>(k)])];
        const bool directed = e.direction.squaredNorm() > 0 && f.direction.squaredNorm() > 0;
        stiffness += f.stiffness * (directed ? std::abs(e.direction.dot(f.direction)) : 1);
      }
      sum += stiffness / system.mass[particle];
    }
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

}  // namespace cloth
