#include "scene/material_conversion.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/scene_cloth.h"

namespace cloth {
namespace {

/// Why there is no other way to say what this cloth is made of; empty where there is.
std::string refusal_of(const Scene& scene, bool has_source, const char* source) {
  const ClothSheet& sheet = scene.cloth;
  if (!has_source) return fmt::format("The scene has no {}.", source);
  if (sheet.is_mesh())
    return "A mesh has no cells: springs and materials of grids alone stand for each other.";
  if (sheet.is_cut()) return "The cloth is cut round: only a material can be, springs are of whole grids.";
  constexpr double largest_cosine = 1e-9;
  if (!(std::abs(sheet.across.normalized().dot(sheet.down.normalized())) <= largest_cosine))
    return "cloth.across and cloth.down are not at right angles: the cells of a material are rectangles.";
  return "";
}

std::string weight_loss(const char* now, double from, double to) {
  return fmt::format("{} The cloth weighs {:.4g} kg instead of {:.4g} kg.", now, to, from);
}

/// In N/m along rows and columns, and of shear, of what each family contributes with these stiffnesses.
struct PlaneNumbers {
  double weft = 0, warp = 0, shear = 0;
};

PlaneNumbers membrane_of(double structural, double shear, double flexion, const CellSides& cell) {
  const double a = cell.across, b = cell.down, square = a * a + b * b, along = structural + 4 * flexion;
  return {.weft = along * a / b + 2 * shear * a * a * a / (b * square),
          .warp = along * b / a + 2 * shear * b * b * b / (a * square),
          .shear = 2 * shear * a * b / square};
}

/// Of dampers c along every spring, over the springs' stiffness, where the cloth is stretched along its
/// threads.
double damping_time(const SpringMaterial& springs, const CellSides& cell) {
  const auto damper = [&](double stiffness) { return stiffness > 0 ? springs.damping : 0; };
  const PlaneNumbers k = membrane_of(springs.structural, springs.shear, springs.flexion, cell);
  const PlaneNumbers c =
      membrane_of(damper(springs.structural), damper(springs.shear), damper(springs.flexion), cell);
  const double stiffness = k.weft + k.warp;
  return stiffness > 0 ? (c.weft + c.warp) / stiffness : 0;
}

bool are_alike(const SpringMaterial& springs) {
  for (const double one : {springs.structural, springs.shear, springs.flexion})
    for (const double other : {springs.structural, springs.shear, springs.flexion})
      if (one > 0 && other > 0 && one != other) return false;
  return true;
}

void list_losses_of_springs(const Scene& scene, const Material& material, std::vector<std::string>& losses) {
  const SpringMaterial& springs = *scene.springs;
  if (springs.flexion > 0)
    losses.push_back(
        "The moment of flexion springs grows with the cube of the curvature: a slightly bent cloth does not "
        "feel them. The material has no bending stiffness; what they add to stretching, it has.");
  losses.push_back(
      weight_loss("Border particles of a material have half the springs, mass and drag of those inside, "
                  "corners a quarter.",
                  scene.cloth.mass, material.areal_density * scene.cloth.width * scene.cloth.height));
  if (springs.damping > 0 && !are_alike(springs))
    losses.push_back(fmt::format(
        "Every spring has the same damper, {:.4g} N s/m, whatever its stiffness; of a material the dampers "
        "go "
        "with the stiffness, after {:.4g} s. That is right for stretching along the threads{}.",
        springs.damping, material.stretch_damping,
        springs.shear > 0 ? fmt::format(", shear would have {:.4g} s", springs.damping / springs.shear)
                          : ""));
}

/// What is in the cloth's material is no longer in these.
void leave_to_material(Scene& scene) {
  scene.springs.reset();
  scene.damping.reset();
  scene.cloth.mass = ClothSheet{}.mass;
  if (!scene.air) return;
  if (scene.air->wind.isZero(0)) return scene.air.reset();
  scene.air->drag = Air{}.drag;
  scene.air->skin_friction = Air{}.skin_friction;
}

void list_losses_of_material(const Scene& scene, const CellSprings& k, const Scene& springs,
                             std::vector<std::string>& losses) {
  const Material& m = *scene.material;
  if (m.bending_warp > 0 || m.bending_weft > 0 || m.twist > 0)
    losses.push_back(
        "Springs have no bending stiffness and no twist: the cloth is limp. Flexion springs, whose moment "
        "grows with the cube of the curvature, can be added by hand.");
  if (std::abs(k.across - k.down) > 1e-9 * (k.across + k.down))
    losses.push_back(fmt::format(
        "Structural springs have one stiffness, {:.4g} N/m; the material has {:.4g} N/m along rows "
        "and {:.4g} N/m along columns.",
        springs.springs->structural, k.across, k.down));
  losses.push_back(
      weight_loss("Border particles have the springs, mass and drag of those inside, not half of them.",
                  m.areal_density * scene.cloth.width * scene.cloth.height, springs.cloth.mass));
  if (m.stretch_damping > 0 && !are_alike(*springs.springs))
    losses.push_back(fmt::format(
        "Springs have one damper, that of structural ones, {:.4g} N s/m; of the material each has {:.4g} s "
        "times its stiffness.",
        springs.springs->damping, m.stretch_damping));
  if (m.bending_damping > 0 && (m.bending_warp > 0 || m.bending_weft > 0))
    losses.push_back("Bending is not damped either.");
  if (m.hysteresis_warp > 0 || m.hysteresis_weft > 0)
    losses.push_back("Bending has no hysteresis.");
}

}  // namespace

SceneConversion with_material(const Scene& scene) {
  if (const std::string refusal = refusal_of(scene, scene.springs.has_value(), "springs"); !refusal.empty())
    return {std::nullopt, refusal};
  const CellSides cell = cell_sides(scene.cloth);
  const double area = cell.across * cell.down, mass = particle_mass(scene);
  const SpringMaterial& springs = *scene.springs;
  const PlaneNumbers plane = membrane_of(springs.structural, springs.shear, springs.flexion, cell);
  const Air air = scene.air.value_or(Air{.drag = 0, .gust = std::nullopt});
  const Material material{.areal_density = mass / area,
                          .stretch_warp = plane.warp,
                          .stretch_weft = plane.weft,
                          .shear = plane.shear,
                          .stretch_damping = damping_time(springs, cell),
                          .mass_damping = scene.damping.value_or(0) / mass,
                          .drag_normal = air.drag / area,
                          .drag_tangential = air.skin_friction / area};
  SceneConversion to{scene};
  to.scene->material = material;
  leave_to_material(*to.scene);
  list_losses_of_springs(scene, material, to.losses);
  return to;
}

SceneConversion with_springs(const Scene& scene) {
  if (const std::string refusal = refusal_of(scene, scene.material.has_value(), "material"); !refusal.empty())
    return {std::nullopt, refusal};
  const Material& m = *scene.material;
  const CellSides cell = cell_sides(scene.cloth);
  const double area = cell.across * cell.down, mass = particle_mass(scene);
  const CellSprings k = cell_springs(m, cell.across, cell.down);
  const double structural = 0.5 * (k.across + k.down);
  SceneConversion to{scene};
  to.scene->material.reset();
  to.scene->springs =
      SpringMaterial{.structural = structural,
                     .shear = k.diagonal,
                     .damping = m.stretch_damping * (structural > 0 ? structural : k.diagonal)};
  to.scene->cloth.mass = mass * scene.cloth.rows * scene.cloth.columns;
  if (m.mass_damping > 0) to.scene->damping = m.mass_damping * mass;
  if (!to.scene->air && (m.drag_normal > 0 || m.drag_tangential > 0)) to.scene->air.emplace();
  if (to.scene->air) to.scene->air->drag = m.drag_normal * area;
  if (to.scene->air) to.scene->air->skin_friction = m.drag_tangential * area;
  list_losses_of_material(scene, k, *to.scene, to.losses);
  return to;
}

}  // namespace cloth
