// The parameters of continuous contact and of obstacles that move.
#include "params/field_builders.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

ParameterInfo thickness_info(const char* doc) {
  return {.key = "thickness",
          .label = "Thickness",
          .unit = "m",
          .doc = doc,
          .scale = Scale::logarithmic,
          .minimum = 0,
          .minimum_excluded = true,
          .slider_minimum = 1e-4,
          .slider_maximum = 0.05};
}

}  // namespace

const Fields<ContactSettings>& contact_fields() {
  static const Fields<ContactSettings> fields{
      number(&ContactSettings::thickness,
             thickness_info("Distance that contact keeps between cloth and obstacles.")),
  };
  return fields;
}

const Fields<SelfContact>& self_contact_fields() {
  using S = SelfContact;
  static const Fields<S> fields{
      number(&S::thickness,
             thickness_info("Distance that contact keeps between two layers of the cloth; at most half "
                            "of the shortest structural spring.")),
      number(&S::friction, {.key = "friction",
                            .label = "Friction",
                            .doc = "Coefficient of friction of the cloth on itself.",
                            .minimum = 0,
                            .slider_minimum = 0,
                            .slider_maximum = 1}),
  };
  return fields;
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
