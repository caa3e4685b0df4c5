// The parameters of springs, air, damping, the deformation rate and contact.
// Designated initialisers keep the order of ParameterInfo's members.
#include "params/field_builders.h"
#include "scene/block_fields.h"

namespace cloth {
namespace {

/// A force for each particle, or spring, and speed.
ParameterInfo coefficient_info(const char* key, const char* label, const char* doc, const char* formula) {
  return {.key = key,
          .label = label,
          .unit = "N s/m",
          .doc = doc,
          .formula = formula,
          .scale = Scale::logarithmic,
          .minimum = 0};
}

ParameterInfo thickness_info(const char* doc) {
  return positive({.key = "thickness",
                   .label = "Thickness",
                   .unit = "m",
                   .doc = doc,
                   .scale = Scale::logarithmic,
                   .slider_minimum = 1e-4,
                   .slider_maximum = 0.05});
}

}  // namespace

Fields<SpringMaterial> spring_fields() {
  using S = SpringMaterial;
  const auto stiffness = [](double S::*member, const char* key, const char* label, const char* doc) {
    return field(member, {.key = key,
                          .label = label,
                          .unit = "N/m",
                          .doc = doc,
                          .formula = "F = k (|d| - L) d/|d|",
                          .scale = Scale::logarithmic,
                          .minimum = 0,
                          .slider_maximum = 1e5});
  };
  return {
      stiffness(&S::structural, "structural", "Structural stiffness",
                "Resistance to stretching along rows and columns; 0 leaves these springs out."),
      stiffness(&S::shear, "shear", "Shear stiffness",
                "Resistance to shearing, along the diagonals of each cell; 0 leaves these springs out."),
      stiffness(&S::flexion, "flexion", "Flexion stiffness",
                "Resistance to bending, between particles two apart; 0 leaves these springs out."),
      field(&S::damping,
            coefficient_info(
                "damping", "Spring damping",
                "Resistance to the rate of stretching, along every spring; leaves free fall alone.",
                "F = k_d ((v_j - v_i) . d/|d|) d/|d|")),
  };
}

Fields<Gust> gust_fields() {
  using G = Gust;
  return {
      field(&G::amplitude, {.key = "amplitude",
                            .label = "Gust amplitude",
                            .doc = "How far the wind's speed swings around its mean, as a fraction of it.",
                            .formula = "wind * (1 + amplitude * sin(2 pi frequency t))",
                            .minimum = 0,
                            .slider_maximum = 2}),
      field(&G::frequency, {.key = "frequency",
                            .label = "Gust frequency",
                            .unit = "Hz",
                            .doc = "Swings of the wind per second.",
                            .minimum = 0,
                            .slider_maximum = 5}),
  };
}

Fields<Air> air_fields() {
  using A = Air;
  return {
      field(&A::drag, coefficient_info(
                          "drag", "Air drag",
                          "Force of the air per particle and speed along the normal; 0 leaves the air out.",
                          "F = c_a (n . (u - v)) n")),
      field(&A::skin_friction,
            coefficient_info("skin_friction", "Skin friction",
                             "Force of the air per particle and speed along the cloth; 0 leaves it out.",
                             "F = c_t (I - n n^T) (u - v)")),
      field(&A::wind, {.key = "wind",
                       .label = "Wind",
                       .unit = "m/s",
                       .doc = "Mean velocity of the air.",
                       .slider_minimum = -20,
                       .slider_maximum = 20}),
  };
}

Fields<Deformation> deformation_fields() {
  using D = Deformation;
  return {
      field(&D::rate,
            {.key = "rate",
             .label = "Deformation rate",
             .doc = "Largest elongation that limited springs may keep, as a fraction of the rest length.",
             .formula = "|d| <= (1 + rate) L",
             .scale = Scale::logarithmic,
             .minimum = 0,
             .slider_minimum = 0.001}),
      field(&D::springs, {.key = "springs",
                          .label = "Limited springs",
                          .doc = "Which spring families the deformation rate limits.",
                          .word_sets = {{}, {"structural"}, {"structural", "shear"}}}),
      field(
          &D::tolerance,
          positive({.key = "tolerance",
                    .label = "Tolerance",
                    .doc = "Excess over the deformation rate that may be left, relative to the rest length.",
                    .scale = Scale::logarithmic,
                    .slider_minimum = 1e-6,
                    .slider_maximum = 1e-2})),
      field(&D::max_sweeps,
            {.key = "max_sweeps",
             .label = "Most sweeps",
             .doc = "Of the solver \"sweeps\": how many per step before the rest is reported as excess.",
             .scale = Scale::logarithmic,
             .minimum = 1,
             .maximum = 1000000,
             .slider_minimum = 1,
             .slider_maximum = 1000}),
      field(&D::solver,
            {.key = "solver",
             .label = "Solver",
             .doc = "How the rate is kept: by tensions of the limited springs (auto), by sweeps as "
                    "Provot's, or by the nearest shape that obeys it.",
             .choices = {"auto", "sweeps", "direct"}}),
  };
}

Fields<ContactSettings> contact_fields() {
  return {
      field(&ContactSettings::thickness,
            thickness_info("Distance that contact keeps between cloth and obstacles.")),
  };
}

Fields<SelfContact> self_contact_fields() {
  using S = SelfContact;
  return {
      field(&S::thickness,
            thickness_info("Distance that contact keeps between two layers of the cloth; at most half "
                           "of the shortest structural spring.")),
      field(&S::friction, {.key = "friction",
                           .label = "Friction",
                           .doc = "Coefficient of friction of the cloth on itself.",
                           .minimum = 0}),
  };
}

Field<Scene> damping_field() {
  return optional_field(
      &Scene::damping,
      coefficient_info("damping", "Viscous damping",
                       "Resistance to every motion of a particle, free fall included.", "F = -c v"));
}

}  // namespace cloth
