// Every parameter of a scene, declared once. Designated initialisers keep the order of ParameterInfo's
// members.
#include <map>

#include "integrators/registry.h"
#include "params/field_builders.h"
#include "scene/scene_parameters.h"

namespace cloth {

const Fields<SpringMaterial>& spring_fields() {
  using S = SpringMaterial;
  const auto stiffness = [](double S::*member, const char* key, const char* label, const char* doc) {
    return number(member, {.key = key,
                           .label = label,
                           .unit = "N/m",
                           .doc = doc,
                           .formula = "F = k (|d| - L) d/|d|",
                           .scale = Scale::logarithmic,
                           .minimum = 0,
                           .slider_minimum = 0,
                           .slider_maximum = 1e5});
  };
  static const Fields<S> fields{
      stiffness(&S::structural, "structural", "Structural stiffness",
                "Resistance to stretching along rows and columns; 0 leaves these springs out."),
      stiffness(&S::shear, "shear", "Shear stiffness",
                "Resistance to shearing, along the diagonals of each cell; 0 leaves these springs out."),
      stiffness(&S::flexion, "flexion", "Flexion stiffness",
                "Resistance to bending, between particles two apart; 0 leaves these springs out."),
      number(&S::damping,
             {.key = "damping",
              .label = "Spring damping",
              .unit = "N s/m",
              .doc = "Resistance to the rate of stretching, along every spring; leaves free fall alone.",
              .formula = "F = k_d ((v_j - v_i) . d/|d|) d/|d|",
              .scale = Scale::logarithmic,
              .minimum = 0,
              .slider_minimum = 0,
              .slider_maximum = 1}),
  };
  return fields;
}

const Fields<Gust>& gust_fields() {
  using G = Gust;
  static const Fields<G> fields{
      number(&G::amplitude, {.key = "amplitude",
                             .label = "Gust amplitude",
                             .doc = "How far the wind's speed swings around its mean, as a fraction of it.",
                             .formula = "wind * (1 + amplitude * sin(2 pi frequency t))",
                             .minimum = 0,
                             .slider_minimum = 0,
                             .slider_maximum = 2}),
      number(&G::frequency, {.key = "frequency",
                             .label = "Gust frequency",
                             .unit = "Hz",
                             .doc = "Swings of the wind per second.",
                             .minimum = 0,
                             .slider_minimum = 0,
                             .slider_maximum = 5}),
  };
  return fields;
}

const Fields<Air>& air_fields() {
  using A = Air;
  static const Fields<A> fields{
      number(&A::drag,
             {.key = "drag",
              .label = "Air drag",
              .unit = "N s/m",
              .doc = "Force of the air per particle and speed along the normal; 0 leaves the air out.",
              .formula = "F = c_a (n . (u - v)) n",
              .scale = Scale::logarithmic,
              .minimum = 0,
              .slider_minimum = 0,
              .slider_maximum = 1}),
      vector(&A::wind, {.key = "wind",
                        .label = "Wind",
                        .unit = "m/s",
                        .doc = "Mean velocity of the air.",
                        .slider_minimum = -20,
                        .slider_maximum = 20}),
  };
  return fields;
}

const Fields<Deformation>& deformation_fields() {
  using D = Deformation;
  static const Fields<D> fields{
      number(&D::rate,
             {.key = "rate",
              .label = "Deformation rate",
              .doc = "Largest elongation that limited springs may keep, as a fraction of the rest length.",
              .formula = "|d| <= (1 + rate) L",
              .scale = Scale::logarithmic,
              .minimum = 0,
              .slider_minimum = 0.001,
              .slider_maximum = 1}),
      words(&D::springs, {.key = "springs",
                          .label = "Limited springs",
                          .doc = "Which spring families the deformation rate limits.",
                          .word_sets = {{}, {"structural"}, {"structural", "shear"}}}),
      number(&D::tolerance,
             {.key = "tolerance",
              .label = "Tolerance",
              .doc = "Excess over the deformation rate that may be left, relative to the rest length.",
              .scale = Scale::logarithmic,
              .minimum = 0,
              .minimum_excluded = true,
              .slider_minimum = 1e-6,
              .slider_maximum = 1e-2}),
      integer(&D::max_sweeps,
              {.key = "max_sweeps",
               .label = "Most sweeps",
               .doc = "Of the solver \"sweeps\": how many per step before the rest is reported as excess.",
               .scale = Scale::logarithmic,
               .minimum = 1,
               .maximum = 1000000,
               .slider_minimum = 1,
               .slider_maximum = 1000}),
      choice(&D::solver,
             {.key = "solver",
              .label = "Solver",
              .doc = "How the rate is kept: by tensions of the limited springs (auto), by sweeps as "
                     "Provot's, or by the nearest shape that obeys it.",
              .choices = {"auto", "sweeps", "direct"}}),
  };
  return fields;
}

namespace {

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

namespace {

Fields<IntegratorChoice> common_integrator_fields() {
  using I = IntegratorChoice;
  return {
      choice(
          &I::method,
          {.key = "method", .label = "Method", .doc = "The time integrator.", .choices = integrator_names()}),
      number_or_auto(&I::time_step, {.key = "time_step",
                                     .label = "Time step",
                                     .unit = "s",
                                     .doc = "Length of a step; auto takes 80 % of the method's limit for the "
                                            "flat cloth, and at most 95 % of that for every shape.",
                                     .scale = Scale::logarithmic,
                                     .minimum = 0,
                                     .minimum_excluded = true,
                                     .slider_minimum = 1e-6,
                                     .slider_maximum = 0.1}),
  };
}

Field<IntegratorChoice> tolerance_field(double minimum, bool excluded, const char* doc) {
  return number(&IntegratorChoice::tolerance, {.key = "tolerance",
                                               .label = "Tolerance",
                                               .doc = doc,
                                               .scale = Scale::logarithmic,
                                               .minimum = minimum,
                                               .maximum = 1,
                                               .minimum_excluded = excluded,
                                               .slider_minimum = 1e-12,
                                               .slider_maximum = 1e-2});
}

Field<IntegratorChoice> count_field(std::int64_t IntegratorChoice::*member, const char* key,
                                    const char* label, const char* doc) {
  return integer(member, {.key = key,
                          .label = label,
                          .doc = doc,
                          .scale = Scale::logarithmic,
                          .minimum = 1,
                          .maximum = 100000,
                          .slider_minimum = 1,
                          .slider_maximum = 200});
}

Fields<IntegratorChoice> own_integrator_fields(MethodSettings settings) {
  using I = IntegratorChoice;
  switch (settings) {
    case MethodSettings::none:
      return {};
    case MethodSettings::error_control:
      return {
          tolerance_field(0, false,
                          "Largest error of an inner step, relative to the cloth's diagonal; 0 takes every "
                          "time step as it is.")};
    case MethodSettings::newton:
      return {
          tolerance_field(0, true,
                          "Change of the velocities at which Newton's method ends, relative to the largest."),
          count_field(&I::newton_iterations, "iterations", "Most iterations",
                      "Iterations of Newton's method after which a step has failed.")};
    case MethodSettings::projective:
      return {count_field(&I::projective_iterations, "iterations", "Iterations",
                          "Local and global solves of a step.")};
    case MethodSettings::xpbd:
      return {count_field(&I::substeps, "substeps", "Substeps", "Parts that a time step is taken in."),
              count_field(&I::xpbd_iterations, "iterations", "Iterations",
                          "Passes over all springs in a substep.")};
  }
  return {};
}

}  // namespace

const Fields<IntegratorChoice>& integrator_fields(const std::string& method) {
  static const auto all = [] {
    std::map<std::string, Fields<IntegratorChoice>> fields;
    for (const MethodFacts& facts : integrator_facts()) {
      Fields<IntegratorChoice>& of_method = fields[facts.name] = common_integrator_fields();
      for (Field<IntegratorChoice>& own : own_integrator_fields(facts.settings))
        of_method.push_back(std::move(own));
    }
    fields[""] = common_integrator_fields();
    return fields;
  }();
  const auto found = all.find(method);
  return found == all.end() ? all.at("") : found->second;
}

const Fields<Recording>& recording_fields() {
  using R = Recording;
  static const Fields<R> fields{
      number(&R::interval, {.key = "interval",
                            .label = "Record interval",
                            .unit = "s",
                            .doc = "Simulated time between two rows of a recording.",
                            .cost = EditCost::restart,
                            .scale = Scale::logarithmic,
                            .minimum = 0,
                            .minimum_excluded = true,
                            .slider_minimum = 1e-4,
                            .slider_maximum = 1}),
  };
  return fields;
}

const Fields<Scene>& scene_fields() {
  using S = Scene;
  static const Fields<S> fields{
      text(&S::title,
           {.key = "title", .label = "Title", .doc = "What the scene shows.", .cost = EditCost::live}),
      optional_field(&S::damping, {.key = "damping",
                                   .label = "Viscous damping",
                                   .unit = "N s/m",
                                   .doc = "Resistance to every motion of a particle, free fall included.",
                                   .formula = "F = -c v",
                                   .scale = Scale::logarithmic,
                                   .minimum = 0,
                                   .slider_minimum = 0,
                                   .slider_maximum = 1}),
      [] {
        ParameterInfo info{.key = "gravity",
                           .label = "Gravity",
                           .unit = "m/s^2",
                           .doc = "Acceleration of free fall.",
                           .formula = "F = m g",
                           .slider_minimum = -20,
                           .slider_maximum = 20};
        info.kind = Kind::vector;
        return optional_field(&S::gravity, info);
      }(),
      number(&S::duration, {.key = "duration",
                            .label = "Duration",
                            .unit = "s",
                            .doc = "Simulated time of a run on the command line.",
                            .scale = Scale::logarithmic,
                            .minimum = 0,
                            .minimum_excluded = true,
                            .slider_minimum = 0.1,
                            .slider_maximum = 100}),
  };
  return fields;
}

}  // namespace cloth
