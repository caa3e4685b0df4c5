// General meshes: their numbering, and a kernel that must give what the plain sum over the springs gives.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <set>
#include <thread>

#include "cloth/grid.h"
#include "cloth/mesh_order.h"
#include "forces/springs.h"
#include "kernels/mesh_springs.h"
#include "support/direct_run.h"
#include "support/meshes.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test {
namespace {

ClothSystem shuffled_grid(int rows, int columns, Random& random) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0};
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  return renumbered(DirectRun(scene, "verlet").system, random_order(rows * columns, random));
}

std::vector<ClothSystem> some_meshes(Random& random) {
  std::vector<ClothSystem> meshes{irregular_triangulation(3, 4, 80, true, random),
                                  irregular_triangulation(40, 53, 80, true, random),
                                  shuffled_grid(33, 30, random)};
  for (std::size_t k = meshes.size(); k-- > 0;)
    meshes.push_back(renumbered(meshes[k], small_bandwidth_order(meshes[k])));
  return meshes;
}

Vec3Field crumpled(const ClothSystem& system, Random& random) {
  return crumpled_state(system, 0.02, 0, random).position;
}

Vec3Field mesh_forces(const ClothSystem& system, const Vec3Field& position,
                      const MeshKernel& kernel = chosen_mesh_kernel()) {
  Vec3Field force(position.size());
  MeshSprings(system, kernel).add_forces(position, force);
  return force;
}

/// As many threads as parts.
void on_threads(int parts, const std::function<void(int)>& part) {
  std::vector<std::thread> threads;
  for (int k = 0; k < parts; ++k) threads.emplace_back(part, k);
  for (std::thread& thread : threads) thread.join();
}

bool same_bits(const Vec3Field& a, const Vec3Field& b) {
  return a.size() == b.size() && std::memcmp(a.x(), b.x(), 3 * a.size() * sizeof(double)) == 0;
}

TEST(MeshOrder, IsAPermutationAndItsInverseUndoesIt) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const ParticleOrder order = small_bandwidth_order(system);
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), system.mass.size());
    ClothState state = crumpled_state(system, 0.1, 1, random);
    state.time = 3, state.step = 5;
    EXPECT_NE(renumbered(state, order), state);
    EXPECT_EQ(renumbered(renumbered(state, order), inverse_of(order)), state);
    EXPECT_EQ(inverse_of(inverse_of(order)), order);
  }
}

TEST(MeshOrder, KeepsEveryParticleItsMassPinAndSprings) {
  Random random;
  ClothSystem system = irregular_triangulation(9, 11, 80, true, random);
  for (double& mass : system.mass) mass = random.uniform(1, 2);
  const ParticleOrder order = small_bandwidth_order(system);
  const ClothSystem ordered = renumbered(system, order);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto old = static_cast<std::size_t>(order[k]);
    EXPECT_EQ(ordered.mass[k], system.mass[old]);
    EXPECT_EQ(ordered.inverse_mass[k], system.inverse_mass[old]);
    EXPECT_EQ(ordered.pinned[k], system.pinned[old]);
    EXPECT_EQ(ordered.start[k], system.start[old]);
  }
  const Vec3Field position = crumpled(system, random);
  const Vec3Field expected = renumbered(spring_forces(springs_of(system), position), order);
  const Vec3Field force = spring_forces(springs_of(ordered), renumbered(position, order));
  EXPECT_LE(largest_distance(force, expected), 1e-12 * largest_norm(expected));
  for (const SpringFamily family : spring_families)
    EXPECT_EQ(ordered.spring_count(family), system.spring_count(family));
}

TEST(MeshOrder, HasTheBandwidthOfASheetHoweverItWasNumbered) {
  Random random;
  const int side = 30;
  for (const ClothSystem& system :
       {shuffled_grid(side, side, random), irregular_triangulation(side, side, 80, false, random)}) {
    EXPECT_GT(bandwidth_of(system), side * side / 2);
    EXPECT_LE(bandwidth_of(renumbered(system, small_bandwidth_order(system))), 4 * side);
  }
}

