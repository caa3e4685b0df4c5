#include "viewport/gl/cloth_mesh.h"

namespace clothlab {

void cloth_triangles(int rows, int columns, std::vector<std::uint32_t>& indices) {
  indices.clear();
  for (int r = 0; r + 1 < rows; ++r) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<std::uint32_t>(r * columns + column), b = a + 1;
      const std::uint32_t d = a + static_cast<std::uint32_t>(columns), c = d + 1;
      indices.insert(indices.end(), {a, d, c, a, c, b});
    }
  }
}

}  // namespace clothlab
