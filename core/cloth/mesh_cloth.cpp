#include "cloth/mesh_cloth.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cloth/grid.h"

namespace cloth {
namespace {

void append_springs(ClothSystem& system, SpringFamily family, const std::vector<std::array<int, 2>>& pairs,
                    double stiffness) {
  if (!(stiffness > 0)) return;
  for (const auto& [low, high] : pairs) {
    const double rest_length =
        (system.start[static_cast<std::size_t>(high)] - system.start[static_cast<std::size_t>(low)]).norm();
    system.springs.push_back({family, low, 1, high - low, rest_length, stiffness});
  }
}

ClothSystem make_mesh_cloth(const ClothSheet& sheet, const SpringMaterial& material) {
  const LoadedMesh& mesh = *sheet.mesh.loaded;
  ClothSystem system;
  const std::size_t particles = mesh.surface.vertices.size();
  system.rows = 1;
  system.columns = static_cast<int>(particles);
  system.triangles = mesh.surface.triangles;
  give_particles(sheet, system);
  for (std::size_t i = 0; i < particles; ++i) system.start.set(i, sheet.origin + mesh.surface.vertices[i]);
  system.diagonal = mesh.bounds.diagonal().norm();
  append_springs(system, SpringFamily::structural, mesh.edges, material.structural);
  append_springs(system, SpringFamily::flexion, mesh.hinges, material.flexion);
  return system;
}

}  // namespace

ClothSystem make_cloth(const ClothSheet& sheet, const SpringMaterial& material) {
  if (!sheet.is_mesh()) return make_grid(sheet, material);
  assert(sheet.mesh.is_loaded());
  return make_mesh_cloth(sheet, material);
}

double diagonal_of(const ClothSheet& sheet) {
  return sheet.is_mesh() ? sheet.mesh.loaded->bounds.diagonal().norm()
                         : std::hypot(sheet.width, sheet.height);
}

std::vector<Triangle> triangles_of(const ClothSystem& system) {
  if (system.is_mesh()) return system.triangles;
  std::vector<Triangle> triangles;
  for (int row = 0; row + 1 < system.rows; ++row)
    for (int column = 0; column + 1 < system.columns; ++column) {
      const int a = system.index(row, column), b = a + 1, d = a + system.columns, c = d + 1;
      triangles.push_back({a, d, c});
      triangles.push_back({a, c, b});
    }
  return triangles;
}

TriangleMesh rest_surface(const ClothSystem& system) {
  TriangleMesh surface{{}, triangles_of(system)};
  for (std::size_t i = 0; i < system.start.size(); ++i) surface.vertices.push_back(system.start[i]);
  return surface;
}

std::shared_ptr<const LoadedMesh> surface_to_draw(const ClothSystem& system) {
  auto mesh = std::make_shared<LoadedMesh>();
  mesh->surface = rest_surface(system);
  for (const Vec3& vertex : mesh->surface.vertices) mesh->bounds.extend(vertex);
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    if (run.family == SpringFamily::structural)
      mesh->edges.push_back({static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))});
  });
  std::sort(mesh->edges.begin(), mesh->edges.end());
  return mesh;
}

}  // namespace cloth
