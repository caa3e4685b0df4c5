// One root and one division after the other: compiled, like the reference kernel, without vectors.
#pragma once

#include <cstddef>

namespace cloth::speed {

/// y = 1 / sqrt(x), both `count` long.
void scalar_roots(const double* x, double* y, std::size_t count);

}  // namespace cloth::speed
