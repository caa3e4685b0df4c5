// The parameters of obstacles of any shape: of their surface and of their motion. Those of the shapes stand
// in their files (scene/shapes/).
#include <map>

#include "params/field_builders.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

Fields<Obstacle> with_response(Fields<Obstacle> fields) {
  using O = Obstacle;
  fields.push_back(
      field(&O::response,
            {.key = "response",
             .label = "Response",
             .doc = "Coulomb: friction and restitution. Reflect: the report's Eq. (17), which returns no "
                    "more energy than the contact takes.",
             .formula = "coulomb: v_n -> -e v_n, v_t loses up to friction |change of v_n|; "
                        "reflect: v -> f (v - 2 v_n n)",
             .choices = {"coulomb", "reflect"}}));
  fields.push_back(
      field(&O::friction, {.key = "friction",
                           .label = "Friction",
                           .doc = "Coulomb: coefficient of friction. Reflect: what is kept of the velocity.",
                           .minimum = 0}));
  fields.push_back(field(&O::restitution, {.key = "restitution",
                                           .label = "Restitution",
                                           .doc = "Coulomb: what is kept of the normal speed, 0 to 1.",
                                           .minimum = 0,
                                           .maximum = 1}));
  return fields;
}

}  // namespace

const Fields<Obstacle>& obstacle_fields(Shape shape) {
  static const auto all = [] {
    std::map<Shape, Fields<Obstacle>> fields;
    for (const Shape each : obstacle_shapes()) fields[each] = with_response(each->fields());
    return fields;
  }();
  return all.at(shape);
}

const Fields<Obstacle>& motion_fields() {
  using O = Obstacle;
  static const Fields<O> fields{
      field(&O::velocity, {.key = "velocity",
                           .label = "Velocity",
                           .unit = "m/s",
                           .doc = "Steady motion of the obstacle from the start on.",
                           .slider_minimum = -5,
                           .slider_maximum = 5}),
      field(&O::spin, {.key = "spin",
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
      field(&K::time, {.key = "time", .label = "Time", .unit = "s", .doc = "When the obstacle is there."}),
      field(
          &K::position,
          {.key = "position", .label = "Position", .unit = "m", .doc = "Where its centre or point is then."}),
      field(&K::rotation, {.key = "rotation",
                           .label = "Rotation",
                           .unit = "rad",
                           .doc = "How it is turned then: axis times angle."}),
  };
  return fields;
}

}  // namespace cloth
