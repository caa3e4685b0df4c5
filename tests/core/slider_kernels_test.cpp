// The sliders of hysteresis in the passes over the rows of a grid, in every instruction set that this machine
// has, against the list of sliders taken one by one.
#include <gtest/gtest.h>

#include "kernels/instruction_set.h"
#include "kernels/slider_grid.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_cloth.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::slider_kernels_test {
namespace {

class SlidersOnEveryInstructionSet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, SlidersOnEveryInstructionSet,
                         ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

constexpr std::pair<int, int> odd_sizes[] = {{3, 3},  {3, 17}, {17, 3},  {4, 8},  {7, 9},
                                             {40, 7}, {9, 8},  {12, 10}, {5, 33}, {20, 6}};
const char* const fused_methods[] = {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"};

enum Feature { without_warp = 1, without_weft = 2, dampers = 4, air = 8 };
constexpr int all_features = 16;
bool has_sliders(int features) {
  return (features & 3) != 3;
}

/// Of cells that are not square, held by a clamp, a corner and a particle inside.
Scene sheet_of(int rows, int columns, int features) {
  Material m = any_material();
  m.mass_damping = 2;
  m.hysteresis_warp = features & without_warp ? 0 : 8e-3;
  m.hysteresis_weft = features & without_weft ? 0 : 6e-3;
  if (features & dampers) m.stretch_damping = 1e-4, m.bending_damping = 2e-4;
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

std::string name_of_case(int rows, int columns, int features) {
  return std::to_string(rows) + " x " + std::to_string(columns) + ", features " + std::to_string(features);
}

/// With one mass changed in its last digits no kernel takes the system.
void make_general(DirectRun& run) {
  run.system.mass.back() *= 1 + 1e-15;
  if (run.system.inverse_mass.back() > 0) run.system.inverse_mass.back() = 1 / run.system.mass.back();
  run.forces.system_changed();
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return a.size() == b.size() ? largest : INFINITY;
}
double largest_of(const std::vector<double>& a) {
  return largest_difference(a, std::vector<double>(a.size(), 0.0));
}

TEST_P(SlidersOnEveryInstructionSet, HaveTheForcesEnergiesAndLossesOfTheList) {
  Random random;
  for (const auto& [rows, columns] : odd_sizes)
    for (int features = 0; features < 3; ++features) {
      const std::string what = name_of_case(rows, columns, features);
      const Scene scene = sheet_of(rows, columns, features);
      DirectRun swept(scene, "verlet"), general(scene, "verlet");
      make_general(general);
      ASSERT_TRUE(swept.forces.swept().sliders) << what;
      ASSERT_FALSE(general.forces.swept().sliders) << what;
      for (const double crumpling : {3e-4, 0.02, 0.02}) {
        const Vec3Field at = crumpled_state(swept.system, crumpling, 0, random).position;
        swept.forces.update(at, 0), general.forces.update(at, 0);
        const Vec3Field& expected = general.forces.position_force();
        const double scale = largest_norm(expected);
        EXPECT_LE(largest_distance(swept.forces.position_force(), expected), 1e-13 * scale) << what;
        const double stored = general.forces.stored_energy(at);
        EXPECT_NEAR(swept.forces.stored_energy(at), stored, 1e-12 * stored) << what;
        // A held force becomes that of the cloth after the step.
        Vec3Field held = swept.forces.position_force(), held_too = expected;
        const double lost = general.forces.end_step(at, &held_too);
        EXPECT_NEAR(swept.forces.end_step(at, &held), lost, 1e-12 * stored) << what;
        EXPECT_LE(largest_difference(swept.forces.history(), general.forces.history()),
                  1e-12 * largest_of(general.forces.history()) + 1e-14)
            << what;
        swept.forces.update(at, 0), general.forces.update(at, 0);
        EXPECT_LE(largest_distance(held, swept.forces.position_force()), 1e-13 * scale) << what;
        EXPECT_LE(largest_distance(held_too, expected), 1e-13 * scale) << what;
        EXPECT_LE(largest_distance(swept.forces.position_force(), expected), 1e-13 * scale) << what;
      }
      EXPECT_GT(largest_of(general.forces.history()), 0) << "nothing has yielded";
    }
}

/// Steps with their ends, as Simulation takes them. Returns what is lost.
double advance_with_ends(DirectRun& run, int steps, double h) {
  double lost = 0;
  for (int n = 0; n < steps; ++n) {
    run.advance(1, h);
    lost += run.forces.end_step(run.state.position, run.integrator().held_force());
  }
  return lost;
}

TEST_P(SlidersOnEveryInstructionSet, StepAsTheGeneralWayDoes) {
  Random random;
  for (const char* method : fused_methods)
    for (const auto& [rows, columns] : odd_sizes)
      for (int features = 0; features < all_features; ++features) {
        if (!has_sliders(features)) continue;
        const Scene scene = sheet_of(rows, columns, features);
        DirectRun whole(scene, method), general(scene, method);
        for (DirectRun* run : {&whole, &general})
          if (features & dampers) run->take_damping(EndVelocity::predicted);
        EXPECT_TRUE(whole.forces.is_swept_whole());
        make_general(general);
        whole.state = crumpled_state(whole.system, 0.002, 0.1, random);
        general.state = whole.state;
        const double lost = advance_with_ends(whole, 20, 1e-4),
                     expected = advance_with_ends(general, 20, 1e-4);
        const std::string what = std::string(method) + ", " + name_of_case(rows, columns, features);
        EXPECT_LE(largest_distance(whole.state.position, general.state.position), 2e-14) << what;
        EXPECT_LE(largest_distance(whole.state.velocity, general.state.velocity), 2e-11) << what;
        EXPECT_NEAR(lost, expected, 1e-11 * std::abs(expected)) << what;
        if (rows * columns > 9) {
          EXPECT_GT(largest_of(general.forces.history()), 0) << "nothing has yielded: " << what;
        }
        EXPECT_NEAR(whole.work.damping_loss, general.work.damping_loss, 1e-11 * general.work.damping_loss)
            << what;
        EXPECT_LE(largest_difference(whole.forces.history(), general.forces.history()),
                  1e-10 * largest_of(general.forces.history()))
            << what;
      }
}

TEST_P(SlidersOnEveryInstructionSet, HaveTheSameBitsForAnyNumberOfThreads) {
  for (const char* method : fused_methods)
    for (const int features : {0, int{dampers}, int{air}, int{dampers | air}}) {
      Scene scene = sheet_of(151, 103, features);
      scene.integrator.method = method;
      scene.integrator.time_step = std::string(method) == "explicit-euler" ? 1e-6 : 1e-4;
      const auto advance = [](Simulation& simulation) {
        for (int k = 0; k < 12; ++k) ASSERT_FALSE(simulation.step());
      };
      Simulation alone(scene);
      advance(alone);
      EXPECT_GT(alone.measure().ledger.forces.hysteresis_loss, 0);
      for (const int threads : {2, 3, 5}) {
        Simulation shared(scene);
        shared.set_threads(threads, ThreadUse::always);
        ASSERT_EQ(shared.threads(), threads);
        advance(shared);
        EXPECT_EQ(alone.state(), shared.state()) << method << ", " << features << ", " << threads;
        EXPECT_EQ(alone.checkpoint().force_history, shared.checkpoint().force_history);
        EXPECT_EQ(alone.measure().ledger.forces.hysteresis_loss,
                  shared.measure().ledger.forces.hysteresis_loss);
        EXPECT_EQ(alone.measure().energy.elastic, shared.measure().energy.elastic);
      }
    }
}

/// A scene that begins with waves in its cloth, so that sliders yield at once; `general`: its mass is changed
/// in its last digits, so that no kernel takes it.
Simulation waving(const char* name, bool general = false) {
  return Simulation(builtin_scene(name), [general](ClothSystem& system, ClothState& state) {
    for (std::size_t i = 0; i < state.position.size(); ++i)
      if (!system.pinned[i])
        state.position.add(i, Vec3(0, 0, 0.004 * std::sin(0.7 * static_cast<double>(i))));
    if (general) system.mass.back() *= 1 + 1e-15, system.inverse_mass.back() = 1 / system.mass.back();
  });
}
double hysteresis_loss_of(const Simulation& run) {
  return run.measure().ledger.forces.hysteresis_loss;
}

TEST(SlidersInPasses, GoOnFromACheckpointToTheBit) {
  for (const char* name : {"flag-cotton", "curtain-wool"}) {
    Simulation run = waving(name), again = waving(name);
    ASSERT_FALSE(run.advance(400));
    const Checkpoint checkpoint = run.checkpoint();
    ASSERT_FALSE(run.advance(150));
    again.restore(checkpoint);
    ASSERT_FALSE(again.advance(150));
    EXPECT_TRUE(run.state() == again.state()) << name;
    EXPECT_EQ(run.checkpoint().force_history, again.checkpoint().force_history) << name;
    EXPECT_EQ(hysteresis_loss_of(run), hysteresis_loss_of(again)) << name;
    EXPECT_GT(largest_of(checkpoint.force_history), 0) << name;
  }
}

TEST(SlidersInPasses, MoveAsInTheGeneralWay) {
  for (const char* name : {"flag-cotton", "curtain-wool"}) {
    Simulation run = waving(name), general = waving(name, true);
    ASSERT_FALSE(run.advance(400));
    ASSERT_FALSE(general.advance(400));
    EXPECT_LE(largest_distance(run.state().position, general.state().position), 1e-12) << name;
    const double expected = hysteresis_loss_of(general);
    EXPECT_NEAR(hysteresis_loss_of(run), expected, 1e-9 * expected) << name;
    EXPECT_NEAR(run.measure().energy_error(), general.measure().energy_error(), 1e-9 * expected) << name;
    EXPECT_GT(expected, 0) << name;
    EXPECT_GT(largest_of(general.checkpoint().force_history), 0) << name;
  }
}

TEST(SliderGrid, IsRecognisedOnlyWhereEverySliderIsItsCells) {
  const ClothSystem system = make_cloth(sheet_of(6, 7, 0));
  ASSERT_TRUE(slider_grid(system));
  const auto is_taken = [&](auto change) {
    ClothSystem other = system;
    change(other.sliders);
    return slider_grid(other).has_value();
  };
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.clear(); }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.push_back(s.front()); }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.front().area *= 2; }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.front().yield *= 2; }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.front().coefficient[1] *= 2; }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.front().particle[2] += 1; }));
  EXPECT_FALSE(is_taken([](BendingSliders& s) { s.front().normal_points = 2; }));
  EXPECT_TRUE(is_taken([](BendingSliders& s) { s.pop_back(); })) << "as pins do";
}

}  // namespace
}  // namespace cloth::test::slider_kernels_test
