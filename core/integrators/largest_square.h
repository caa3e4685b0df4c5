// What iterations compare their last change with.
#pragma once

#include <algorithm>

#include "geometry/vec3_field.h"

namespace cloth {

/// The largest |v|^2 of a field; 0 of an empty one.
inline double largest_square(const Vec3Field& field) {
  double largest = 0;
  for (std::size_t i = 0; i < field.size(); ++i) largest = std::max(largest, field[i].squaredNorm());
  return largest;
}

}  // namespace cloth
