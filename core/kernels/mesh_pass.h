// What one pass of a kernel over the particles of a general mesh works on. Plain data only, as in
// grid_pass.h.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth::kernels {

/// Eight particles in a row make a slice, whatever the width of the registers; some slices make a block.
inline constexpr int slice_width = 8, block_slices = 16, block_width = slice_width * block_slices;

/// So many kinds fit into a register.
inline constexpr int max_kinds = 8;

/// All springs at both their ends: slot after slot, each with one spring of every particle of a slice. A lane
/// without a spring left has padding_index() for its neighbour, with stiffness 0. F_i = (k - k L / |d|) d, d
/// = x_j - x_i.
///
/// Stiffness and tension stand in full, or are looked up by kind where few different ones occur: `kind` is
/// null where neither is.
struct MeshSlots {
  const int* slot_begin = nullptr;      ///< slice s has the slots slot_begin[s] to slot_begin[s + 1]
  const int* neighbour = nullptr;       ///< [slot][lane]: 4 times the number of the other end
  const unsigned char* kind = nullptr;  ///< [slot][lane]
  double stiffness_of_kind[max_kinds]{}, tension_of_kind[max_kinds]{};
  const double* stiffness = nullptr;  ///< [slot][lane]: k, N/m; null: of the kind
  const double* tension = nullptr;    ///< [slot][lane]: k L, N; null: of the kind
};

/// The vector behind those of all slices: a place where no particle is.
constexpr int padding_index(int slices) {
  return slices * slice_width;
}
inline constexpr double nowhere[4] = {3e5, 7e5, 11e5, 0};  // m

struct FieldPointers {
  double *x = nullptr, *y = nullptr, *z = nullptr;
};

/// One stage of Runge-Kutta, as step_updates.h has it: `position` and `velocity` of the pass are the stage's.
struct MeshStage {
  double weight = 0, ahead = 0;  ///< s
  bool is_last = false;
  FieldPointers sum_position, sum_velocity, next_sum_position, next_sum_velocity;
  FieldPointers state_position, state_velocity, next_position, next_velocity;
};

/// One pass over the blocks [begin, end). It reads the positions of neighbours from `vectors` only, so that
/// the fields can be stepped in place.
struct MeshPass {
  MeshSlots slots;
  int particles = 0;
  int begin = 0, end = 0;
  /// By block: the particles up to this one are loaded into `vectors` before it, in whole slices; null: all
  /// are.
  const int* load_until = nullptr;
  bool kicks = false;  ///< Verlet's first half comes before loading
  double* vectors =
      nullptr;  ///< m: x y z 0 of every particle, for whole slices, and nowhere; 64-byte aligned
  double* velocities = nullptr;  ///< m/s, as `vectors`; only where springs are damped
  FieldPointers position, velocity, force;
  const double* inverse_mass = nullptr;  ///< 1/kg; 0 where pinned
  FieldPointers load;                    ///< N, of every particle, in addition; may be null
  double weight[3] = {0, 0, 0};          ///< N, of every particle
  double damping = 0;                    ///< N s/m, viscous
  double spring_damping = 0;             ///< N s/m, along every spring
  double mass_of_free = 1;               ///< kg
  double step = 0;                       ///< s
  bool drift_first = false;              ///< explicit Euler: the position follows the old velocity
  MeshStage stage;                       ///< of runge_kutta
  /// Sums of |v|^2 of each block: those before the step (Runge-Kutta: at the stage), then those after it.
  double* squares[2] = {nullptr, nullptr};
  double* dampers = nullptr;  ///< W, of each block: what the dampers along the springs take
};

/// The passes of one instruction set; what they compute is in grid_pass.h.
struct MeshKernels {
  /// Takes the positions of the particles [begin, end), whole slices, into `vectors`; after Verlet's first
  /// half where the pass `kicks`. With damped springs their velocities too.
  void (*load)(const MeshPass& pass, int begin, int end);
  void (*euler)(const MeshPass& pass);
  void (*verlet)(const MeshPass& pass);  ///< the half after the force
  void (*verlet_between)(const MeshPass& pass);
  void (*runge_kutta)(const MeshPass& pass);  ///< one stage
  void (*evaluate)(const MeshPass& pass);
  void (*damp)(const MeshPass& pass);
  void (*sum_squares)(const MeshPass& pass);

  CLOTHLAB_KERNEL_TABLE(MeshKernels)
};

}  // namespace cloth::kernels
