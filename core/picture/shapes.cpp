#include "picture/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/mesh_cloth.h"
#include "cloth/normals.h"
#include "geometry/mesh_look.h"
#include "measure/strain.h"

namespace cloth {

namespace {

/// For the pattern: a share of the width and one of the height for each particle.
std::vector<Eigen::Vector2f> pattern_of(const ClothSystem& system) {
  std::vector<Eigen::Vector2f> shares;
  shares.reserve(static_cast<std::size_t>(system.size()));
  if (system.is_mesh()) {
    const FlatPattern flat = flat_pattern(rest_surface(system));
    const Eigen::Vector2d size = flat.size.cwiseMax(1e-9);
    for (const Eigen::Vector2d& at : flat.at) shares.push_back(at.cwiseQuotient(size).cast<float>());
    return shares;
  }
  for (int r = 0; r < system.rows; ++r)
    for (int c = 0; c < system.columns; ++c)
      shares.emplace_back(static_cast<float>(c) / static_cast<float>(system.columns - 1),
                          static_cast<float>(r) / static_cast<float>(system.rows - 1));
  return shares;
}

}  // namespace

PictureMesh sheet_mesh(const ClothSystem& system, const Vec3Field& position, double strain_scale) {
  PictureMesh mesh;
  if (!system.is_mesh() && (system.rows < 2 || system.columns < 2)) return mesh;
  Vec3Field normal(position.size());
  particle_normals(system, position, normal);
  std::vector<float> strain(position.size());
  particle_strain(system, position, strain);
  const std::vector<Eigen::Vector2f> share = pattern_of(system);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double fraction = strain[i] / strain_scale;
    mesh.vertices.push_back(
        {position[i], normal[i].cast<float>(), share[i].x(), share[i].y(),
         std::isnan(fraction) ? 1.0F : static_cast<float>(std::clamp(fraction, 0.0, 1.0))});
  }
  for (const Triangle& t : triangles_of(system))
    mesh.triangles.insert(mesh.triangles.end(), t.begin(), t.end());
  return mesh;
}

PictureMesh body_mesh(const TriangleMesh& body) {
  PictureMesh mesh;
  const std::vector<Vec3> normals = corner_normals(body);
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const int vertex = body.triangles[k / 3][k % 3];
    mesh.vertices.push_back({body.vertices[static_cast<std::size_t>(vertex)], normals[k].cast<float>()});
    mesh.triangles.push_back(static_cast<int>(k));
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
