// The law of contact particle by particle (obstacle_contact.h) for many particles and one obstacle at once.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// Of an obstacle, and of the step.
struct TouchLaw {
  double friction = 0, restitution = 0;
  bool reflects = false;
  double step = 0;           ///< s
  double gravity_speed = 0;  ///< m/s, that gravity adds
};

/// Particles side by side, from the beginning of the step through one obstacle after the other. Lengths in m,
/// speeds in m/s.
struct alignas(64) TouchBlock {
  static constexpr int size = 32;  ///< particles
  using Numbers = double[size];
  using Vectors = double[3][size];

  Numbers mass;                                      ///< kg, above 0
  Numbers held;                                      ///< 1: contact acted on it in the last step
  Vectors start, start_velocity;                     ///< as the step began
  Vectors integrated_position, integrated_velocity;  ///< by the integrator

  // of the present obstacle
  Numbers touched;      ///< 1: the particle touches it
  Vectors point;        ///< of its surface
  Vectors normal;       ///< outward
  Numbers normal_load;  ///< N s, impulse of the springs into the surface within the step

  // in and out
  Vectors position, velocity;
  Vectors before;   ///< velocity at the beginning of the step, or after the last obstacle
  Numbers work;     ///< J, of all obstacles so far
  Numbers outcome;  ///< 1: an obstacle touched it; 2: it rebounded from one
};

struct TouchKernels {
  /// Moves what touches the obstacle to its surface, and changes its velocity.
  void (*respond)(const TouchLaw& law, TouchBlock& block);

  CLOTHLAB_KERNEL_TABLE(TouchKernels)
};

}  // namespace cloth
