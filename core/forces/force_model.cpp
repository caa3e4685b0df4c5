#include "forces/force_model.h"

#include <algorithm>

#include "cloth/sums.h"
#include "forces/pull_force.h"
#include "forces/registry.h"
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

std::unique_ptr<SpringSweep> sweep_for(const ClothSystem& system) {
  if (!system.membrane.empty()) return nullptr;
  const auto grid = system.bending.empty() ? grid_springs(system) : std::nullopt;
  if (grid) return std::make_unique<GridSweep>(system, *grid, common_mass(system));
  if (auto layout = cell_layout(system)) return std::make_unique<GridSweep>(system, std::move(*layout));
  if (suits_mesh_layout(system)) return std::make_unique<MeshSweep>(system, common_mass(system));
  return nullptr;
}

}  // namespace

ForceModel::ForceModel(const Scene& scene, const ClothSystem& system) : system_(&system) {
  for (const ForceEntry& entry : force_registry())
    if (auto force = entry.make(scene, system)) {
      forces_.push_back(std::move(force));
      if (entry.work == &Work::damping_loss) has_damping_loss_ = true;
      if (entry.work == &Work::hysteresis_loss) with_history_ = forces_.back().get();
    }
  system_changed();
  set_history({}, system.start);
}

void ForceModel::system_changed() {
  sweep_ = sweep_for(*system_);
  sort_forces();
}

/// Which forces the kernels compute, and which kinds there are.
void ForceModel::sort_forces() {
  swept_ = {.uniform_mass = sweep_ && sweep_->has_common_mass()};
  swept_.has_shares = sweep_ && sweep_->has_shares();
  swept_.takes_sliders = sweep_ && sweep_->takes_sliders();
  if (swept_.uniform_mass) swept_.mass = sweep_->mass();
  const bool takes_air = sweep_ && sweep_->takes_air();
  apart_.clear();
  apart_from_steps_.clear();
  has_damping_ = has_power_ = pull_ != nullptr;
  for (const auto& force : forces_) {
    const KernelCoverage coverage = force->join(swept_);
    if (coverage != KernelCoverage::every_pass) apart_.push_back(force.get());
    const bool in_steps =
        coverage == KernelCoverage::every_pass || (coverage == KernelCoverage::whole_steps && takes_air);
    if (!in_steps) apart_from_steps_.push_back(force.get());
    NodeDamping damping;
    const bool coupled = !force->add_node_damping(damping);
    if (coupled || !damping.isotropic.is_zero() || !damping.along_normal.is_zero())
      has_damping_ = has_power_ = true;
  }
  if (!takes_air) swept_.air = nullptr;
}

void ForceModel::add(std::unique_ptr<Force> force) {
  forces_.push_back(std::move(force));
  sort_forces();
}

void ForceModel::update(const Vec3Field& position, double time) {
  if (!sweep_) {
    clear(position_force_, position.size());
    for_each_force([&](Force& force) { force.update(*system_, position, time, position_force_); });
    return;
  }
  const bool has_load = pull_ || !apart_.empty();
  if (has_load) {
    clear(position_force_, position.size());
    for (Force* force : apart_) force->update(*system_, position, time, position_force_);
    if (pull_) pull_->update(*system_, position, time, position_force_);
  } else if (position_force_.size() != position.size()) {
    position_force_ = Vec3Field(position.size());
  }
  sweep_->evaluate(
      {.weight = weight(), .load = has_load ? &position_force_ : nullptr, .sliders = swept_.sliders},
      position, position_force_);
}

double ForceModel::stored_energy(const Vec3Field& position) const {
  if (swept_.sliders) return sweep_->slider_energy(*swept_.sliders, position);
  return with_history_ ? with_history_->stored_energy(position) : 0;
}

double ForceModel::end_step(const Vec3Field& position, Vec3Field* held) {
  if (swept_.sliders) return sweep_->end_sliders(*swept_.sliders, position, held);
  return with_history_ ? with_history_->end_step(position, held) : 0;
}

/// With the normals of the pass that will take them at the end of each step: to the bit what they were.
void ForceModel::set_history(const std::vector<double>& history, const Vec3Field& position) {
  if (!with_history_) return;
  with_history_->set_history(history, position);
  if (swept_.sliders) sweep_->take_slider_normals(*swept_.sliders, position);
}

Vec3 ForceModel::weight() const {
  return swept_.uniform_mass ? Vec3(sweep_->mass() * swept_.gravity) : Vec3(Vec3::Zero());
}

Work ForceModel::step_load(const Vec3Field& position, const Vec3Field& velocity, double time,
                           Vec3Field& load) {
  clear(load, position.size());
  clear(product_, position.size());
  Work power;
  const auto add = [&](Force& force) {
    force.update(*system_, position, time, load);
    force.add_damping(position, velocity, product_);
    force.add_power(position, velocity, power);
  };
  for (Force* force : apart_from_steps_) add(*force);
  if (pull_) add(*pull_);
  const auto to = load.flat();
  const auto damping = product_.flat();
  for (std::size_t k = 0; k < to.size(); ++k) to[k] -= damping[k];
  return power;
}

