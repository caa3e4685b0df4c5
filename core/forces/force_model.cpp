#include "forces/force_model.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "forces/air.h"
#include "forces/gravity.h"
#include "forces/pull_force.h"
#include "forces/springs.h"
#include "forces/viscous.h"
#include "kernels/grid_sweep.h"
#include "kernels/mesh_sweep.h"

namespace cloth {
namespace {

void clear(Vec3Field& field, std::size_t size) {
  if (field.size() == size)
    field.fill(0);
  else
    field = Vec3Field(size);
}

/// b = a - b
void subtract_from(const Vec3Field& a, Vec3Field& b) {
  const auto from = a.flat();
  const auto to = b.flat();
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] - to[k];
}

}  // namespace

ForceModel::ForceModel(const Scene& scene, const ClothSystem& system) : system_(&system) {
  const auto keep = [this](auto force) {
    auto* const kept = force.get();
    forces_.push_back(std::move(force));
    return kept;
  };
  if (scene.gravity && scene.gravity->squaredNorm() > 0) {
    gravity_ = *scene.gravity;
    gravity_force_ = keep(std::make_unique<Gravity>(gravity_));
  }
  if (!system.springs.empty()) spring_force_ = keep(std::make_unique<SpringForce>());
  if (!system.springs.empty() && scene.springs->damping > 0)
    spring_damping_ = keep(std::make_unique<SpringDamping>(scene.springs->damping));
  if (scene.damping && *scene.damping > 0) {
    viscous_ = *scene.damping;
    viscous_force_ = keep(std::make_unique<ViscousDamping>(viscous_));
  }
  if (scene.air && scene.air->drag > 0) air_ = keep(std::make_unique<AirForce>(*scene.air));
  note_kinds();
  system_changed();
}

void ForceModel::system_changed() {
  sweep_.reset();
  weight_ = Vec3::Zero();
  if (const auto grid = recognise_grid(*system_))
    sweep_ = std::make_unique<GridSweep>(*system_, *grid, common_mass(*system_));
  else if (suits_mesh_layout(*system_))
    sweep_ = std::make_unique<MeshSweep>(*system_, common_mass(*system_));
  if (sweep_) {
    sweep_->set_team(team_, thread_use_);
    if (sweep_->has_common_mass()) weight_ = sweep_->mass() * gravity_;
  }
  beside_sweep_.clear();
  for (const auto& force : forces_)
    if (force.get() != spring_force_ && force.get() != viscous_force_ && force.get() != spring_damping_ &&
        !(force.get() == gravity_force_ && can_step()))
      beside_sweep_.push_back(force.get());
}

ForceModel::~ForceModel() = default;
ForceModel::ForceModel(ForceModel&&) noexcept = default;
ForceModel& ForceModel::operator=(ForceModel&&) noexcept = default;

void ForceModel::add(std::unique_ptr<Force> force) {
  beside_sweep_.push_back(force.get());
  forces_.push_back(std::move(force));
  note_kinds();
}

void ForceModel::note_kinds() {
  has_damping_ = has_power_ = pull_ != nullptr;
  for (const auto& force : forces_) {
    NodeDamping damping;
    const bool coupled = !force->add_node_damping(damping);
    if (coupled || damping.isotropic > 0 || damping.along_normal > 0) has_damping_ = has_power_ = true;
  }
}

void ForceModel::update(const Vec3Field& position, double time) {
  ++evaluations_;
  if (sweep_) {
    if (has_load())
      update_load(position, time);
    else if (position_force_.size() != position.size())
      position_force_ = Vec3Field(position.size());
    if (spring_damping_) spring_damping_->update(*system_, position, time, position_force_);
    sweep_->evaluate({weight_, 0, has_load() ? &position_force_ : nullptr}, position, position_force_);
    return;
  }
  clear(position_force_, position.size());
  for (const auto& force : forces_) force->update(*system_, position, time, position_force_);
  if (pull_) pull_->update(*system_, position, time, position_force_);
}

/// p of what the sweep does not compute.
void ForceModel::update_load(const Vec3Field& position, double time) {
  clear(position_force_, position.size());
  for (Force* force : beside_sweep_) force->update(*system_, position, time, position_force_);
  if (pull_) pull_->update(*system_, position, time, position_force_);
}

/// Whether whole steps of Euler's and Kutta's compute the air on their way, so that nothing is a load.
bool ForceModel::sweeps_air() const {
  return air_ && !air_->has_brush() && !pull_ && beside_sweep_.size() == 1 && can_step() &&
         sweep_->takes_air();
}

SweptAir ForceModel::swept_air(std::span<const double> times) const {
  SweptAir air;
  if (!sweeps_air()) return air;
  air.drag = air_->air().drag;
  for (std::size_t k = 0; k < times.size(); ++k) air.wind[k] = wind_at(air_->air(), times[k]);
  return air;
}

