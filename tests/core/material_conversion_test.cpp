// Springs and materials that are the same cloth inside a grid, and what is said where they are not.
#include "scene/material_conversion.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "cloth/grid.h"
#include "forces/air.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "support/materials.h"
#include "support/scenes.h"

namespace cloth::test::material_conversion_test {
namespace {

/// Cells of 2 cm by 3 cm with everything that a material can take over.
Scene spring_sheet(double structural, double shear, double flexion) {
  Scene scene = bare_sheet(7, 9);
  scene.cloth.width = 0.02 * 8;
  scene.cloth.height = 0.03 * 6;
  scene.cloth.mass = 0.05;
  scene.springs =
      SpringMaterial{.structural = structural, .shear = shear, .flexion = flexion, .damping = 0.01};
  scene.damping = 0.002;
  scene.air = Air{.drag = 0.003, .skin_friction = 0.0004, .wind = {1, 2, 3}, .gust = Gust{}};
  return scene;
}

/// J/m^2 of a small strain inside the grid, from the springs of each direction at a particle.
double energy_inside(const Scene& scene, double weft, double warp, double shear) {
  const GridCell cell = cell_of(scene.cloth);
  const Eigen::Matrix2d strain{{weft, 0.5 * shear}, {0.5 * shear, warp}};
  double energy = 0;
  for (const SpringDirection& direction : spring_directions()) {
    const Eigen::Vector2d spring(direction.columns * cell.across.norm(), direction.rows * cell.down.norm());
    const double elongation = spring.dot(strain * spring) / spring.norm();
    energy += 0.5 * stiffness_of(*scene.springs, direction.family) * elongation * elongation;
  }
  return energy / (cell.across.norm() * cell.down.norm());
}

TEST(SpringsAsAMaterial, StoreTheSameEnergyInsideTheGridInEveryStrain) {
  for (const auto& [structural, shear, flexion] : {std::tuple{500.0, 200.0, 30.0}, {300, 0, 0}, {0, 80, 7}}) {
    const Scene scene = spring_sheet(structural, shear, flexion);
    const Material m = *with_material(scene).scene->material;
    for (const auto& [x, y, g] : {std::tuple{1.0, 0.0, 0.0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {2, -1, 3}}) {
      const double expected =
          0.5 * (m.stretch_weft * x * x + m.stretch_warp * y * y + 2 * m.shear * x * y + m.shear * g * g);
      EXPECT_NEAR(energy_inside(scene, x, y, g), expected, 1e-12 * (1 + expected));
    }
  }
}

TEST(SpringsAsAMaterial, HaveTheSameMassDampingAndDragInsideTheGrid) {
  const Scene from = spring_sheet(500, 200, 30), to = *with_material(from).scene;
  const double mass = particle_mass(from);
  EXPECT_DOUBLE_EQ(particle_mass(to), mass);
  EXPECT_DOUBLE_EQ(to.material->mass_damping * mass, *from.damping);
  EXPECT_DOUBLE_EQ(to.material->drag_normal * 0.02 * 0.03, from.air->drag);
  EXPECT_DOUBLE_EQ(to.material->drag_tangential * 0.02 * 0.03, from.air->skin_friction);
  EXPECT_FALSE(to.springs || to.damping);
  EXPECT_EQ(to.air->wind, from.air->wind);
  EXPECT_EQ(to.air->gust, from.air->gust);
}

TEST(SpringsAsAMaterial, AreAValidSceneThatReadsBack) {
  for (const double flexion : {0.0, 40.0}) {
    const Scene to = *with_material(spring_sheet(500, 200, flexion)).scene;
    EXPECT_TRUE(find_problems(to).empty());
    EXPECT_EQ(*read_scene(write_scene(to), "x").scene, to);
    const Scene back = *with_springs(to).scene;
    EXPECT_TRUE(find_problems(back).empty());
    EXPECT_EQ(*read_scene(write_scene(back), "x").scene, back);
  }
}

TEST(SpringsAsAMaterial, ComeBackWhereNothingIsLost) {
  const Scene from = spring_sheet(200, 200, 0), back = *with_springs(*with_material(from).scene).scene;
  EXPECT_NEAR(back.springs->structural, 200, 1e-10);
  EXPECT_NEAR(back.springs->shear, 200, 1e-10);
  EXPECT_NEAR(back.springs->damping, 0.01, 1e-14);
  EXPECT_NEAR(back.cloth.mass, 0.05, 1e-15);
  EXPECT_NEAR(*back.damping, 0.002, 1e-16);
  EXPECT_NEAR(back.air->drag, 0.003, 1e-16);
  EXPECT_NEAR(back.air->skin_friction, 0.0004, 1e-17);
}

bool says(const SceneConversion& conversion, const std::string& words) {
  for (const std::string& loss : conversion.losses)
    if (loss.find(words) != std::string::npos) return true;
  return false;
}

TEST(SpringsAsAMaterial, SayWhatCannotBeSaid) {
  const SceneConversion all = with_material(spring_sheet(500, 200, 30));
  EXPECT_TRUE(says(all, "cube of the curvature"));
  EXPECT_TRUE(says(all, "weighs 0.0381 kg instead of 0.05 kg"));
  EXPECT_TRUE(says(all, "shear would have 5e-05 s"));
  const SceneConversion alike = with_material(spring_sheet(200, 200, 0));
  EXPECT_EQ(alike.losses.size(), 1U);
  EXPECT_DOUBLE_EQ(alike.scene->material->stretch_damping, 0.01 / 200);
}

TEST(AMaterialAsSprings, SaysWhatCannotBeSaid) {
  Material material = any_material();
  material.stretch_damping = 1e-3;
  material.bending_damping = 1e-3;
  const SceneConversion to = with_springs(material_sheet(5, 6, 0.02, 0.02, material));
  EXPECT_TRUE(says(to, "no bending stiffness and no twist"));
  EXPECT_TRUE(says(to, "340 N/m along rows and 440 N/m along columns"));
  EXPECT_TRUE(says(to, "Border particles"));
  EXPECT_TRUE(says(to, "one damper"));
  EXPECT_TRUE(says(to, "Bending is not damped either."));
}

TEST(Conversions, AreRefusedWhereThereIsNothingToConvert) {
  EXPECT_EQ(with_material(bare_sheet(5, 5)).refusal, "The scene has no springs.");
  EXPECT_EQ(with_springs(spring_sheet(1, 1, 1)).refusal, "The scene has no material.");
  Scene oblique = spring_sheet(1, 1, 1);
  oblique.cloth.down = {0.1, -1, 0};
  EXPECT_NE(with_material(oblique).refusal.find("right angles"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::material_conversion_test
