// The friction of a cloth that bends: its loop, its loss in the ledger, on grids and meshes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "cloth/sums.h"
#include "integrators/implicit/linear_solver.h"
#include "measure/energy.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/rest_shape.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::hysteresis_test {
namespace {

Material with_friction() {
  Material m = any_material();
  m.hysteresis_warp = 8e-3, m.hysteresis_weft = 6e-3;
  return m;
}

/// A sheet bent along the weft to this curvature, its middle where it was.
Vec3Field rolled(const ClothSystem& system, double curvature) {
  Vec3Field position = system.start;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 x = position[i];
    const double angle = curvature * (x.x() - 0.2);
    position.set(i, curvature == 0
                        ? x
                        : Vec3(0.2 + std::sin(angle) / curvature, x.y(), (1 - std::cos(angle)) / curvature));
  }
  return position;
}

/// The moment for each metre of width that the sliders of a sheet exert at a curvature, by the slope of their
/// energy.
double slider_moment(const ClothSystem& system, const SliderState& state, double curvature) {
  constexpr double shift = 1e-5;
  const double ahead = slider_energy(system.sliders, state, rolled(system, curvature + shift)),
               behind = slider_energy(system.sliders, state, rolled(system, curvature - shift));
  return (ahead - behind) / (2 * shift);
}

double area_of(const ClothSystem& system) {
  double area = 0;
  for (const BendingSlider& s : system.sliders) area += s.area;
  return area;
}

Material with_friction_along_the_weft() {
  Material m = with_friction();
  m.hysteresis_warp = 0;
  return m;
}

TEST(Hysteresis, DrawsALoopAsWideAs2HBOnAGridHoweverItLies) {
  const Material m = with_friction_along_the_weft();
  Scene scene = material_sheet(5, 41, 0.01, 0.02, m);
  const ClothSystem system = make_cloth(scene);
  SliderState state = sliders_at(system, system.start);
  const double area = area_of(system), most = 10 * m.hysteresis_weft / m.bending_weft;
  EXPECT_NEAR(area, 0.39 * 0.08, 1e-12);
  const auto follow = [&](double from, double to) {
    for (int n = 1; n <= 200; ++n)
      end_slider_step(system, rolled(system, from + (to - from) * n / 200), state);
  };
  follow(0, most);
  const double up = slider_moment(system, state, most + 0.01) / area;
  follow(most, 0);
  const double middle_down = slider_moment(system, state, -0.01) / area;
  follow(0, -most);
  follow(-most, 0);
  const double middle_up = slider_moment(system, state, 0.01) / area;
  EXPECT_NEAR(up, 0.5 * m.hysteresis_weft, 0.02 * m.hysteresis_weft);
  EXPECT_NEAR(middle_up - middle_down, m.hysteresis_weft, 0.02 * m.hysteresis_weft);
}

TEST(Hysteresis, LosesTheAreaOfItsLoop) {
  const Material m = with_friction_along_the_weft();
  const ClothSystem system = make_cloth(material_sheet(5, 41, 0.01, 0.02, m));
  SliderState state = sliders_at(system, system.start);
  const double most = 10 * m.hysteresis_weft / m.bending_weft;
  double stored = 0, lost = 0;
  const auto follow = [&](double from, double to) {
    for (int n = 1; n <= 500; ++n)
      lost += end_slider_step(system, rolled(system, from + (to - from) * n / 500), state);
  };
  follow(0, most);
  follow(most, -most);
  stored = slider_energy(system.sliders, state, rolled(system, -most));
  lost = 0;
  follow(-most, most);
  follow(most, -most);
  EXPECT_NEAR(slider_energy(system.sliders, state, rolled(system, -most)), stored, 0.02 * stored);
  // A parallelogram: 2HB high, as wide as the way less what is elastic at both turns.
  const double elastic = m.hysteresis_weft / (slider_stiffness_ratio * m.bending_weft);
  const double expected = m.hysteresis_weft * (2 * most - elastic) * area_of(system);
  EXPECT_NEAR(lost, expected, 0.02 * expected);
}

