#include "bench_scenes.h"

namespace cloth::bench {

Scene hanging_cloth(int size, const std::string& method) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 500, .shear = 250, .flexion = 50};
  scene.damping = 0.001;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator.method = method;
  return scene;
}

const std::vector<ExtraStage>& extra_stages() {
  static const std::vector<ExtraStage> stages{
      {"air",
       [](Scene& s) {
         s.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = std::nullopt};
       }},
      {"spring damping", [](Scene& s) { s.springs->damping = 0.001; }},
      {"limiter to 1 %", [](Scene& s) { s.deformation = Deformation{.rate = 0.01}; }},
      {"sphere",
       [](Scene& s) {
         Obstacle sphere;
         sphere.center = {0, 0.5, -0.1};
         sphere.radius = 0.2;
         s.obstacles.push_back(sphere);
       }},
  };
  return stages;
}

}  // namespace cloth::bench
