#include "viewport/gl/cloth_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

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

void cloth_normals(std::span<const float> positions, int rows, int columns, std::vector<float>& normals) {
  using Point = Eigen::Map<const Eigen::Vector3f>;
  using Sum = Eigen::Map<Eigen::Vector3f>;
  normals.assign(positions.size(), 0.0F);
  for (int r = 0; r + 1 < rows; ++r) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = 3 * (static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(column));
      const std::size_t b = a + 3, d = a + 3 * static_cast<std::size_t>(columns), c = d + 3;
      const Point pa(&positions[a]), pb(&positions[b]), pc(&positions[c]), pd(&positions[d]);
      const Eigen::Vector3f diagonal = pc - pa;
      const Eigen::Vector3f lower = (pd - pa).cross(diagonal), upper = diagonal.cross(pb - pa);
      Sum(&normals[a]) += lower + upper;
      Sum(&normals[c]) += lower + upper;
      Sum(&normals[d]) += lower;
      Sum(&normals[b]) += upper;
    }
  }
}

}  // namespace clothlab
