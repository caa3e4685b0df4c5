#include "compare/difference.h"

#include <cassert>
#include <cmath>

namespace cloth {

void measure_difference(const Vec3Field& a, const Vec3Field& b, Difference& into) {
  assert(a.size() == b.size());
  into.distance.resize(a.size());
  into.largest = 0;
  into.particle = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double square = (a[i] - b[i]).squaredNorm();
    const double distance = std::sqrt(square);
    squares += square;
    into.distance[i] = static_cast<float>(distance);
    if (distance > into.largest) {
      into.largest = distance;
      into.particle = static_cast<int>(i);
    }
  }
  into.rms = a.size() > 0 ? std::sqrt(squares / static_cast<double>(a.size())) : 0;
}

}  // namespace cloth