/// What acts beside the elasticity of springs in a whole step whose forces are taken at `times`.
SweepLoads ForceModel::sweep_loads(std::span<const double> times) const {
  return {weight_, viscous_, steps_with_load() ? &position_force_ : nullptr,
          spring_damping_ ? spring_damping_->damping() : 0, swept_air(times)};
}

bool ForceModel::can_step() const {
  return sweep_ && sweep_->has_common_mass();
}

std::optional<double> ForceModel::euler_step(double time, double step, bool drift_first, ClothState& state,
                                             Work& work) {
  if (!can_step()) return std::nullopt;
  ++evaluations_;
  Work power;
  if (steps_with_load()) {
    update_load(state.position, time);
    clear(product_, state.position.size());
    for (const Force* force : beside_sweep_) {
      force->add_damping(state.position, state.velocity, product_);
      force->add_power(state.position, state.velocity, power);
    }
    if (pull_) {
      pull_->add_damping(state.position, state.velocity, product_);
      pull_->add_power(state.position, state.velocity, power);
    }
    const auto load = position_force_.flat();
    const auto damping = product_.flat();
    for (std::size_t k = 0; k < load.size(); ++k) load[k] -= damping[k];
  }
  StepSums sums;
  sweep_->euler(step, drift_first, sweep_loads({&time, 1}), {&sums, 1}, state);
  power.damping_loss += viscous_ * sums.before + sums.dampers;
  power.air += sums.air;
  if (has_power_) work += step * power;
  return sums.after;
}

bool ForceModel::gains_steps_at_once() const {
  const bool is_steady = !air_ || !air_->air().gust;
  return can_step() && !steps_with_load() && is_steady && sweep_->gains_steps_at_once();
}

void ForceModel::euler_steps(double step, bool drift_first, std::span<double> squares, ClothState& state,
                             Work& work) {
  assert(gains_steps_at_once());
  evaluations_ += static_cast<std::int64_t>(squares.size());
  std::vector<StepSums> of_steps(squares.size());
  constexpr std::array any_time{0.0};
  sweep_->euler(step, drift_first, sweep_loads(any_time), of_steps, state);
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const StepSums& sums = of_steps[k];
    squares[k] = sums.after;
    if (has_power_)
      work += step * Work{.damping_loss = viscous_ * sums.before + sums.dampers, .air = sums.air};
  }
}

std::optional<double> ForceModel::verlet_step(double step, ClothState& state, Work& power) {
  if (!steps_verlet()) return std::nullopt;
  ++evaluations_;
  const double squares = sweep_->verlet(step, sweep_loads({}), position_force_, state);
  power = power_after(squares);
  return squares;
}

void ForceModel::verlet_steps(double step, std::span<double> squares, ClothState& state) {
  assert(steps_verlet());
  evaluations_ += static_cast<std::int64_t>(squares.size());
  sweep_->verlet_steps(step, sweep_loads({}), squares, position_force_, state);
}

std::optional<double> ForceModel::runge_kutta_step(const std::array<double, 4>& times, double step,
                                                   ClothState& state, Work& work) {
  if (!can_step() || steps_with_load()) return std::nullopt;
  double squares = 0;
  sweep_runge_kutta(times, step, {&squares, 1}, state, work);
  return squares;
}

void ForceModel::runge_kutta_steps(double step, std::span<double> squares, ClothState& state, Work& work) {
  assert(gains_steps_at_once());
  constexpr std::array<double, 4> any_times{};
  sweep_runge_kutta(any_times, step, squares, state, work);
}

void ForceModel::sweep_runge_kutta(const std::array<double, 4>& times, double step, std::span<double> squares,
                                   ClothState& state, Work& work) {
  evaluations_ += 4 * static_cast<std::int64_t>(squares.size());
  constexpr std::array weights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  stage_sums_.resize(squares.size());
  sweep_->runge_kutta(step, sweep_loads(times), stage_sums_, state);
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const StageSums& sums = stage_sums_[k];
    double loss = 0, given = 0;
    for (std::size_t s = 0; s < weights.size(); ++s) {
      loss += weights[s] * (viscous_ * sums.squares[s] + sums.dampers[s]);
      given += weights[s] * sums.air[s];
    }
    work.damping_loss += step * loss;
    work.air += step * given;
    squares[k] = sums.after;
  }
}

void ForceModel::copy(const ClothState& from, ClothState& to) {
  if (sweep_)
    sweep_->copy(from, to);
  else
    to = from;
}

void ForceModel::set_team(WorkerTeam* team, ThreadUse use) {
  team_ = team, thread_use_ = use;
  if (sweep_) sweep_->set_team(team, use);
}

