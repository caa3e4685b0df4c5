// The bending elements of a material on grids.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "cloth/grid.h"
#include "scene/scene_cloth.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::bending_test {
namespace {

TEST(Bending, StoresTheMaterialsEnergyOfACylinderAndASaddle) {
  const Material m = any_material();
  constexpr double curvature = 0.1;
  for (const Scene& scene : grids_of_a_sheet(m)) {
    const ClothSystem system = make_cloth(scene);
    const double width = scene.cloth.width, height = scene.cloth.height, a = width / (system.columns - 1),
                 b = height / (system.rows - 1);
    const auto energy = [&](auto height_at) {
      Vec3Field position = system.start;
      for (std::size_t i = 0; i < position.size(); ++i)
        position.set(i, {position[i].x(), position[i].y(), height_at(position[i])});
      return bending_energy(system.bending, position);
    };
    const double square = 0.5 * curvature * curvature;
    // A line has no element at its ends, where it does not bend: half a cell less at each.
    EXPECT_NEAR(energy([](const Vec3& x) { return 0.5 * curvature * x.x() * x.x(); }),
                square * m.bending_weft * (width - a) * height, 1e-12 * m.bending_weft);
    EXPECT_NEAR(energy([](const Vec3& x) { return 0.5 * curvature * x.y() * x.y(); }),
                square * m.bending_warp * width * (height - b), 1e-12 * m.bending_warp);
    EXPECT_NEAR(energy([](const Vec3& x) { return curvature * x.x() * x.y(); }),
                square * 2 * m.twist * width * height, 1e-12 * m.twist);
    EXPECT_NEAR(energy([](const Vec3& x) { return 3 * x.x() - 2 * x.y(); }), 0, 1e-20);
  }
}

TEST(Bending, AtAnAngleIsWhatACylinderOfThatDirectionStores) {
  Material m = any_material();
  m.twist = twist_from(m.bending_warp, m.bending_weft, 2.4e-3);
  EXPECT_NEAR(bending_at(m, M_PI / 4), 2.4e-3, 1e-18);
  EXPECT_DOUBLE_EQ(bending_at(m, 0), m.bending_warp);
  EXPECT_NEAR(bending_at(m, M_PI / 2), m.bending_weft, 1e-18);
  const Scene scene = material_sheet(81, 81, 0.01, 0.01, m);
  const ClothSystem system = make_cloth(scene);
  for (const double angle : {0.3, M_PI / 4, 1.1}) {  // between a line of curvature and the warp, which is y
    Vec3Field position = system.start;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const double along = std::sin(angle) * position[i].x() + std::cos(angle) * position[i].y();
      position.set(i, {position[i].x(), position[i].y(), 0.05 * along * along});
    }
    EXPECT_NEAR(bending_energy(system.bending, position) / (0.5 * 0.01 * 0.64), bending_at(m, angle),
                0.013 * bending_at(m, angle))
        << angle;  // but for the lines' ends, 1/80 of the sheet
  }
}

TEST(Bending, ForceIsMinusTheSlopeOfItsEnergyWithPinsToo) {
  Random random;
  Material m = any_material();
  m.stretch_warp = m.stretch_weft = m.shear = 0;
  Scene scene = material_sheet(6, 7, 0.1, 0.08, m);
  scene.cloth.pins = {NamedPin::left_edge, PinnedParticle{2, 1}, PinnedParticle{3, 1}};
  const ClothSystem system = make_cloth(scene);
  const Vec3Field position = crumpled_state(system, 0.05, 0, random).position;
  const Vec3Field force = force_of(scene, position);
  double largest = 0, furthest = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      Vec3Field shifted = position;
      const Vec3 shift = 1e-4 * Vec3::Unit(axis);
      shifted.add(i, shift);
      const double above = bending_energy(system.bending, shifted);
      shifted.add(i, -2 * shift);
      const double slope = (above - bending_energy(system.bending, shifted)) / 2e-4;
      largest = std::max(largest, std::abs(slope));
      furthest = std::max(furthest, std::abs(slope + force[i][axis]));
    }
  EXPECT_GT(largest, 0.1);
  EXPECT_LE(furthest, 1e-9 * largest);
}

TEST(Bending, EnergyDoesNotChangeWhenTheClothIsMovedAndTurned) {
  Random random;
  const ClothSystem system = make_cloth(material_sheet(6, 7, 0.1, 0.08, any_material()));
  const Vec3Field position = crumpled_state(system, 0.05, 0, random).position;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Vec3(1, -2, 3).normalized()).toRotationMatrix();
  Vec3Field turned = mapped(position, turn);
  for (std::size_t i = 0; i < turned.size(); ++i) turned.add(i, Vec3(3, -1, 2));
  const double energy = bending_energy(system.bending, position);
  EXPECT_NEAR(bending_energy(system.bending, turned), energy, 1e-11 * energy);
}

TEST(Bending, ByPairsIsTheSameEnergy) {
  Random random;
  const ClothSystem system = make_cloth(material_sheet(6, 7, 0.1, 0.08, any_material()));
  const Vec3Field position = crumpled_state(system, 0.05, 0, random).position;
  double energy = 0;
  for_each_bending_pair(system.bending, [&](std::size_t i, std::size_t j, double k) {
    energy += 0.5 * k * (position[i] - position[j]).squaredNorm();
  });
  EXPECT_NEAR(energy, bending_energy(system.bending, position), 1e-11 * std::abs(energy));
}

/// The stiffness of the elements with these three points, or four.
std::vector<double> stiffness_at(const ClothSystem& system, int points, int first) {
  std::vector<double> found;
  for (const BendingRun& run : system.bending)
    if (run.points == points && first >= run.first && first < run.first + run.count)
      found.push_back(run.stiffness);
  return found;
}

TEST(Bending, DoublesAtAClampAndIsLeftOutBehindIt) {
  Scene scene = material_sheet(5, 9, 0.1, 0.1, any_material());
  scene.cloth.pins = {NamedPin::left_edge};
  for (int row = 0; row < 5; ++row)
    for (int column = 1; column < 4; ++column) scene.cloth.pins.emplace_back(PinnedParticle{row, column});
  const ClothSystem system = make_cloth(scene);
  const CellBending k = cell_bending(*scene.material, 0.1, 0.1);
  const auto near = [](double expected) { return std::vector{expected}; };
  const int row = system.index(1, 0);
  // Rows at 0 to 8: pinned to 3. Along a row the element 2-3-4 bends on its free side alone.
  EXPECT_EQ(stiffness_at(system, 3, system.index(4, 0)), std::vector<double>{});
  EXPECT_EQ(stiffness_at(system, 3, system.index(4, 1)), std::vector<double>{});
  EXPECT_EQ(stiffness_at(system, 3, system.index(4, 2)), near(k.across)) << "twice, and half at the border";
  EXPECT_EQ(stiffness_at(system, 3, system.index(4, 3)), near(k.across / 2));
  EXPECT_EQ(stiffness_at(system, 4, row + 2), std::vector<double>{}) << "a cell behind the clamp";
  EXPECT_EQ(stiffness_at(system, 4, row + 3), near(k.twist)) << "two corners pinned";
  scene.cloth.pins.emplace_back(PinnedParticle{1, 4});
  EXPECT_EQ(stiffness_at(make_cloth(scene), 4, row + 3), near(2 * k.twist)) << "three corners pinned";
}

}  // namespace
}  // namespace cloth::test::bending_test
