// Round cloth cut from a grid of a material: what is left of the grid, its masses, springs and bending.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "cloth/cut_grid.h"
#include "cloth/grid.h"
#include "cloth/material_cut.h"
#include "cloth/material_grid.h"
#include "cloth/mesh_cloth.h"
#include "measure/energy.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "simulation/rest_shape.h"
#include "simulation/simulation.h"
#include "support/materials.h"
#include "support/scenes.h"

namespace cloth::test::cut_cloth_test {
namespace {

Scene round_sheet(int rows, int columns, double across, double down) {
  Scene scene = material_sheet(rows, columns, across, down, any_material());
  scene.cloth.cut = "round";
  return scene;
}

std::vector<Scene> round_sheets() {
  return {round_sheet(2, 2, 0.1, 0.1), round_sheet(5, 5, 0.1, 0.1), round_sheet(12, 9, 0.05, 0.08),
          round_sheet(33, 33, 0.01, 0.01)};
}

int cells_of(const CutGrid& grid) {
  int cells = 0;
  for (const std::uint8_t cell : grid.cells) cells += cell;
  return cells;
}

Vec3Field moved(const Vec3Field& from, const std::function<Vec3(const Vec3&)>& by) {
  Vec3Field to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to.set(i, by(from[i]));
  return to;
}

TEST(CutGrid, HasTheCellsWhoseMiddleIsWithinTheEllipse) {
  ClothSheet sheet;
  sheet.rows = sheet.columns = 5;
  sheet.cut = "round";
  // Middles at +-1/4 and +-3/4 of the half side: of the corners' squares 9/16 + 9/16 is beyond 1.
  const CutGrid grid = cut_grid(sheet);
  const std::vector<std::uint8_t> expected{0, 1, 1, 0,  //
                                           1, 1, 1, 1,  //
                                           1, 1, 1, 1,  //
                                           0, 1, 1, 0};
  EXPECT_EQ(grid.cells, expected);
  EXPECT_EQ(grid.place.size(), 21U);  // all but the four corners
  EXPECT_EQ(grid.at(0, 0), -1);
  EXPECT_EQ(grid.at(0, 1), 0);
  EXPECT_EQ(grid.cells_around(1, 1), 3);
}

TEST(CutGrid, ComesNearTheDiscsAreaOnFinerGrids) {
  double before = 1;
  for (const int count : {17, 65, 257}) {
    ClothSheet sheet;
    sheet.rows = sheet.columns = count;
    sheet.cut = "round";
    const double area = 4.0 * cells_of(cut_grid(sheet)) / ((count - 1) * (count - 1));
    const double error = std::abs(area / std::numbers::pi - 1);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(RoundCloth, WeighsItsArealDensityTimesItsCells) {
  for (const Scene& scene : round_sheets()) {
    const CellSides cell = cell_sides(scene.cloth);
    const double area = cells_of(cut_grid(scene.cloth)) * cell.across * cell.down;
    EXPECT_NEAR(make_cloth(scene).total_mass(), any_material().areal_density * area, 1e-12 * area);
  }
}

TEST(RoundCloth, IsAMeshWithTwoTrianglesForEachCellThatFaceLikeTheGrids) {
  for (const Scene& scene : round_sheets()) {
    const ClothSystem system = make_cloth(scene);
    EXPECT_TRUE(system.is_mesh());
    EXPECT_EQ(system.rows, 1);
    EXPECT_EQ(system.size(), particle_count(scene.cloth));
    EXPECT_EQ(system.triangles.size(), 2U * static_cast<std::size_t>(cells_of(cut_grid(scene.cloth))));
    const TriangleMesh surface = rest_surface(system);
    const Vec3 front = scene.cloth.down.cross(scene.cloth.across);
    for (const Triangle& t : surface.triangles) EXPECT_GT(surface.area_normal(t).dot(front), 0);
  }
}

/// Cell by cell is the same cloth whether it is assembled as a grid or as what a cut leaves.
TEST(RoundCloth, OfWhichNothingIsCutIsTheGridsOwnCloth) {
  Scene scene = material_sheet(6, 9, 0.05, 0.04, any_material());
  scene.cloth.pins = {NamedPin::left_edge, PinnedParticle{0, 1}, PinnedParticle{1, 1}, PinnedParticle{4, 6}};
  const ClothSystem grid = make_cloth(scene), cut = make_material_cut(scene.cloth, any_material());
  const auto shape = [](const Vec3& x) -> Vec3 {
    return {1.01 * x.x() + 0.3 * x.y() * x.y(), x.y() - 0.2 * x.x() * x.x(), std::sin(9 * x.x() - 4 * x.y())};
  };
  EXPECT_EQ(cut.pinned, grid.pinned);
  for (std::size_t i = 0; i < grid.mass.size(); ++i) EXPECT_NEAR(cut.mass[i], grid.mass[i], 1e-15);
  const Vec3Field position = moved(grid.start, shape);
  const Vec3Field expected = conservative_forces(scene, grid, position),
                  found = conservative_forces(scene, cut, position);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_LT((found[i] - expected[i]).norm(), 1e-9 * (1 + expected[i].norm())) << "particle " << i;
}

TEST(RoundCloth, AtRestAndTurnedFeelsNoForceAnywhere) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, -1).normalized());
  for (const Scene& scene : round_sheets()) {
    const ClothSystem system = make_cloth(scene);
    const Vec3Field position = moved(system.start, [&](const Vec3& x) -> Vec3 { return turn * x; });
    const Vec3Field force = conservative_forces(scene, system, position);
    for (std::size_t i = 0; i < force.size(); ++i) EXPECT_LT(force[i].norm(), 1e-10) << "particle " << i;
  }
}

/// As the stress is the same everywhere, what does not lie at the border has none to carry.
TEST(RoundCloth, UnderTheSameStrainEverywhereIsInEquilibriumInside) {
  for (const Scene& scene : round_sheets()) {
    const ClothSystem system = make_cloth(scene);
    const CutGrid grid = cut_grid(scene.cloth);
    const Vec3Field position = moved(system.start, [](const Vec3& x) -> Vec3 {
      return {1.03 * x.x() + 0.02 * x.y(), 0.98 * x.y() - 0.01 * x.x(), 0.05 * x.x()};
    });
    const Vec3Field force = conservative_forces(scene, system, position);
    double largest = 0;
    for (std::size_t i = 0; i < force.size(); ++i) largest = std::max(largest, force[i].norm());
    EXPECT_GT(largest, 1e-3);  // at the border the stress ends
    for (std::size_t i = 0; i < force.size(); ++i)
      if (grid.cells_around(grid.place[i] / grid.columns, grid.place[i] % grid.columns) == 4) {
        EXPECT_LT(force[i].norm(), 1e-12 * largest / 1e-3);
      }
  }
}

/// The energy of a strain of the whole is that of the material over the area of the cells, at borders too.
TEST(RoundCloth, StoresTheMaterialsEnergyOfASmallStrain) {
  const Material m = any_material();
  constexpr double small = 1e-5;
  for (const Scene& scene : round_sheets()) {
    const ClothSystem system = make_cloth(scene);
    const CellSides cell = cell_sides(scene.cloth);
    const double area = cells_of(cut_grid(scene.cloth)) * cell.across * cell.down;
    ClothState state = starting_state(system);
    state.position = moved(system.start, [](const Vec3& x) -> Vec3 {
      return {(1 + small) * x.x() + 2 * small * x.y(), (1 - small) * x.y(), x.z()};
    });
    const double expected = 0.5 * (m.stretch_weft + m.stretch_warp) - m.shear + 2 * m.shear;
    EXPECT_NEAR(measure_energy(system, Vec3::Zero(), state).elastic / (area * small * small), expected,
                1e-4 * expected);
  }
}

/// Of a cylinder about the columns' direction: B/2 curvature^2 for each area. Stencils have no curvature on
/// the outermost particles of each line, so that a border of half a cell's width is missing: first order.
TEST(RoundCloth, StoresTheMaterialsBendingEnergyOfACylinderOnFinerGrids) {
  const Material m = any_material();
  constexpr double curvature = 2, side = 0.4;
  double before = 1;
  for (const int count : {17, 33, 65, 129}) {
    const Scene scene = round_sheet(count, count, side / (count - 1), side / (count - 1));
    const ClothSystem system = make_cloth(scene);
    const Vec3Field position = moved(system.start, [](const Vec3& x) -> Vec3 {
      return {std::sin(curvature * x.x()) / curvature, x.y(), (1 - std::cos(curvature * x.x())) / curvature};
    });
    const double cell = side / (count - 1), area = cells_of(cut_grid(scene.cloth)) * cell * cell;
    const double expected = 0.5 * m.bending_weft * curvature * curvature * area;
    const double error = 1 - bending_energy(system.bending, position) / expected;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.65 * before);
    EXPECT_LT(error, 1.6 * cell / side);
    before = error;
  }
}

