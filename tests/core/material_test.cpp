// A material on grids: springs, masses and bending elements that are the same cloth on every grid.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "cloth/grid.h"
#include "integrators/registry.h"
#include "measure/energy.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "simulation/recorder.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/materials.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::material_test {
namespace {

/// Grids of one sheet, 0.6 m by 0.4 m, with cells of any shape.
std::vector<Scene> grids_of_a_sheet(const Material& material) {
  std::vector<Scene> scenes;
  for (const auto& [rows, columns] : {std::pair{3, 4}, {5, 7}, {9, 7}, {7, 13}, {9, 13}})
    scenes.push_back(material_sheet(rows, columns, 0.6 / (columns - 1), 0.4 / (rows - 1), material));
  return scenes;
}

Vec3Field mapped(const Vec3Field& from, const Eigen::Matrix3d& by) {
  Vec3Field to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to.set(i, by * from[i]);
  return to;
}

double elastic_energy_of(const ClothSystem& system, const Vec3Field& position) {
  ClothState state = starting_state(system);
  state.position = position;
  return measure_energy(system, Vec3::Zero(), state).elastic;
}

Vec3Field force_of(const Scene& scene, const Vec3Field& position) {
  DirectRun run(scene, "verlet");
  Vec3Field force(position.size());
  run.forces.update(position, 0);
  run.forces.force(position, Vec3Field(position.size()), force);
  return force;
}

Eigen::Matrix3d strained(double weft, double warp, double shear) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 0) += weft, f(1, 1) += warp, f(0, 1) += shear;
  return f;
}

TEST(MaterialGrid, StoresTheMaterialsEnergyOfASmallStrainOnEveryGrid) {
  const Material m = any_material();
  constexpr double small = 1e-5, area = 0.24;
  struct State {
    double weft, warp, shear, energy;  // the last over area and small^2
  };
  const State states[] = {{1, 0, 0, 0.5 * m.stretch_weft},
                          {0, 1, 0, 0.5 * m.stretch_warp},
                          {0, 0, 1, 0.5 * m.shear},
                          {1, 1, 0, 0.5 * (m.stretch_weft + m.stretch_warp) + m.shear},
                          {1, -1, 2, 0.5 * (m.stretch_weft + m.stretch_warp) - m.shear + 2 * m.shear}};
  for (const Scene& scene : grids_of_a_sheet(m)) {
    const ClothSystem system = make_cloth(scene);
    for (const State& s : states) {
      const auto map = strained(small * s.weft, small * s.warp, small * s.shear);
      EXPECT_NEAR(elastic_energy_of(system, mapped(system.start, map)) / (area * small * small), s.energy,
                  5e-5 * s.energy)
          << scene.cloth.rows << " rows, " << scene.cloth.columns << " columns";
    }
  }
}

TEST(MaterialGrid, IsInEquilibriumInsideAndPullsAtItsEdgesAsTheMaterialDoesInEveryAffineState) {
  const Material m = any_material();
  constexpr double small = 1e-6;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Vec3 traction = small * Vec3(m.stretch_weft * 2 + m.shear * -1, m.shear * 3, 0);
  for (const Scene& scene : grids_of_a_sheet(m)) {
    const ClothSystem system = make_cloth(scene);
    const Eigen::Matrix3d map = turn * strained(2 * small, -1 * small, 3 * small);
    const Vec3Field force = force_of(scene, mapped(system.start, map));
    const double down = scene.cloth.height / (system.rows - 1);
    for (int row = 1; row + 1 < system.rows; ++row) {
      const auto at = [&](int column) { return force[static_cast<std::size_t>(system.index(row, column))]; };
      for (int column = 1; column + 1 < system.columns; ++column) EXPECT_LE(at(column).norm(), 1e-12);
      EXPECT_LE((at(0) / down - turn * traction).norm(), 1e-4 * traction.norm());
      EXPECT_LE((at(system.columns - 1) / down + turn * traction).norm(), 1e-4 * traction.norm());
    }
  }
}

TEST(MaterialGrid, HasTheMassOfItsAreaAQuarterOfACellsAtACorner) {
  for (const Scene& scene : grids_of_a_sheet(any_material())) {
    const ClothSystem system = make_cloth(scene);
    EXPECT_NEAR(system.total_mass(), 0.18 * 0.24, 1e-15);
    const double of_cell = 0.18 * 0.24 / ((system.rows - 1) * (system.columns - 1));
    EXPECT_NEAR(system.mass[0], of_cell / 4, 1e-15);
    EXPECT_NEAR(system.mass[1], of_cell / 2, 1e-15);
    EXPECT_NEAR(system.mass[static_cast<std::size_t>(system.index(1, 1))], of_cell, 1e-15);
  }
}

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

