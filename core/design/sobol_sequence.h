// The Sobol' sequence of design.h.
#pragma once

#include "design/design.h"

namespace cloth {

/// Its first `count` points, with `shifts[j]` added bit by bit (xor) to number j: all 0 for the sequence
/// itself. The shifts' size is the number of dimensions, 1 to max_sobol_dimensions.
UnitPoints sobol_sequence(std::size_t count, const std::vector<std::uint64_t>& shifts);

/// Shifts drawn from a seed.
std::vector<std::uint64_t> digital_shifts(std::size_t dimensions, std::uint64_t seed);

}  // namespace cloth
