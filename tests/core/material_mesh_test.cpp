// A material on triangle meshes: triangles of constant strain and the bending of patches.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "cloth/mesh_cloth.h"
#include "cloth/mesh_patch.h"
#include "measure/energy.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::material_mesh_test {
namespace {

constexpr double width = 0.6, height = 0.4;

Material meshed_material() {
  Material m = any_material();
  m.coupling = 130;
  return m;
}

/// Regular and irregular, coarse and fine.
std::vector<Scene> meshes_of_a_sheet(const Material& material, Random& random) {
  return {material_mesh_sheet(4, 3, width, height, 0, material, random),
          material_mesh_sheet(7, 9, width, height, 0.3, material, random),
          material_mesh_sheet(13, 9, width, height, 0.3, material, random)};
}

Vec3Field mapped(const Vec3Field& from, const Eigen::Matrix3d& by) {
  Vec3Field to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to.set(i, by * from[i]);
  return to;
}

double elastic_energy_of(const ClothSystem& system, const Vec3Field& position) {
  ClothState state{.position = position, .velocity = Vec3Field(position.size())};
  return measure_energy(system, Vec3::Zero(), state).elastic;
}

Vec3Field force_of(const Scene& scene, const ClothSystem& system, const Vec3Field& position) {
  ForceModel forces(scene, system);
  Vec3Field force(position.size());
  forces.update(position, 0);
  forces.force(position, Vec3Field(position.size()), force);
  return force;
}

/// The particles that no edge of one triangle alone ends at.
std::vector<bool> are_inside(const ClothSystem& system) {
  std::multiset<std::pair<int, int>> edges;
  for (const Triangle& t : system.triangles)
    for (std::size_t e = 0; e < 3; ++e) edges.insert(std::minmax({t[e], t[(e + 1) % 3]}));
  std::vector<bool> inside(system.mass.size(), true);
  for (const auto& edge : edges)
    if (edges.count(edge) == 1) inside[at(edge.first)] = inside[at(edge.second)] = false;
  return inside;
}

/// St. Venant and Kirchhoff's energy of an area whose deformation gradient is everywhere the same, warp along
/// y.
double energy_density(const Material& m, const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d e = 0.5 * (gradient.transpose() * gradient - Eigen::Matrix3d::Identity());
  return 0.5 * m.stretch_weft * e(0, 0) * e(0, 0) + 0.5 * m.stretch_warp * e(1, 1) * e(1, 1) +
         coupling_of(m) * e(0, 0) * e(1, 1) + 2 * m.shear * e(0, 1) * e(0, 1);
}

Eigen::Matrix3d large_gradient() {
  Eigen::Matrix3d f;
  f << 1.1, 0.25, 0, -0.15, 0.9, 0, 0, 0, 1;
  return Eigen::AngleAxisd(0.9, Vec3(1, -2, 1).normalized()).toRotationMatrix() * f;
}

TEST(MaterialMesh, StoresTheEnergyOfEveryAffineDeformationOnEveryMeshExactly) {
  Random random;
  const Material m = meshed_material();
  for (const Scene& scene : meshes_of_a_sheet(m, random)) {
    const ClothSystem system = make_cloth(scene);
    const double expected = width * height * energy_density(m, large_gradient());
    EXPECT_NEAR(elastic_energy_of(system, mapped(system.start, large_gradient())), expected,
                1e-10 * expected);
  }
}

TEST(MaterialMesh, OfAutomaticCouplingHasTheSmallStrainsOfAGridOfTheSameMaterial) {
  Random random;
  const Material m = any_material();
  const Scene mesh = material_mesh_sheet(9, 9, width, height, 0.3, m, random);
  const Scene grid = material_sheet(9, 9, width / 8, height / 8, m);
  const ClothSystem of_mesh = make_cloth(mesh), of_grid = make_cloth(grid);
  constexpr double small = 1e-5;
  for (const Vec3& strain : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(2, -1, 1)}) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 0) += small * strain.x(), f(1, 1) += small * strain.y(), f(0, 1) += small * strain.z();
    const double expected = elastic_energy_of(of_grid, mapped(of_grid.start, f));
    EXPECT_NEAR(elastic_energy_of(of_mesh, mapped(of_mesh.start, f)), expected, 1e-4 * expected);
  }
}

