// The kernels of a grid, in every instruction set that this machine has, against springs taken one by one.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "cloth/grid.h"
#include "integrators/registry.h"
#include "kernels/grid_sweep.h"
#include "kernels/instruction_set.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::grid_kernels_test {
namespace {

class EveryInstructionSet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, EveryInstructionSet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

constexpr std::pair<int, int> odd_sizes[] = {{2, 2},   {2, 3},   {3, 2}, {3, 17},  {7, 9},
                                             {33, 33}, {40, 7},  {9, 8}, {12, 10}, {65, 64},
                                             {2, 500}, {11, 41}, {20, 6}};

/// A hanging sheet with the families of the bits of `families`.
Scene sheet_of(int rows, int columns, int families) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = families & 1 ? 70.0 : 0,
                                 .shear = families & 2 ? 40.0 : 0,
                                 .flexion = families & 4 ? 15.0 : 0,
                                 .damping = 0};
  scene.gravity = Vec3(0.3, -9.81, 0.1);
  scene.damping = 0.01;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  return scene;
}

/// Spring by spring, in long double.
Vec3Field reference_force(const ClothSystem& system, const Vec3Field& position) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  std::vector<Long3> force(position.size(), Long3::Zero());
  for (const SpringRun& run : system.springs)
    for (int s = 0; s < run.count; ++s) {
      const auto i = static_cast<std::size_t>(run.first + s), j = i + static_cast<std::size_t>(run.offset);
      const Long3 d = position[j].cast<long double>() - position[i].cast<long double>();
      const long double length = d.norm();
      if (!(length > 0)) continue;
      const Long3 f = run.stiffness * (1 - run.rest_length / length) * d;
      force[i] += f, force[j] -= f;
    }
  Vec3Field result(position.size());
  for (std::size_t i = 0; i < force.size(); ++i) result.set(i, force[i].cast<double>());
  return result;
}

TEST_P(EveryInstructionSet, GivesTheForcesOfSpringsTakenOneByOne) {
  Random random;
  for (const auto& [rows, columns] : odd_sizes)
    for (int families = 1; families < 8; ++families) {
      const Scene scene = sheet_of(rows, columns, families);
      const ClothSystem system = make_grid(scene.cloth, *scene.springs);
      if (system.springs.empty()) continue;
      const auto grid = grid_springs(system);
      ASSERT_TRUE(grid) << rows << " x " << columns << ", families " << families;
      ClothState state = crumpled_state(system, 0.04, 0, random);
      state.position.set(1, state.position[0]);  // a spring of no length
      Vec3Field force(state.position.size());
      GridSweep sweep(system, *grid, common_mass(system));
      const Vec3Field load = random.field(force.size(), 0.1);
      const Vec3 weight(0.1, -0.3, 0.2);
      sweep.evaluate({weight, 0, &load}, state.position, force);
      Vec3Field expected = reference_force(system, state.position);
      for (std::size_t i = 0; i < expected.size(); ++i) expected.add(i, load[i] + weight);
      EXPECT_LE(largest_distance(force, expected), 2e-14 * largest_norm(expected))
          << rows << " x " << columns << ", families " << families;
    }
}

/// 1/sqrt(s) within two units in the last place over every magnitude, and nothing at all where s is zero.
TEST_P(EveryInstructionSet, HasNoRootOfLessThanFullPrecision) {
  Random random;
  std::vector<double> squares{0, DBL_MIN, 1e-300, 1.2e-38, 1e-38, 3e38, 4e38, 1e300, DBL_MAX, 1, 2, 4};
  for (int exponent = -1020; exponent < 1023; ++exponent)
    for (int k = 0; k < 8; ++k) squares.push_back(std::ldexp(random.uniform(1, 2), exponent));
  std::vector<double> result(squares.size());
  for (const auto spring_scales : active_kernels<kernels::GridKernels>().spring_scales) {
    spring_scales({0, 1}, squares.data(), result.data(), static_cast<int>(squares.size()));
    EXPECT_EQ(result[0], 0);
    for (std::size_t i = 1; i < squares.size(); ++i) {
      const long double exact = -1 / std::sqrt(static_cast<long double>(squares[i]));
      ASSERT_LE(std::abs((result[i] - exact) / exact), 2 * DBL_EPSILON) << squares[i];
    }
  }
  for (const auto inverse_roots : active_kernels<kernels::GridKernels>().inverse_roots) {
    inverse_roots(squares.data(), result.data(), static_cast<int>(squares.size()));
    EXPECT_EQ(result[0], 0);
    for (std::size_t i = 1; i < squares.size(); ++i) {
      const long double exact = 1 / std::sqrt(static_cast<long double>(squares[i]));
      ASSERT_LE(std::abs((result[i] - exact) / exact), 2 * DBL_EPSILON) << squares[i];
    }
  }
}

