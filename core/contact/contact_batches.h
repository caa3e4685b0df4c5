// Contacts that share particles, packed for vectors: colours of contacts that move no particle in common,
// taken one after the other, the contacts of each side by side (relax_kernels.h).
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "contact/contact_constraint.h"
#include "contact/relax_kernels.h"

namespace cloth {

/// When a solve ends, and what takes part in it.
struct SolveLimits {
  int sweeps = 100;      ///< at most so many
  double tolerance = 0;  ///< m or m/s: of no particle did a sweep change the value by more
  /// m or m/s: a contact without an impulse that keeps its bound by more is left out until the solution of
  /// the others violates it.
  double margin = std::numeric_limits<double>::infinity();
};

class ContactBatches {
 public:
  /// Without contacts, of so many particles.
  void clear(std::size_t particles);
  /// `number`: of the contact in the arguments of the others.
  void add(std::size_t number, const ContactConstraint& contact, const std::vector<double>& inverse_mass);
  /// After the last one.
  void arrange(std::span<const ContactConstraint> contacts, const std::vector<double>& inverse_mass);
  bool is_empty() const { return rows_.empty(); }
  /// Relaxes the contacts sweep by sweep. In and out: their impulses, and `value`, which contains their
  /// effect. Of the contacts nothing else may have changed since arrange(). Where few particles moved in the
  /// last sweep, contacts of none of them are left out of the next, except in every fourth sweep and in the
  /// one that ends the solve. Returns the sweeps.
  int solve(std::span<ContactConstraint> contacts, const SolveLimits& limits, Vec3Field& value);

 private:
  struct Row {
    std::size_t contact;
    int colour;
    int place;  ///< in the batches, one after the other
    std::array<int, 4> slot;
  };
  int slot_of(int particle);
  int take_colour(const Row& row, const ContactConstraint& contact, const std::vector<double>& inverse_mass);
  void order_moved();
  int sweep(const SolveLimits& limits);

  std::vector<Row> rows_;
  std::vector<int> slot_;      ///< of each particle, -1: no contact has it
  std::vector<int> particle_;  ///< of each slot; of the first ones, which belong to none, -1
  std::vector<std::uint64_t>
      colours_of_;                 ///< of each slot, the first colours of contacts that move it, a bit each
  std::vector<int> colour_after_;  ///< of each slot, one that none of its contacts has, nor any after it
  std::vector<int> next_place_;    ///< of each colour
  std::vector<ContactValue> values_, before_;
  std::vector<unsigned char> moved_;  ///< of each slot, in the last sweep
  std::vector<ContactBatch> batches_;
  std::vector<int> all_, active_;  ///< batches
};

}  // namespace cloth