TEST(MaterialMesh, IsInEquilibriumInsideInEveryAffineDeformation) {
  Random random;
  Material m = meshed_material();
  m.bending_warp = m.bending_weft = m.twist = 0;
  for (const Scene& scene : meshes_of_a_sheet(m, random)) {
    const ClothSystem system = make_cloth(scene);
    const Vec3Field force = force_of(scene, system, mapped(system.start, large_gradient()));
    const std::vector<bool> inside = are_inside(system);
    for (std::size_t i = 0; i < force.size(); ++i)
      if (inside[i]) EXPECT_LE(force[i].norm(), 1e-11 * largest_norm(force)) << i;
  }
}

TEST(MaterialMesh, HasTheMassOfItsArea) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    EXPECT_NEAR(system.total_mass(), 0.18 * width * height, 1e-14);
    EXPECT_NEAR(particle_mass(scene) * system.size(), 0.18 * width * height, 1e-14);
  }
}

TEST(MaterialMesh, ForceIsMinusTheSlopeOfItsEnergyInAnyShape) {
  Random random;
  for (Scene& scene : meshes_of_a_sheet(meshed_material(), random)) {
    scene.cloth.down = Vec3(0.3, -0.5, 0), scene.cloth.across = Vec3(0.5, 0.3, 0);
    const ClothSystem system = make_cloth(scene);
    const Vec3Field position = crumpled_state(system, 0.02, 0, random).position;
    const Vec3Field force = force_of(scene, system, position);
    for (int n = 0; n < 5; ++n) {
      const Vec3Field direction = random.field(position.size(), 1);
      constexpr double shift = 1e-6;
      Vec3Field ahead = position, behind = position;
      add_scaled(shift, direction, ahead), add_scaled(-shift, direction, behind);
      const double slope =
          (elastic_energy_of(system, ahead) - elastic_energy_of(system, behind)) / (2 * shift);
      double expected = 0;
      for (std::size_t i = 0; i < force.size(); ++i) expected -= force[i].dot(direction[i]);
      EXPECT_NEAR(slope, expected, 1e-6 * largest_norm(force) * std::sqrt(double(force.size())));
    }
  }
}

TEST(MaterialMesh, DoesNotResistMovingAndTurning) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(2, 1, -1).normalized()).toRotationMatrix();
    EXPECT_LE(elastic_energy_of(system, mapped(system.start, turn)), 1e-20);
    const Vec3Field bent = crumpled_state(system, 0.01, 0, random).position;
    const double energy = elastic_energy_of(system, bent);
    EXPECT_NEAR(elastic_energy_of(system, mapped(bent, turn)), energy, 1e-11 * energy);
  }
}

// ---- bending ----

/// The sheet as a surface over itself.
template <class HeightAt>
double bending_of_surface(const ClothSystem& system, HeightAt height_at) {
  Vec3Field position = system.start;
  for (std::size_t i = 0; i < position.size(); ++i)
    position.set(i, {position[i].x(), position[i].y(), height_at(position[i])});
  return bending_energy(system.bending, position);
}

/// Of every triangle, whether it has one across every edge and they have, too: all that its bending depends
/// on.
std::vector<bool> are_surrounded(const ClothSystem& system) {
  const TriangleNeighbours neighbours = neighbours_of(system.triangles);
  const auto is_complete = [&](std::size_t t) {
    return std::all_of(neighbours[t].begin(), neighbours[t].end(),
                       [](const AcrossEdge& across) { return across.triangle >= 0; });
  };
  std::vector<bool> surrounded(neighbours.size());
  for (std::size_t t = 0; t < neighbours.size(); ++t)
    surrounded[t] =
        is_complete(t) && std::all_of(neighbours[t].begin(), neighbours[t].end(),
                                      [&](const AcrossEdge& a) { return is_complete(at(a.triangle)); });
  return surrounded;
}

