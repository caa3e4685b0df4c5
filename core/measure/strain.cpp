#include "measure/strain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

template <class Visit>  // visit(i, j, squared distance)
void for_each_spring(const SpringRun& run, const Vec3Field& position, Visit visit) {
  const double *x = position.x(), *y = position.y(), *z = position.z();
  for (int i = run.first; i < run.first + run.count; ++i) {
    const int j = i + run.offset;
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    visit(i, j, dx * dx + dy * dy + dz * dz);
  }
}

}  // namespace

double Strain::maximum() const {
  return std::max(largest[static_cast<std::size_t>(SpringFamily::structural)],
                  largest[static_cast<std::size_t>(SpringFamily::shear)]);
}

Strain measure_strain(const ClothSystem& system, const Vec3Field& position) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  std::array<double, 3> largest{none, none, none};
  for (const SpringRun& run : system.springs) {
    if (!(run.rest_length > 0)) continue;  // a spring without length has no strain
    double longest = 0;
    for_each_spring(run, position, [&](int, int, double squared) { longest = std::max(longest, squared); });
    double& family = largest[static_cast<std::size_t>(run.family)];
    family = std::max(family, std::sqrt(longest) / run.rest_length - 1);
  }
  Strain strain;
  for (std::size_t family = 0; family < largest.size(); ++family)
    strain.largest[family] = largest[family] == none ? 0 : largest[family];
  return strain;
}

void particle_strain(const ClothSystem& system, const Vec3Field& position, std::span<float> strain) {
  constexpr float none = -2;  // below every strain: |d|/L - 1 >= -1
  std::fill(strain.begin(), strain.end(), none);
  for (const SpringRun& run : system.springs) {
    if (run.family == SpringFamily::flexion || !(run.rest_length > 0)) continue;
    for_each_spring(run, position, [&](int i, int j, double squared) {
      const auto value = static_cast<float>(std::sqrt(squared) / run.rest_length - 1);
      for (const int end : {i, j}) {
        float& at = strain[static_cast<std::size_t>(end)];
        at = std::max(at, value);
      }
    });
  }
  std::replace(strain.begin(), strain.end(), none, 0.0f);
}

}  // namespace cloth
