// A cloth from a mesh obeys the laws that a grid obeys.
#include "cloth/mesh_cloth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "cloth/grid.h"
#include "cloth/normals.h"
#include "geometry/mesh_repair.h"
#include "integrators/registry.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_json.h"
#include "scene/scene_mesh.h"
#include "simulation/recorder.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"
#include "support/direct_run.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"
#include "support/test_names.h"

namespace cloth::test::mesh_cloth_test {
namespace {

Scene mesh_scene(const TriangleMesh& surface) {
  Scene scene;
  scene.cloth.mesh = made_mesh("made.obj", surface);
  scene.cloth.rows = 1;
  scene.cloth.columns = static_cast<int>(surface.vertices.size());
  scene.cloth.mass = 1e-2 * scene.cloth.columns;
  scene.cloth.origin.setZero();
  return scene;
}

/// A sheet of rows x columns vertices 0.2 m apart, cut along one or the other diagonal, irregular by `shake`
/// m; along one only where that is 0.
TriangleMesh shaken_sheet(int rows, int columns, double shake) {
  TriangleMesh mesh;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double k = r * columns + c;
      mesh.vertices.push_back(Vec3(0.2 * c, -0.2 * r, 0) + shake * Vec3(std::sin(12.9 * k),
                                                                        std::sin(78.2 * k + 1),
                                                                        std::sin(37.7 * k + 2)));
    }
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (shake > 0 && (r + c) % 2 == 1) {
        mesh.triangles.push_back({a, d, b});
        mesh.triangles.push_back({b, d, e});
      } else {
        mesh.triangles.push_back({a, d, e});
        mesh.triangles.push_back({a, e, b});
      }
    }
  return mesh;
}

/// As smooth_scene, of triangles.
Scene smooth_mesh_scene() {
  Scene scene = mesh_scene(shaken_sheet(5, 5, 0.04));
  const Scene like = smooth_scene(5, 5);
  scene.springs = like.springs;
  scene.damping = like.damping;
  scene.gravity = like.gravity;
  scene.air = like.air;
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 4}};
  return scene;
}

TEST(MeshCloth, EdgesAreStructuralAndVerticesAcrossThemFlexionSprings) {
  const TriangleMesh surface = shaken_sheet(4, 5, 0.03);
  Scene scene = mesh_scene(surface);
  const ClothSystem system = make_cloth(scene.cloth, {.structural = 7, .shear = 5, .flexion = 2});
  std::map<std::pair<int, int>, std::vector<int>> across;  // of each edge the corners opposite it
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) across[std::minmax(t[k], t[(k + 1) % 3])].push_back(t[(k + 2) % 3]);
  std::map<std::pair<int, int>, int> structural, flexion;
  for (const SpringRun& run : system.springs) {
    const std::pair pair(run.first, run.first + run.offset);
    ASSERT_EQ(run.count, 1);
    EXPECT_NE(run.family, SpringFamily::shear);
    EXPECT_NEAR(run.rest_length,
                (surface.vertices[static_cast<std::size_t>(pair.first)] -
                 surface.vertices[static_cast<std::size_t>(pair.second)])
                    .norm(),
                1e-15);
    EXPECT_EQ(run.stiffness, run.family == SpringFamily::structural ? 7 : 2);
    ++(run.family == SpringFamily::structural ? structural : flexion)[pair];
  }
  EXPECT_EQ(structural.size(), across.size());
  for (const auto& [edge, corners] : across) {
    EXPECT_EQ(structural[edge], 1);
    if (corners.size() == 2) {
      EXPECT_EQ(flexion[std::minmax(corners[0], corners[1])], 1);
    }
  }
}

TEST(MeshCloth, OfAGridsTrianglesMovesAsTheGridWithThatOneDiagonalAsSprings) {
  // Two triangles a cell: all springs of the grid, and one diagonal more, which the grid's twin is given too.
  const Scene grid = smooth_scene(5, 5);
  Scene mesh = mesh_scene(shaken_sheet(5, 5, 0));
  mesh.springs = SpringMaterial{.structural = 47};
  mesh.damping = grid.damping, mesh.gravity = grid.gravity, mesh.air = grid.air;
  mesh.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 4}};
  ClothSystem twin = make_grid(grid.cloth, {.structural = 47});
  for (int row = 0; row < 4; ++row)
    twin.springs.push_back({SpringFamily::structural, 5 * row, 4, 6, 0.2 * std::sqrt(2.0), 47});
  Scene like = grid;
  like.springs = mesh.springs;
  DirectRun of_mesh(mesh, exactly("verlet")), of_twin(twin, like, exactly("verlet"));
  of_mesh.advance(200, 1e-3);
  of_twin.advance(200, 1e-3);
  EXPECT_LT(largest_distance(of_mesh.state.position, of_twin.state.position), 1e-12);
  EXPECT_GT(largest_distance(of_mesh.state.position, of_mesh.system.start), 1e-2);
}