// ---- damping, air, falling ----

TEST(MaterialGrid, FallsAsOneThroughAirAndDampingWhateverItsGrid) {
  Material m = any_material();
  m.mass_damping = 3, m.drag_normal = 0.6;
  const double rate = m.mass_damping + m.drag_normal / m.areal_density, time = 0.4;
  const double speed = 9.81 / rate * (1 - std::exp(-rate * time));
  for (Scene scene : grids_of_a_sheet(m)) {
    scene.cloth.down = Vec3(0, 0, 1);  // it lies flat
    scene.gravity = Vec3(0, -9.81, 0);
    scene.integrator = {"rk4", 1e-3};
    Simulation run(scene);
    ASSERT_FALSE(run.advance(400));
    for (std::size_t i = 0; i < run.state().velocity.size(); ++i)
      EXPECT_LE((run.state().velocity[i] - Vec3(0, -speed, 0)).norm(), 1e-9);
    EXPECT_LE(run.measure().strain.maximum(), 1e-12);
    EXPECT_LE(std::abs(run.measure().energy_error()), 1e-9);
  }
}

TEST(MaterialGrid, SlidesThroughAirAsItsTangentialDragSays) {
  Material m = any_material();
  m.drag_tangential = 0.9;
  Scene scene = material_sheet(5, 7, 0.1, 0.07, m);  // upright: it falls along itself
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator = {"rk4", 1e-3};
  Simulation run(scene);
  ASSERT_FALSE(run.advance(300));
  const double rate = m.drag_tangential / m.areal_density;
  for (std::size_t i = 0; i < run.state().velocity.size(); ++i)
    EXPECT_NEAR(run.state().velocity[i].y(), -9.81 / rate * (1 - std::exp(-rate * 0.3)), 1e-9);
}

/// A sheet held by its top edge, with every force of its own and wind.
Scene complete_scene() {
  Material m = any_material();
  m.stretch_damping = 2e-4, m.bending_damping = 1e-3, m.mass_damping = 0.5;
  m.drag_normal = 0.8, m.drag_tangential = 0.1;
  Scene scene = material_sheet(7, 9, 0.05, 0.04, m);
  scene.cloth.down = Vec3(0, -0.6, 0.8);
  scene.cloth.pins = {NamedPin::top_edge};  // and the next row: it bends at a clamp
  for (int column = 0; column < 9; ++column) scene.cloth.pins.emplace_back(PinnedParticle{1, column});
  scene.gravity = Vec3(0, -9.81, 0);
  scene.air = Air{.wind = {0.5, 0.2, 2}, .gust = std::nullopt};
  scene.duration = 0.2;
  scene.record.interval = 0.02;
  return scene;
}

TEST(MaterialGrid, AccountsForItsEnergyWithEveryForceOfItsOwn) {
  for (const auto& [method, step, most] : {std::tuple{"semi-implicit-euler", 1e-5, 2e-3},
                                           {"verlet", 1e-4, 1e-4},
                                           {"rk4", 1e-4, 1e-7},
                                           {"dormand-prince", 1e-3, 1e-4},
                                           {"implicit-euler", 2e-5, 2e-2},
                                           {"implicit-midpoint", 2e-4, 2e-4},
                                           {"bdf2", 1e-4, 1e-3}}) {
    Scene scene = complete_scene();
    scene.integrator.method = method, scene.integrator.time_step = step;
    Simulation run(scene);
    double exchanged = 0, error = 0;
    while (run.time() < scene.duration - 1e-9) {
      ASSERT_FALSE(run.advance(10)) << method;
      const Measurement m = run.measure();
      exchanged = std::max(exchanged, m.energy.kinetic + m.energy.elastic);
      error = std::max(error, std::abs(m.energy_error()));
    }
    EXPECT_GT(run.measure().energy.bending, 0.1 * exchanged) << method;
    EXPECT_GT(run.measure().ledger.forces.damping_loss, 0.01 * exchanged) << method;
    EXPECT_GT(std::abs(run.measure().ledger.forces.air), 0.01 * exchanged) << method;
    EXPECT_LE(error, most * exchanged) << method;
  }
}

