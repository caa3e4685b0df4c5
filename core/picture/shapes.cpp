#include "picture/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/normals.h"
#include "measure/strain.h"

namespace cloth {

PictureMesh sheet_mesh(const ClothSystem& system, const Vec3Field& position, double strain_scale) {
  const int rows = system.rows, columns = system.columns;
  PictureMesh mesh;
  if (rows < 2 || columns < 2) return mesh;
  Vec3Field normal(position.size());
  particle_normals(rows, columns, position, normal);
  std::vector<float> strain(position.size());
  particle_strain(system, position, strain);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<std::size_t>(system.index(r, c));
      const double fraction = strain[i] / strain_scale;
      mesh.vertices.push_back(
          {position[i], normal[i].cast<float>(), static_cast<float>(c) / static_cast<float>(columns - 1),
           static_cast<float>(r) / static_cast<float>(rows - 1),
           std::isnan(fraction) ? 1.0F : static_cast<float>(std::clamp(fraction, 0.0, 1.0))});
    }
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = system.index(r, c), b = a + 1, d = a + columns, opposite = d + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, d, opposite, a, opposite, b});
    }
  }
  return mesh;
}

PictureMesh sphere_mesh(const Vec3& center, double radius) {
  constexpr int around = 96, down = 48;
  constexpr double pi = std::numbers::pi;
  PictureMesh mesh;
  for (int i = 0; i <= down; ++i) {
    for (int k = 0; k <= around; ++k) {
      const double polar = pi * i / down, turn = 2 * pi * k / around;
      const Vec3 n(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
      mesh.vertices.push_back({center + radius * n, n.cast<float>()});
    }
  }
  for (int i = 0; i < down; ++i) {
    for (int k = 0; k < around; ++k) {
      const int a = i * (around + 1) + k, b = a + around + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  return mesh;
}

PictureMesh box_mesh(const Vec3& center, const Vec3& size, double rounding) {
  // A ball of that radius, cut into eight along the axes' planes, its pieces moved to the box's corners; what
  // comes to lie between them are the rounded edges and the flat faces.
  constexpr int steps = 6, around = 4 * (steps + 1), down = 2 * (steps + 1);
  constexpr double quarter = std::numbers::pi / 2;
  const double r = std::clamp(rounding, 0.0, 0.5 * size.minCoeff());
  const Vec3 corner = size / 2 - Vec3::Constant(r);
  PictureMesh mesh;
  for (int i = 0; i < down; ++i) {
    for (int k = 0; k < around; ++k) {
      const int half = i / (steps + 1), part = k / (steps + 1);
      const double polar = quarter * (half + static_cast<double>(i % (steps + 1)) / steps);
      const double turn = quarter * (part + static_cast<double>(k % (steps + 1)) / steps);
      const Vec3 n(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
      const Vec3 side(part < 2 ? 1 : -1, half == 0 ? 1 : -1, part == 0 || part == 3 ? 1 : -1);
      mesh.vertices.push_back({center + corner.cwiseProduct(side) + r * n, n.cast<float>()});
    }
  }
  for (int i = 0; i + 1 < down; ++i) {
    for (int k = 0; k < around; ++k) {
      const int a = i * around + k, next = i * around + (k + 1) % around, b = a + around,
                next_b = next + around;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, next_b, a, next_b, next});
    }
  }
  for (const bool top : {true, false}) {
    const int first = top ? 0 : (down - 1) * around, part = steps + 1;
    const std::array<int, 4> cap{first, first + part, first + 2 * part, first + 3 * part};
    const auto add = [&](int a, int b, int c) { mesh.triangles.insert(mesh.triangles.end(), {a, b, c}); };
    top ? add(cap[0], cap[1], cap[2]) : add(cap[0], cap[2], cap[1]);
    top ? add(cap[0], cap[2], cap[3]) : add(cap[0], cap[3], cap[2]);
  }
  return mesh;
}

}  // namespace cloth