TEST(MeshCloth, NormalsOfAGridsTrianglesAreTheGridsNormals) {
  Random random;
  const Scene grid = smooth_scene(6, 4);
  const Scene mesh = mesh_scene(shaken_sheet(6, 4, 0));
  const ClothSystem a = make_cloth(grid.cloth, {}), b = make_cloth(mesh.cloth, {});
  Vec3Field position = a.start, direction(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    position.add(i, 0.05 * random.vector(1));
    direction.set(i, random.vector(1));
  }
  Vec3Field of_a(position.size()), of_b(position.size()), change_a(position.size()),
      change_b(position.size());
  particle_normals(a, position, of_a);
  particle_normals(b, position, of_b);
  particle_normal_changes(a, position, direction, change_a);
  particle_normal_changes(b, position, direction, change_b);
  EXPECT_LT(largest_distance(of_a, of_b), 1e-13);
  EXPECT_LT(largest_distance(change_a, change_b), 1e-12);
  EXPECT_EQ(triangles_of(a).size(), triangles_of(b).size());
}

TEST(MeshCloth, FreeKeepsItsMomentumAndTurningMomentum) {
  Random random;
  Scene scene = mesh_scene(shaken_sheet(6, 6, 0.04));
  scene.springs = SpringMaterial{.structural = 40, .flexion = 8};
  for (const char* method : {"verlet", "rk4", "semi-implicit-euler"}) {
    DirectRun run(scene, exactly(method));
    for (std::size_t i = 0; i < run.state.velocity.size(); ++i) run.state.velocity.set(i, random.vector(1));
    const auto momenta = [&] {
      return std::pair(momentum(run.system, run.state), angular_momentum(run.system, run.state));
    };
    const auto before = momenta();
    run.advance(300, 1e-3);
    EXPECT_LT((momenta().first - before.first).norm(), 1e-12) << method;
    EXPECT_LT((momenta().second - before.second).norm(), method == std::string("rk4") ? 1e-6 : 1e-11)
        << method;
  }
}

TEST(MeshCloth, LosesNoEnergyToAnAccurateMethod) {
  Scene scene = smooth_mesh_scene();
  double last = 0;
  for (const double step : {2e-3, 1e-3}) {
    scene.integrator = {"rk4", step};
    Simulation simulation(scene);
    while (simulation.time() < 0.3) ASSERT_FALSE(simulation.step());
    const double error = std::abs(simulation.measure().energy_error());
    EXPECT_LT(error, 1e-4);
    if (last > 0) {
      EXPECT_LT(error, last / 8);
    }
    last = error;
  }
}

TEST(MeshCloth, KeepsTheMirrorImageOfAMirroredStart) {
  Scene scene;
  scene.cloth.mesh.file = "disc.obj";
  ASSERT_TRUE(load_meshes(scene).empty());
  TriangleMesh mirrored = scene.cloth.mesh.loaded->surface;
  for (Vec3& vertex : mirrored.vertices) vertex.x() = -vertex.x();
  for (Triangle& t : mirrored.triangles) std::swap(t[1], t[2]);
  Scene image = mesh_scene(mirrored);
  for (Scene* one : {&scene, &image}) {
    one->cloth.mass = 0.2, one->cloth.origin.setZero();
    one->cloth.pins = {PinnedParticle{0, 0}};
    one->springs = SpringMaterial{.structural = 100, .flexion = 10};
    one->gravity = Vec3(0, -9.81, 0);
    one->air = Air{.drag = 0.001, .wind = {0, 0, 2}, .gust = {}};
  }
  DirectRun a(scene, exactly("verlet")), b(image, exactly("verlet"));
  a.advance(100, 2e-4);
  b.advance(100, 2e-4);
  for (std::size_t i = 0; i < a.state.position.size(); ++i) {
    const Vec3 x = a.state.position[i];
    EXPECT_LT((b.state.position[i] - Vec3(-x.x(), x.y(), x.z())).norm(), 1e-12);
  }
}

class MeshClothWith : public ::testing::TestWithParam<std::string> {};

