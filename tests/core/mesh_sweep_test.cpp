// The kernels of general meshes must give what the plain sum over the springs gives, and step as the general
// way does, on every instruction set and any number of threads.
#include "kernels/mesh_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "cloth/grid.h"
#include "cloth/mesh_order.h"
#include "forces/springs.h"
#include "kernels/instruction_set.h"
#include "support/direct_run.h"
#include "support/meshes.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::mesh_sweep_test {
namespace {

class MeshSprings : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};

INSTANTIATE_TEST_SUITE_P(Kernels, MeshSprings, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& test) { return std::string(name_of(test.param)); });

/// Of springs that are all alike in stiffness, of three kinds, and all different; numbered at random and
/// well.
std::vector<ClothSystem> some_meshes(Random& random) {
  std::vector<ClothSystem> meshes{
      irregular_triangulation(3, 4, 80, true, random), irregular_triangulation(40, 53, 80, true, random),
      shuffled_grid(33, 30, random), irregular_triangulation(21, 30, 80, true, random)};
  for (SpringBlock& block : meshes.back().springs.blocks()) block.run.stiffness *= random.uniform(0.5, 2);
  for (std::size_t k = meshes.size(); k-- > 0;)
    meshes.push_back(renumbered(meshes[k], order_for_sweeps(meshes[k])));
  return meshes;
}

Vec3Field crumpled(const ClothSystem& system, Random& random) {
  return crumpled_state(system, 0.02, 0, random).position;
}

Vec3Field mesh_forces(const ClothSystem& system, const Vec3Field& position) {
  Vec3Field force(position.size());
  MeshSweep(system, common_mass(system)).evaluate({}, position, force);
  return force;
}

bool same_bits(const Vec3Field& a, const Vec3Field& b) {
  return a.size() == b.size() && std::memcmp(a.x(), b.x(), 3 * a.size() * sizeof(double)) == 0;
}

TEST_P(MeshSprings, GiveTheSumOverTheSprings) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const Vec3Field position = crumpled(system, random);
    const Vec3Field expected = spring_forces(springs_of(system), position);
    EXPECT_LE(largest_distance(mesh_forces(system, position), expected), 1e-13 * largest_norm(expected));
  }
}

TEST_P(MeshSprings, HaveFullPrecisionAtEveryLength) {
  Random random;
  constexpr double unit = 2.3e-16;  // a bit more than the spacing of doubles at 1
  for (int k = 0; k < 2000; ++k) {
    const double scale = std::pow(10, random.uniform(-100, 100)), rest_length = scale * random.uniform(0, 2);
    Vec3Field ends(2);
    ends.set(1, scale * random.vector(1));
    const ClothSystem system = mesh_system(ends, {{0, 1, rest_length, 1}}, {});
    using Long = Eigen::Matrix<long double, 3, 1>;
    const Long d = ends[1].cast<long double>();
    const Vec3 expected = ((1 - rest_length / d.norm()) * d).cast<double>();
    EXPECT_LE((mesh_forces(system, ends)[0] - expected).norm(), 4 * unit * (ends[1].norm() + rest_length))
        << "at " << d.norm();
  }
}

TEST_P(MeshSprings, ThatAreEndlesslyLongOrUndefinedDoNotHideIt) {
  for (const double far :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    Vec3Field ends(2);
    ends.set(1, {far, 0, 0});
    EXPECT_FALSE(all_finite(mesh_forces(mesh_system(ends, {{0, 1, 1, 1}}, {}), ends)));
  }
  Vec3Field ends(2);
  ends.set(1, {0, 1e200, 0});  // its square is no double
  EXPECT_EQ(mesh_forces(mesh_system(ends, {{0, 1, 1, 3}}, {}), ends)[0], Vec3(0, 3e200, 0));
}

