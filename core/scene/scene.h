// A scene is a value that determines a run completely: cloth, forces, obstacles, method, duration. The
// window, the command line, tests and benchmarks all start from scenes. An optional block that is absent
// leaves out that force or constraint. SI units throughout. docs/parameters.md describes every value.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloth/cloth_sheet.h"
#include "cloth/material.h"
#include "params/parameter.h"
#include "scene/probe.h"
#include "scene/scene_mesh.h"

namespace cloth {

/// The wind at time t: wind * (1 + amplitude * sin(2 pi frequency t)).
struct Gust {
  double amplitude = 0.5;  ///< relative to the wind
  double frequency = 0.7;  ///< Hz
  bool operator==(const Gust&) const = default;
};

struct Air {
  double drag = 0.01;        ///< N s/m per particle, along the normal
  double skin_friction = 0;  ///< N s/m per particle, along the cloth
  Vec3 wind{0, 0, 0};        ///< m/s
  std::optional<Gust> gust;
  bool operator==(const Air&) const = default;
};

/// The deformation limiter (Provot 1995): after each step the strain (|d| - L)/L of limited springs is at
/// most `rate`.
struct Deformation {
  double rate = 0.1;
  Words springs{"structural", "shear"};
  double tolerance = 1e-4;  ///< relative to the rest length
  std::int64_t max_sweeps = 200;
  std::string solver = "auto";
  bool operator==(const Deformation&) const = default;
};

/// Each shape of obstacle is a class with one instance (scene/obstacle_shape.h); pointers to it identify it.
class ObstacleShape;
using Shape = const ObstacleShape*;
const ObstacleShape& sphere_shape();

/// The position of a moving obstacle's pivot (center or point) at a time, and its rotation relative to the
/// orientation that the scene describes.
struct Keyframe {
  double time = 0;         ///< s
  Vec3 position{0, 0, 0};  ///< m
  Vec3 rotation{0, 0, 0};  ///< rotation vector, rad
  bool operator==(const Keyframe&) const = default;
};

/// Which members matter depends on `shape`: sphere: center, radius; box: center, size; plane: point, normal;
/// mesh: mesh, scale, rotate, translate.
struct Obstacle {
  Shape shape = &sphere_shape();
  Vec3 center{0, 0, 0};
  double radius = 0.3;
  Vec3 size{0.4, 0.4, 0.4};
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 1, 0};
  MeshChoice mesh = {};
  double scale = 1;
  Vec3 rotate{0, 0, 0};     ///< degrees about x, then y, then z
  Vec3 translate{0, 0, 0};  ///< m, after scaling and rotation
  std::string response = "coulomb";
  double friction = 0.3;
  double restitution = 0;
  Vec3 velocity{0, 0, 0};                ///< m/s
  Vec3 spin{0, 0, 0};                    ///< angular velocity about the pivot, rad/s
  std::vector<Keyframe> keyframes = {};  ///< ascending in time; with any, velocity and spin are ignored
  bool operator==(const Obstacle&) const = default;
};

/// Turns on continuous contact with obstacles (contact/continuous_contact.h).
struct ContactSettings {
  double thickness = 0.005;  ///< m, kept between cloth and obstacles
  bool operator==(const ContactSettings&) const = default;
};

/// Turns on continuous contact of the cloth with itself.
struct SelfContact {
  double thickness = 0.004;  ///< m
  double friction = 0.3;
  bool operator==(const SelfContact&) const = default;
};

/// Which of the settings matter depends on `method`: integrator_fields(method) lists them.
struct IntegratorChoice {
  std::string method = "verlet";
  std::optional<double> time_step = {};  ///< s; absent: "auto", 80 % of the method's stability limit
  double tolerance = 1e-6;  ///< dormand-prince: of a step's error; Newton's method: of its last change
  std::int64_t newton_iterations = 500;     ///< largest number in a step
  std::int64_t projective_iterations = 10;  ///< local and global solves in each step
  std::string projective_acceleration =
      "none";                                  ///< projective: of the iterations (integrators/acceleration.h)
  std::int64_t xpbd_iterations = 1;            ///< passes over all springs in each substep
  std::int64_t substeps = 10;                  ///< xpbd
  std::int64_t vbd_iterations = 20;            ///< visits of every particle in each step
  std::string vbd_acceleration = "chebyshev";  ///< or "none"
  bool operator==(const IntegratorChoice&) const = default;
};

struct Recording {
  double interval = 0.01;  ///< s of simulated time between rows
  bool operator==(const Recording&) const = default;
};

/// Points that somebody measured on such a cloth: a run does not know of them, clothlab-cli validate --scene
/// holds the scene against them (study/validation/measured_points.h).
struct MeasuredPoints {
  std::string file;                   ///< CSV, as seen from the scene's folder
  std::string output = "middle-row";  ///< a line of particles, or a quantity as grid convergence has it
  std::string state = "rest";         ///< in which it was measured: "rest", or "end" of the duration
  double tolerance = 0.02;            ///< relative
  bool operator==(const MeasuredPoints&) const = default;
};

struct Scene {
  std::string title;
  ClothSheet cloth;
  std::optional<SpringMaterial> springs;
  std::optional<Material> material;  ///< in place of springs, damping, cloth.mass and the air's drag
  std::optional<double> damping;     ///< viscous, N s/m per particle
  std::optional<Vec3> gravity;       ///< m/s^2
  std::optional<Air> air;
  std::optional<Deformation> deformation;
  std::vector<Obstacle> obstacles;
  std::optional<ContactSettings> contact;
  std::optional<SelfContact> self_contact;
  IntegratorChoice integrator;
  double duration = 5.0;  ///< s
  Recording record;
  std::vector<Probe> probes;
  std::optional<MeasuredPoints> measured;
  SceneFolder folder;  ///< for relative paths of mesh files; not written to the file
  bool operator==(const Scene&) const = default;
};

/// m/s^2; zero where the scene has none.
inline Vec3 gravity_of(const Scene& scene) {
  return scene.gravity.value_or(Vec3::Zero());
}

}  // namespace cloth