TEST_P(EveryInstructionSet, GivesTheDampersOfSpringsTakenOneByOne) {
  Random random;
  constexpr double damping = 0.7;
  for (const auto& [rows, columns] : odd_sizes)
    for (int families = 1; families < 8; ++families) {
      const Scene scene = sheet_of(rows, columns, families);
      const ClothSystem system = make_grid(scene.cloth, *scene.springs);
      if (system.springs.empty()) continue;
      ClothState state = crumpled_state(system, 0.04, 0.3, random);
      state.position.set(1, state.position[0]);  // a spring of no length
      Vec3Field product(state.position.size()), expected;
      GridSweep sweep(system, *grid_springs(system), common_mass(system));
      const double loss = sweep.damp({.spring_damping = damping}, state.position, state.velocity, product);
      const double expected_loss = damper_product(system, damping, state, expected);
      const std::string what =
          std::to_string(rows) + " x " + std::to_string(columns) + ", families " + std::to_string(families);
      EXPECT_LE(largest_distance(product, expected), 2e-14 * largest_norm(expected)) << what;
      EXPECT_NEAR(loss, expected_loss, 1e-13 * expected_loss) << what;
    }
}

TEST_P(EveryInstructionSet, LetsNothingNotFiniteReachWhereNoSpringLeads) {
  constexpr int rows = 9, columns = 21, row = 4, column = 9;
  const Scene scene = sheet_of(rows, columns, 7);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  GridSweep sweep(system, *grid_springs(system), common_mass(system));
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Vec3Field position = system.start, force(position.size());
    position.set(static_cast<std::size_t>(system.index(row, column)), Vec3(0, bad, 0));
    sweep.evaluate({}, position, force);
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const int dr = std::abs(r - row), dc = std::abs(c - column);
        const bool joined = (dr <= 1 && dc <= 1) || (dr == 2 && dc == 0) || (dr == 0 && dc == 2);
        EXPECT_EQ(force[static_cast<std::size_t>(system.index(r, c))].allFinite(), !joined) << r << ", " << c;
      }
  }
}

