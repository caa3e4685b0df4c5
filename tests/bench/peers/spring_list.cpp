#include "bench/peers/spring_list.h"

namespace cloth::peers {

SpringList spring_list(const ClothSystem& system, const Vec3& gravity) {
  SpringList list{.position = system.start,
                  .velocity = Vec3Field(system.start.size()),
                  .mass = system.mass,
                  .springs = {},
                  .gravity = gravity};
  for (std::size_t i = 0; i < list.mass.size(); ++i)
    if (system.pinned[i]) list.mass[i] = 0;
  for (const SpringRun& run : system.springs)
    for (int k = 0; k < run.count; ++k)
      list.springs.push_back({.a = run.first + k,
                              .b = run.first + k + run.offset,
                              .rest_length = run.rest_length,
                              .stiffness = run.stiffness,
                              .bends = run.family == SpringFamily::flexion});
  return list;
}

}  // namespace cloth::peers
