#include "cloth/cloth_system.h"

#include <numeric>

namespace cloth {

const char* name_of(SpringFamily family) {
  return std::array{"structural", "shear", "flexion"}.at(static_cast<std::size_t>(family));
}

std::int64_t ClothSystem::spring_count(SpringFamily family) const {
  std::int64_t count = 0;
  for (const SpringRun& run : springs)
    if (run.family == family) count += run.count;
  return count;
}

double ClothSystem::total_mass() const {
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}

}  // namespace cloth