void ForceModel::update_external(const Vec3Field& position, double time) {
  clear(position_force_, position.size());
  for_each_force([&](Force& force) {
    if (!force.is_internal()) force.update(*system_, position, time, position_force_);
  });
}

NodeDamping ForceModel::damping_parts() const {
  NodeDamping parts;
  for_each_force([&](Force& force) { force.add_node_damping(parts); });
  return parts;
}

bool ForceModel::couples_particles() const {
  NodeDamping unused;
  return std::any_of(forces_.begin(), forces_.end(),
                     [&](const auto& force) { return !force->add_node_damping(unused); });
}

/// product = D v of the dampers of springs and bending that a sweep computes, else 0. Returns what they take,
/// in W.
double ForceModel::swept_dampers(const Vec3Field& position, const Vec3Field& velocity,
                                 Vec3Field& product) const {
  if (sweeps_dampers()) {
    if (product.size() != velocity.size()) product = Vec3Field(velocity.size());
    return sweep_->damp({.spring_damping = swept_.spring_damping,
                         .stretch_time = swept_.stretch_time,
                         .bending_time = swept_.bending_time},
                        position, velocity, product);
  }
  clear(product, velocity.size());
  return 0;
}

double ForceModel::coupled_damping(const Vec3Field& position, const Vec3Field& velocity,
                                   Vec3Field& product) const {
  const double dampers = swept_dampers(position, velocity, product);
  bool is_all = sweeps_dampers() && !pull_;
  for (const auto& force : forces_) {
    NodeDamping unused;
    if (is_damped_by_sweep(*force) || force->add_node_damping(unused)) continue;
    force->add_damping(position, velocity, product);
    is_all = false;
  }
  if (pull_) pull_->add_damping(position, velocity, product);
  return is_all ? dampers : dot(velocity.flat(), product.flat());
}

/// product = D v. Returns the part of swept_dampers().
double ForceModel::damping_product(const Vec3Field& position, const Vec3Field& velocity,
                                   Vec3Field& product) const {
  const double dampers = swept_dampers(position, velocity, product);
  for_each_force([&](Force& force) {
    if (!is_damped_by_sweep(force)) force.add_damping(position, velocity, product);
  });
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
  if (!has_damping_) {
    result = position_force_;
    return has_power_ ? power(position, velocity) : Work{};
  }
  Work power{.damping_loss = damping_product(position, velocity, result)};
  subtract_from(position_force_, result);
  add_power_beside_dampers(position, velocity, power);
  return power;
}

Work ForceModel::power(const Vec3Field& position, const Vec3Field& velocity) const {
  Work power;
  if (sweeps_dampers()) power.damping_loss = swept_dampers(position, velocity, product_);
  add_power_beside_dampers(position, velocity, power);
  return power;
}

/// Without that of dampers that a sweep computes.
void ForceModel::add_power_beside_dampers(const Vec3Field& position, const Vec3Field& velocity,
                                          Work& power) const {
  for_each_force([&](Force& force) {
    if (!is_damped_by_sweep(force)) force.add_power(position, velocity, power);
  });
}

void ForceModel::linearise(const Vec3Field& position, const LinearisationWeights& weights,
                           Linearisation& result) const {
  result.nodes.assign(position.size(), {});
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double m = system_->mass[i];
    result.nodes.set(i, {m, 0, 0, m, 0, m});
  }
  result.springs.assign(system_->springs.spring_count(), {});
  result.bending = result.membrane = 0;
  result.slider_slope.clear();
  result.has_compressed = false;
  for_each_force([&](Force& force) { force.add_linearisation(*system_, position, weights, result); });
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

bool ForceModel::has_normals() const {
  return std::any_of(forces_.begin(), forces_.end(), [](const auto& force) { return force->has_normals(); });
}

void ForceModel::hold_normals(bool hold) {
  for (const auto& force : forces_) force->hold_normals(hold);
}

void ForceModel::set_team(WorkerTeam* team, ThreadUse use) {
  solve_job_.set_team(team, use);
  for (const auto& force : forces_) force->set_team(team, use);
}

void ForceModel::set_brush(const std::optional<BrushGust>& brush) {
  for (const auto& force : forces_) force->set_brush(brush);
  sort_forces();
}

void ForceModel::set_pull(const std::optional<Pull>& pull, double stiffness, double damping) {
  pull_ = pull && !system_->pinned[static_cast<std::size_t>(pull->particle)]
              ? std::make_unique<PullForce>(*pull, stiffness, damping)
              : nullptr;
  sort_forces();
}

}  // namespace cloth