double surrounded_area(const ClothSystem& system) {
  const std::vector<bool> surrounded = are_surrounded(system);
  double area = 0;
  for (std::size_t t = 0; t < surrounded.size(); ++t) {
    const Triangle& corner = system.triangles[t];
    const Vec3 a = system.start[at(corner[0])];
    if (surrounded[t])
      area += 0.5 * (system.start[at(corner[1])] - a).cross(system.start[at(corner[2])] - a).norm();
  }
  return area;
}

double quadratic(const Vec3& p) {
  return 0.065 * p.x() * p.x() - 0.105 * p.y() * p.y() + 0.17 * p.x() * p.y() + 0.4 * p.x() - 0.3;
}

TEST(MeshBending, OfAQuadraticSurfaceIsExactOnEveryTriangleWithNeighboursWhateverItsShape) {
  Random random;
  const Material m = any_material();
  for (const Scene& scene : meshes_of_a_sheet(m, random)) {
    const ClothSystem system = make_cloth(scene);
    const double density =
        0.5 * (m.bending_weft * 0.13 * 0.13 + m.bending_warp * 0.21 * 0.21 + 2 * m.twist * 0.17 * 0.17);
    const double energy = bending_of_surface(system, quadratic);
    // Those at a free edge have no more than the surface has, and no less than nothing.
    EXPECT_GE(energy, (1 - 1e-9) * density * surrounded_area(system));
    EXPECT_LE(energy, (1 + 1e-9) * density * width * height);
  }
}

/// A quadratic surface has the same moment everywhere; what the free edges change ends some cells from them.
TEST(MeshBending, OfAConstantMomentIsInEquilibriumAwayFromFreeEdgesOnEveryMesh) {
  Random random;
  for (const double disorder : {0.0, 0.3}) {
    const ClothSystem system =
        make_cloth(material_mesh_sheet(25, 21, width, height, disorder, any_material(), random));
    Vec3Field position = system.start, force(position.size());
    for (std::size_t i = 0; i < position.size(); ++i)
      position.set(i, {position[i].x(), position[i].y(), quadratic(position[i])});
    add_bending_product(system.bending, -1, position, force);
    constexpr double some_cells = 0.13;
    int inside = 0;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 p = system.start[i];
      if (std::min({p.x(), width - p.x(), -p.y(), height + p.y()}) < some_cells) continue;
      EXPECT_LE(force[i].norm(), 1e-10 * largest_norm(force)) << i << " at a disorder of " << disorder;
      ++inside;
    }
    EXPECT_GT(inside, 50);
  }
}

TEST(MeshBending, OfACylinderIsThatOfItsWholeAreaButWhereItEndsStraightOnAnIrregularMesh) {
  Random random;
  const Material m = any_material();
  double before = 0;
  for (const int cells : {8, 16, 32}) {
    const ClothSystem system =
        make_cloth(material_mesh_sheet(cells + 1, cells + 1, width, height, 0.25, m, random));
    // No curvature across the ends: the free edges' own condition.
    const double k = M_PI / width, amplitude = 0.01;
    const double energy =
        bending_of_surface(system, [&](const Vec3& p) { return amplitude * std::sin(k * p.x()); });
    const double exact = 0.25 * m.bending_weft * amplitude * amplitude * std::pow(k, 4) * width * height;
    const double error = std::abs(energy / exact - 1);
    if (before > 0) EXPECT_LE(error, 0.75 * before) << cells;
    before = error;
  }
  EXPECT_LE(before, 0.02);
}

TEST(MeshBending, DiffersWithTheAngleToTheWarpAsTheMaterialDoes) {
  Random random;
  Material m = any_material();
  m.twist = 4e-3;
  const ClothSystem system = make_cloth(material_mesh_sheet(41, 41, 0.4, 0.4, 0.2, m, random));
  for (const double angle : {0.0, 0.4, M_PI / 4, 1.2, M_PI / 2}) {
    const double energy = bending_of_surface(system, [&](const Vec3& p) {
      const double along = std::sin(angle) * p.x() + std::cos(angle) * p.y();
      return 0.5 * 0.1 * along * along;
    });
    const double whole = 0.5 * 0.01 * bending_at(m, angle) * 0.16;
    EXPECT_NEAR(energy, whole, 0.05 * whole) << angle;  // free edges miss a part of one cell
    EXPECT_GE(energy, 0.5 * 0.01 * bending_at(m, angle) * surrounded_area(system) * (1 - 1e-9)) << angle;
  }
}

