#include "cloth/material_mesh.h"

#include <cassert>
#include <map>

#include "cloth/grid.h"
#include "cloth/mesh_bending.h"

namespace cloth {
namespace {

void give_masses(double areal_density, const TriangleMesh& mesh, ClothSystem& system) {
  std::fill(system.mass.begin(), system.mass.end(), 0.0);
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) system.mass[at(corner)] += areal_density * mesh.area_normal(t).norm() / 6;
  for (std::size_t i = 0; i < system.mass.size(); ++i)
    system.inverse_mass[i] = system.pinned[i] ? 0 : 1 / system.mass[i];
}

/// Springs without stiffness along the edges, and the number of each by its ends.
std::map<std::pair<int, int>, int> add_edges(const LoadedMesh& mesh, ClothSystem& system) {
  std::map<std::pair<int, int>, int> number;
  for (const auto& [low, high] : mesh.edges) {
    number.emplace(std::pair(low, high), static_cast<int>(number.size()));
    const double length = (system.start[at(high)] - system.start[at(low)]).norm();
    system.springs.push_back({SpringFamily::structural, low, 1, high - low, length, 0});
  }
  return number;
}

void add_membrane(const LoadedMesh& mesh, const PlaneAxes& axes, const PlaneStiffness& stiffness,
                  ClothSystem& system) {
  const auto number = add_edges(mesh, system);
  for (const Triangle& t : mesh.surface.triangles) {
    if (!(mesh.surface.area_normal(t).norm() > 0)) continue;
    const auto [one, two] = axes.in(mesh.surface, t);
    std::array<Eigen::Vector2d, 3> at_rest;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 arm = mesh.surface.vertices[at(t[c])] - mesh.surface.vertices[at(t[0])];
      at_rest[c] = {arm.dot(one), arm.dot(two)};
    }
    MembraneTriangle triangle = membrane_triangle(t, at_rest, stiffness);
    for (std::size_t e = 0; e < 3; ++e) triangle.spring[e] = number.at(std::minmax({t[e], t[(e + 1) % 3]}));
    system.membrane.push_back(triangle);
  }
}

}  // namespace

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += 0.5 * mesh.area_normal(t).norm();
  return sum;
}

ClothSystem make_material_mesh(const ClothSheet& sheet, const Material& material) {
  assert(sheet.mesh.is_loaded());
  const LoadedMesh& mesh = *sheet.mesh.loaded;
  ClothSystem system;
  system.rows = 1;
  system.columns = static_cast<int>(mesh.surface.vertices.size());
  system.triangles = mesh.surface.triangles;
  give_particles(sheet, system);
  give_masses(material.areal_density, mesh.surface, system);
  for (std::size_t i = 0; i < system.mass.size(); ++i)
    system.start.set(i, sheet.origin + mesh.surface.vertices[i]);
  system.diagonal = mesh.bounds.diagonal().norm();
  const PlaneAxes axes{sheet.down, sheet.across};
  add_membrane(mesh, axes,
               {material.stretch_warp, material.stretch_weft, coupling_of(material), material.shear}, system);
  MeshBending bending = mesh_bending(mesh.surface, system.pinned, axes,
                                     {material.bending_warp, material.bending_weft, material.twist},
                                     {.yield_1 = 0.5 * material.hysteresis_warp,
                                      .yield_2 = 0.5 * material.hysteresis_weft,
                                      .stiffness_1 = slider_stiffness_ratio * material.bending_warp,
                                      .stiffness_2 = slider_stiffness_ratio * material.bending_weft});
  system.bending = std::move(bending.elements);
  if (!system.bending.empty()) system.bending_rows = bending_rows(system.bending, system.mass.size());
  system.sliders = std::move(bending.sliders);
  return system;
}

}  // namespace cloth
