#include "cloth/cloth_obj.h"

#include <fmt/format.h>

#include "cloth/mesh_cloth.h"
#include "cloth/normals.h"
#include "io/obj_writer.h"

namespace cloth {
namespace {

std::vector<double> interleaved(const Vec3Field& field) {
  std::vector<double> values;
  values.reserve(3 * field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Vec3 value = field[i];
    values.insert(values.end(), {value.x(), value.y(), value.z()});
  }
  return values;
}

}  // namespace

std::string cloth_obj(const ClothSystem& system, const ClothState& state, const std::string& title) {
  Vec3Field normal(state.position.size());
  particle_normals(system, state.position, normal);
  const std::vector<double> positions = interleaved(state.position), normals = interleaved(normal);
  const std::vector<Triangle> triangles = triangles_of(system);
  ObjSurface<double> surface;
  surface.positions = positions;
  surface.normals = normals;
  surface.texture = grid_texture<double>(system.rows, system.columns);
  surface.triangles = triangles;
  return obj_text(surface, title);
}

std::string title_at(const std::string& scene_title, double time) {
  return fmt::format("{}, at {:.6g} s", scene_title, time);
}

}  // namespace cloth