TEST(MeshBending, IsHalfAsLongAndTwiceAsStiffAtAClampAndAbsentBehindIt) {
  Random random;
  const Material m = any_material();
  Scene scene = material_mesh_sheet(4, 2, 0.3, 0.1, 0, m, random);
  for (const int i : {0, 1, 4, 5}) scene.cloth.pins.emplace_back(PinnedParticle{0, i});
  const ClothSystem system = make_cloth(scene);
  Vec3Field position = system.start;
  constexpr double up = 1e-3;
  for (const int i : {2, 6}) position.set(at(i), position[at(i)] + Vec3(0, 0, up));
  for (const int i : {3, 7}) position.set(at(i), position[at(i)] + Vec3(0, 0, 2 * up));
  // A fold at the clamp, straight on beyond: curvature 2 up/a^2 over half a cell.
  const double curvature = 2 * up / 0.01;
  EXPECT_NEAR(bending_energy(system.bending, position),
              0.5 * m.bending_weft * curvature * curvature * 0.05 * 0.1, 1e-12);
  for (const BendingRun& run : system.bending) {
    bool moves = false;
    for (std::size_t p = 0; p < std::size_t(run.points); ++p) moves |= !system.pinned[at(run.offset[p])];
    EXPECT_TRUE(moves);
  }
}

// ---- motion ----

/// Held by its upper corners and moving in every way that a material can.
Scene moving_mesh(Random& random) {
  Material m = meshed_material();
  m.stretch_damping = 2e-4, m.bending_damping = 1e-3, m.mass_damping = 0.5;
  m.drag_normal = 0.8, m.drag_tangential = 0.1;
  Scene scene = material_mesh_sheet(7, 6, 0.3, 0.25, 0.2, m, random);
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 6}};
  scene.gravity = Vec3(0, -6, 7);
  scene.air = Air{.wind = {0.5, 0.2, 2}, .gust = std::nullopt};
  scene.duration = 0.2;
  scene.record.interval = 0.02;
  return scene;
}

TEST(MaterialMesh, AnswersTheSameByEveryMethodAsStepsShrink) {
  Random random;
  const Scene scene = moving_mesh(random);
  const auto end_by = [&](const std::string& method, double step) {
    DirectRun run(scene, exactly(method, step));
    run.advance(static_cast<int>(std::lround(0.04 / step)), step);
    return run.state.position;
  };
  const Vec3Field exact = end_by("rk4", 1e-5);
  for (const auto& [method, step, order] : {std::tuple{"semi-implicit-euler", 8e-5, 1},
                                            {"verlet", 1e-4, 2},
                                            {"implicit-euler", 1e-4, 1},
                                            {"implicit-midpoint", 2e-4, 2},
                                            {"bdf2", 2e-4, 2},
                                            {"projective", 1e-4, 1},
                                            {"xpbd", 1e-4, 1}}) {
    const double coarse = rms_distance(end_by(method, step), exact),
                 fine = rms_distance(end_by(method, step / 2), exact);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.25) << method;
    EXPECT_LE(coarse, 2e-3) << method;
  }
}

TEST(MaterialMesh, AccountsForItsEnergyAndKeepsItsMomentum) {
  Random random;
  Scene scene = moving_mesh(random);
  scene.integrator = {"rk4", 5e-5};
  Simulation run(scene);
  double exchanged = 0;
  while (run.time() < scene.duration - 1e-9) {
    ASSERT_FALSE(run.advance(50));
    exchanged = std::max(exchanged, run.measure().energy.kinetic);
    EXPECT_LE(std::abs(run.measure().energy_error()), 1e-6 * exchanged);
  }
  EXPECT_GT(run.measure().ledger.forces.damping_loss, 1e-3 * exchanged);

  scene = material_mesh_sheet(7, 6, 0.3, 0.25, 0.2, meshed_material(), random);
  DirectRun free(scene, exactly("rk4", 1e-4));
  free.state = crumpled_state(free.system, 0.003, 0.5, random);
  const Vec3 before = momentum(free.system, free.state), turning = angular_momentum(free.system, free.state);
  free.advance(200, 1e-4);
  EXPECT_LE((momentum(free.system, free.state) - before).norm(), 1e-12 * (1 + before.norm()));
  // RK4 keeps it to its own order alone.
  const double scale = free.system.total_mass() * 0.3 * 0.5;
  EXPECT_LE((angular_momentum(free.system, free.state) - turning).norm(), 1e-5 * scale);
}

