// Contact particle by particle (obstacle_contact.h) of many particles with one obstacle at once: which of
// them touch it, and the law of contact.
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

/// An obstacle with an inside.
struct TouchSolid {
  enum class Kind { half_space, ball, box };

  Kind kind = Kind::half_space;
  double center[3] = {0, 0, 0};  ///< m; of a half space, a point of its surface
  double normal[3] = {0, 1, 0};  ///< outward, of a half space
  double half[3] = {0, 0, 0};    ///< m, half the size of a box
  double radius = 0;             ///< m, of a ball
};

/// Particles side by side, from the beginning of the step through one obstacle after the other. Lengths in m,
/// speeds in m/s.
struct alignas(64) TouchBlock {
  static constexpr int size = 32;  ///< particles
  using Numbers = double[size];
  using Vectors = double[3][size];

  Numbers mass;     ///< kg, above 0
  Numbers is_free;  ///< 1: it moves; 0: it does not, or there is none
  Vectors start;    ///< as the step began

  // that the law with restitution asks for alone
  Numbers held;                                      ///< 1: contact acted on it in the last step
  Vectors start_velocity;                            ///< as the step began
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
  /// Writes `touched`, `point` and `normal`, the last two for others as well: the free particles inside the
  /// obstacle, by their positions, and the point of its surface nearest to each
  /// (ObstacleShape::penetration()). Returns their number.
  int (*find_touched)(const TouchSolid& solid, TouchBlock& block);

  /// Moves what touches the obstacle to its surface, and changes its velocity.
  void (*respond)(const TouchLaw& law, TouchBlock& block);

  CLOTHLAB_KERNEL_TABLE(TouchKernels)
};

}  // namespace cloth
