// A cloth as another program gets it: particles, and springs between them one by one.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"

namespace cloth::peers {

struct ListedSpring {
  int a = 0, b = 0;
  double rest_length = 0;  ///< m
  double stiffness = 0;    ///< N/m
  bool bends = false;      ///< of flexion
};

struct SpringList {
  Vec3Field position, velocity;  ///< m, m/s
  std::vector<double> mass;      ///< kg; 0 where pinned
  std::vector<ListedSpring> springs;
  Vec3 gravity{0, 0, 0};  ///< m/s^2
};

/// The start of a cloth of springs. Nothing but springs and gravity is listed.
SpringList spring_list(const ClothSystem& system, const Vec3& gravity);

}  // namespace cloth::peers