TEST(Hysteresis, LeavesABentStripWithACurvatureOfHBOverB) {
  Material m = with_friction_along_the_weft();
  Scene scene = material_sheet(3, 33, 0.0125, 0.0125, m);
  const ClothSystem system = make_cloth(scene);
  // What it keeps where nothing else acts: the elastic moment against a slider that has yielded backwards.
  SliderState state = sliders_at(system, system.start);
  const double most = 20 * 0.5 * m.hysteresis_weft / m.bending_weft;
  for (int n = 1; n <= 100; ++n) end_slider_step(system, rolled(system, most * n / 100), state);
  double low = 0, high = most, area = area_of(system);
  const auto moment = [&](double curvature) {
    SliderState there = state;
    for (int n = 1; n <= 100; ++n)
      end_slider_step(system, rolled(system, most + (curvature - most) * n / 100), there);
    return slider_moment(system, there, curvature) / area + m.bending_weft * curvature;
  };
  for (int n = 0; n < 30; ++n) (moment(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
  EXPECT_NEAR(low, 0.5 * m.hysteresis_weft / m.bending_weft, 0.02 * low);
}

std::vector<Scene> grid_and_mesh(const Material& m, Random& random) {
  return {material_sheet(6, 9, 0.05, 0.04, m), material_mesh_sheet(9, 6, 0.4, 0.2, 0.2, m, random)};
}

TEST(Hysteresis, ForceIsMinusTheSlopeOfItsEnergyAndItsJacobianTheForces) {
  Random random;
  for (const Scene& scene : grid_and_mesh(with_friction(), random)) {
    const ClothSystem system = make_cloth(scene);
    SliderState state = sliders_at(system, system.start);
    end_slider_step(system, crumpled_state(system, 4e-4, 0, random).position, state);
    const Vec3Field position = crumpled_state(system, 4e-4, 0, random).position;
    const Vec3Field u = random.field(position.size(), 1);
    constexpr double shift = 1e-7;
    Vec3Field ahead = position, behind = position, force(u.size()), of_ahead(u.size()), of_behind(u.size());
    add_scaled(shift, u, ahead), add_scaled(-shift, u, behind);
    add_slider_force(system.sliders, state, position, force);
    add_slider_force(system.sliders, state, ahead, of_ahead);
    add_slider_force(system.sliders, state, behind, of_behind);
    const double slope =
        (slider_energy(system.sliders, state, ahead) - slider_energy(system.sliders, state, behind)) /
        (2 * shift);
    EXPECT_NEAR(slope, -dot(force.flat(), u.flat()), 1e-5 * std::abs(slope) + 1e-9);
    Linearisation linear;
    linear.nodes.assign(u.size(), {});
    linear.springs.assign(system.springs.spring_count(), {});
    linear.slider_slope = slider_slopes(system.sliders, state, position), linear.slider_normal = state.normal;
    Vec3Field product(u.size());
    linear.multiply_free(system, u, product);
    int yielding = 0, held = 0;
    for (const double k : linear.slider_slope) (k > 0 ? held : yielding)++;
    EXPECT_GT(yielding, 5);
    EXPECT_GT(held, 5);
    double error = 0, scale = 0;
    for (std::size_t k = 0; k < product.flat().size(); ++k) {
      const double expected = -(of_ahead.flat()[k] - of_behind.flat()[k]) / (2 * shift);
      error += std::pow(product.flat()[k] - expected, 2), scale += expected * expected;
    }
    EXPECT_LE(error, 1e-8 * scale);
  }
}

TEST(Hysteresis, DoesNotResistMovingAndTurning) {
  Random random;
  for (const Scene& scene : grid_and_mesh(with_friction(), random)) {
    const ClothSystem system = make_cloth(scene);
    SliderState state = sliders_at(system, system.start);
    const Vec3Field bent = crumpled_state(system, 0.02, 0, random).position;
    end_slider_step(system, bent, state);
    const double stored = slider_energy(system.sliders, state, bent);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.2, Vec3(2, 1, -1).normalized()).toRotationMatrix();
    Vec3Field turned = bent;
    for (std::size_t i = 0; i < turned.size(); ++i) turned.set(i, turn * bent[i] + Vec3(3, 1, 2));
    SliderState there = sliders_at(system, turned);
    there.slip = state.slip;
    EXPECT_NEAR(slider_energy(system.sliders, there, turned), stored, 1e-9 * stored);
  }
}

/// A strip that swings down from level, held at its left edge.
Scene falling_strip(const Material& m, bool mesh, Random& random) {
  Scene scene =
      mesh ? material_mesh_sheet(13, 4, 0.3, 0.075, 0.15, m, random) : material_sheet(4, 13, 0.025, 0.025, m);
  scene.cloth.pins.clear();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 2; ++column)
      scene.cloth.pins.emplace_back(mesh ? PinnedParticle{0, row * 13 + column}
                                         : PinnedParticle{row, column});
  scene.gravity = Vec3(0, 0, -9.81);
  scene.duration = 0.3;
  scene.record.interval = 0.03;
  return scene;
}

