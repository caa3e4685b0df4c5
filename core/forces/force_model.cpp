#include "forces/force_model.h"

#include <algorithm>

#include "forces/air.h"
#include "forces/gravity.h"
#include "forces/pull_force.h"
#include "forces/springs.h"
#include "forces/viscous.h"

namespace cloth {

ForceModel::ForceModel(const Scene& scene, const ClothSystem& system)
    : system_(&system), position_force_(static_cast<std::size_t>(system.size())) {
  if (scene.gravity && scene.gravity->squaredNorm() > 0)
    forces_.push_back(std::make_unique<Gravity>(*scene.gravity));
  if (!system.springs.empty()) forces_.push_back(std::make_unique<SpringForce>(system));
  if (!system.springs.empty() && scene.springs->damping > 0)
    forces_.push_back(std::make_unique<SpringDamping>(scene.springs->damping));
  if (scene.damping && *scene.damping > 0)
    forces_.push_back(std::make_unique<ViscousDamping>(*scene.damping));
  if (scene.air && scene.air->drag > 0) {
    auto air = std::make_unique<AirForce>(*scene.air);
    air_ = air.get();
    forces_.push_back(std::move(air));
  }
  note_kinds();
}

ForceModel::~ForceModel() = default;
ForceModel::ForceModel(ForceModel&&) noexcept = default;
ForceModel& ForceModel::operator=(ForceModel&&) noexcept = default;

void ForceModel::add(std::unique_ptr<Force> force) {
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
  position_force_.fill(0);
  for (const auto& force : forces_) force->update(*system_, position, time, position_force_);
  if (pull_) pull_->update(*system_, position, time, position_force_);
}

void ForceModel::update_external(const Vec3Field& position, double time) {
  ++evaluations_;
  position_force_.fill(0);
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

void ForceModel::damping_product(const Vec3Field& velocity, Vec3Field& product) const {
  product.fill(0);
  for (const auto& force : forces_) force->add_damping(velocity, product);
  if (pull_) pull_->add_damping(velocity, product);
}

void ForceModel::force(const Vec3Field& velocity, Vec3Field& result) const {
  if (!has_damping_) {
    result = position_force_;
    return;
  }
  damping_product(velocity, result);
  const auto p = position_force_.flat();
  const auto f = result.flat();
  for (std::size_t k = 0; k < f.size(); ++k) f[k] = p[k] - f[k];
}

Work ForceModel::power(const Vec3Field& velocity) const {
  Work power;
  for (const auto& force : forces_) force->add_power(velocity, power);
  if (pull_) pull_->add_power(velocity, power);
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
