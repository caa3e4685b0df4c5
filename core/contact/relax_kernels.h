// The innermost loops of the contact solver (contact_solver.h). Only addition, subtraction, multiplication,
// division, square root and comparison are used, in one order and never contracted, so that every instruction
// set gives the same bits.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// The value (position or velocity) of a particle that contacts move; the fourth number is 0.
struct alignas(32) ContactValue {
  double of[4] = {0, 0, 0, 0};
};

/// Four contacts side by side: ContactConstraint with products made once. Of an empty place, and of the
/// particles that a contact does not have, all is 0 but the slots: theirs are those of values that belong to
/// no particle.
struct alignas(32) FourContacts {
  double weight[4][4];    ///< of each contact, of the particles' values in its point
  double response[4][4];  ///< weight times inverse mass, 1/kg: change of the values by an impulse
  int slot[4][4];         ///< of each contact, its particles in the array of values
  double normal[3][4], rest[3][4], friction_impulse[3][4];
  double bound[4], rest_level[4];  ///< rest_level: normal . rest
  double inverse_mobility[4], friction[4], normal_impulse[4];
};

/// Contacts none of which moves a particle of another. All eight read their particles before any writes them,
/// so that a load that waits for a store of the batch before waits once for eight contacts.
struct ContactBatch {
  static constexpr int width = 8;
  static constexpr int spare = width * 4;  ///< values of no particle that it needs, at most

  FourContacts four[width / 4];
};

struct RelaxKernels {
  /// Relaxes the contacts of batches[order[0]], batches[order[1]], ... one batch after the other.
  void (*relax)(ContactBatch* batches, const int* order, int count, ContactValue* values);

  /// Sets moved[k] to whether values[k] differs from before[k] by more than the root of `squared_tolerance`,
  /// and before[k] to values[k]. Returns how many have moved.
  int (*note_moved)(const ContactValue* values, ContactValue* before, unsigned char* moved, int count,
                    double squared_tolerance);

  CLOTHLAB_KERNEL_TABLE(RelaxKernels)
};

}  // namespace cloth