// ---- stability ----

TEST(MaterialMesh, HasNoFrequencyAboveTheBoundAsLongAsNoEdgeIsStretchedBeyondWhatItCovers) {
  Random random;
  for (Scene& scene : meshes_of_a_sheet(meshed_material(), random)) {
    scene.cloth.pins = {PinnedParticle{0, 0}};
    const ClothSystem system = make_cloth(scene);
    const double bound = guaranteed_frequency(scene);
    EXPECT_LE(measure_spectrum(system, system.start).largest_frequency(), bound);
    EXPECT_LE(largest_frequency(scene), bound);
    for (const double stretch : {0.9, 1.0, covered_stretch}) {
      const Vec3Field position = mapped(system.start, stretch * Eigen::Matrix3d::Identity());
      EXPECT_LE(measure_spectrum(system, position).largest_frequency(), bound) << stretch;
    }
  }
}

// ---- the block ----

std::string rule_of(const Scene& scene, const std::string& path) {
  for (const Problem& problem : find_problems(scene))
    if (problem.path == path) return problem.rule;
  return "";
}

TEST(MaterialMesh, TakesEveryCouplingThatCostsEnergyAndAGridOnlyThatOfItsSprings) {
  Random random;
  Material m = any_material();
  m.stretch_warp = 25, m.stretch_weft = 6.5, m.shear = 8.8;  // navy-sparkle-sweat
  Scene mesh = material_mesh_sheet(4, 3, width, height, 0.2, m, random);
  EXPECT_EQ(rule_of(mesh, "material.shear"), "");
  Scene grid = material_sheet(5, 5, 0.1, 0.1, m);
  EXPECT_NE(rule_of(grid, "material.shear"), "");
  mesh.material->shear = 14;
  EXPECT_NE(rule_of(mesh, "material.shear"), "") << "the automatic coupling is beyond the root of 25 x 6.5";
  mesh.material->coupling = 5;
  EXPECT_EQ(rule_of(mesh, "material.shear"), "");
  mesh.material->coupling = 13;
  EXPECT_NE(rule_of(mesh, "material.coupling"), "");
  grid.material = any_material();
  grid.material->coupling = 20;
  EXPECT_NE(rule_of(grid, "material.coupling"), "");
  grid.material->coupling = grid.material->shear;
  EXPECT_EQ(rule_of(grid, "material.coupling"), "");
}

TEST(MaterialMesh, HasDirectionsInItsFileAndOneOfSpringsHasNone) {
  const auto with = [](const std::string& holds, const std::string& directions) {
    return read_scene(R"({"format": "clothlab/scene/1", "cloth": {"mesh": "disc.obj")" + directions + "}, " +
                          holds + R"(, "integrator": {"method": "verlet", "time_step": "auto"}, "duration": 1,
                      "record": {"interval": 0.01}})",
                      "test");
  };
  const std::string turned = R"(, "across": [0, 0, 1], "down": [1, 0, 0])";
  const auto material = with(R"("material": "gray-interlock")", turned);
  ASSERT_TRUE(material.scene.has_value());
  EXPECT_EQ(material.scene->cloth.down, Vec3(1, 0, 0));
  const auto again = read_scene(write_scene(*material.scene), "test");
  ASSERT_TRUE(again.scene.has_value());
  EXPECT_EQ(again.scene->cloth.down, Vec3(1, 0, 0));
  const auto springs = with(R"("springs": {"structural": 100})", turned);
  ASSERT_EQ(springs.problems.size(), 2u);
  EXPECT_EQ(springs.problems[0].path, "cloth.across");
  EXPECT_EQ(springs.problems[1].path, "cloth.down");
}

}  // namespace
}  // namespace cloth::test::material_mesh_test