const char* const fused_methods[] = {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"};

TEST_P(EveryInstructionSet, StepsAsTheGeneralWayDoes) {
  Random random;
  for (const char* method : fused_methods)
    for (const auto& [rows, columns] : odd_sizes)
      for (int features = 1; features < 32; ++features) {
        const int families = features % 8;
        Scene scene = sheet_of(rows, columns, families);
        if (features & 8) scene.springs->damping = 0.02;
        if (features & 16) scene.air = Air{.drag = 0.02, .wind = {0.3, -1, 2}, .gust = Gust{0.5, 30}};
        DirectRun whole(scene, method);
        if (whole.system.springs.empty()) continue;

        DirectRun parts(scene, method);
        parts.system.mass.back() *= 1 + 1e-15;  // not of one mass: no whole steps
        parts.system.inverse_mass.back() /= 1 + 1e-15;
        parts.forces.system_changed();
        whole.state = crumpled_state(whole.system, 0.02, 0.1, random);
        parts.state = whole.state;
        whole.advance(10, 1e-3);
        parts.advance(10, 1e-3);
        EXPECT_LE(largest_distance(whole.state.position, parts.state.position), 1e-14)
            << method << ", " << rows << " x " << columns << ", features " << features;
        EXPECT_LE(largest_distance(whole.state.velocity, parts.state.velocity), 1e-11) << method;
        EXPECT_NEAR(whole.work.damping_loss, parts.work.damping_loss, 1e-12 * parts.work.damping_loss)
            << method;
        EXPECT_NEAR(whole.work.air, parts.work.air, 1e-11 * std::abs(parts.work.air)) << method;
        EXPECT_EQ(parts.work.air != 0, (features & 16) != 0) << method;
      }
}

TEST_P(EveryInstructionSet, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const char* method : fused_methods)
    for (const char* feature : {"", "air", "spring damping", "both"}) {
      const std::string with = feature;
      Scene scene = sheet_of(151, 103, 7);
      scene.integrator.method = method;
      scene.integrator.time_step = 2e-4;
      if (with == "spring damping" || with == "both") scene.springs->damping = 0.01;
      if (with == "air" || with == "both")
        scene.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = std::nullopt};
      Simulation alone(scene);
      const auto advance = [](Simulation& simulation) {
        for (int k = 0; k < 12; ++k) ASSERT_FALSE(simulation.step());
      };
      advance(alone);
      for (const int threads : {2, 3, 5}) {
        Simulation shared(scene);
        shared.set_threads(threads, ThreadUse::always);
        ASSERT_EQ(shared.threads(), threads);
        advance(shared);
        EXPECT_EQ(alone.state(), shared.state()) << method << ", " << with << ", " << threads;
        EXPECT_EQ(alone.measure().ledger.forces.damping_loss, shared.measure().ledger.forces.damping_loss);
      }
    }
}

/// Rounding differs between the sets and grows as the motion lets it; this motion is smooth.
TEST(InstructionSets, AgreeToRoundingAfterAThousandSteps) {
  for (const char* method : fused_methods) {
    Scene scene = sheet_of(33, 33, 7);
    scene.integrator.method = method;
    scene.integrator.time_step = std::string(method) == "explicit-euler" ? 2e-5 : 2e-4;
    std::vector<ClothState> states;
    for (const InstructionSet set : supported_instruction_sets()) {
      set_instruction_set(set);
      Simulation simulation(scene);
      for (int k = 0; k < 1000; ++k) ASSERT_FALSE(simulation.step());
      states.push_back(simulation.state());
      EXPECT_LE(largest_distance(states.front().position, states.back().position), 1e-12)
          << method << ", " << name_of(set);
    }
  }
  set_instruction_set(std::nullopt);
}

TEST(GridSprings, AreRecognisedOnlyWhereEveryDirectionIsWhole) {
  const Scene scene = sheet_of(6, 7, 7);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ASSERT_TRUE(grid_springs(system));
  ClothSystem other = system;
  other.springs.blocks()[2].run.offset += 1;
  EXPECT_FALSE(grid_springs(other));
  other = system;
  other.springs.blocks().pop_back();
  EXPECT_FALSE(grid_springs(other));
  other = system;
  other.springs.blocks().front().run.count -= 1;
  EXPECT_FALSE(grid_springs(other));
  other = system;
  other.springs.blocks().clear();
  EXPECT_FALSE(grid_springs(other));
  other = system;
  other.mass[3] *= 2;
  EXPECT_FALSE(common_mass(other));
  EXPECT_TRUE(common_mass(system));
}

TEST(Threads, AreNotUsedWhereAClothIsTooSmallToGain) {
  Scene scene = sheet_of(17, 17, 7);
  scene.integrator.time_step = 1e-4;
  Simulation simulation(scene);
  simulation.set_threads(8);
  EXPECT_EQ(simulation.threads(), 1);
}

TEST(InstructionSetNames, ReadBackToTheirSets) {
  for (const InstructionSet set : supported_instruction_sets())
    EXPECT_EQ(instruction_set_named(name_of(set)), set);
  EXPECT_FALSE(instruction_set_named("neon"));
}

}  // namespace
}  // namespace cloth::test::grid_kernels_test
