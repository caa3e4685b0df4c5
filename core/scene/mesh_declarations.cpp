// The parameters of what comes from mesh files: cloths and obstacles.
#include <algorithm>

#include "params/field_builders.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

/// A mesh is chosen by its file; load_meshes() reads it.
template <class Owner>
Field<Owner> mesh_file(MeshChoice Owner::*member, ParameterInfo info) {
  info.kind = Kind::text;
  return {std::move(info), [member](const Owner& owner) { return ParameterValue((owner.*member).file); },
          [member](Owner& owner, const ParameterValue& value) {
            (owner.*member).file = std::get<std::string>(value);
          }};
}

Field<ClothSheet> shared_field(const std::string& key) {
  const Fields<ClothSheet>& grid = cloth_fields(false);
  return *std::find_if(grid.begin(), grid.end(),
                       [&](const Field<ClothSheet>& field) { return field.info.key == key; });
}

}  // namespace

Fields<ClothSheet> mesh_cloth_fields() {
  Field<ClothSheet> mass = shared_field("mass"), origin = shared_field("origin");
  mass.info.formula = "m = mass / vertices";
  origin.info.doc = "How far the mesh is moved from where its file has it.";
  return {
      mesh_file(&ClothSheet::mesh,
                {.key = "mesh",
                 .label = "Mesh",
                 .doc = "OBJ file, as seen from the scene's folder, or built-in mesh; its vertices are the "
                        "particles.",
                 .cost = EditCost::restart}),
      std::move(mass), std::move(origin)};
}

Fields<Obstacle> mesh_obstacle_fields() {
  using O = Obstacle;
  return {mesh_file(&O::mesh, {.key = "file",
                               .label = "Mesh",
                               .doc = "OBJ file, as seen from the scene's folder, or built-in mesh."}),
          number(&O::scale, {.key = "scale",
                             .label = "Scale",
                             .doc = "Factor on the file's lengths.",
                             .scale = Scale::logarithmic,
                             .minimum = 0,
                             .minimum_excluded = true,
                             .smallest = 1e-9,
                             .slider_minimum = 0.01,
                             .slider_maximum = 100}),
          vector(&O::rotate, {.key = "rotate",
                              .label = "Rotation",
                              .unit = "deg",
                              .doc = "Turns about the x, then the y, then the z axis.",
                              .slider_minimum = -180,
                              .slider_maximum = 180}),
          vector(&O::translate, {.key = "translate",
                                 .label = "Position",
                                 .unit = "m",
                                 .doc = "Where the file's origin is put.",
                                 .formula = "x = translate + R_z R_y R_x scale x_file",
                                 .slider_minimum = -2,
                                 .slider_maximum = 2})};
}

}  // namespace cloth