TEST(PinnedDisc, HoldsWhatIsWithinItsRadiusAndFourTenthsOfACell) {
  Scene scene = round_sheet(21, 21, 0.01, 0.01);
  scene.cloth.pins = {PinnedDisc{0.05}};
  const ClothSystem system = make_cloth(scene);
  const Vec3 middle = scene.cloth.origin + 0.1 * scene.cloth.across + 0.1 * scene.cloth.down;
  for (std::size_t i = 0; i < system.pinned.size(); ++i)
    EXPECT_EQ(system.pinned[i] != 0, (system.start[i] - middle).norm() <= 0.054);
}

TEST(PinnedDisc, HoldsTheSamePlacesOfTheWholeGrid) {
  Scene scene = material_sheet(21, 21, 0.01, 0.01, any_material());
  scene.cloth.pins = {PinnedDisc{0.05}};
  const std::vector<int> whole = pinned_particles(scene.cloth);
  scene.cloth.cut = "round";
  const CutGrid grid = cut_grid(scene.cloth);
  std::vector<int> places;
  for (const int particle : pinned_particles(scene.cloth))
    places.push_back(grid.place[static_cast<std::size_t>(particle)]);
  EXPECT_EQ(places, whole);
  EXPECT_GT(whole.size(), 60U);
}

