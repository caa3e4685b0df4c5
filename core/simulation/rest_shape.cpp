#include "simulation/rest_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/grid.h"
#include "forces/force_model.h"
#include "integrators/implicit/linear_solver.h"
#include "measure/energy.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

/// The forces that have an energy.
Scene conservative(Scene scene) {
  scene.damping.reset(), scene.air.reset(), scene.deformation.reset();
  if (scene.springs) scene.springs->damping = 0;
  if (Material* m = scene.material ? &*scene.material : nullptr)
    m->stretch_damping = m->bending_damping = m->mass_damping = m->drag_normal = m->drag_tangential = 0;
  return scene;
}

class RestSearch {
 public:
  RestSearch(const Scene& scene, const ClothSystem& system, const Vec3Field& from, const RestOptions& options)
      : options_(options),
        system_(system),
        scene_(conservative(scene)),
        forces_(scene_, system_),
        state_(starting_state(system_)) {
    state_.position = from;
    step_ = Vec3Field(from.size());
    for (std::size_t i = 0; i < system_.mass.size(); ++i)
      if (!system_.pinned[i]) free_mass_ += system_.mass[i];
    weight_ = free_mass_ * gravity_of(scene_).norm();
    rounding_ = rounding();
    shift_ = 1e3;
  }

  void set_history(const std::vector<double>& history) { forces_.set_history(history, state_.position); }
  std::vector<double> end_step() {
    forces_.end_step(state_.position);
    return forces_.history();
  }

  RestShape run() {
    RestShape rest;
    evaluate();
    const double enough = std::max(options_.tolerance, rounding_);
    for (; rest.iterations < options_.iterations && residual() > enough && shift_ < most_shift;
         ++rest.iterations) {
      if (options_.stop && options_.stop()) break;
      if (find_step()) take_step();
    }
    rest.position = state_.position;
    rest.residual = residual();
    rest.found = rest.residual <= enough;
    if (!rest.found)
      rest.failure = fmt::format("no rest within {} iterations: {:.3g} of the weight is not balanced",
                                 rest.iterations, rest.residual);
    return rest;
  }

 private:
  static constexpr double most_shift = 1e14;  // 1/s^2

  double residual() const { return net_.flat().empty() ? 0 : norm(net_) / std::max(weight_, 1e-300); }
  static double norm(const Vec3Field& field) {
    double sum = 0;
    for (const double x : field.flat()) sum += x * x;
    return std::sqrt(sum);
  }

