#include "study/reference_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "forces/force_model.h"
#include "measure/energy.h"
#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"
#include "simulation/step_batches.h"

namespace cloth {
namespace {

constexpr double tolerance = 1e-13;
constexpr double collocation_phase = 0.3;  // step * fastest rate
const char* const loop_method = "verlet";

double fastest_rate(const Scene& scene) {
  const double omega = largest_frequency(scene);
  return std::hypot(omega, damping_rates(scene).most);
}

/// What an error is measured by in each component: the cloth's diagonal, and that over the horizon.
Eigen::VectorXd scale_of(const ClothSystem& system, double horizon) {
  Eigen::VectorXd scale(6 * system.size());
  scale.head(3 * system.size()).setConstant(system.diagonal);
  scale.tail(3 * system.size()).setConstant(system.diagonal / std::min(horizon, 1.0));
  return scale;
}

double weighted_square(const ClothSystem& system, const Eigen::VectorXd& field) {
  const int n = system.size();
  double sum = 0;
  for (int k = 0; k < 3 * n; ++k)
    if (!system.pinned[static_cast<std::size_t>(k % n)])
      sum += system.mass[static_cast<std::size_t>(k % n)] * field(k) * field(k);
  return sum;
}

/// Gathers |a|^2 and |da/dt|^2 along the motion, da/dt as a central difference.
class ExcitedFrequency {
 public:
  explicit ExcitedFrequency(double rate) : moment_(1e-3 / rate) {}

  void look(ClothMotion& motion, double time, const Eigen::VectorXd& y) {
    const Eigen::Index half = y.size() / 2;
    motion.derivative(time, y, slope_);
    const Eigen::VectorXd before_y = y - moment_ * slope_, after_y = y + moment_ * slope_;
    motion.derivative(time - moment_, before_y, before_);
    motion.derivative(time + moment_, after_y, after_);
    acceleration_ += weighted_square(motion.system(), slope_.tail(half));
    jerk_ += weighted_square(motion.system(), ((after_ - before_).tail(half) / (2 * moment_)).eval());
  }
  double value() const { return acceleration_ > 0 ? std::sqrt(jerk_ / acceleration_) : 0; }

 private:
  double moment_;  // s
  double acceleration_ = 0, jerk_ = 0;
  Eigen::VectorXd slope_, before_, after_;
};

void finish(const ClothSystem& system, const std::vector<ClothState>& check, ReferenceSolution& solution) {
  solution.floor = difference(solution.states, check);
  for (const ClothState& state : solution.states)
    solution.largest_kinetic = std::max(solution.largest_kinetic, kinetic_energy(system, state.velocity));
}

}  // namespace

bool is_smooth(const Scene& scene) {
  if (!scene.obstacles.empty()) return false;
  const ClothSystem system = make_cloth(scene);
  return !(scene.deformation && DeformationLimiter::is_needed(*scene.deformation, system));
}

struct ClothMotion::Forces {
  Forces(const Scene& scene, const ClothSystem& system)
      : model(scene, system),
        position(static_cast<std::size_t>(system.size())),
        velocity(position),
        force(position) {}
  ForceModel model;
  Vec3Field position, velocity, force;
};

ClothMotion::ClothMotion(const Scene& scene)
    : system_(make_cloth(scene)), forces_(std::make_unique<Forces>(scene, system_)) {}

ClothMotion::~ClothMotion() = default;

Eigen::VectorXd ClothMotion::start() const {
  const ClothState state = starting_state(system_);
  Eigen::VectorXd y(6 * system_.size());
  std::copy(state.position.flat().begin(), state.position.flat().end(), y.data());
  std::copy(state.velocity.flat().begin(), state.velocity.flat().end(), y.data() + 3 * system_.size());
  return y;
}

ClothState ClothMotion::state(double time, const Eigen::VectorXd& y) const {
  ClothState state = starting_state(system_);
  const double* from = y.data();
  std::copy(from, from + 3 * system_.size(), state.position.flat().begin());
  std::copy(from + 3 * system_.size(), from + 6 * system_.size(), state.velocity.flat().begin());
  state.time = time;
  return state;
}

void ClothMotion::derivative(double time, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
  const Eigen::Index n = system_.size();
  const double* from = y.data();
  std::copy(from, from + 3 * n, forces_->position.flat().begin());
  std::copy(from + 3 * n, from + 6 * n, forces_->velocity.flat().begin());
  forces_->model.update(forces_->position, time);
  forces_->model.force(forces_->position, forces_->velocity, forces_->force);
  ++evaluations_;
  dy.resize(6 * n);
  dy.head(3 * n) = y.tail(3 * n);
  const Eigen::Map<const Eigen::ArrayXd> inverse_mass(system_.inverse_mass.data(), n);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Map<const Eigen::ArrayXd> force(forces_->force.x() + axis * n, n);
    dy.segment((3 + axis) * n, n) = inverse_mass * force;
  }
}

