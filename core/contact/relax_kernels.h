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

/// A contact as its relaxation reads it: ContactConstraint with products made once. Vectors have a fourth
/// number, 0. Where it has fewer than four particles the remaining weights are 0.
struct alignas(32) ContactRow {
  double normal[4], rest[4], friction_impulse[4];
  double weight[4];    ///< of the particles' values in the contact's point
  double response[4];  ///< weight times inverse mass, 1/kg: change of the values by an impulse
  int slot[4];         ///< of the particles, in the array of values
  double bound, rest_level, inverse_mobility, friction, normal_impulse;  ///< rest_level: normal . rest
};

struct RelaxKernels {
  /// Relaxes rows[order[0]], rows[order[1]], ... one after the other.
  void (*relax)(ContactRow* rows, const int* order, int count, ContactValue* values);

  /// Sets moved[k] to whether values[k] differs from before[k] by more than the root of `squared_tolerance`,
  /// and before[k] to values[k]. Returns whether any has moved.
  bool (*note_moved)(const ContactValue* values, ContactValue* before, unsigned char* moved, int count,
                     double squared_tolerance);

  CLOTHLAB_KERNEL_TABLE(RelaxKernels)
};

}  // namespace cloth
