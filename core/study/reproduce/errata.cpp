#include "study/reproduce/errata.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "cloth/grid.h"
#include "contact/obstacle_contact.h"
#include "forces/force_model.h"
#include "integrators/integrator.h"
#include "integrators/registry.h"
#include "scene/obstacle_shape.h"
#include "simulation/simulation.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

// The methods as the source report prints them. Not in the registry: they are wrong, and here to show it.

/// Eq. (8) with its 3 k3: y' = y + h/6 (k1 + 2 k2 + 3 k3 + k4). The weights sum to 7/6: order 0.
class PrintedRk4 : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work&) override {
    constexpr std::array<double, 4> nodes{0, 0.5, 0.5, 1};
    constexpr std::array<double, 4> weights{1.0 / 6, 2.0 / 6, 3.0 / 6, 1.0 / 6};  // as printed
    const double h = times.step;
    if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
    stage_position_ = next_position_ = state.position;
    stage_velocity_ = next_velocity_ = state.velocity;
    for (std::size_t s = 0; s < nodes.size(); ++s) {
      forces.update(stage_position_, times.begin + nodes[s] * h);
      forces.force(stage_position_, stage_velocity_, force_);
      add_scaled(h * weights[s], stage_velocity_, next_position_);
      add_acceleration(forces.system(), h * weights[s], force_, next_velocity_);
      if (s + 1 == nodes.size()) break;
      const double ahead = h * nodes[s + 1];
      stage_position_ = state.position;
      add_scaled(ahead, stage_velocity_, stage_position_);
      stage_velocity_ = state.velocity;
      add_acceleration(forces.system(), ahead, force_, stage_velocity_);
    }
    std::swap(state.position, next_position_);
    std::swap(state.velocity, next_velocity_);
    return {.force_evaluations = 4};
  }

 private:
  Vec3Field force_, stage_position_, stage_velocity_, next_position_, next_velocity_;
};

/// Eq. (14), x(t+h) = 2 x(t) - x(t-h) + h^2 a(t), with the only velocity that it has, (x(t) - x(t-h))/h, in
/// a: that lags by half a step, and the order falls to 1 where a force depends on the velocity.
class PrintedVerlet : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work&) override {
    const double h = times.step;
    if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
    forces.update(state.position, times.begin);
    forces.force(state.position, state.velocity, force_);
    if (!previous_) {  // the start by Taylor's formula: x(t-h) = x - h v + h^2/2 a
      previous_ = state.position;
      add_scaled(-h, state.velocity, *previous_);
      add_acceleration(forces.system(), 0.5 * h * h, force_, *previous_);
    }
    next_ = state.position;
    add_scaled(1, state.position, next_);
    add_scaled(-1, *previous_, next_);
    add_acceleration(forces.system(), h * h, force_, next_);
    state.velocity.fill(0);
    add_scaled(1 / h, next_, state.velocity);
    add_scaled(-1 / h, state.position, state.velocity);
    *previous_ = std::exchange(state.position, next_);
    return {.force_evaluations = 1};
  }

  void forget(Change) override { previous_.reset(); }

 private:
  std::optional<Vec3Field> previous_;  ///< x(t-h), m
  Vec3Field force_, next_;
};

/// One step of y' = A y.
Eigen::Vector2d weighted_step(const Eigen::Matrix2d& a, const Eigen::Vector2d& y, double h, double third) {
  const Eigen::Vector2d k1 = a * y;
  const Eigen::Vector2d k2 = a * (y + h / 2 * k1);
  const Eigen::Vector2d k3 = a * (y + h / 2 * k2);
  const Eigen::Vector2d k4 = a * (y + h * k3);
  return y + h / 6 * (k1 + 2 * k2 + third * k3 + k4);
}

Scene small_smooth_cloth() {
  Scene scene = scene_run("corners-free", {"cloth.rows=6", "cloth.columns=6", "duration=0.4"}).scene;
  scene.cloth.mass = 0.36;
  scene.springs = SpringMaterial{.structural = 46, .shear = 23, .flexion = 11.5};
  scene.damping = 0.02;
  scene.air = Air{.drag = 0.02, .wind = {0.5, 0, -2}, .gust = Gust{}};
  return scene;
}

Vec3Field shape_after(const Scene& scene, Integrator& method, int steps) {
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = starting_state(system);
  ForceModel forces(scene, system);
  Work work;
  const double h = scene.duration / steps;
  for (int n = 0; n < steps; ++n) method.step(forces, {n * h, (n + 1) * h, h}, state, work);
  return state.position;
}

MethodErrors errors_of(const std::string& name, int order, const Scene& scene, const Vec3Field& reference,
                       const std::function<std::unique_ptr<Integrator>()>& make) {
  MethodErrors result{name, order, {}, {}};
  for (int steps = 50; steps <= 800; steps *= 2) {
    result.steps.push_back(scene.duration / steps);
    result.errors.push_back(rms_distance(shape_after(scene, *make(), steps), reference));
  }
  return result;
}

double radius_of(const Vec3Field& position) {
  Vec3 middle = Vec3::Zero();
  for (std::size_t i = 0; i < position.size(); ++i) middle += position[i];
  middle /= static_cast<double>(position.size());
  double radius = 0;
  for (std::size_t i = 0; i < position.size(); ++i) radius = std::max(radius, (position[i] - middle).norm());
  return radius;
}