TEST_P(MeshClothWith, RunsToItsEndLimitedAndPinned) {
  Scene scene = smooth_mesh_scene();
  scene.deformation = Deformation{.rate = 0.05, .springs = {"structural"}};
  scene.integrator = {GetParam(), std::nullopt};
  scene.duration = 0.3;
  if (!resolved_time_step(scene)) GTEST_SKIP() << "has no stable step";
  const RunResult result = run_scene(scene, {});
  EXPECT_EQ(result.summary.status, Status::finished);
  EXPECT_TRUE(all_finite(result.final_state));
  EXPECT_EQ(result.final_state.position[0], make_cloth(scene.cloth, {}).start[0]);
  EXPECT_LT(result.summary.limiter_excess, 1e-3);
}

TEST_P(MeshClothWith, ConvergesToOneMotion) {
  const Scene scene = smooth_mesh_scene();
  const double time = 0.1;
  const auto solve = [&](const std::string& method, int steps) {
    DirectRun run(scene, exactly(method));
    run.advance(steps, time / steps);
    return run.state;
  };
  const ClothState reference = solve("rk4", 1600);
  const int order = facts_of(GetParam()).order;
  const int steps = order >= 4 ? 12 : 200;
  const double coarse = rms_distance(solve(GetParam(), steps).position, reference.position);
  const double fine = rms_distance(solve(GetParam(), 2 * steps).position, reference.position);
  const double observed = std::log2(coarse / fine);
  EXPECT_GT(observed, order - 0.4) << coarse << ' ' << fine;
  EXPECT_LT(observed, order + 0.8) << coarse << ' ' << fine;
}

TEST_P(MeshClothWith, GoesOnFromACheckpointToTheBit) {
  Scene scene = smooth_mesh_scene();
  scene.integrator = {GetParam(), 1e-3};
  Simulation whole(scene), parts(scene);
  for (int n = 0; n < 20; ++n) ASSERT_FALSE(whole.step());
  const Checkpoint half = whole.checkpoint();
  for (int n = 0; n < 20; ++n) ASSERT_FALSE(whole.step());
  parts.restore(half);
  for (int n = 0; n < 20; ++n) ASSERT_FALSE(parts.step());
  EXPECT_EQ(whole.state(), parts.state());
}

INSTANTIATE_TEST_SUITE_P(Methods, MeshClothWith, ::testing::ValuesIn(integrator_names()), test_name);

TEST(RestingFrequency, BoundsTheSpectrumAtRestAndNotByMuch) {
  for (const char* name : {"disc.obj"}) {
    Scene scene;
    scene.cloth.mesh.file = name;
    ASSERT_TRUE(load_meshes(scene).empty());
    for (const SpringMaterial& material :
         {SpringMaterial{.structural = 100}, SpringMaterial{.structural = 100, .flexion = 30}}) {
      const ClothSystem system = make_cloth(scene.cloth, material);
      const double bound = resting_frequency(system);
      const double found = measure_spectrum(system, system.start).largest_frequency();
      EXPECT_GE(bound, found * (1 - 1e-9));
      EXPECT_LE(bound, 1.3 * found);
      EXPECT_EQ(bound, largest_frequency(scene.cloth, material));
    }
  }
}

TEST(RestingFrequency, OfASquareGridOfStructuralSpringsIsTheGridsOwn) {
  const Scene scene = bare_sheet(8, 8);
  const SpringMaterial material{.structural = 30};
  EXPECT_NEAR(resting_frequency(make_grid(scene.cloth, material)), largest_frequency(scene.cloth, material),
              1e-9);
}

TEST(MeshCloth, ARateThatItsPinsMakeUnreachableIsFoundByTheShortestChain) {
  Scene scene = smooth_mesh_scene();
  scene.deformation = Deformation{.rate = 0.05, .springs = {"structural"}};
  ClothSystem system = make_cloth(scene.cloth, *scene.springs);
  EXPECT_FALSE(find_unreachable_rate(scene, system, system.start));
  Vec3Field moved = system.start;
  moved.add(4, Vec3(0.05, 0, 0));
  EXPECT_FALSE(find_unreachable_rate(scene, system, moved)) << "the chain is not straight";
  moved.add(4, Vec3(0.5, 0, 0));
  const auto found = find_unreachable_rate(scene, system, moved);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->second, 4);
  EXPECT_GT(found->reach, 0.8);
  EXPECT_NE(describe(*found, system).find("pins 0 and 4"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::mesh_cloth_test