TEST_P(MeshSprings, LetNothingNotFiniteReachWhereNoSpringLeads) {
  Random random;
  const ClothSystem system = irregular_triangulation(12, 13, 80, false, random);
  constexpr int bad_particle = 40;
  std::set<int> joined{bad_particle};
  for (const SpringRun& run : system.springs) {
    if (run.first == bad_particle) joined.insert(run.first + run.offset);
    if (run.first + run.offset == bad_particle) joined.insert(run.first);
  }
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Vec3Field position = system.start;
    position.set(bad_particle, Vec3(0, bad, 0));
    const Vec3Field force = mesh_forces(system, position);
    for (int i = 0; i < system.size(); ++i)
      EXPECT_EQ(force[static_cast<std::size_t>(i)].allFinite(), !joined.contains(i)) << i;
  }
}

TEST_P(MeshSprings, GiveTheSameBitsOnAnyNumberOfThreadsAndAgain) {
  Random random;
  for (const auto numbered : {false, true}) {
    ClothSystem system = irregular_triangulation(71, 80, 80, true, random);
    if (numbered) system = renumbered(system, order_for_sweeps(system));
    const Vec3Field position = crumpled(system, random), load = random.field(position.size(), 1);
    MeshSweep alone(system, common_mass(system));
    Vec3Field expected(position.size());
    alone.evaluate({.load = &load}, position, expected);
    for (const int threads : {2, 3, 5}) {
      WorkerTeam team(threads);
      MeshSweep shared(system, common_mass(system));
      shared.set_team(&team, ThreadUse::always);
      ASSERT_EQ(shared.threads(), threads);
      for (int again = 0; again < 3; ++again) {
        Vec3Field force(position.size());
        shared.evaluate({.load = &load}, position, force);
        EXPECT_TRUE(same_bits(force, expected)) << threads << " threads";
      }
    }
  }
}

TEST_P(MeshSprings, AddToWeightAndLoad) {
  Random random;
  const ClothSystem system = irregular_triangulation(7, 9, 80, false, random);
  const Vec3Field position = crumpled(system, random), load = random.field(position.size(), 1);
  const Vec3 weight(0.1, -2, 0.3);
  const Vec3Field alone = mesh_forces(system, position);
  Vec3Field force = load;
  MeshSweep(system, common_mass(system)).evaluate({.weight = weight, .load = &force}, position, force);
  for (std::size_t i = 0; i < force.size(); ++i)
    EXPECT_LE((force[i] - load[i] - weight - alone[i]).norm(), 1e-13 * largest_norm(alone));
}

TEST_P(MeshSprings, OfZeroLengthPullNothingAndTheOthersGoOn) {
  Random random;
  const ClothSystem system = irregular_triangulation(9, 10, 80, false, random);
  Vec3Field position = crumpled(system, random);
  for (const SpringRun& run : {system.springs.list()[0], system.springs.list()[50]})
    position.set(static_cast<std::size_t>(run.first + run.offset),
                 position[static_cast<std::size_t>(run.first)]);
  const Vec3Field expected = spring_forces(springs_of(system), position);
  Vec3Field point(position.size());
  for (std::size_t i = 0; i < point.size(); ++i) point.set(i, {1, 2, 3});
  EXPECT_LE(largest_distance(mesh_forces(system, position), expected), 1e-13 * largest_norm(expected));
  EXPECT_EQ(largest_norm(mesh_forces(system, point)), 0);
}

TEST_P(MeshSprings, LeaveLonelyParticlesAlone) {
  Random random;
  for (const int size : {3, 8, 9, 21}) {
    const ClothSystem system =
        mesh_system(random.field(static_cast<std::size_t>(size), 1), {{0, 2, 1, 5}}, {0});
    const Vec3Field force = mesh_forces(system, system.start);
    for (int i = 0; i < size; ++i)
      EXPECT_EQ(force[static_cast<std::size_t>(i)].norm() > 0, i == 0 || i == 2) << i << " of " << size;
  }
}

TEST_P(MeshSprings, SumOnTheirEndsToNothing) {
  Random random;
  const ClothSystem system = irregular_triangulation(20, 20, 80, true, random);
  const Vec3Field force = mesh_forces(system, crumpled(system, random));
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < force.size(); ++i) sum += force[i];
  EXPECT_LE(sum.norm(), 1e-12 * largest_norm(force));
}

