// Random numbers of tests: the seed is fixed, printed, and taken from CLOTHLAB_TEST_SEED where that is set.
#pragma once

#include <random>

#include "geometry/vec3_field.h"

namespace cloth::test {

class Random {
 public:
  Random();
  double uniform(double low, double high);
  double normal(double deviation);
  int integer(int low, int high);  ///< both included
  bool coin() { return integer(0, 1) == 1; }
  Vec3 vector(double deviation);
  Vec3Field field(std::size_t size, double deviation);

 private:
  std::mt19937_64 engine_;
};

}  // namespace cloth::test
