#include "contact/contact_solver.h"

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
  add_impulse(contact, inverse_mass, contact.normal_impulse * contact.normal + contact.friction_impulse,
              value);
}

int ContactSolver::slot_of(int particle, const Vec3Field& value) {
  int& slot = slot_[at(particle)];
  if (slot < 0) {
    slot = static_cast<int>(particle_.size());
    const Vec3 v = value[at(particle)];
    particle_.push_back(particle), contacts_of_.push_back(0);
    values_.push_back({{v.x(), v.y(), v.z(), 0}});
  }
  return slot;
}

void ContactSolver::gather(std::span<const ContactConstraint> contacts,
                           const std::vector<double>& inverse_mass, const Vec3Field& value) {
  slot_.resize(value.size(), -1);
  particle_.assign(1, -1), contacts_of_.assign(1, 0), values_.assign(1, {});
  rows_.clear(), contact_of_.clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactConstraint& contact = contacts[c];
    if (!(contact.mobility > 0)) continue;
    ContactRow& row = rows_.emplace_back(row_of(contact));
    contact_of_.push_back(c);
    for (std::size_t k = 0; k < at(contact.count); ++k) {
      if (contact.weight[k] == 0) continue;
      const int particle = contact.particle[k];
      row.slot[k] = slot_of(particle, value);
      row.weight[k] = contact.weight[k], row.response[k] = contact.weight[k] * inverse_mass[at(particle)];
      if (row.response[k] != 0) ++contacts_of_[at(row.slot[k])];
    }
  }
  alone_.clear(), coupled_.clear();
  for (int r = 0; r < static_cast<int>(rows_.size()); ++r) {
    const ContactRow& row = rows_[at(r)];
    bool shares = false;
    for (std::size_t k = 0; k < 4; ++k) shares = shares || contacts_of_[at(row.slot[k])] > 1;
    (shares ? coupled_ : alone_).push_back(r);
  }
}

/// The coupled rows with a particle that the last sweep has moved.
void ContactSolver::order_moved() {
  active_.clear();
  for (const int r : coupled_) {
    const auto& slot = rows_[at(r)].slot;
    if (moved_[at(slot[0])] | moved_[at(slot[1])] | moved_[at(slot[2])] | moved_[at(slot[3])])
      active_.push_back(r);
  }
}

int ContactSolver::sweep(const SolveLimits& limits) {
  const RelaxKernels& kernels = active_kernels<RelaxKernels>();
  const auto relax = [&](const std::vector<int>& order) {
    kernels.relax(rows_.data(), order.data(), static_cast<int>(order.size()), values_.data());
  };
  relax(alone_);
  if (coupled_.empty()) return 1;
  before_ = values_;
  moved_.assign(values_.size(), 1);
  bool is_whole = true;
  for (int sweep = 1, whole = 0; sweep <= limits.sweeps; ++sweep) {
    is_whole = is_whole || sweep - whole >= whole_sweep_after;
    if (is_whole)
      whole = sweep;
    else
      order_moved();
    relax(is_whole ? coupled_ : active_);
    const bool any =
        kernels.note_moved(values_.data(), before_.data(), moved_.data(), static_cast<int>(values_.size()),
                           limits.tolerance * limits.tolerance);
    if (!any && is_whole) return sweep;
    is_whole = !any;
  }
  return limits.sweeps;
}

void ContactSolver::scatter(std::span<ContactConstraint> contacts, Vec3Field& value) const {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ContactRow& row = rows_[r];
    ContactConstraint& contact = contacts[contact_of_[r]];
    contact.normal_impulse = row.normal_impulse;
    contact.friction_impulse = {row.friction_impulse[0], row.friction_impulse[1], row.friction_impulse[2]};
  }
  for (std::size_t k = 1; k < values_.size(); ++k)
    value.set(at(particle_[k]), {values_[k].of[0], values_[k].of[1], values_[k].of[2]});
}

int ContactSolver::solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                         const SolveLimits& limits, Vec3Field& value) {
  gather(contacts, inverse_mass, value);
  const int sweeps = sweep(limits);
  scatter(contacts, value);
  for (std::size_t k = 1; k < particle_.size(); ++k) slot_[at(particle_[k])] = -1;
  return sweeps;
}

}  // namespace cloth