TEST(MeshOrder, TakesAChainFromEndToEnd) {
  Random random;
  const int size = 50;
  std::vector<MeshSpring> springs;
  for (int i = 0; i + 1 < size; ++i) springs.push_back({i, i + 1, 1, 1});
  const ClothSystem chain = mesh_system(random.field(size, 1), springs, {});
  const ClothSystem shuffled = renumbered(chain, random_order(size, random));
  EXPECT_EQ(bandwidth_of(renumbered(shuffled, small_bandwidth_order(shuffled))), 1);
}

TEST(MeshOrder, TakesPartsAndLonelyParticlesOneAfterTheOther) {
  Random random;
  const ClothSystem system = mesh_system(random.field(9, 1), {{0, 8, 1, 1}, {1, 7, 1, 1}, {2, 6, 1, 1}}, {});
  const ParticleOrder order = small_bandwidth_order(system);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 9u);
  EXPECT_EQ(bandwidth_of(renumbered(system, order)), 1);
}

TEST(MeshSprings, GiveTheSumOverTheSpringsOnEveryInstructionSet) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const Vec3Field position = crumpled(system, random);
    const Vec3Field expected = spring_forces(springs_of(system), position);
    for (const MeshKernel* kernel : supported_mesh_kernels())
      EXPECT_LE(largest_distance(mesh_forces(system, position, *kernel), expected),
                1e-13 * largest_norm(expected))
          << kernel->name;
  }
}

TEST(MeshSprings, HaveFullPrecisionAtEveryLength) {
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
    for (const MeshKernel* kernel : supported_mesh_kernels())
      EXPECT_LE((mesh_forces(system, ends, *kernel)[0] - expected).norm(),
                4 * unit * (ends[1].norm() + rest_length))
          << kernel->name << " at " << d.norm();
  }
}

TEST(MeshSprings, ThatAreEndlesslyLongOrUndefinedDoNotHideIt) {
  for (const MeshKernel* kernel : supported_mesh_kernels()) {
    for (const double far :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      Vec3Field ends(2);
      ends.set(1, {far, 0, 0});
      EXPECT_FALSE(all_finite(mesh_forces(mesh_system(ends, {{0, 1, 1, 1}}, {}), ends, *kernel)))
          << kernel->name;
    }
    Vec3Field ends(2);
    ends.set(1, {0, 1e200, 0});  // its square is no double
    EXPECT_EQ(mesh_forces(mesh_system(ends, {{0, 1, 1, 3}}, {}), ends, *kernel)[0], Vec3(0, 3e200, 0))
        << kernel->name;
  }
}

TEST(MeshSprings, GiveTheSameBitsOnAnyNumberOfThreadsAndAgain) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const Vec3Field position = crumpled(system, random), before = random.field(position.size(), 1);
    for (const MeshKernel* kernel : supported_mesh_kernels()) {
      MeshSprings springs(system, *kernel);
      Vec3Field alone = before;
      springs.add_forces(position, alone);
      for (const int threads : {1, 2, 3, 7})
        for (int again = 0; again < 3; ++again) {
          Vec3Field together = before;
          springs.add_forces(position, together, threads, on_threads);
          EXPECT_TRUE(same_bits(together, alone)) << threads << " threads, " << kernel->name;
        }
    }
  }
}

TEST(MeshSprings, AddToTheForcesThatAreThere) {
  Random random;
  const ClothSystem system = irregular_triangulation(7, 9, 80, false, random);
  const Vec3Field position = crumpled(system, random), before = random.field(position.size(), 1);
  const Vec3Field alone = mesh_forces(system, position);
  Vec3Field force = before;
  MeshSprings(system).add_forces(position, force);
  for (std::size_t i = 0; i < force.size(); ++i) EXPECT_EQ(force[i], Vec3(before[i] + alone[i]));
}

