// The parameters of a material.
#include "params/field_builders.h"
#include "scene/block_fields.h"

namespace cloth {
namespace {

using M = Material;

Field<M> stiffness(double M::*member, const char* key, const char* label, const char* doc) {
  return field(member, {.key = key,
                        .label = label,
                        .unit = "N/m",
                        .doc = doc,
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .slider_maximum = 1e4});
}

Field<M> bending(double M::*member, const char* key, const char* label, const char* doc,
                 const char* formula) {
  return field(member, {.key = key,
                        .label = label,
                        .unit = "N m",
                        .doc = doc,
                        .formula = formula,
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .slider_maximum = 1e-3});
}

Field<M> hysteresis(double M::*member, const char* key, const char* label, const char* doc) {
  return field(member, {.key = key,
                        .label = label,
                        .unit = "N",
                        .doc = doc,
                        .formula = "M = B kappa +- 2HB/2",
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .slider_maximum = 1e-2});
}

Field<M> damping_time(double M::*member, const char* key, const char* label, const char* doc) {
  return field(member, {.key = key,
                        .label = label,
                        .unit = "s",
                        .doc = doc,
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .slider_maximum = 0.1});
}

Field<M> drag(double M::*member, const char* key, const char* label, const char* doc, const char* formula) {
  return field(member, {.key = key,
                        .label = label,
                        .unit = "N s/m^3",
                        .doc = doc,
                        .formula = formula,
                        .scale = Scale::logarithmic,
                        .minimum = 0,
                        .slider_maximum = 10});
}

}  // namespace

Fields<Material> material_fields() {
  return {
      field(&M::areal_density, positive({.key = "areal_density",
                                         .label = "Areal density",
                                         .unit = "kg/m^2",
                                         .doc = "Mass of a square metre.",
                                         .scale = Scale::logarithmic,
                                         .slider_minimum = 0.01,
                                         .slider_maximum = 1})),
      stiffness(&M::stretch_warp, "stretch_warp", "Stretch stiffness, warp",
                "Force for each metre of width over strain, along the columns."),
      stiffness(&M::stretch_weft, "stretch_weft", "Stretch stiffness, weft",
                "Force for each metre of width over strain, along the rows."),
      stiffness(&M::shear, "shear", "Shear stiffness",
                "Force for each metre of width over the shear angle; springs also resist stretching across "
                "by as much."),
      number_or_auto(&M::coupling,
                     {.key = "coupling",
                      .label = "Coupling of warp and weft",
                      .unit = "N/m",
                      .doc = "Pull across over strain along, C12; \"auto\" is as much as shear, which is what "
                             "springs have. Another value needs a mesh.",
                      .minimum = 0,
                      .slider_maximum = 1e4}),
      bending(&M::bending_warp, "bending_warp", "Bending stiffness, warp",
              "Moment for each metre of width over curvature, of columns that bend.", "M = B kappa"),
      bending(&M::bending_weft, "bending_weft", "Bending stiffness, weft",
              "Moment for each metre of width over curvature, of rows that bend.", "M = B kappa"),
      bending(
          &M::twist, "twist", "Twist stiffness",
          "Resistance to twisting; bending_45, the bending stiffness at 45 degrees, may be given instead.",
          "twist = 2 B_45 - (B_warp + B_weft)/2"),
      hysteresis(&M::hysteresis_warp, "hysteresis_warp", "Bending hysteresis, warp",
                 "Width of the loop of moment over curvature of columns that bend and bend back, 2HB."),
      hysteresis(&M::hysteresis_weft, "hysteresis_weft", "Bending hysteresis, weft",
                 "Width of the loop of moment over curvature of rows that bend and bend back, 2HB."),
      damping_time(&M::stretch_damping, "stretch_damping", "Stretch damping",
                   "Of every spring the damper over its stiffness."),
      damping_time(&M::bending_damping, "bending_damping", "Bending damping",
                   "Of bending the resistance to its rate over that to bending."),
      field(&M::mass_damping, {.key = "mass_damping",
                               .label = "Mass damping",
                               .unit = "1/s",
                               .doc = "Resistance to every motion over mass, free fall included.",
                               .formula = "F = -rate m v",
                               .scale = Scale::logarithmic,
                               .minimum = 0,
                               .slider_maximum = 10}),
      drag(&M::drag_normal, "drag_normal", "Air drag, normal",
           "Force of the air for each area and speed along the normal.", "F/A = c (n . (u - v)) n"),
      drag(&M::drag_tangential, "drag_tangential", "Air drag, along",
           "Force of the air for each area and speed along the cloth.", "F/A = c (I - n n^T) (u - v)"),
  };
}

Material starter_material() {
  return {.areal_density = 0.15,
          .stretch_warp = 500,
          .stretch_weft = 400,
          .shear = 30,
          .bending_warp = 2e-5,
          .bending_weft = 1.5e-5,
          .twist = 1.7e-5,
          .stretch_damping = 0.0005,
          .bending_damping = 0.001,
          .mass_damping = 0.2,
          .drag_normal = 1,
          .drag_tangential = 0.05};
}

}  // namespace cloth
