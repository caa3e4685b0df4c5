#include "bench/speed/scalar_roots.h"

#include <cmath>

namespace cloth::speed {

void scalar_roots(const double* x, double* y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) y[i] = 1 / std::sqrt(x[i]);
}

}  // namespace cloth::speed
