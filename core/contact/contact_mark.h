// Where contact acts, for whoever wants to see it.
#pragma once

#include "cloth/vec3_field.h"

namespace cloth {

struct ContactMark {
  Vec3 point{0, 0, 0};        ///< m, of the cloth
  Vec3 normal{0, 1, 0};       ///< the way the cloth is pushed, of length one
  double normal_impulse = 0;  ///< kg m, of the last step; 0 where contact does not say
};

}  // namespace cloth