TEST(MaterialGrid, AnswersTheSameByEveryMethodAsStepsShrink) {
  Scene scene = complete_scene();
  const auto end_by = [&](const std::string& method, double step) {
    DirectRun run(scene, exactly(method, step));
    run.advance(static_cast<int>(std::lround(0.04 / step)), step);
    return run.state.position;
  };
  const Vec3Field exact = end_by("rk4", 2e-5);
  for (const auto& [method, step, order] : {std::tuple{"semi-implicit-euler", 8e-5, 1},
                                            {"verlet", 1e-4, 2},
                                            {"implicit-euler", 1e-4, 1},
                                            {"implicit-midpoint", 2e-4, 2},
                                            {"bdf2", 2e-4, 2},
                                            {"projective", 1e-4, 1},
                                            {"xpbd", 1e-4, 1}}) {
    const double coarse = rms_distance(end_by(method, step), exact),
                 fine = rms_distance(end_by(method, step / 2), exact);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << method;
    EXPECT_LE(coarse, 2e-3) << method;
  }
}

// ---- stability ----

/// The largest circular frequency of the free particles, springs and bending, in 1/s.
double largest_frequency_of(const ClothSystem& system, const Vec3Field& position) {
  const Eigen::MatrixXd hessian = spring_hessian(system, position) + bending_hessian(system);
  Eigen::VectorXd scale(hessian.rows());
  for (Eigen::Index row = 0; row < hessian.rows(); ++row)
    scale[row] = std::sqrt(system.inverse_mass[static_cast<std::size_t>(row / 3)]);
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
                       .eigenvalues()
                       .maxCoeff());
}

TEST(MaterialFrequency, IsBoundedForEveryShapePinsAndCells) {
  Random random;
  for (int trial = 0; trial < 24; ++trial) {
    Material m = any_material();
    const double stiffer =
        std::pow(10, random.uniform(-3, 3));  // from springs that rule to bending that does
    m.bending_warp *= stiffer * random.uniform(0, 1), m.bending_weft *= stiffer, m.twist *= stiffer;
    const double down = random.uniform(0.03, 0.1);
    m.shear = random.uniform(0, 1) * largest_shear(m, 0.05, down);
    Scene scene = material_sheet(trial % 3 ? 6 : 10, trial % 3 == 1 ? 7 : 11, 0.05, down, m);
    if (trial % 2) scene.cloth.pins = {NamedPin::left_edge, PinnedParticle{2, 1}, PinnedParticle{3, 1}};
    const ClothSystem system = make_cloth(scene);
    EXPECT_LE(largest_frequency_of(system, system.start), largest_frequency(scene) * (1 + 1e-9)) << trial;
    EXPECT_GE(largest_frequency_of(system, system.start), 0.7 * largest_frequency(scene));
    EXPECT_NEAR(
        measure_spectrum(system, system.start, {.iterations = 400, .tolerance = 1e-9}).largest_frequency(),
        largest_frequency_of(system, system.start), 1e-4 * largest_frequency(scene));
    for (const double deviation : {0.02, 0.2, 2.0})
      EXPECT_LE(largest_frequency_of(system, crumpled_state(system, deviation, 0, random).position),
                guaranteed_frequency(scene) * (1 + 1e-12))
          << trial;
  }
}

TEST(MaterialFrequency, OfBendingAloneIsThatOfThePlatesFastestWave) {
  Material m = any_material();
  m.stretch_warp = m.stretch_weft = m.shear = 0;
  const Scene scene = material_sheet(24, 24, 0.01, 0.01, m);
  const double closed = std::sqrt((16 * (m.bending_warp + m.bending_weft) + 32 * m.twist) /
                                  (m.areal_density * std::pow(0.01, 4)));
  EXPECT_NEAR(largest_frequency(scene), closed, 1e-6 * closed);
  EXPECT_NEAR(guaranteed_frequency(scene), closed, 1e-9 * closed);
  const ClothSystem system = make_cloth(scene);
  EXPECT_GE(largest_frequency_of(system, system.start), 0.98 * closed);
}

// ---- files ----

std::vector<std::string> problems_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const SceneReading reading = read_scene(text, "name", overrides);
  std::vector<std::string> texts;
  for (const Problem& problem : reading.problems) texts.push_back(problem.text());
  return texts;
}

using Texts = std::vector<std::string>;

TEST(MaterialBlock, RefusesWhatItReplacesAndNamesBoth) {
  EXPECT_EQ(
      problems_of("{ \"cloth\": { \"mass\": 1 },\n"
                  "\"material\": { \"areal_density\": 0.1 },\n"
                  "\"springs\": { \"structural\": 3 },\n"
                  "\"damping\": 0.1,\n"
                  "\"air\": { \"wind\": [1, 0, 0], \"drag\": 2, \"skin_friction\": 3 } }"),
      Texts({"name:1:22: cloth.mass = 1: must be left out beside \"material\", which has "
             "material.areal_density for it",
             "name:3:1: springs: must be left out beside \"material\", which has stretch_warp, stretch_weft, "
             "shear and bending for it",
             "name:4:12: damping = 0.1: must be left out beside \"material\", which has "
             "material.mass_damping for it",
             "name:5:37: air.drag = 2: must be left out beside \"material\", which has material.drag_normal "
             "for it",
             "name:5:57: air.skin_friction = 3: must be left out beside \"material\", which has "
             "material.drag_tangential for it"}));
}

