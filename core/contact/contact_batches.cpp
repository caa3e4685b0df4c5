#include "contact/contact_batches.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int whole_sweep_after = 4;  ///< sweeps
constexpr int width = ContactBatch::width;

/// Where a contact stands in its batch.
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
  for (int axis = 0; axis < 3; ++axis)
    lane.four.normal[axis][k] = contact.normal[axis], lane.four.rest[axis][k] = contact.rest[axis];
  lane.four.bound[k] = contact.bound, lane.four.rest_level[k] = contact.normal.dot(contact.rest);
  lane.four.inverse_mobility[k] = 1 / contact.mobility, lane.four.friction[k] = contact.friction;
}

void write_impulses(Lane lane, const ContactConstraint& contact) {
  lane.four.normal_impulse[lane.of] = contact.normal_impulse;
  for (int axis = 0; axis < 3; ++axis)
    lane.four.friction_impulse[axis][lane.of] = contact.friction_impulse[axis];
}

void read_impulses(const Lane& lane, ContactConstraint& contact) {
  contact.normal_impulse = lane.four.normal_impulse[lane.of];
  for (int axis = 0; axis < 3; ++axis)
    contact.friction_impulse[axis] = lane.four.friction_impulse[axis][lane.of];
}

}  // namespace

void ContactBatches::clear(std::size_t particles) {
  rows_.clear();
  for (std::size_t k = ContactBatch::spare; k < particle_.size(); ++k) slot_[at(particle_[k])] = -1;
  slot_.resize(particles, -1);
  particle_.assign(ContactBatch::spare, -1);
  colours_of_.assign(ContactBatch::spare, 0), colour_after_.assign(ContactBatch::spare, 0);
  next_place_.clear();
}

int ContactBatches::slot_of(int particle) {
  int& slot = slot_[at(particle)];
  if (slot < 0) {
    slot = static_cast<int>(particle_.size());
    particle_.push_back(particle), colours_of_.push_back(0), colour_after_.push_back(0);
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
                         const std::vector<double>& inverse_mass) {
  Row& row = rows_.emplace_back(Row{number, 0, 0, {}});
  for (std::size_t k = 0; k < at(contact.count); ++k)
    if (contact.weight[k] != 0) row.slot[k] = slot_of(contact.particle[k]);
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
    write(lane, contact);
    for (int k = 0; k < 4; ++k) {
      const double weight = k < contact.count ? contact.weight[at(k)] : 0;
      lane.four.slot[lane.of][k] = weight != 0 ? row.slot[at(k)] : lane.spare + k;
      lane.four.weight[lane.of][k] = weight;
      lane.four.response[lane.of][k] = weight != 0 ? weight * inverse_mass[at(contact.particle[at(k)])] : 0;
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
  const int slots = static_cast<int>(values_.size()), few = (slots - ContactBatch::spare) / 2;
  bool is_whole = true;
  for (int sweep = 1, whole = 0, moved = slots; sweep <= limits.sweeps; ++sweep) {
    is_whole = is_whole || moved > few || sweep - whole >= whole_sweep_after;
    if (is_whole)
      whole = sweep;
    else
      order_moved();
    const std::vector<int>& order = is_whole ? all_ : active_;
    kernels.relax(batches_.data(), order.data(), static_cast<int>(order.size()), values_.data());
    moved = kernels.note_moved(values_.data(), before_.data(), moved_.data(), slots,
                               limits.tolerance * limits.tolerance);
    if (moved == 0 && is_whole) return sweep;
    is_whole = moved == 0;
  }
  return limits.sweeps;
}

int ContactBatches::solve(std::span<ContactConstraint> contacts, const SolveLimits& limits,
                          Vec3Field& value) {
  values_.assign(particle_.size(), {});
  for (std::size_t k = ContactBatch::spare; k < values_.size(); ++k) {
    const Vec3 v = value[at(particle_[k])];
    values_[k] = {{v.x(), v.y(), v.z(), 0}};
  }
  for (const Row& row : rows_) write_impulses(Lane(batches_, row.place), contacts[row.contact]);
  const int sweeps = sweep(limits);
  for (const Row& row : rows_) read_impulses(Lane(batches_, row.place), contacts[row.contact]);
  for (std::size_t k = ContactBatch::spare; k < values_.size(); ++k)
    value.set(at(particle_[k]), {values_[k].of[0], values_[k].of[1], values_[k].of[2]});
  return sweeps;
}

}  // namespace cloth
