// The parameters of a grid cloth; those of a cloth from a mesh are in mesh_declarations.cpp.
#include "params/field_builders.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

Fields<ClothSheet> grid_cloth_fields() {
  using C = ClothSheet;
  return {
      integer(&C::columns, {.key = "columns",
                            .label = "Columns",
                            .doc = "Particles along each row.",
                            .cost = EditCost::restart,
                            .scale = Scale::logarithmic,
                            .minimum = 2,
                            .maximum = 4096,
                            .slider_minimum = 2,
                            .slider_maximum = 257}),
      integer(&C::rows, {.key = "rows",
                         .label = "Rows",
                         .doc = "Particles along each column.",
                         .cost = EditCost::restart,
                         .scale = Scale::logarithmic,
                         .minimum = 2,
                         .maximum = 4096,
                         .slider_minimum = 2,
                         .slider_maximum = 257}),
      number(&C::width, {.key = "width",
                         .label = "Width",
                         .unit = "m",
                         .doc = "Length of a row at the start.",
                         .cost = EditCost::restart,
                         .minimum = 0,
                         .minimum_excluded = true,
                         .slider_minimum = 0.1,
                         .slider_maximum = 4}),
      number(&C::height, {.key = "height",
                          .label = "Height",
                          .unit = "m",
                          .doc = "Length of a column at the start.",
                          .cost = EditCost::restart,
                          .minimum = 0,
                          .minimum_excluded = true,
                          .slider_minimum = 0.1,
                          .slider_maximum = 4}),
      number(&C::mass, {.key = "mass",
                        .label = "Mass",
                        .unit = "kg",
                        .doc = "Mass of the whole cloth, shared equally by its particles.",
                        .formula = "m = mass / (rows * columns)",
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .minimum_excluded = true,
                        .slider_minimum = 0.01,
                        .slider_maximum = 10}),
      vector(&C::origin, {.key = "origin",
                          .label = "Origin",
                          .unit = "m",
                          .doc = "Where the top left particle starts.",
                          .cost = EditCost::restart,
                          .slider_minimum = -2,
                          .slider_maximum = 2}),
      vector(&C::across, {.key = "across",
                          .label = "Across",
                          .doc = "Direction of a row.",
                          .cost = EditCost::restart,
                          .unit_vector = true,
                          .slider_minimum = -1,
                          .slider_maximum = 1}),
      vector(&C::down, {.key = "down",
                        .label = "Down",
                        .doc = "Direction of a column.",
                        .cost = EditCost::restart,
                        .unit_vector = true,
                        .slider_minimum = -1,
                        .slider_maximum = 1}),
  };
}

}  // namespace

const Fields<ClothSheet>& cloth_fields(bool is_mesh) {
  static const Fields<ClothSheet> grid = grid_cloth_fields();
  if (!is_mesh) return grid;
  static const Fields<ClothSheet> mesh = mesh_cloth_fields();
  return mesh;
}

}  // namespace cloth
