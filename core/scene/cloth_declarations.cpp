// The parameters of a cloth: of a grid, and of a mesh.
#include <algorithm>

#include "params/field_builders.h"
#include "scene/blocks.h"

namespace cloth {
namespace {

Field<ClothSheet> cut_field() {
  return field(&ClothSheet::cut,
               {.key = "cut",
                .label = "Cut",
                .doc = "What is left of the grid: all of it, or the cells whose middle lies within the "
                       "ellipse of this width and height.",
                .cost = EditCost::restart,
                .choices = {"none", "round"}});
}

Fields<ClothSheet> grid_cloth_fields() {
  using C = ClothSheet;
  const auto count = [](int C::*member, const char* key, const char* label, const char* doc) {
    return field(member, {.key = key,
                          .label = label,
                          .doc = doc,
                          .cost = EditCost::restart,
                          .scale = Scale::logarithmic,
                          .minimum = 2,
                          .maximum = 4096,
                          .slider_minimum = 2,
                          .slider_maximum = 257});
  };
  const auto length = [](double C::*member, const char* key, const char* label, const char* doc) {
    return field(member, positive({.key = key,
                                   .label = label,
                                   .unit = "m",
                                   .doc = doc,
                                   .cost = EditCost::restart,
                                   .slider_minimum = 0.1,
                                   .slider_maximum = 4}));
  };
  const auto direction = [](Vec3 C::*member, const char* key, const char* label, const char* doc) {
    return field(member, {.key = key,
                          .label = label,
                          .doc = doc,
                          .cost = EditCost::restart,
                          .unit_vector = true,
                          .slider_minimum = -1});
  };
  return {
      count(&C::columns, "columns", "Columns", "Particles along each row."),
      count(&C::rows, "rows", "Rows", "Particles along each column."),
      length(&C::width, "width", "Width", "Length of a row at the start."),
      length(&C::height, "height", "Height", "Length of a column at the start."),
      field(&C::mass, positive({.key = "mass",
                                .label = "Mass",
                                .unit = "kg",
                                .doc = "Mass of the whole cloth, shared equally by its particles.",
                                .formula = "m = mass / (rows * columns)",
                                .scale = Scale::logarithmic,
                                .slider_minimum = 0.01,
                                .slider_maximum = 10})),
      field(&C::origin, {.key = "origin",
                         .label = "Origin",
                         .unit = "m",
                         .doc = "Where the top left particle starts.",
                         .cost = EditCost::restart,
                         .slider_minimum = -2,
                         .slider_maximum = 2}),
      direction(&C::across, "across", "Across", "Direction of a row."),
      direction(&C::down, "down", "Down", "Direction of a column."),
      cut_field(),
  };
}

Field<ClothSheet> shared_field(const std::string& key) {
  const Fields<ClothSheet>& grid = cloth_fields(false);
  return *std::find_if(grid.begin(), grid.end(),
                       [&](const Field<ClothSheet>& field) { return field.info.key == key; });
}

Fields<ClothSheet> mesh_cloth_fields() {
  Field<ClothSheet> mass = shared_field("mass"), origin = shared_field("origin"),
                    across = shared_field("across"), down = shared_field("down");
  across.info.doc = "Direction of a material's weft where down stands across the triangle.";
  down.info.doc = "Direction of a material's warp, as projected into each triangle.";
  mass.info.formula = "m = mass / vertices";
  origin.info.doc = "How far the mesh is moved from where its file has it.";
  return {field(&ClothSheet::mesh,
                {.key = "mesh",
                 .label = "Mesh",
                 .doc = "OBJ file, as seen from the scene's folder, or built-in mesh; its vertices are the "
                        "particles.",
                 .cost = EditCost::restart}),
          std::move(mass), std::move(origin), std::move(across), std::move(down)};
}

}  // namespace

const Fields<ClothSheet>& cloth_fields(bool is_mesh) {
  static const Fields<ClothSheet> grid = grid_cloth_fields();
  if (!is_mesh) return grid;
  static const Fields<ClothSheet> mesh = mesh_cloth_fields();
  return mesh;
}

std::vector<Parameter> cloth_parameters(bool is_mesh) {
  return bound<ClothSheet>("cloth", cloth_fields(is_mesh), [](Scene& s) -> ClothSheet& { return s.cloth; });
}

}  // namespace cloth
