// The cloth's triangles: two per cell of the grid.
#pragma once

#include <cstdint>
#include <vector>

namespace clothlab {

/// Triangles (a, d, c) and (a, c, b) of each cell a = (r, c), b = (r, c+1), c = (r+1, c+1), d = (r+1, c): the
/// face of a cloth laid out to the right and downwards looks at the viewer.
void cloth_triangles(int rows, int columns, std::vector<std::uint32_t>& indices);

}  // namespace clothlab