int ForceModel::threads() const {
  return sweep_ ? sweep_->threads() : 1;
}

void ForceModel::update_external(const Vec3Field& position, double time) {
  ++evaluations_;
  clear(position_force_, position.size());
  for (const auto& force : forces_)
    if (!force->is_internal()) force->update(*system_, position, time, position_force_);
  if (pull_) pull_->update(*system_, position, time, position_force_);
}

NodeDamping ForceModel::damping_parts() const {
  NodeDamping parts;
  for (const auto& force : forces_) force->add_node_damping(parts);
  if (pull_) pull_->add_node_damping(parts);
  return parts;
}

bool ForceModel::is_swept(const Force& force) const {
  return sweeps_dampers() && &force == spring_damping_;
}

/// product = D v of the dampers along springs where a sweep computes them, else 0. Returns what they take, in
/// W.
double ForceModel::swept_dampers(const Vec3Field& position, const Vec3Field& velocity,
                                 Vec3Field& product) const {
  if (sweeps_dampers()) {
    if (product.size() != velocity.size()) product = Vec3Field(velocity.size());
    return sweep_->damp(spring_damping_->damping(), position, velocity, product);
  }
  clear(product, velocity.size());
  return 0;
}

/// product = D v. Returns the part of swept_dampers().
double ForceModel::damping_product(const Vec3Field& position, const Vec3Field& velocity,
                                   Vec3Field& product) const {
  const double dampers = swept_dampers(position, velocity, product);
  for (const auto& force : forces_)
    if (!is_swept(*force)) force->add_damping(position, velocity, product);
  if (pull_) pull_->add_damping(position, velocity, product);
  return dampers;
}

void ForceModel::force(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const {
  if (!has_damping_) {
    result = position_force_;
    return;
  }
  damping_product(position, velocity, result);
  subtract_from(position_force_, result);
}

Work ForceModel::force_and_power(const Vec3Field& position, const Vec3Field& velocity,
                                 Vec3Field& result) const {
  if (!sweeps_dampers()) {
    force(position, velocity, result);
    return has_power_ ? power(position, velocity) : Work{};
  }
  Work power{.damping_loss = damping_product(position, velocity, result)};
  subtract_from(position_force_, result);
  power += power_beside_dampers(position, velocity);
  return power;
}

Work ForceModel::power(const Vec3Field& position, const Vec3Field& velocity) const {
  Work power;
  if (sweeps_dampers()) power.damping_loss = swept_dampers(position, velocity, product_);
  power += power_beside_dampers(position, velocity);
  return power;
}

/// Without that of dampers along springs where a sweep computes them.
Work ForceModel::power_beside_dampers(const Vec3Field& position, const Vec3Field& velocity) const {
  Work power;
  if (can_step() && !has_load()) {  // to the bits of a whole step
    if (viscous_ > 0) power.damping_loss = viscous_ * sweep_->squares(velocity);
    return power;
  }
  for (const auto& force : forces_)
    if (!is_swept(*force)) force->add_power(position, velocity, power);
  if (pull_) pull_->add_power(position, velocity, power);
  return power;
}

void ForceModel::linearise(const Vec3Field& position, const LinearisationWeights& weights,
                           Linearisation& result) const {
  std::size_t springs = 0;
  for (const SpringRun& run : system_->springs) springs += static_cast<std::size_t>(run.count);
  result.nodes.assign(position.size(), {});
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double m = system_->mass[i];
    result.nodes.set(i, {m, 0, 0, m, 0, m});
  }
  result.springs.assign(springs, {});
  result.has_compressed = false;
  for (const auto& force : forces_) force->add_linearisation(*system_, position, weights, result);
  if (pull_) pull_->add_linearisation(*system_, position, weights, result);
}

bool ForceModel::has_asymmetric_part() const {
  return std::any_of(forces_.begin(), forces_.end(),
                     [](const auto& force) { return force->has_asymmetric_part(); });
}

void ForceModel::asymmetric_product(const Vec3Field& position, const Vec3Field& velocity,
                                    const Vec3Field& direction, Vec3Field& product) const {
  product.fill(0);
  for (const auto& force : forces_)
    if (force->has_asymmetric_part())
      force->add_asymmetric_product(*system_, position, velocity, direction, product);
}

void ForceModel::set_brush(const std::optional<BrushGust>& brush) {
  if (air_) air_->set_brush(brush);
}

void ForceModel::set_pull(const std::optional<Pull>& pull, double stiffness, double damping) {
  pull_ = pull && !system_->pinned[static_cast<std::size_t>(pull->particle)]
              ? std::make_unique<PullForce>(*pull, stiffness, damping)
              : nullptr;
  note_kinds();
}

}  // namespace cloth