std::vector<Problem> problems_of(const std::string& cloth, const std::string& rest, int count = 9) {
  return read_scene(
             fmt::format(
                 R"({{"format": "clothlab/scene/1", "cloth": {{"rows": {0}, "columns": {0}, {1}}}{2}}})",
                 count, cloth, rest),
             "a.scene.json")
      .problems;
}

TEST(RoundCloth, NeedsAMaterial) {
  const auto problems = problems_of(R"("cut": "round")", R"(, "springs": {"structural": 100})");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].path, "cloth.cut");
  EXPECT_NE(problems[0].rule.find("needs a material"), std::string::npos);
  EXPECT_TRUE(problems_of(R"("cut": "round")", R"(, "material": "gray-interlock")").empty());
}

TEST(RoundCloth, RefusesPinsWhereItIsCutAway) {
  const std::string material = R"(, "material": "gray-interlock")";
  for (const char* pin : {R"("top-left")", "[0, 0]", "[0, 1]", R"({"disc": 0.00001})"}) {
    const auto problems = problems_of(fmt::format(R"("cut": "round", "pins": [{}])", pin), material, 10);
    ASSERT_EQ(problems.size(), 1U) << pin;
    EXPECT_EQ(problems[0].path, "cloth.pins.0");
  }
  for (const char* pin : {R"("top-edge")", "[0, 4]", "[4, 4]", R"({"disc": 0.09})"})
    EXPECT_TRUE(problems_of(fmt::format(R"("cut": "round", "pins": [{}])", pin), material).empty()) << pin;
}

