// The bending that a grid of springs adds where it is bent across its lines.
#include "measure/oblique_locking.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "scene/scene_cloth.h"
#include "simulation/recorder.h"
#include "support/materials.h"

namespace cloth::test::oblique_locking_test {
namespace {

/// The least energy for each area, over all strains of the sheet, that the springs of a cell keep on a
/// cylinder of this curvature at 45 degrees: what no stretch or shear takes out of them.
double least_membrane_energy(const Material& m, double cell, double curvature) {
  const CellSprings k = cell_springs(m, cell, cell);
  struct Direction {
    Eigen::Vector2d along;
    double stiffness;
  };
  const Direction directions[] = {
      {{cell, 0}, k.across}, {{0, cell}, k.down}, {{cell, cell}, k.diagonal}, {{cell, -cell}, k.diagonal}};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double constant = 0;
  for (const auto& [d, stiffness] : directions) {
    const double length = d.norm(), arc = (d.x() + d.y()) / std::sqrt(2.0),
                 rest = (d.x() - d.y()) / std::sqrt(2.0);
    const double chord = 2 / curvature * std::sin(curvature * arc / 2);
    const double shortened = std::hypot(chord, rest) - length;
    const Eigen::Vector3d strain(d.x() * d.x() / length, d.y() * d.y() / length, d.x() * d.y() / length);
    normal += stiffness * strain * strain.transpose();
    right -= stiffness * shortened * strain;
    constant += 0.5 * stiffness * shortened * shortened;
  }
  const Eigen::Vector3d best = normal.inverse() * right;
  return (constant - 0.5 * right.dot(best)) / (cell * cell);
}

TEST(LockingRatio, IsTheMomentOfTheMembraneOverThatOfBendingAt45Degrees) {
  const Material m = any_material();
  for (const double cell : {0.005, 0.01, 0.02})
    for (const double curvature : {2.0, 5.0, 10.0}) {
      const double more = 1.001 * curvature, less = 0.999 * curvature;
      const double moment =
          (least_membrane_energy(m, cell, more) - least_membrane_energy(m, cell, less)) / (more - less);
      EXPECT_NEAR(locking_ratio(m, cell, cell, curvature), moment / (bending_at(m, M_PI / 4) * curvature),
                  0.01 * locking_ratio(m, cell, cell, curvature))
          << cell << " " << curvature;
    }
}

/// Rolled up about an axis at this angle to the rows.
Vec3Field rolled(const ClothSystem& system, double angle, double curvature) {
  Vec3Field position(system.start.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 x = system.start[i];
    const double arc = -std::sin(angle) * x.x() + std::cos(angle) * x.y(),
                 along = std::cos(angle) * x.x() + std::sin(angle) * x.y();
    position.set(i,
                 {along, std::sin(curvature * arc) / curvature, (1 - std::cos(curvature * arc)) / curvature});
  }
  return position;
}

TEST(ObliqueLocking, IsThatOfTheCurvatureAcrossTheGridAndNothingAlongItsLines) {
  Scene scene = material_sheet(21, 21, 0.01, 0.01, any_material());
  const ClothSystem system = make_cloth(scene);
  const double expected = locking_ratio(*scene.material, 0.01, 0.01, 20);
  EXPECT_NEAR(measure_oblique_locking(scene, system, rolled(system, M_PI / 4, 20)).largest, expected,
              0.02 * expected);
  EXPECT_LE(measure_oblique_locking(scene, system, rolled(system, 0, 20)).largest, 1e-9 * expected);
  EXPECT_LE(measure_oblique_locking(scene, system, rolled(system, M_PI / 2, 20)).largest, 1e-9 * expected);
}

TEST(ObliqueLocking, IsWarnedOfWhereCellsAreTooLargeAndNotOnAFinerGrid) {
  Material soft = any_material();
  soft.bending_warp = soft.bending_weft = soft.twist = 1e-5;
  const auto text_with = [&](int cells) {
    const Scene scene = material_sheet(cells + 1, cells + 1, 0.2 / cells, 0.2 / cells, soft);
    const ClothSystem system = make_cloth(scene);
    return locking_text(scene, measure_oblique_locking(scene, system, rolled(system, M_PI / 4, 20)));
  };
  EXPECT_NE(text_with(10).find("100 % of the cells, 0.02 m by 0.02 m, are too large"), std::string::npos)
      << text_with(10);
  EXPECT_EQ(text_with(100), "");
}

}  // namespace
}  // namespace cloth::test::oblique_locking_test