StateDifference difference(const std::vector<ClothState>& a, const std::vector<ClothState>& b) {
  StateDifference result;
  double position = 0, velocity = 0, count = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    for (std::size_t i = 0; i < a[k].position.size(); ++i) {
      const double square = (a[k].position[i] - b[k].position[i]).squaredNorm();
      position += square;
      velocity += (a[k].velocity[i] - b[k].velocity[i]).squaredNorm();
      result.largest_position = std::max(result.largest_position, std::sqrt(square));
      count += 1;
    }
  if (count > 0) {
    result.rms_position = std::sqrt(position / count);
    result.rms_velocity = std::sqrt(velocity / count);
  }
  return result;
}

ReferenceSolution solve_smooth(const Scene& scene, double horizon, int samples,
                               const ReferenceProgress& progress, const StopTest& stop) {
  ReferenceSolution solution;
  ClothMotion motion(scene);
  const Derivative f = [&](double time, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    motion.derivative(time, y, dy);
  };
  const double rate = std::max(fastest_rate(scene), 1 / horizon);
  const int steps = std::max(1, static_cast<int>(std::ceil(horizon / samples * rate / collocation_phase)));
  solution.first = fmt::format("Gauss-Legendre collocation of order 12 in {} steps", steps * samples);
  solution.second = fmt::format("Gragg-Bulirsch-Stoer extrapolation, tolerance {:.0e} a step", tolerance);

  const Eigen::VectorXd scale = scale_of(motion.system(), horizon);
  Extrapolation extrapolation(tolerance, scale);
  Collocation collocation(scale);
  ExcitedFrequency excited(rate);
  Eigen::VectorXd first = motion.start(), second = first;
  std::vector<ClothState> check;
  for (int k = 1; k <= samples; ++k) {
    const double begin = horizon * (k - 1) / samples, end = horizon * k / samples;
    auto failure = collocation.advance(f, begin, end, steps, first, stop);
    if (!failure) failure = extrapolation.advance(f, begin, end, second, stop);
    if (failure) solution.failure = *failure;
    if (!failure && progress && !progress(static_cast<double>(k) / samples)) solution.failure = "stopped";
    if (!solution.failure.empty()) return solution;
    excited.look(motion, end, first);
    solution.states.push_back(motion.state(end, first));
    check.push_back(motion.state(end, second));
  }
  solution.excited_frequency = excited.value();
  solution.evaluations = motion.evaluations();
  finish(motion.system(), check, solution);
  return solution;
}

ReferenceSolution solve_by_loop(const Scene& scene, double horizon, int samples, std::int64_t steps,
                                const ReferenceProgress& progress, const StopTest& stop) {
  ReferenceSolution solution;
  solution.smooth = false;
  solution.first = fmt::format("{} with the same limiter and contact in {} steps", loop_method, steps);
  solution.second = fmt::format("the same in {} steps", steps / 2);
  Scene fine = scene;
  fine.integrator = {loop_method, horizon / static_cast<double>(steps)};
  Scene coarse = scene;
  coarse.integrator = {loop_method, 2 * horizon / static_cast<double>(steps)};
  Simulation first(fine), second(coarse);
  std::vector<ClothState> check;
  const auto advance = [&](StepBatches& batches, std::int64_t to) {
    if (solution.failure.empty() && !batches.run_to(to))
      solution.failure = batches.divergence() ? describe(*batches.divergence()) : "stopped";
  };
  first.set_threads(machine_threads());
  second.set_threads(machine_threads());
  StepBatches first_steps(first, stop), second_steps(second, stop);
  for (int k = 1; k <= samples && solution.failure.empty(); ++k) {
    for (int part = 1; part <= 10 && solution.failure.empty(); ++part) {  // so that it can be stopped soon
      const std::int64_t to = steps * (k - 1) / samples + steps / samples * part / 10;
      advance(first_steps, to);
      if (progress && !progress(0.67 * static_cast<double>(to) / static_cast<double>(steps)))
        solution.failure = "stopped";
    }
    solution.states.push_back(first.state());
  }
  for (int k = 1; k <= samples && solution.failure.empty(); ++k) {
    advance(second_steps, steps / 2 * k / samples);
    check.push_back(second.state());
    if (progress && !progress(0.67 + 0.33 * k / samples)) solution.failure = "stopped";
  }
  solution.evaluations = first.count().force_evaluations + second.count().force_evaluations;
  if (solution.failure.empty()) finish(first.system(), check, solution);
  return solution;
}

std::string bytes_of(const std::vector<ClothState>& states) {
  std::string bytes;
  for (const ClothState& state : states)
    for (const Vec3Field* field : {&state.position, &state.velocity}) {
      const std::span<const double> numbers = field->flat();
      bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    }
  return bytes;
}

std::vector<ClothState> states_from(const std::string& bytes, int particles, int samples, double horizon) {
  if (particles < 1 || samples < 1) return {};
  const auto count = static_cast<std::size_t>(particles);
  if (bytes.size() != static_cast<std::size_t>(samples) * 6 * count * sizeof(double)) return {};
  std::vector<ClothState> states;
  const char* from = bytes.data();
  for (int k = 1; k <= samples; ++k) {
    ClothState state{.position = Vec3Field(count), .velocity = Vec3Field(count)};
    for (Vec3Field* field : {&state.position, &state.velocity}) {
      std::memcpy(field->flat().data(), from, field->flat().size_bytes());
      from += field->flat().size_bytes();
    }
    state.time = horizon * k / samples;
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace cloth
