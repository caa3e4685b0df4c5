// The parameters of obstacles: of each shape, of their surface and of their motion.
#include "params/field_builders.h"
#include "scene/mesh_field.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

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

Fields<Obstacle> shape_fields(Shape shape) {
  using O = Obstacle;
  const ParameterInfo place{.unit = "m", .slider_minimum = -2, .slider_maximum = 2};
  auto placed = [&](const char* key, const char* label, const char* doc) {
    ParameterInfo info = place;
    info.key = key, info.label = label, info.doc = doc;
    return info;
  };
  switch (shape) {
    case Shape::sphere:
      return {vector(&O::center, placed("center", "Centre", "Centre of the sphere.")),
              number(&O::radius, {.key = "radius",
                                  .label = "Radius",
                                  .unit = "m",
                                  .doc = "Radius of the sphere.",
                                  .minimum = 0,
                                  .minimum_excluded = true,
                                  .slider_minimum = 0.01,
                                  .slider_maximum = 1})};
    case Shape::box:
      return {vector(&O::center, placed("center", "Centre", "Centre of the box.")),
              vector(&O::size, {.key = "size",
                                .label = "Size",
                                .unit = "m",
                                .doc = "Full lengths of the box along x, y and z.",
                                .minimum = 0,
                                .minimum_excluded = true,
                                .slider_minimum = 0.01,
                                .slider_maximum = 2})};
    case Shape::plane:
      return {vector(&O::point, placed("point", "Point", "A point of the plane.")),
              vector(&O::normal, {.key = "normal",
                                  .label = "Normal",
                                  .doc = "Outward direction of the plane.",
                                  .unit_vector = true,
                                  .slider_minimum = -1,
                                  .slider_maximum = 1})};
    case Shape::mesh:
      return mesh_obstacle_fields();
  }
  return {};
}

Fields<Obstacle> with_response(Fields<Obstacle> fields) {
  using O = Obstacle;
  fields.push_back(
      choice(&O::response, {.key = "response",
                            .label = "Response",
                            .doc = "Coulomb: friction and restitution. Reflect: the report's Eq. (17).",
                            .formula = "coulomb: v_n -> -e v_n, v_t loses up to friction |change of v_n|; "
                                       "reflect: v -> f (v - 2 v_n n)",
                            .choices = {"coulomb", "reflect"}}));
  fields.push_back(
      number(&O::friction, {.key = "friction",
                            .label = "Friction",
                            .doc = "Coulomb: coefficient of friction. Reflect: what is kept of the velocity.",
                            .minimum = 0,
                            .slider_minimum = 0,
                            .slider_maximum = 1}));
  fields.push_back(number(&O::restitution, {.key = "restitution",
                                            .label = "Restitution",
                                            .doc = "Coulomb: what is kept of the normal speed, 0 to 1.",
                                            .minimum = 0,
                                            .maximum = 1,
                                            .slider_minimum = 0,
                                            .slider_maximum = 1}));
  return fields;
}

}  // namespace

const Fields<Obstacle>& obstacle_fields(Shape shape) {
  static const auto all = [] {
    std::array<Fields<Obstacle>, all_shapes.size()> fields;
    for (std::size_t k = 0; k < fields.size(); ++k) fields[k] = with_response(shape_fields(all_shapes[k]));
    return fields;
  }();
  return all[static_cast<std::size_t>(shape)];
}

const Fields<Obstacle>& motion_fields() {
  using O = Obstacle;
  static const Fields<O> fields{
      vector(&O::velocity, {.key = "velocity",
                            .label = "Velocity",
                            .unit = "m/s",
                            .doc = "Steady motion of the obstacle from the start on.",
                            .slider_minimum = -5,
                            .slider_maximum = 5}),
      vector(&O::spin, {.key = "spin",
                        .label = "Spin",
                        .unit = "rad/s",
                        .doc = "Steady turning about the obstacle's centre or point: axis times rate.",
                        .slider_minimum = -10,
                        .slider_maximum = 10}),
  };
  return fields;
}

const Fields<Keyframe>& keyframe_fields() {
  using K = Keyframe;
  static const Fields<K> fields{
      number(&K::time, {.key = "time", .label = "Time", .unit = "s", .doc = "When the obstacle is there."}),
      vector(
          &K::position,
          {.key = "position", .label = "Position", .unit = "m", .doc = "Where its centre or point is then."}),
      vector(&K::rotation, {.key = "rotation",
                            .label = "Rotation",
                            .unit = "rad",
                            .doc = "How it is turned then: axis times angle."}),
  };
  return fields;
}

}  // namespace cloth
