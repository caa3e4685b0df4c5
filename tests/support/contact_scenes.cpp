#include "support/contact_scenes.h"

#include <fmt/format.h>

#include <stdexcept>

#include "cloth/mesh_cloth.h"
#include "geometry/builtin_meshes.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth::test {
namespace {

Obstacle obstacle_of(Shape shape, const Vec3& center) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.center = obstacle.point = obstacle.translate = center;
  obstacle.friction = 0.4;
  return obstacle;
}

Obstacle box_of(const Vec3& center, double side) {
  Obstacle box = obstacle_of(&box_shape(), center);
  box.size = Vec3::Constant(side);
  return box;
}

Obstacle ball_of(const Vec3& center, double radius) {
  Obstacle ball = obstacle_of(&sphere_shape(), center);
  ball.radius = radius;
  return ball;
}

Obstacle cones() {
  Obstacle bed = obstacle_of(&mesh_shape(), {0, -0.07, 0});
  bed.scale = 0.4;
  bed.mesh.file = "cone-bed.obj";
  return bed;
}

TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& vertex : mesh.vertices) vertex = pose.at(vertex);
  return mesh;
}

Count crossings_of(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose) {
  switch (shape_of(obstacle).body) {
    case BodyKind::ball:
      return triangles_in_sphere(cloth, pose.at(obstacle.center), pose.stretch.x() * obstacle.radius);
    case BodyKind::box:
      return triangles_in_solid(cloth, box_triangles(pose.at(obstacle.center), pose.rotation,
                                                     0.5 * pose.stretch.cwiseProduct(obstacle.size)));
    case BodyKind::half_space:
      return vertices_below_plane(cloth, pose.at(obstacle.point), pose.rotation * obstacle.normal);
    case BodyKind::surface:
      return crossings(cloth, moved(placed_mesh(obstacle), pose));
  }
  return {};
}

}  // namespace

Scene sheet_over(double height, int particles_a_side) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = particles_a_side;
  scene.cloth.width = scene.cloth.height = 0.4;
  scene.cloth.mass = 0.05;
  scene.cloth.origin = {-0.19, height, -0.205};
  scene.cloth.down = {0, 0, 1};
  scene.springs = SpringMaterial{.structural = 60, .shear = 30, .flexion = 3, .damping = 0.005};
  scene.damping = 0.0002;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.contact = ContactSettings{};
  return scene;
}

const std::vector<std::string>& contact_scene_names() {
  static const std::vector<std::string> names{"sphere", "box",    "corner",          "plane",
                                              "cones",  "itself", "ball-from-below", "turning-box"};
  return names;
}

Scene contact_scene(const std::string& name) {
  Scene scene = sheet_over(0.01);
  if (name == "sphere") {
    scene.obstacles = {ball_of({0, -0.1, 0}, 0.1)};
  } else if (name == "box") {
    scene.obstacles = {box_of({0, -0.08, 0}, 0.16)};
  } else if (name == "corner") {
    Obstacle box = box_of({0, -0.14, 0}, 0.16);
    box.keyframes = {{0, box.center, {-0.6755108, 0, 0.6755108}}};
    scene.obstacles = {box};
  } else if (name == "plane") {
    scene.obstacles = {obstacle_of(&plane_shape(), Vec3::Zero())};
  } else if (name == "cones") {
    scene.obstacles = {cones()};
  } else if (name == "ball-from-below") {
    scene.obstacles = {ball_of({0.01, -0.3, 0}, 0.06)};
    scene.obstacles[0].velocity = {0, 5, 0};
  } else if (name == "turning-box") {
    scene.obstacles = {box_of({0, -0.15, 0}, 0.16)};
    scene.obstacles[0].spin = {1, 12, 3};
  } else if (name == "itself") {
    scene.cloth.origin = {-0.2, 0.42, 0};
    scene.cloth.down = {0, -1, 0.1};
    scene.springs->flexion = 0.5;
    scene.obstacles = {obstacle_of(&plane_shape(), Vec3::Zero())};
    scene.self_contact = SelfContact{};
  } else {
    throw std::invalid_argument(name);
  }
  load_meshes(scene);
  return scene;
}

Preparation thrown(const Vec3& velocity) {
  return [velocity](ClothSystem& system, ClothState& state) {
    for (std::size_t i = 0; i < state.velocity.size(); ++i)
      if (!system.pinned[i]) state.velocity.set(i, velocity);
  };
}

Count all_crossings(const Simulation& simulation) {
  TriangleMesh cloth;
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    cloth.vertices.push_back(simulation.state().position[i]);
  cloth.triangles = triangles_of(simulation.system());
  Count all;
  const auto add = [&](const Count& count, const std::string& what) {
    if (all.number == 0 && count.number > 0) all.first = what + ": " + count.first;
    all.number += count.number;
  };
  const Scene& scene = simulation.scene();
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    add(crossings_of(cloth, scene.obstacles[k], simulation.obstacle_pose(k, simulation.time())),
        fmt::format("obstacle {}", k));
  if (scene.self_contact) add(self_crossings(cloth), "itself");
  return all;
}

}  // namespace cloth::test