TEST(MaterialBlock, NeedsAnArealDensityAndLeavesOutWhatIsNotGiven) {
  EXPECT_EQ(problems_of("{ \"cloth\": {}, \"material\": {} }"),
            Texts({"name:1:28: material.areal_density = 0 kg/m^2: must be > 0"}));
  const SceneReading reading =
      read_scene("{ \"cloth\": {}, \"material\": { \"areal_density\": 0.1 } }", "name");
  ASSERT_TRUE(reading.scene);
  Material bare;
  bare.areal_density = 0.1;
  EXPECT_EQ(*reading.scene->material, bare);
  const ClothSystem system = make_cloth(*reading.scene);
  EXPECT_TRUE(system.bending.empty());
  EXPECT_TRUE(system.springs.empty());
}

TEST(MaterialBlock, SaysWhichShearFitsSpringsOnTheseCells) {
  const std::string text =
      "{ \"cloth\": { \"columns\": 11, \"rows\": 11, \"width\": 1, \"height\": 0.5 },\n"
      "\"material\": { \"areal_density\": 0.1, \"stretch_warp\": 100, \"stretch_weft\": 80, \"shear\": 21 } "
      "}";
  const Texts found = problems_of(text);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].substr(0, 55), "name:2:87: material.shear = 21 N/m: must be at most 20 ") << found[0];
  EXPECT_EQ(problems_of(text, {{"material.shear", "20"}}), Texts{});
  EXPECT_EQ(problems_of(text, {{"cloth.height", "1"}}), Texts{}) << "square cells";
}

TEST(MaterialBlock, IsForRectangularCells) {
  const std::string text =
      "{ \"cloth\": { \"down\": [0.5, -1, 0] }, \"material\": { \"areal_density\": 0.1 } }";
  EXPECT_EQ(problems_of(text),
            Texts({"name:1:22: cloth.down = [0.5, -1, 0]: must be at right angles to cloth.across: the cells "
                   "of a material are rectangles"}));
}

TEST(MaterialBlock, TakesTheBendingAt45DegreesForTheTwist) {
  const auto with = [](const std::string& more) {
    return "{ \"cloth\": {}, \"material\": { \"areal_density\": 0.1, \"bending_warp\": 2e-5, "
           "\"bending_weft\": "
           "4e-5" +
           more + " } }";
  };
  const SceneReading reading = read_scene(with(", \"bending_45\": 2.5e-5"), "name");
  ASSERT_TRUE(reading.scene);
  EXPECT_NEAR(reading.scene->material->twist, 2e-5, 1e-19);
  EXPECT_EQ(problems_of(with(", \"bending_45\": 2.5e-5, \"twist\": 1e-5")).size(), 1u);
  EXPECT_EQ(problems_of(with(", \"bending_45\": -1")).size(), 1u);
  EXPECT_EQ(problems_of(with(", \"bending_45\": \"soft\"")).size(), 1u);
  const Texts negative = problems_of(with(", \"bending_45\": 1e-5"));
  ASSERT_EQ(negative.size(), 1u);
  EXPECT_NE(negative[0].find("must be at least a quarter"), std::string::npos) << negative[0];
}

TEST(MaterialBlock, IsWrittenAndReadBackAndHasNoMassOfItsOwnBesideIt) {
  Scene scene = complete_scene();
  const std::string text = write_scene(scene);
  EXPECT_EQ(text.find("\"mass\""), std::string::npos);
  EXPECT_EQ(text.find("\"drag\""), std::string::npos);
  const SceneReading reading = read_scene(text, "name");
  ASSERT_TRUE(reading.scene) << reading.problems.front().text();
  EXPECT_EQ(reading.scene->material, scene.material);
  EXPECT_EQ(write_scene(*reading.scene), text);
}

TEST(Recorder, HasBendingEnergyOnlyWhereTheClothBends) {
  const auto has_bending = [](const Scene& scene) {
    const auto columns = record_columns(Simulation(scene).quantities());
    return std::find(columns.begin(), columns.end(), "bending_J") != columns.end();
  };
  EXPECT_TRUE(has_bending(complete_scene()));
  Scene flat = complete_scene();
  flat.material->bending_warp = flat.material->bending_weft = flat.material->twist = 0;
  EXPECT_FALSE(has_bending(flat));
  EXPECT_FALSE(has_bending(smooth_scene(5, 5)));
}

}  // namespace
}  // namespace cloth::test::material_test