Leaving follow(const Obstacle& ball, bool as_printed) {
  constexpr double h = 1e-3;
  Vec3 position(0, ball.radius - 1e-3 - h, 0), velocity(0, 1, 0);
  position.y() -= h;  // so that it is still inside after the first step
  Leaving leaving;
  bool touched = false;
  for (int n = 0; n <= 40; ++n) {
    leaving.distance.emplace_back(n * h, position.y() - ball.radius);
    position += h * velocity;
    const auto surface = penetration(ball, position);
    if (!surface) continue;
    const double outward = velocity.dot(surface->normal);
    position = surface->point;
    velocity = as_printed ? Vec3(ball.friction * (velocity - 2 * outward * surface->normal))
                          : contact_velocity(ball, surface->normal, velocity);
    if (!touched) leaving.velocity = velocity.dot(surface->normal);
    touched = true;
  }
  return leaving;
}

double time_outside(const Leaving& leaving, double distance) {
  for (const auto& [time, gap] : leaving.distance)
    if (gap >= distance) return time;
  return leaving.distance.back().first;
}

}  // namespace

WeightedRungeKutta weighted_runge_kutta(double third_weight) {
  WeightedRungeKutta result;
  Eigen::Matrix2d decay = -Eigen::Matrix2d::Identity();
  Eigen::Vector2d y(1, 0);
  for (int n = 0; n < 320; ++n) y = weighted_step(decay, y, 1.0 / 320, third_weight);
  result.decay_error = std::abs(y.x() - std::exp(-1.0));

  Eigen::Matrix2d oscillator;
  oscillator << 0, 1, -1, 0;
  constexpr int steps = 1000;
  const double h = 2 * std::numbers::pi / steps;
  y = {1, 0};
  double angle = 0;
  for (int n = 0; n < 2 * steps; ++n) {
    if (n % 10 == 0) result.position.emplace_back(static_cast<double>(n) / steps, y.x());
    const Eigen::Vector2d next = weighted_step(oscillator, y, h, third_weight);
    angle += std::atan2(y.y() * next.x() - y.x() * next.y(), y.dot(next));
    y = next;
    if (n + 1 == steps) result.turns = angle / (2 * std::numbers::pi);
  }
  return result;
}

double MethodErrors::last_order() const {
  return pairwise_orders(errors).back();
}

std::vector<MethodErrors> errors_of_printed_methods() {
  const Scene scene = small_smooth_cloth();
  const auto registered = [](const char* method) {
    return [method] { return make_integrator(IntegratorChoice{method}); };
  };
  const Vec3Field reference = shape_after(scene, *registered("rk4")(), 12800);
  return {
      errors_of("Runge-Kutta 4 with 3 k3, Eq. (8)", 0, scene, reference,
                [] { return std::make_unique<PrintedRk4>(); }),
      errors_of("Runge-Kutta 4", 4, scene, reference, registered("rk4")),
      errors_of("Verlet with lagged damping, Eq. (14)", 1, scene, reference,
                [] { return std::make_unique<PrintedVerlet>(); }),
      errors_of("Verlet, damping centred", 2, scene, reference, registered("verlet")),
  };
}

CurrentLengthCloth current_length_cloth() {
  Scene scene;
  scene.cloth.columns = scene.cloth.rows = 10;
  scene.cloth.width = scene.cloth.height = 0.9;
  scene.cloth.mass = 1.0;
  scene.springs = SpringMaterial{.structural = 100, .shear = 100, .flexion = 100};
  scene.integrator = {.method = "rk4", .time_step = 1e-4};
  scene.duration = 0.03;
  Simulation simulation(scene, [](ClothSystem& system, ClothState&) {
    for (SpringBlock& block : system.springs.blocks()) block.run.rest_length = 0;
  });

  CurrentLengthCloth result;
  result.start_radius = result.least_radius = radius_of(simulation.state().position);
  while (simulation.time() < scene.duration) {
    const double radius = radius_of(simulation.state().position);
    if (radius < result.least_radius) result.least_radius = radius, result.time = simulation.time();
    result.radius.emplace_back(simulation.time(), radius);
    if (simulation.step()) break;
    // The first step from rest shows the force: v = h a up to h^3.
    if (simulation.count().steps == 1)
      result.pull = simulation.state().velocity[0].norm() / 1e-4 * simulation.system().mass[0];
  }
  result.pull_in_g = result.pull / (0.01 * 9.81);
  return result;
}

CubePush cube_push() {
  Obstacle cube{.shape = &box_shape()};
  cube.size = {2, 2, 2};
  const auto corner_of = [](const Vec3& p) {
    return Vec3(std::copysign(1.0, p.x()), std::copysign(1.0, p.y()), std::copysign(1.0, p.z()));
  };
  CubePush result;
  constexpr int n = 60;  // midpoints of one octant; the others are its mirror images
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 p = Vec3(i + 0.5, j + 0.5, k + 0.5) / n;
        result.mean_corner += (corner_of(p) - p).norm() / (n * n * n);
        result.mean_least += (penetration(cube, p)->point - p).norm() / (n * n * n);
      }
  const Vec3 example(0.1, 0.99, 0.2);
  result.corner = (corner_of(example) - example).norm();
  result.least = (penetration(cube, example)->point - example).norm();
  return result;
}

std::pair<Leaving, Leaving> leaving_particle() {
  Obstacle ball{.shape = &sphere_shape(), .response = "reflect", .friction = 0.9};
  Leaving printed = follow(ball, true), right = follow(ball, false);
  printed.time_lost = time_outside(printed, 0.01) - time_outside(right, 0.01);
  return {std::move(printed), std::move(right)};
}

}  // namespace cloth
