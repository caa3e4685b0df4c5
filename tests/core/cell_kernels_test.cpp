// The kernels of a grid that is assembled cell by cell, in every instruction set that this machine has,
// against springs and bending elements taken one by one.
#include <gtest/gtest.h>

#include "integrators/registry.h"
#include "kernels/grid_layout.h"
#include "kernels/instruction_set.h"
#include "scene/scene_cloth.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::cell_kernels_test {
namespace {

class MaterialsOnEveryInstructionSet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, MaterialsOnEveryInstructionSet,
                         ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

constexpr std::pair<int, int> odd_sizes[] = {{2, 2},  {2, 3}, {3, 2},   {3, 17},  {7, 9},   {33, 33},
                                             {40, 7}, {9, 8}, {12, 10}, {65, 64}, {11, 41}, {20, 6}};
const char* const fused_methods[] = {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"};

enum Feature { without_shear = 1, without_bending = 2, stretch_damping = 4, bending_damping = 8, air = 16 };
constexpr int all_features = 32;

/// Held by a clamp, a corner and a particle inside.
Scene sheet_of(int rows, int columns, int features) {
  Material m = any_material();
  m.mass_damping = 2;
  if (features & without_shear) m.shear = 0;
  if (features & without_bending) m.bending_warp = m.bending_weft = m.twist = 0;
  if (features & stretch_damping) m.stretch_damping = 1e-4;
  if (features & bending_damping) m.bending_damping = 2e-4;
  if (features & air) m.drag_normal = 0.7, m.drag_tangential = 0.2;
  Scene scene = material_sheet(rows, columns, 0.1, 0.08, m);
  scene.gravity = Vec3(0.3, -9.81, 0.1);
  if (features & air) scene.air = Air{.wind = {0.3, -1, 2}, .gust = Gust{0.5, 30}};
  scene.cloth.pins = {NamedPin::top_right, PinnedParticle{rows / 2, columns / 2}};
  if (columns > 4)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 2; ++column) scene.cloth.pins.emplace_back(PinnedParticle{row, column});
  return scene;
}

/// With one mass changed in its last digits no kernel takes the system.
void make_general(DirectRun& run) {
  run.system.mass.back() *= 1 + 1e-15;
  if (run.system.inverse_mass.back() > 0) run.system.inverse_mass.back() = 1 / run.system.mass.back();
  run.forces.system_changed();
}

TEST_P(MaterialsOnEveryInstructionSet, HaveTheForcesOfElementsTakenOneByOne) {
  Random random;
  for (const auto& [rows, columns] : odd_sizes)
    for (int features = 0; features < 4; ++features) {
      const Scene scene = sheet_of(rows, columns, features);
      DirectRun swept(scene, "verlet"), general(scene, "verlet");
      ASSERT_TRUE(swept.forces.sweep()) << rows << " x " << columns << ", features " << features;
      make_general(general);
      ASSERT_FALSE(general.forces.sweep() && general.forces.sweep()->has_shares());
      ClothState state = crumpled_state(swept.system, 0.03, 0, random);
      state.position.set(1, state.position[0]);  // a spring of no length
      swept.forces.update(state.position, 0), general.forces.update(state.position, 0);
      const Vec3Field& expected = general.forces.position_force();
      EXPECT_LE(largest_distance(swept.forces.position_force(), expected), 1e-13 * largest_norm(expected))
          << rows << " x " << columns << ", features " << features;
    }
}

TEST_P(MaterialsOnEveryInstructionSet, HaveTheDampingOfElementsTakenOneByOne) {
  Random random;
  for (const auto& [rows, columns] : odd_sizes)
    for (int features = 0; features < all_features; ++features) {
      const Scene scene = sheet_of(rows, columns, features);
      DirectRun swept(scene, "verlet"), general(scene, "verlet");
      make_general(general);
      ClothState state = crumpled_state(swept.system, 0.03, 0.5, random);
      state.position.set(1, state.position[0]);  // a spring of no length
      Vec3Field force(state.position.size()), expected(state.position.size());
      Work power, expected_power;
      for (auto& [run, f, p] : {std::tie(swept, force, power), std::tie(general, expected, expected_power)}) {
        run.forces.update(state.position, 0);
        p = run.forces.force_and_power(state.position, state.velocity, f);
      }
      const std::string what =
          std::to_string(rows) + " x " + std::to_string(columns) + ", features " + std::to_string(features);
      EXPECT_LE(largest_distance(force, expected), 1e-13 * largest_norm(expected)) << what;
      EXPECT_NEAR(power.damping_loss, expected_power.damping_loss, 1e-12 * expected_power.damping_loss)
          << what;
    }
}

TEST_P(MaterialsOnEveryInstructionSet, StepAsTheGeneralWayDoes) {
  Random random;
  for (const char* method : fused_methods)
    for (const auto& [rows, columns] : odd_sizes)
      for (int features = 0; features < all_features; ++features) {
        const Scene scene = sheet_of(rows, columns, features);
        DirectRun whole(scene, method), general(scene, method);
        const bool is_swept_whole = whole.forces.is_swept_whole();
        EXPECT_TRUE(is_swept_whole);
        make_general(general);
        whole.state = crumpled_state(whole.system, 0.01, 0.1, random);
        general.state = whole.state;
        whole.advance(10, 1e-4);
        general.advance(10, 1e-4);
        const std::string what = std::string(method) + ", " + std::to_string(rows) + " x " +
                                 std::to_string(columns) + ", features " + std::to_string(features);
        EXPECT_LE(largest_distance(whole.state.position, general.state.position), 1e-14) << what;
        EXPECT_LE(largest_distance(whole.state.velocity, general.state.velocity), 1e-11) << what;
        EXPECT_NEAR(whole.work.damping_loss, general.work.damping_loss, 1e-12 * general.work.damping_loss)
            << what;
        EXPECT_NEAR(whole.work.air, general.work.air, 1e-11 * std::abs(general.work.air)) << what;
        EXPECT_EQ(general.work.air != 0, (features & air) != 0) << what;
        EXPECT_GT(general.work.damping_loss, 0) << what;
      }
}

TEST_P(MaterialsOnEveryInstructionSet, HaveTheSameBitsForAnyNumberOfThreads) {
  for (const char* method : fused_methods)
    for (const int features : {0, int{stretch_damping | bending_damping}, int{air}, all_features - 4}) {
      Scene scene = sheet_of(151, 103, features);
      scene.integrator.method = method;
      scene.integrator.time_step = std::string(method) == "explicit-euler" ? 1e-6 : 1e-4;
      const auto advance = [](Simulation& simulation) {
        for (int k = 0; k < 12; ++k) ASSERT_FALSE(simulation.step());
      };
      Simulation alone(scene);
      advance(alone);
      for (const int threads : {2, 3, 5}) {
        Simulation shared(scene);
        shared.set_threads(threads, ThreadUse::always);
        ASSERT_EQ(shared.threads(), threads);
        advance(shared);
        EXPECT_EQ(alone.state(), shared.state()) << method << ", " << features << ", " << threads;
        EXPECT_EQ(alone.measure().ledger.forces.damping_loss, shared.measure().ledger.forces.damping_loss);
      }
    }
}

TEST(CellLayout, IsRecognisedOnlyWhereEveryShareIsItsCells) {
  const ClothSystem system = make_cloth(sheet_of(6, 7, 0));
  ASSERT_TRUE(cell_layout(system));
  const auto is_taken = [&](auto change) {
    ClothSystem other = system;
    change(other);
    return cell_layout(other).has_value();
  };
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.mass[3] *= 2; }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.springs.blocks().front().run.stiffness *= 2; }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.springs.blocks()[1].run.rest_length *= 2; }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.springs.blocks().erase(s.springs.blocks().begin() + 1); }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.springs.push_back({SpringFamily::flexion, 0, 1, 2, 1, 1}); }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.bending.front().offset[2] += 1; }));
  EXPECT_FALSE(is_taken([](ClothSystem& s) { s.bending.push_back(s.bending.front()); }));
  EXPECT_TRUE(is_taken([](ClothSystem& s) { s.bending.clear(); }));
  EXPECT_TRUE(is_taken([](ClothSystem& s) { s.bending.front().stiffness *= 3; })) << "as clamps do";
}

}  // namespace
}  // namespace cloth::test::cell_kernels_test