TEST(MeshSprings, OfZeroLengthPullNothingAndTheOthersGoOn) {
  Random random;
  const ClothSystem system = irregular_triangulation(9, 10, 80, false, random);
  Vec3Field position = crumpled(system, random);
  for (const SpringRun& run : {system.springs[0], system.springs[50]})
    position.set(static_cast<std::size_t>(run.first + run.offset),
                 position[static_cast<std::size_t>(run.first)]);
  const Vec3Field expected = spring_forces(springs_of(system), position);
  Vec3Field point(position.size());
  for (std::size_t i = 0; i < point.size(); ++i) point.set(i, {1, 2, 3});
  for (const MeshKernel* kernel : supported_mesh_kernels()) {
    const Vec3Field force = mesh_forces(system, position, *kernel);
    EXPECT_LE(largest_distance(force, expected), 1e-13 * largest_norm(expected)) << kernel->name;
    EXPECT_EQ(largest_norm(mesh_forces(system, point, *kernel)), 0) << kernel->name;
  }
}

TEST(MeshSprings, LeaveLonelyParticlesAlone) {
  Random random;
  for (const int size : {3, 8, 9, 21}) {
    const ClothSystem system =
        mesh_system(random.field(static_cast<std::size_t>(size), 1), {{0, 2, 1, 5}}, {0});
    for (const MeshKernel* kernel : supported_mesh_kernels()) {
      const Vec3Field force = mesh_forces(system, system.start, *kernel);
      for (int i = 0; i < size; ++i)
        EXPECT_EQ(force[static_cast<std::size_t>(i)].norm() > 0, i == 0 || i == 2) << i << " of " << size;
    }
  }
}

TEST(MeshSprings, SumOnTheirEndsToNothing) {
  Random random;
  const ClothSystem system = irregular_triangulation(20, 20, 80, true, random);
  const Vec3Field force = mesh_forces(system, crumpled(system, random));
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < force.size(); ++i) sum += force[i];
  EXPECT_LE(sum.norm(), 1e-12 * largest_norm(force));
}

TEST(MeshSprings, AreMinusTheSlopeOfTheEnergy) {
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

TEST(MeshSprings, OwnAboutAsManySpringsEachSoThatFewLanesAreEmpty) {
  Random random;
  const ClothSystem system = irregular_triangulation(64, 64, 80, false, random);
  const MeshLayout layout = make_mesh_layout(renumbered(system, small_bandwidth_order(system)));
  EXPECT_LE(static_cast<double>(layout.neighbour.size()) * slice_width,
            1.25 * static_cast<double>(system.springs.size()));
}

TEST(MeshSprings, OfOneColourMeetAtNoParticle) {
  Random random;
  for (const ClothSystem& system : some_meshes(random)) {
    const MeshLayout layout = make_mesh_layout(system);
    int slices = 0;
    for (const auto& blocks : layout.colours) {
      std::set<int> touched;
      for (const MeshLayout::Block block : blocks) {
        slices += block.end - block.begin;
        std::set<int> here;
        for (int i = block.begin * slice_width; i < block.end * slice_width; ++i) here.insert(i);
        for (int slot = layout.slot_begin[static_cast<std::size_t>(block.begin)];
             slot < layout.slot_begin[static_cast<std::size_t>(block.end)]; ++slot)
          for (const int offset : layout.neighbour[static_cast<std::size_t>(slot)].lane)
            here.insert(offset / 4);
        for (const int i : here) EXPECT_TRUE(touched.insert(i).second) << i;
      }
    }
    EXPECT_EQ(slices, layout.slices);
  }
}

TEST(MeshSprings, OfAWellNumberedSheetNeedFewColours) {
  Random random;
  const ClothSystem system = shuffled_grid(80, 80, random);
  EXPECT_LE(make_mesh_layout(renumbered(system, small_bandwidth_order(system))).colours.size(), 3u);
}

TEST(SpringForce, TakesAMeshLikeTheGridThatItIs) {
  Random random;
  Scene scene = bare_sheet(12, 13);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0.3};
  scene.cloth.pins = {NamedPin::top_left};
  scene.gravity = Vec3(0, -9.81, 0);
  const ClothSystem grid = DirectRun(scene, "semi-implicit-euler").system;
  const ParticleOrder order = random_order(grid.size(), random);
  ASSERT_FALSE(MeshSprings::suits(grid));
  ASSERT_TRUE(MeshSprings::suits(renumbered(grid, order)));
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
}  // namespace cloth::test
