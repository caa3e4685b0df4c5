#include "picture/shapes.h"

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

PictureMesh box_mesh(const Vec3& center, const Vec3& size) {
  PictureMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int first = static_cast<int>(mesh.vertices.size());
      const Vec3 n = side * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3), v = n.cross(u);
      for (const auto& [s, t] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        mesh.vertices.push_back({center + size.cwiseProduct(n + s * u + t * v) / 2, n.cast<float>()});
      for (const int k : {0, 1, 2, 0, 2, 3}) mesh.triangles.push_back(first + k);
    }
  }
  return mesh;
}

}  // namespace cloth
