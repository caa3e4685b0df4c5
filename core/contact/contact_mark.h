// Contact points, for display.
#pragma once

#include "geometry/vec3_field.h"

namespace cloth {

struct ContactMark {
  Vec3 point{0, 0, 0};        ///< m, of the cloth
  Vec3 normal{0, 1, 0};       ///< unit vector, from the obstacle to the cloth
  double normal_impulse = 0;  ///< kg m, of the last step; 0 where it is not known
};

}  // namespace cloth
