// Layers at rest lie a thickness apart, however long the step and however many there are; a cloth that starts
// exactly flat gives way where it is squeezed.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cloth/mesh_cloth.h"
#include "contact/near_pairs.h"
#include "geometry/mesh_repair.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_mesh.h"
#include "support/contact_scenes.h"
#include "support/meshes.h"

namespace cloth::test::contact_layers_test {
namespace {

/// Sheets of 9 x 9 particles and 0.3 m over each other, `apart` m, each turned by half a radian more than the
/// one below it, as one cloth.
TriangleMesh sheets(int count, double apart) {
  constexpr int n = 9;
  TriangleMesh mesh;
  for (int sheet = 0; sheet < count; ++sheet) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5 * sheet, Vec3::UnitY()).toRotationMatrix();
    Vec3Field position(n * n);
    for (int k = 0; k < n * n; ++k)
      position.set(static_cast<std::size_t>(k),
                   turn * Vec3(0.0375 * (k % n) - 0.15, 0.006 + apart * sheet, 0.0375 * (k / n) - 0.15));
    const TriangleMesh one = grid_triangles(n, n, position);
    mesh.vertices.insert(mesh.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const Triangle& t : one.triangles)
      mesh.triangles.push_back({t[0] + n * n * sheet, t[1] + n * n * sheet, t[2] + n * n * sheet});
  }
  return mesh;
}

Scene layers(int count, double thickness) {
  Scene scene;
  scene.cloth.mesh = made_mesh("made.obj", sheets(count, std::max(0.01, 1.5 * thickness)));
  scene.cloth.rows = 1;
  scene.cloth.columns = static_cast<int>(scene.cloth.mesh.loaded->surface.vertices.size());
  scene.cloth.origin.setZero();
  scene.cloth.mass = 0.01 * count;
  scene.springs = SpringMaterial{.structural = 500, .shear = 0, .flexion = 50, .damping = 0.004};
  scene.damping = 0.001;
  scene.gravity = Vec3(0, -9.81, 0);
  Obstacle plane;
  plane.shape = &plane_shape();
  scene.obstacles = {plane};
  scene.contact = ContactSettings{};
  scene.self_contact = SelfContact{.thickness = thickness};
  scene.integrator.method = "implicit-euler";
  scene.integrator.time_step = 1.0 / 60;
  return scene;
}

/// m, the least of features that share no particle.
double least_own_distance(const Simulation& simulation, double within) {
  const Vec3Field& position = simulation.state().position;
  SweptBounds around{.own_reach = within};
  around.from = around.to = position;
  around.radius.assign(position.size(), 0);
  const Surface surface = make_surface(static_cast<int>(position.size()), simulation.cloth_mesh().triangles);
  std::vector<FeaturePair> pairs;
  PairSearch(surface, position, {}, true, 0).find(around, {}, pairs);
  double least = within;
  for (const FeaturePair& pair : pairs)
    least = std::min(least, separate(pair, {surface, position, {}, {}}, 0).distance);
  return least;
}

void expect_layers_apart(const Scene& scene, double seconds) {
  const double thickness = scene.self_contact->thickness;
  Simulation simulation(scene);
  while (simulation.time() < seconds) ASSERT_FALSE(simulation.step());
  EXPECT_GT(least_own_distance(simulation, 1.5 * thickness), 0.9 * thickness)
      << thickness << " m, " << scene.integrator.method << " at " << *scene.integrator.time_step << " s";
  EXPECT_EQ(all_crossings(simulation).number, 0);
}

TEST(LayersAtRest, LieAThicknessApartWhereAStepFallsManyThicknesses) {
  expect_layers_apart(layers(2, 4e-4), 1.0);
}

TEST(LayersAtRest, LieAThicknessApartInAStack) {
  expect_layers_apart(layers(5, 0.004), 1.0);
}

TEST(LayersAtRest, LieAThicknessApartWithAnyMethodAndStep) {
  struct Way {
    const char* method;
    double step;
  };
  for (const int count : {2, 3})
    for (const double thickness : {0.001, 0.003, 0.01})
      for (const auto& [method, step] :
           {Way{"verlet", 2e-4}, Way{"implicit-euler", 1.0 / 60}, Way{"xpbd", 0.01},
            Way{"projective", 1.0 / 60}, Way{"bdf2", 0.005}, Way{"vbd", 1.0 / 60}}) {
        const bool is_verlet = std::string(method) == "verlet";  // thousands of steps: once is enough
        if (is_verlet && !(count == 2 && thickness == 0.003)) continue;
        if (count == 3 && thickness != 0.003) continue;
        Scene scene = layers(count, thickness);
        scene.integrator.method = method;
        scene.integrator.time_step = step;
        expect_layers_apart(scene, 1.0);
      }
}

TEST(AClothThatIsExactlyFlat, BucklesWhereItIsSqueezedOnAPlane) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 17;
  scene.cloth.width = scene.cloth.height = 0.5;
  scene.cloth.mass = 0.0625;
  scene.cloth.origin = {-0.25, 0.0051, -0.25};
  scene.cloth.down = {0, 0, 1};
  scene.springs = SpringMaterial{.structural = 500, .shear = 250, .flexion = 50};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.contact = ContactSettings{};
  scene.self_contact = SelfContact{};
  scene.integrator.time_step = 4e-4;
  Obstacle plane, box;
  plane.shape = &plane_shape(), box.shape = &box_shape();
  box.size = {0.2, 0.2, 1};
  scene.obstacles = {plane, box, box};
  scene.obstacles[1].center = {-0.36, 0.09, 0}, scene.obstacles[1].velocity = {0.4, 0, 0};
  scene.obstacles[2].center = {0.36, 0.09, 0}, scene.obstacles[2].velocity = {-0.4, 0, 0};
  Simulation simulation(scene);
  double highest = 0;
  while (0.52 - 0.8 * simulation.time() > 0.15) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop) << ", " << 0.52 - 0.8 * simulation.time() << " m open";
  }
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    highest = std::max(highest, simulation.state().position[i].y());
  EXPECT_GT(highest, 0.05) << "m";
  EXPECT_EQ(all_crossings(simulation).number, 0);
}

}  // namespace
}  // namespace cloth::test::contact_layers_test
