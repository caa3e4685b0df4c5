// The Latin hypercube of design.h.
#pragma once

#include "design/design.h"

namespace cloth {

UnitPoints latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed);

/// The square of the distance of the two closest points; `enough`: a smaller value may be any that is below
/// it. Infinity for fewer than two points.
double closest_pair(const UnitPoints& points, double enough = 0);

}  // namespace cloth
