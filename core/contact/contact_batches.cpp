#include "contact/contact_batches.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int whole_sweep_after = 4;  ///< sweeps
constexpr int width = ContactBatch::width;

/// One of the four contacts.
struct Lane {
  Lane(std::vector<ContactBatch>& batches, int place)
      : four(batches[at(place / width)].four[place % width / 4]), of(place % 4), spare(place % width * 4) {}

  FourContacts& four;
  int of;
  int spare;  ///< the first of its slots that belong to no particle
};

void clear(Lane lane) {
  const int k = lane.of;
  for (int j = 0; j < 4; ++j)
    lane.four.weight[k][j] = lane.four.response[k][j] = 0, lane.four.slot[k][j] = lane.spare + j;
  for (int axis = 0; axis < 3; ++axis)
    lane.four.normal[axis][k] = lane.four.rest[axis][k] = lane.four.friction_impulse[axis][k] = 0;
  lane.four.bound[k] = lane.four.rest_level[k] = lane.four.inverse_mobility[k] = 0;
  lane.four.friction[k] = lane.four.normal_impulse[k] = 0;
}

void write(Lane lane, const ContactConstraint& contact) {
  const int k = lane.of;
  for (int axis = 0; axis < 3; ++axis) {
    lane.four.normal[axis][k] = contact.normal[axis], lane.four.rest[axis][k] = contact.rest[axis];
    lane.four.friction_impulse[axis][k] = contact.friction_impulse[axis];
  }
  lane.four.bound[k] = contact.bound, lane.four.rest_level[k] = contact.normal.dot(contact.rest);
  lane.four.inverse_mobility[k] = 1 / contact.mobility;
  lane.four.friction[k] = contact.friction, lane.four.normal_impulse[k] = contact.normal_impulse;
}

void read(const Lane& lane, ContactConstraint& contact) {
  const int k = lane.of;
  contact.normal_impulse = lane.four.normal_impulse[k];
  for (int axis = 0; axis < 3; ++axis) contact.friction_impulse[axis] = lane.four.friction_impulse[axis][k];
}

}  // namespace

void ContactBatches::clear(std::size_t particles) {
  rows_.clear();
  slot_.resize(particles, -1);
  for (std::size_t k = ContactBatch::spare; k < particle_.size(); ++k) slot_[at(particle_[k])] = -1;
  particle_.assign(ContactBatch::spare, -1), values_.assign(ContactBatch::spare, {});
  colours_of_.assign(ContactBatch::spare, 0), colour_after_.assign(ContactBatch::spare, 0);
  next_place_.clear();
}

int ContactBatches::slot_of(int particle, const Vec3Field& value) {
  int& slot = slot_[at(particle)];
  if (slot < 0) {
    slot = static_cast<int>(particle_.size());
    const Vec3 v = value[at(particle)];
    particle_.push_back(particle), colours_of_.push_back(0), colour_after_.push_back(0);
    values_.push_back({{v.x(), v.y(), v.z(), 0}});
  }
  return slot;
}

/// The first colour that no other contact of its particles has; of those that have more than 64, one more.
int ContactBatches::take_colour(const Row& row, const ContactConstraint& contact,
                                const std::vector<double>& inverse_mass) {
  std::uint64_t taken = 0;
  int after = 0;
  const auto moves = [&](std::size_t k) {
    return contact.weight[k] != 0 && inverse_mass[at(contact.particle[k])] > 0;
  };
  for (std::size_t k = 0; k < at(contact.count); ++k)
    if (moves(k))
      taken |= colours_of_[at(row.slot[k])], after = std::max(after, colour_after_[at(row.slot[k])]);
  const int first_free = std::countr_one(taken), colour = first_free < 64 ? first_free : std::max(after, 64);
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    if (!moves(k)) continue;
    if (colour < 64) colours_of_[at(row.slot[k])] |= std::uint64_t{1} << colour;
    colour_after_[at(row.slot[k])] = std::max(after, colour + 1);
  }
  return colour;
}

void ContactBatches::add(std::size_t number, const ContactConstraint& contact,
                         const std::vector<double>& inverse_mass, const Vec3Field& value) {
  Row& row = rows_.emplace_back(Row{number, 0, 0, {}});
  for (std::size_t k = 0; k < at(contact.count); ++k)
    if (contact.weight[k] != 0) row.slot[k] = slot_of(contact.particle[k], value);
  row.colour = take_colour(row, contact, inverse_mass);
  if (next_place_.size() <= at(row.colour)) next_place_.resize(at(row.colour) + 1, 0);
  ++next_place_[at(row.colour)];
}

/// Each colour begins a batch; places that are left over at its end stay empty.
void ContactBatches::arrange(std::span<const ContactConstraint> contacts,
                             const std::vector<double>& inverse_mass) {
  int end = 0;
  for (int& next : next_place_) {
    const int count = next;
    next = end;
    end += (count + width - 1) / width * width;
  }
  batches_.resize(at(end / width));
  for (Row& row : rows_) row.place = next_place_[at(row.colour)]++;
  for (const int next : next_place_)
    for (int place = next; place % width != 0; ++place) cloth::clear(Lane(batches_, place));
  for (const Row& row : rows_) {
    const Lane lane(batches_, row.place);
    const ContactConstraint& contact = contacts[row.contact];
    cloth::clear(lane);
    write(lane, contact);
    for (std::size_t k = 0; k < at(contact.count); ++k) {
      if (contact.weight[k] == 0) continue;
      lane.four.slot[lane.of][k] = row.slot[k];
      lane.four.weight[lane.of][k] = contact.weight[k];
      lane.four.response[lane.of][k] = contact.weight[k] * inverse_mass[at(contact.particle[k])];
    }
  }
}

/// The batches with a particle that the last sweep has moved.
void ContactBatches::order_moved() {
  active_.clear();
  for (const int b : all_) {
    unsigned any = 0;
    for (const FourContacts& four : batches_[at(b)].four)
      for (const auto& slots : four.slot)
        for (const int slot : slots) any |= moved_[at(slot)];
    if (any) active_.push_back(b);
  }
}

int ContactBatches::sweep(const SolveLimits& limits) {
  const RelaxKernels& kernels = active_kernels<RelaxKernels>();
  all_.resize(batches_.size());
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
    kernels.relax(batches_.data(), order.data(), static_cast<int>(order.size()), values_.data());
    const bool any =
        kernels.note_moved(values_.data(), before_.data(), moved_.data(), static_cast<int>(values_.size()),
                           limits.tolerance * limits.tolerance);
    if (!any && is_whole) return sweep;
    is_whole = !any;
  }
  return limits.sweeps;
}

int ContactBatches::solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                          const SolveLimits& limits, Vec3Field& value) {
  arrange(contacts, inverse_mass);
  const int sweeps = sweep(limits);
  for (const Row& row : rows_) read(Lane(batches_, row.place), contacts[row.contact]);
  for (std::size_t k = ContactBatch::spare; k < values_.size(); ++k)
    value.set(at(particle_[k]), {values_[k].of[0], values_[k].of[1], values_[k].of[2]});
  return sweeps;
}

}  // namespace cloth