TEST(Hysteresis, HasItsLossInTheLedgerWithEveryMethod) {
  Random random;
  for (const bool mesh : {false, true})
    for (const auto& [method, step, most] : {std::tuple{"semi-implicit-euler", 2e-5, 5e-3},
                                             {"verlet", 1e-4, 1e-3},
                                             {"rk4", 1e-4, 1e-3},
                                             {"dormand-prince", 1e-3, 1e-2},
                                             {"implicit-midpoint", 2e-4, 2e-3},
                                             {"bdf2", 1e-4, 2e-2}}) {
      Scene scene = falling_strip(with_friction(), mesh, random);
      scene.integrator.method = method, scene.integrator.time_step = step;
      Simulation run(scene);
      double exchanged = 0, error = 0, before = 0;
      while (run.time() < scene.duration - 1e-9) {
        ASSERT_FALSE(run.advance(10)) << method;
        const Measurement m = run.measure();
        exchanged = std::max(exchanged, m.energy.kinetic + m.energy.elastic);
        error = std::max(error, std::abs(m.energy_error()));
        EXPECT_GE(m.ledger.forces.hysteresis_loss, before - 1e-3 * exchanged) << method;
        before = m.ledger.forces.hysteresis_loss;
      }
      EXPECT_GT(before, 0.05 * exchanged) << method << (mesh ? ", mesh" : ", grid");
      EXPECT_LE(error, most * exchanged) << method << (mesh ? ", mesh" : ", grid");
    }
}

TEST(Hysteresis, GivesOneMotionByEveryMethodAsStepsShrink) {
  Random random;
  const Scene scene = falling_strip(with_friction(), false, random);
  const auto end_by = [&](const std::string& method, double step) {
    Scene with = scene;
    with.integrator = exactly(method, step);
    Simulation run(with);
    EXPECT_FALSE(run.advance(static_cast<int>(std::lround(0.06 / step)))) << method;
    return run.state().position;
  };
  const Vec3Field exact = end_by("rk4", 1e-5);
  for (const char* method : {"semi-implicit-euler", "verlet", "implicit-euler", "implicit-midpoint",
                             "projective", "xpbd", "vbd"}) {
    const double coarse = rms_distance(end_by(method, 1e-4), exact),
                 fine = rms_distance(end_by(method, 5e-5), exact);
    EXPECT_LE(fine, 0.7 * coarse) << method;
    EXPECT_LE(fine, 1e-3) << method;
  }
}

TEST(Hysteresis, GoesOnFromACheckpointToTheBit) {
  Random random;
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4", "dormand-prince", "implicit-euler",
                             "implicit-midpoint", "bdf2", "projective", "xpbd", "vbd"}) {
    Scene scene = falling_strip(with_friction(), false, random);
    scene.integrator = {method, 2e-5};
    Simulation run(scene), again(scene);
    ASSERT_FALSE(run.advance(50));
    const Checkpoint checkpoint = run.checkpoint();
    EXPECT_FALSE(checkpoint.force_history.empty());
    ASSERT_FALSE(run.advance(50));
    again.restore(checkpoint);
    ASSERT_FALSE(again.advance(50));
    EXPECT_TRUE(run.state() == again.state()) << method;
    EXPECT_EQ(run.checkpoint().force_history, again.checkpoint().force_history) << method;
  }
}

TEST(Hysteresis, StaysWhenTheSceneIsEdited) {
  Random random;
  Scene scene = falling_strip(with_friction(), false, random);
  scene.integrator = {"verlet", 1e-4};
  Simulation run(scene);
  ASSERT_FALSE(run.advance(500));
  const std::vector<double> slip = run.checkpoint().force_history;
  scene.material->mass_damping = 1;
  run.edit(scene);
  EXPECT_EQ(run.checkpoint().force_history, slip);
}

TEST(Hysteresis, HoldsAStripHigherThanItsBendingAlone) {
  Random random;
  Material m = with_friction();
  m.hysteresis_warp = m.hysteresis_weft = 0.04;
  for (const bool mesh : {false, true}) {
    const Scene elastic = falling_strip(any_material(), mesh, random),
                lagging = falling_strip(m, mesh, random);
    const auto lowest = [](const RestShape& rest) {
      double z = 0;
      for (std::size_t i = 0; i < rest.position.size(); ++i) z = std::min(z, rest.position[i].z());
      return z;
    };
    const RestShape free = find_rest(elastic), held = find_rest(lagging, {.load_steps = 10});
    ASSERT_TRUE(free.found && held.found) << free.failure << held.failure;
    EXPECT_LT(lowest(free), 1.05 * lowest(held));
  }
}

TEST(Hysteresis, NeedsAStiffness) {
  Scene scene = material_sheet(4, 4, 0.1, 0.1, with_friction());
  EXPECT_TRUE(find_problems(scene).empty());
  scene.material->bending_weft = 0;
  ASSERT_EQ(find_problems(scene).size(), 1u);
  EXPECT_EQ(find_problems(scene)[0].path, "material.hysteresis_weft");
}

}  // namespace
}  // namespace cloth::test::hysteresis_test