TEST_P(MeshSprings, AreMinusTheSlopeOfTheEnergy) {
  Random random;
  const ClothSystem system = irregular_triangulation(5, 6, 80, false, random);
  Vec3Field position = crumpled(system, random);
  const Vec3Field force = mesh_forces(system, position);
  const auto energy = [&] {
    const auto parts = elastic_energy(system, position);
    return parts[0] + parts[1] + parts[2];
  };
  constexpr double shift = 1e-6;  // m
  const auto x = position.flat();
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double here = x[k];
    x[k] = here + shift;
    const double above = energy();
    x[k] = here - shift;
    const double below = energy();
    x[k] = here;
    EXPECT_NEAR(force.flat()[k], (below - above) / (2 * shift), 1e-7 * largest_norm(force));
  }
}

TEST(MeshLayout, LeavesFewLanesEmptyAndReadsFewNumbersWhereFewAreDifferent) {
  Random random;
  const ClothSystem irregular = irregular_triangulation(64, 64, 80, false, random),
                    grid = shuffled_grid(64, 64, random);
  for (const ClothSystem* system : {&irregular, &grid}) {
    const MeshLayout layout = make_mesh_layout(*system);
    EXPECT_LE(static_cast<double>(layout.neighbour.size()) * kernels::slice_width,
              1.1 * 2 * static_cast<double>(system->springs.size()));
    EXPECT_TRUE(layout.stiffness.empty());
    EXPECT_EQ(layout.tension.empty(), system == &grid);
  }
}

TEST(MeshLayout, KeepsTheOrderOfAWellNumberedMesh) {
  Random random;
  const ClothSystem system = irregular_triangulation(40, 40, 80, false, random);
  EXPECT_EQ(make_mesh_layout(system).order, order_for_sweeps(system));
  EXPECT_TRUE(make_mesh_layout(renumbered(system, order_for_sweeps(system))).order.empty());
}

const char* const fused_methods[] = {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"};

Scene beside_springs(double damping, double spring_damping = 0) {
  Scene scene = bare_sheet(4, 4);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = spring_damping};
  scene.gravity = Vec3(0.3, -9.81, 0.1);
  if (damping > 0) scene.damping = damping;
  return scene;
}

/// The same cloth, of which no pass makes whole steps, since its masses are not all the same.
void unlike_masses(DirectRun& run) {
  run.system.mass.back() *= 1 + 1e-15;
  run.system.inverse_mass.back() /= 1 + 1e-15;
  run.forces.system_changed();
}

TEST_P(MeshSprings, StepAsTheGeneralWayDoes) {
  Random random;
  for (const char* method : fused_methods)
    for (const double spring_damping : {0.0, 2e-4})
      for (const ClothSystem& system : some_meshes(random)) {
        const Scene scene = beside_springs(1e-3, spring_damping);
        DirectRun whole(system, scene, exactly(method)), parts(system, scene, exactly(method));
        unlike_masses(parts);
        whole.state = parts.state = crumpled_state(system, 0.001, 0.1, random);
        whole.advance(10, 2e-4);
        parts.advance(10, 2e-4);
        EXPECT_LE(largest_distance(whole.state.position, parts.state.position), 1e-13) << method;
        EXPECT_LE(largest_distance(whole.state.velocity, parts.state.velocity), 1e-10) << method;
        EXPECT_NEAR(whole.work.damping_loss, parts.work.damping_loss, 1e-11 * parts.work.damping_loss)
            << method;
      }
}

