// A material on grids: springs, masses and bending elements that are the same cloth on every grid.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "cloth/grid.h"
#include "geometry/dense_decompositions.h"
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

TEST(MaterialGrid, AccountsForItsEnergyWithEveryForceOfItsOwn) {
  for (const auto& [method, step, most] : {std::tuple{"semi-implicit-euler", 1e-5, 2e-3},
                                           {"verlet", 1e-4, 1e-4},
                                           {"rk4", 1e-4, 1e-7},
                                           {"dormand-prince", 1e-3, 1e-4},
                                           {"implicit-euler", 2e-5, 2e-2},
                                           {"implicit-midpoint", 2e-4, 2e-4},
                                           {"bdf2", 1e-4, 1e-3}}) {
    Scene scene = complete_material_scene();
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
  expect_the_same_by_every_method(complete_material_scene());
}

// ---- stability ----

/// The largest circular frequency of the free particles, springs and bending, in 1/s.
double largest_frequency_of(const ClothSystem& system, const Vec3Field& position) {
  const Eigen::MatrixXd hessian = spring_hessian(system, position) + bending_hessian(system);
  Eigen::VectorXd scale(hessian.rows());
  for (Eigen::Index row = 0; row < hessian.rows(); ++row)
    scale[row] = std::sqrt(system.inverse_mass[static_cast<std::size_t>(row / 3)]);
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  return std::sqrt(symmetric_values(scaled).maxCoeff());
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

TEST(Recorder, HasBendingEnergyOnlyWhereTheClothBends) {
  const auto has_bending = [](const Scene& scene) {
    const auto columns = record_columns(Simulation(scene).quantities());
    return std::find(columns.begin(), columns.end(), "bending_J") != columns.end();
  };
  EXPECT_TRUE(has_bending(complete_material_scene()));
  Scene flat = complete_material_scene();
  flat.material->bending_warp = flat.material->bending_weft = flat.material->twist = 0;
  EXPECT_FALSE(has_bending(flat));
  EXPECT_FALSE(has_bending(smooth_scene(5, 5)));
}

}  // namespace
}  // namespace cloth::test::material_test
