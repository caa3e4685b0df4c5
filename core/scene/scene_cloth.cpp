#include "scene/scene_cloth.h"

#include "cloth/grid.h"
#include "cloth/material_cut.h"
#include "cloth/material_grid.h"
#include "cloth/material_mesh.h"
#include "cloth/mesh_cloth.h"

namespace cloth {

ClothSystem make_cloth(const Scene& scene) {
  if (scene.material && scene.cloth.is_mesh()) return make_material_mesh(scene.cloth, *scene.material);
  if (scene.material && scene.cloth.is_cut()) return make_material_cut(scene.cloth, *scene.material);
  if (scene.material) return make_material_grid(scene.cloth, *scene.material);
  return make_cloth(scene.cloth, scene.springs.value_or(SpringMaterial{}));
}

CellSides cell_sides(const ClothSheet& sheet) {
  const GridCell cell = cell_of(sheet);
  return {cell.across.norm(), cell.down.norm()};
}

double particle_mass(const Scene& scene) {
  const ClothSheet& sheet = scene.cloth;
  if (!scene.material) return sheet.mass / (double(sheet.rows) * sheet.columns);
  if (sheet.is_mesh())
    return scene.material->areal_density * area_of(sheet.mesh.loaded->surface) / sheet.columns;
  const CellSides cell = cell_sides(sheet);
  return scene.material->areal_density * cell.across * cell.down;
}

void scale_stiffness(Scene& scene, double factor) {
  if (SpringMaterial* s = scene.springs ? &*scene.springs : nullptr)
    s->structural *= factor, s->shear *= factor, s->flexion *= factor;
  if (Material* m = scene.material ? &*scene.material : nullptr) {
    m->stretch_warp *= factor, m->stretch_weft *= factor, m->shear *= factor;
    if (m->coupling) *m->coupling *= factor;
    m->bending_warp *= factor, m->bending_weft *= factor, m->twist *= factor;
  }
}

void scale_mass(Scene& scene, double factor) {
  if (scene.material)
    scene.material->areal_density *= factor;
  else
    scene.cloth.mass *= factor;
}

double leading_stiffness(const Scene& scene) {
  if (scene.material) return scene.material->stretch_warp;
  return scene.springs ? scene.springs->structural : 0;
}

}  // namespace cloth