  /// What rounding of the positions alone leaves of the forces, over the weight.
  double rounding() const {
    std::vector<double> stiffness(system_.mass.size());
    const auto add = [&](std::size_t i, std::size_t j, double k) {
      stiffness[i] += std::abs(k), stiffness[j] += std::abs(k);
    };
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
      add(i, j, run.stiffness);
    });
    for_each_bending_pair(system_.bending, add);
    for (const MembraneTriangle& t : system_.membrane) {
      const std::array<double, 3> bound = edge_bounds(t);
      for (std::size_t e = 0; e < 3; ++e) add(at(t.corner[e]), at(t.corner[(e + 1) % 3]), bound[e]);
    }
    double sum = 0, furthest = 0;
    for (const double k : stiffness) sum += k * k;
    for (const double x : state_.position.flat()) furthest = std::max(furthest, std::abs(x));
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    return epsilon * furthest * std::sqrt(sum) / std::max(weight_, 1e-300);
  }

  double energy_at(const Vec3Field& position) {
    ClothState state = state_;
    state.position = position;
    return measure_energy(system_, gravity_of(scene_), state).potential() + forces_.stored_energy(position);
  }
  /// Net forces of the free particles at the present shape, and its energy.
  void evaluate() {
    forces_.update(state_.position, 0);
    net_ = forces_.position_force();
    for (std::size_t i = 0; i < net_.size(); ++i)
      if (system_.pinned[i]) net_.set(i, Vec3::Zero());
    energy_ = energy_at(state_.position);
  }

  /// (K + shift M) step = net force; false where not even the clamped K is positive definite.
  bool find_step() {
    // The system is solved over shift, as M + K / shift.
    const double shift = std::max(shift_, least_shift());
    is_clamped_ = false;
    for (const bool clamped : {false, true}) {
      is_clamped_ = clamped;
      forces_.linearise(state_.position, {.position = 1 / shift, .velocity = 0, .clamped = clamped},
                        linearisation_);
      if (!factors_.factorise(system_, linearisation_)) continue;
      factors_.solve(net_, step_);
      for (double& x : step_.flat()) x /= shift;
      return true;
    }
    shift_ = 10 * shift;
    return false;
  }
  /// Below it the masses are lost in rounding beside the stiffness, and the step is Newton's own.
  double least_shift() const { return 1e-9 * weight_ / (free_mass_ * system_.diagonal); }

  void take_step() {
    double longest = 0, slope = 0;
    for (std::size_t i = 0; i < step_.size(); ++i) {
      longest = std::max(longest, step_[i].norm());
      slope -= step_[i].dot(net_[i]);
    }
    const double most = options_.longest_move * system_.diagonal;
    double length = longest > most ? most / longest : 1;
    const Vec3Field before = state_.position, net = net_;
    const double energy = energy_, force = norm(net_);
    for (int halving = 0; halving < 14; ++halving, length /= 2) {
      state_.position = before;
      add_scaled(length, step_, state_.position);
      evaluate();
      // Near the rest the energy's digits end before the force's do.
      const bool falls = energy_ <= energy + 1e-4 * length * slope;
      const bool is_flat = std::abs(energy_ - energy) <= 1e-12 * std::abs(energy) && norm(net_) < force;
      if (falls || is_flat) return follow(length);
    }
    state_.position = before, net_ = net, energy_ = energy;
    forces_.update(state_.position, 0);
    shift_ = 10 * std::max(shift_, 1.0);
  }
  void follow(double length) {
    if (length >= 0.5)
      shift_ *= is_clamped_ ? 0.5 : 0.2;
    else if (length < 0.1)
      shift_ = 3 * std::max(shift_, 1.0);
  }

  const RestOptions options_;
  const ClothSystem& system_;
  const Scene scene_;
  ForceModel forces_;
  ClothState state_;
  Linearisation linearisation_;
  CholeskyFactors factors_;
  Vec3Field net_, step_;  ///< N, m
  double energy_ = 0, weight_ = 0, free_mass_ = 0, rounding_ = 0, shift_ = 0;
  bool is_clamped_ = false;
};

}  // namespace

RestShape find_rest(const Scene& scene, const ClothSystem& system, const Vec3Field& from,
                    const RestOptions& options) {
  RestShape rest{.position = from, .failure = {}};
  std::vector<double> history;
  for (int part = 1; part <= options.load_steps; ++part) {
    Scene loaded = scene;
    loaded.gravity = gravity_of(scene) * part / options.load_steps;
    RestSearch search(loaded, system, rest.position, options);
    search.set_history(history);
    const int iterations = rest.iterations;
    rest = search.run();
    rest.iterations += iterations;
    if (options.stop && options.stop()) break;
    history = search.end_step();
  }
  return rest;
}

bool is_minimum(const Scene& scene, const ClothSystem& system, const Vec3Field& position) {
  const Scene still = conservative(scene);
  ForceModel forces(still, system);
  forces.update(position, 0);
  constexpr double mass_beside_stiffness = 1e-12;  // what cannot be left out of the matrix
  Linearisation linearisation;
  const double stiffness = 1 / (mass_beside_stiffness * gravity_of(still).norm() / system.diagonal);
  forces.linearise(position, {.position = stiffness, .velocity = 0, .clamped = false}, linearisation);
  return CholeskyFactors().factorise(system, linearisation);
}

Vec3Field conservative_forces(const Scene& scene, const ClothSystem& system, const Vec3Field& position) {
  const Scene still = conservative(scene);
  ForceModel forces(still, system);
  forces.update(position, 0);
  return forces.position_force();
}

RestShape find_rest(const Scene& scene, const RestOptions& options) {
  const ClothSystem system = make_cloth(scene);
  return find_rest(scene, system, system.start, options);
}

}  // namespace cloth