TEST(PinnedDisc, IsReadWithItsRuleAndWrittenAgain) {
  const std::string material = R"(, "material": "gray-interlock")";
  for (const char* pin : {R"({"disc": 0})", R"({"disc": -1})", R"({"disc": "a"})", R"({"disk": 1})",
                          R"({"disc": 1, "cells": 2})"})
    EXPECT_FALSE(problems_of(fmt::format(R"("pins": [{}])", pin), material).empty()) << pin;
  Scene scene = round_sheet(9, 9, 0.1, 0.1);
  scene.cloth.pins = {PinnedDisc{0.25}, PinnedParticle{1, 4}, NamedPin::top_edge};
  const SceneReading again = read_scene(write_scene(scene), "a.scene.json");
  ASSERT_TRUE(again.scene);
  EXPECT_EQ(again.scene->cloth.pins, scene.cloth.pins);
  EXPECT_EQ(again.scene->cloth.cut, "round");
}

TEST(RoundCloth, TakesAndFreesPinsWhileItRuns) {
  Scene scene = round_sheet(9, 9, 0.05, 0.05);
  scene.gravity = Vec3(0, -9.81, 0);
  scene.cloth.pins = {NamedPin::top_edge};
  Simulation simulation(scene);
  for (int step = 0; step < 50; ++step) simulation.step();
  const auto pinned = [&] {
    std::vector<int> found;
    for (int i = 0; i < simulation.system().size(); ++i)
      if (simulation.system().pinned[static_cast<std::size_t>(i)] != 0) found.push_back(i);
    return found;
  };
  EXPECT_EQ(pinned(), pinned_particles(scene.cloth));
  scene.cloth.pins = {PinnedParticle{4, 4}, PinnedDisc{0.06}};
  simulation.edit(scene);
  EXPECT_EQ(pinned(), pinned_particles(scene.cloth));
  const Vec3 held = simulation.state().position[static_cast<std::size_t>(cut_grid(scene.cloth).at(4, 4))];
  for (int step = 0; step < 50; ++step) simulation.step();
  EXPECT_EQ(simulation.state().position[static_cast<std::size_t>(cut_grid(scene.cloth).at(4, 4))], held);
}

/// What is drawn has the cloth's particles, and its threads as edges.
TEST(RoundCloth, IsDrawnByItsOwnTrianglesAndThreads) {
  const Simulation simulation(round_sheet(9, 9, 0.05, 0.05));
  ASSERT_TRUE(simulation.surface());
  EXPECT_EQ(simulation.surface()->surface.triangles, simulation.system().triangles);
  EXPECT_EQ(static_cast<std::int64_t>(simulation.surface()->edges.size()),
            simulation.system().spring_count(SpringFamily::structural));
  EXPECT_FALSE(Simulation(material_sheet(9, 9, 0.05, 0.05, any_material())).surface());
}

/// What automatic steps rely on.
TEST(RoundCloth, HasNoFrequencyAboveItsGuaranteedOne) {
  for (Scene scene : round_sheets()) {
    scene.cloth.pins = {PinnedDisc{0.08}};
    const ClothSystem system = make_cloth(scene);
    const double guaranteed = guaranteed_frequency(scene), flat = largest_frequency(scene);
    const Vec3Field bent = moved(system.start, [](const Vec3& x) -> Vec3 {
      return {1.2 * x.x(), 1.2 * x.y(), 0.1 * std::sin(20 * x.x() + 13 * x.y())};
    });
    EXPECT_LE(measure_spectrum(system, system.start).largest_frequency(), flat * (1 + 1e-9));
    EXPECT_LE(measure_spectrum(system, bent).largest_frequency(), guaranteed * (1 + 1e-9));
    EXPECT_LE(flat, guaranteed);
  }
}

}  // namespace
}  // namespace cloth::test::cut_cloth_test
