// How far two states of one cloth are apart, particle by particle.
#pragma once

#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

struct Difference {
  double rms = 0;               ///< m, root of the mean squared distance of all particles
  double largest = 0;           ///< m
  int particle = 0;             ///< that has the largest; the first of several
  std::vector<float> distance;  ///< m, one of each particle, for colours
};

/// Between the same particles of `a` and `b`, which are of one size.
void measure_difference(const Vec3Field& a, const Vec3Field& b, Difference& into);

}  // namespace cloth
