// One root and one division after the other: compiled without vectors.
#pragma once

#include <cstddef>

namespace cloth::speed {

/// y = 1 / sqrt(x), both `count` long.
void scalar_roots(const double* x, double* y, std::size_t count);

}  // namespace cloth::speed