TEST_P(MeshSprings, StepToTheSameBitsOnAnyNumberOfThreads) {
  Random random;
  for (const bool numbered : {false, true}) {
    ClothSystem system = irregular_triangulation(71, 80, 80, true, random);
    if (numbered) system = renumbered(system, order_for_sweeps(system));
    for (const char* method : fused_methods)
      for (const double spring_damping : {0.0, 2e-4}) {
        const Scene scene = beside_springs(1e-3, spring_damping);
        DirectRun alone(system, scene, exactly(method));
        alone.advance(5, 1e-4);
        for (const int threads : {2, 3}) {
          WorkerTeam team(threads);
          DirectRun shared(system, scene, exactly(method));
          shared.forces.sweep()->set_team(&team, ThreadUse::always);
          shared.advance(5, 1e-4);
          EXPECT_EQ(shared.state, alone.state) << method << ", " << threads;
          EXPECT_EQ(shared.work.damping_loss, alone.work.damping_loss) << method;
        }
      }
  }
}

TEST_P(MeshSprings, HaveDampersThatAreTheSumOverTheSprings) {
  Random random;
  constexpr double damping = 0.7;
  for (const ClothSystem& system : some_meshes(random)) {
    ClothState state = crumpled_state(system, 0.02, 0.3, random);
    const SpringRun short_one = *system.springs.begin();  // of no length
    state.position.set(static_cast<std::size_t>(short_one.first + short_one.offset),
                       state.position[static_cast<std::size_t>(short_one.first)]);
    Vec3Field product(state.position.size()), expected;
    MeshSweep sweep(system, common_mass(system));
    const double loss = sweep.damp({.spring_damping = damping}, state.position, state.velocity, product);
    const double expected_loss = damper_product(system, damping, state, expected);
    EXPECT_LE(largest_distance(product, expected), 2e-14 * largest_norm(expected));
    EXPECT_NEAR(loss, expected_loss, 1e-13 * expected_loss);
  }
}

TEST_P(MeshSprings, ManyStepsAtOnceAreTheStepsOneByOneToTheBit) {
  Random random;
  const ClothSystem system = irregular_triangulation(30, 31, 80, true, random);
  for (const std::string method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"})
    for (const double damping : {0.0, 1e-3}) {
      const Scene scene = beside_springs(damping, method == "verlet" ? 0 : damping / 5);
      DirectRun single(system, scene, exactly(method)), many(system, scene, exactly(method));
      constexpr double step = 1e-4;
      single.advance(1, step), many.advance(1, step);
      ASSERT_TRUE(many.integrator().gains_from_batches(many.forces)) << method;
      std::array<double, 10> squares{};
      single.advance(10, step);
      many.integrator().step_many(many.forces, step, squares, many.state, many.work);
      EXPECT_TRUE(same_bits(single.state.position, many.state.position)) << method;
      EXPECT_TRUE(same_bits(single.state.velocity, many.state.velocity)) << method;
      EXPECT_EQ(single.work.damping_loss, many.work.damping_loss) << method;
      single.advance(1, step), many.advance(1, step);
      EXPECT_TRUE(same_bits(single.state.position, many.state.position)) << method << ", afterwards";
    }
}

TEST_P(MeshSprings, MoveAGridAsTheGridThatItIs) {
  Random random;
  Scene scene = bare_sheet(12, 13);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0.3};
  scene.cloth.pins = {NamedPin::top_left};
  scene.gravity = Vec3(0, -9.81, 0);
  const ClothSystem grid = DirectRun(scene, "semi-implicit-euler").system;
  const ParticleOrder order = random_order(grid.size(), random);
  ASSERT_FALSE(suits_mesh_layout(grid));
  ASSERT_TRUE(suits_mesh_layout(renumbered(grid, order)));
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4", "implicit-euler"}) {
    DirectRun run(grid, scene, exactly(method)), mesh(renumbered(grid, order), scene, exactly(method));
    run.advance(50, 1e-3);
    mesh.advance(50, 1e-3);
    const Vec3Field back = renumbered(mesh.state, inverse_of(order)).position;
    EXPECT_GT(largest_distance(back, grid.start), 1e-3) << method;
    EXPECT_LE(largest_distance(back, run.state.position), 1e-10) << method;
  }
}

}  // namespace
}  // namespace cloth::test::mesh_sweep_test
