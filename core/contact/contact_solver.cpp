#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

void add_impulse(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                 const Vec3& impulse, Vec3Field& value) {
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    const auto i = at(contact.particle[k]);
    value.add(i, contact.weight[k] * inverse_mass[i] * impulse);
  }
}

constexpr int whole_sweep_after = 4;  ///< sweeps

/// Of a contact whose particles have no other, this is the solution.
void relax_alone(ContactConstraint& contact, const std::vector<double>& inverse_mass, Vec3Field& value) {
  const Vec3 point = contact.point(value);
  const double inverse_mobility = 1 / contact.mobility, level = contact.normal.dot(point);
  const double change = std::max(contact.normal_impulse + (contact.bound - level) * inverse_mobility, 0.0) -
                        contact.normal_impulse;
  if (change == 0 && contact.normal_impulse == 0) return;
  contact.normal_impulse += change;
  Vec3 total = change * contact.normal;
  if (contact.friction > 0) {
    const Vec3 slip = point - contact.rest;
    const Vec3 across = slip - contact.normal.dot(slip) * contact.normal;
    Vec3 impulse = contact.friction_impulse - inverse_mobility * across;
    const double most = contact.friction * contact.normal_impulse, square = impulse.squaredNorm();
    if (square > most * most) impulse *= most / std::sqrt(square);
    total += impulse - contact.friction_impulse;
    contact.friction_impulse = impulse;
  }
  add_impulse(contact, inverse_mass, total, value);
}

ContactRow row_of(const ContactConstraint& contact) {
  ContactRow row{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    row.normal[axis] = contact.normal[k], row.rest[axis] = contact.rest[k];
    row.friction_impulse[axis] = contact.friction_impulse[k];
  }
  row.bound = contact.bound, row.rest_level = contact.normal.dot(contact.rest);
  row.inverse_mobility = 1 / contact.mobility;
  row.friction = contact.friction, row.normal_impulse = contact.normal_impulse;
  return row;
}

}  // namespace

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass) {
  double mobility = 0;
  for (std::size_t k = 0; k < at(contact.count); ++k)
    mobility += contact.weight[k] * contact.weight[k] * inverse_mass[at(contact.particle[k])];
  return mobility;
}

void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value) {
  if (contact.normal_impulse == 0 && contact.friction_impulse.isZero(0)) return;
  add_impulse(contact, inverse_mass, contact.normal_impulse * contact.normal + contact.friction_impulse,
              value);
}

void ContactSolver::count_contacts(std::span<const ContactConstraint> contacts,
                                   const std::vector<double>& inverse_mass) {
  contacts_of_.assign(inverse_mass.size(), 0);
  for (const ContactConstraint& contact : contacts)
    if (contact.mobility > 0)
      contact.for_each([&](std::size_t i) { contacts_of_[i] += inverse_mass[i] > 0 ? 1 : 0; });
}

int ContactSolver::slot_of(int particle, const Vec3Field& value) {
  int& slot = slot_[at(particle)];
  if (slot < 0) {
    slot = static_cast<int>(particle_.size());
    const Vec3 v = value[at(particle)];
    particle_.push_back(particle);
    values_.push_back({{v.x(), v.y(), v.z(), 0}});
  }
  return slot;
}

void ContactSolver::pack(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                         const Vec3Field& value) {
  ContactRow& row = rows_.emplace_back(row_of(contact));
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    if (contact.weight[k] == 0) continue;
    row.slot[k] = slot_of(contact.particle[k], value);
    row.weight[k] = contact.weight[k];
    row.response[k] = contact.weight[k] * inverse_mass[at(contact.particle[k])];
  }
}

/// The rows with a particle that the last sweep has moved.
void ContactSolver::order_moved() {
  active_.clear();
  for (const int r : all_) {
    const auto& slot = rows_[at(r)].slot;
    if (moved_[at(slot[0])] | moved_[at(slot[1])] | moved_[at(slot[2])] | moved_[at(slot[3])])
      active_.push_back(r);
  }
}

int ContactSolver::sweep(const SolveLimits& limits) {
  const RelaxKernels& kernels = active_kernels<RelaxKernels>();
  all_.resize(rows_.size());
  std::iota(all_.begin(), all_.end(), 0);
  before_ = values_;
  moved_.assign(values_.size(), 1);
  bool is_whole = true;
  for (int sweep = 1, whole = 0; sweep <= limits.sweeps; ++sweep) {
    is_whole = is_whole || sweep - whole >= whole_sweep_after;
    if (is_whole)
      whole = sweep;
    else
      order_moved();
    const std::vector<int>& order = is_whole ? all_ : active_;
    kernels.relax(rows_.data(), order.data(), static_cast<int>(order.size()), values_.data());
    const bool any =
        kernels.note_moved(values_.data(), before_.data(), moved_.data(), static_cast<int>(values_.size()),
                           limits.tolerance * limits.tolerance);
    if (!any && is_whole) return sweep;
    is_whole = !any;
  }
  return limits.sweeps;
}

void ContactSolver::unpack(std::span<ContactConstraint> contacts, Vec3Field& value) {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ContactRow& row = rows_[r];
    ContactConstraint& contact = contacts[contact_of_[r]];
    contact.normal_impulse = row.normal_impulse;
    contact.friction_impulse = {row.friction_impulse[0], row.friction_impulse[1], row.friction_impulse[2]};
  }
  for (std::size_t k = 1; k < values_.size(); ++k) {
    value.set(at(particle_[k]), {values_[k].of[0], values_[k].of[1], values_[k].of[2]});
    slot_[at(particle_[k])] = -1;
  }
}

int ContactSolver::solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                         const SolveLimits& limits, Vec3Field& value) {
  count_contacts(contacts, inverse_mass);
  slot_.resize(value.size(), -1);
  particle_.assign(1, -1), values_.assign(1, {});
  rows_.clear(), contact_of_.clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!(contacts[c].mobility > 0)) continue;
    if (contacts[c].any_of([&](std::size_t i) { return contacts_of_[i] > 1; })) {
      pack(contacts[c], inverse_mass, value);
      contact_of_.push_back(c);
    } else {
      relax_alone(contacts[c], inverse_mass, value);
    }
  }
  if (rows_.empty()) return 1;
  const int sweeps = sweep(limits);
  unpack(contacts, value);
  return sweeps;
}

}  // namespace cloth
