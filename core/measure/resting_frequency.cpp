// The bound on the frequencies at rest, without iterating.

#include <algorithm>
#include <cmath>

#include "measure/spectrum.h"

namespace cloth {
namespace {

struct RestingSpring {
  std::size_t i, j;
  double stiffness;  ///< N/m
  Vec3 direction;    ///< 0: without length
};

std::vector<RestingSpring> springs_at_rest(const ClothSystem& system) {
  std::vector<RestingSpring> springs;
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    const Vec3 d = system.start[j] - system.start[i];
    const double length = d.norm();
    springs.push_back({i, j, run.stiffness, length > 0 ? Vec3(d / length) : Vec3(0, 0, 0)});
  });
  return springs;
}

}  // namespace

double resting_frequency(const ClothSystem& system) {
  const std::vector<RestingSpring> springs = springs_at_rest(system);
  std::vector<std::vector<std::size_t>> of_particle(system.mass.size());  // the numbers of its springs
  for (std::size_t k = 0; k < springs.size(); ++k)
    for (const std::size_t end : {springs[k].i, springs[k].j}) of_particle[end].push_back(k);
  double largest = 0;
  for (const RestingSpring& e : springs) {
    double sum = 0;
    for (const std::size_t particle : {e.i, e.j}) {
      double stiffness = 0;
      for (const std::size_t k : of_particle[particle]) {
        const RestingSpring& f = springs[k];
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
