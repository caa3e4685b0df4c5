#include "contact/stiff_target.h"

#include <algorithm>
#include <cmath>

#include "cloth/sums.h"
#include "geometry/at.h"
#include "integrators/integrator.h"

namespace cloth {

/// m, positive where the constraint is violated.
static double missing(const ContactConstraint& contact, const Vec3Field& position) {
  return contact.bound - contact.normal.dot(contact.point(position));
}

/// N, with the penalty.
double StiffTarget::load_at(std::size_t contact, const Vec3Field& position) const {
  if (!(contacts_[contact].mobility > 0)) return 0;
  return std::max(0.0, load_[contact] + penalty_[contact] * missing(contacts_[contact], position));
}

double StiffTarget::largest_violation(std::span<const ContactConstraint> contacts,
                                      const Vec3Field& position) {
  double largest = 0;
  for (const ContactConstraint& contact : contacts)
    if (contact.mobility > 0) largest = std::max(largest, missing(contact, position));
  return largest;
}

/// A penalty is ten times the largest inertia, M/w^2, that it adds to; where contacts are of one particle
/// each also a part of what springs resist, with which the loads come to their values in fewer iterations.
void StiffTarget::add_penalties(const ClothSystem& system, double weight, const Vec3Field& position,
                                Linearisation& matrix) {
  constexpr double part = 10, part_of_resistance = 0.2;
  const double square = weight * weight;
  size_.resize(position.size());
  for (std::size_t i = 0; i < size_.size(); ++i) {
    const SymmetricBlock node = matrix.nodes[i];
    size_[i] = system.pinned[i] ? 0 : (node.xx + node.yy + node.zz) / 3;
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const ContactConstraint& contact = contacts_[c];
    double largest = 0, weights = 0;
    for (std::size_t k = 0; k < at(contact.count); ++k) {
      largest = std::max(largest, size_[at(contact.particle[k])]);
      weights += std::abs(contact.weight[k]);
    }
    penalty_[c] = part * largest / square + part_of_resistance * resistance_;
    if (!(load_at(c, position) > 0)) continue;
    for (std::size_t k = 0; k < at(contact.count); ++k)
      matrix.nodes.add(
          at(contact.particle[k]),
          block_along(0, square * penalty_[c] * weights * std::abs(contact.weight[k]), contact.normal));
  }
}

/// What the forces, the inertia and the contacts together push the particles with.
void StiffTarget::find_push(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                            const Vec3Field& position) {
  solver_.find_residual(system, forces, step, position, push_);
  for (double& value : push_.flat()) value = -value;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double load = load_at(c, position);
    if (!(load > 0)) continue;
    const ContactConstraint& contact = contacts_[c];
    for (std::size_t k = 0; k < at(contact.count); ++k) {
      const auto i = at(contact.particle[k]);
      if (!system.pinned[i]) push_.add(i, contact.weight[k] * load * contact.normal);
    }
  }
}

bool StiffTarget::find_direction(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                                 const Vec3Field& position) {
  add_penalties(system, step.weight, position, solver_.linearise(system, forces, step, position));
  find_push(system, forces, step, position);
  right_ = push_;
  for (double& value : right_.flat()) value *= step.weight * step.weight;
  return solver_.solve(system, position, right_, direction_);
}

/// Along the direction to where what is left of the equation, along it, is next to 0: were its sign let turn
/// by more, constraints that act in turns would keep the method from ending.
void StiffTarget::move(const ClothSystem& system, ForceModel& forces, const LongStep& step, double before,
                       Vec3Field& position) {
  constexpr int most_trials = 6;
  constexpr double accepted = 0.2, least = 0.1;
  start_ = position;
  double length = 1;
  for (int trial = 1;; ++trial) {
    position = start_;
    add_scaled(length, direction_, position);
    find_push(system, forces, step, position);
    const double after = dot(direction_.flat(), push_.flat());
    if (trial == most_trials || after >= -accepted * before) return;
    length *= std::max(least, before / (before - after));
  }
}

void StiffTarget::update_loads(const Vec3Field& position) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) load_[c] = load_at(c, position);
}

bool StiffTarget::solve(const ClothSystem& system, ForceModel& forces,
                        std::span<const ContactConstraint> contacts, const LongStep& step, double accepted,
                        Vec3Field& position, const Renewal& renewed) {
  const int most_iterations = step.rate ? 60 : 20;
  constexpr double least_work = 1e-3;     // of the first iteration's, and
  constexpr double least_missing = 0.01;  // of the first violation, where contacts stay: ends below both
  contacts_ = contacts;
  const double first_missing = largest_violation(contacts, position);
  const auto keeps_rate = [&] { return !step.rate || step.rate->keeps(position); };
  load_.assign(contacts.size(), 0.0);
  if (!(first_missing > accepted) && keeps_rate()) return false;
  if (push_.size() != position.size()) push_ = direction_ = right_ = Vec3Field(position.size());
  integrated_position_ = position;
  solver_.begin(forces, step, position);
  resistance_ = renewed ? largest_resistance(system, step.weight) : 0;
  penalty_.assign(contacts.size(), 0.0);
  const double most_missing = renewed ? accepted : std::max(accepted, least_missing * first_missing);
  double first = 0;  // J
  for (int n = 0; n < most_iterations; ++n) {
    if (!find_direction(system, forces, step, position)) break;
    const double before = dot(direction_.flat(), push_.flat());
    if (n == 0) first = before;
    if (before <= least_work * first && keeps_rate() &&
        largest_violation(contacts_, position) <= most_missing)
      break;
    move(system, forces, step, before, position);
    update_loads(position);
    if (step.rate) step.rate->update(position);
    if (!renewed) continue;
    contacts_ = renewed(position);
    load_.resize(contacts_.size()), penalty_.resize(contacts_.size());
  }
  contacts_ = {};
  const auto values = position.flat();
  if (std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) return true;
  position = integrated_position_;  // contact begins where the method ended
  load_.assign(load_.size(), 0.0);
  return false;
}

}  // namespace cloth
