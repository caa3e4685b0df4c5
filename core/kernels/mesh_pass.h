// The interface of the kernels for general meshes: the input and output of one pass over particles. Plain
// data only, for the reason given in grid_pass.h. kernels/mesh_layout.h makes the arrays.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth::kernels {

/// Eight consecutive particles are a slice, for registers of any width; a block is 16 slices.
inline constexpr int slice_width = 8, block_slices = 16, block_width = slice_width * block_slices;

/// Springs of equal stiffness (or tension) are a kind; a table of so many fits into an AVX-512 register.
inline constexpr int max_kinds = 8;

/// All springs, stored once at each of their ends, in slots: a slot holds one spring of each particle of a
/// slice. Lanes whose particle has no further spring have the neighbour padding_index() and stiffness 0.
/// F_i = (k - k L / |d|) d, d = x_j - x_i.
///
/// Stiffness and tension are stored for each spring, or looked up by kind where they take few different
/// values. `kind` is null where neither is looked up.
struct MeshSlots {
  const int* slot_begin = nullptr;      ///< slice s has the slots slot_begin[s] to slot_begin[s + 1] - 1
  const int* neighbour = nullptr;       ///< [slot][lane]: 4 times the particle at the other end
  const unsigned char* kind = nullptr;  ///< [slot][lane]
  double stiffness_of_kind[max_kinds]{}, tension_of_kind[max_kinds]{};
  const double* stiffness = nullptr;  ///< [slot][lane]: k, N/m; null: of the kind
  const double* tension = nullptr;    ///< [slot][lane]: k L, N; null: of the kind
};

/// The index of the vector after those of all slices, which holds the position `nowhere`: far from any
/// particle, so that padding lanes have a finite length.
constexpr int padding_index(int slices) {
  return slices * slice_width;
}
inline constexpr double nowhere[4] = {3e5, 7e5, 11e5, 0};  // m

struct FieldPointers {
  double *x = nullptr, *y = nullptr, *z = nullptr;
};

/// The data of one stage of Runge-Kutta, see StageUpdate in step_updates.h. The pass's `position` and
/// `velocity` are those of the stage.
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
  /// For each block: before it, particles below this number, a multiple of slice_width, are copied to
  /// `vectors`; null: all have been copied already.
  const int* load_until = nullptr;
  bool kicks = false;  ///< do Verlet's kick and drift before copying to `vectors`
  double* vectors =
      nullptr;  ///< m: x y z 0 of each particle, padded to whole slices, then `nowhere`; 64-byte aligned
  double* velocities = nullptr;  ///< m/s, as `vectors`; only where springs are damped
  FieldPointers position, velocity, force;
  const double* inverse_mass = nullptr;  ///< 1/kg; 0 where pinned
  FieldPointers load;                    ///< N, additional force on each particle; may be null
  double weight[3] = {0, 0, 0};          ///< N, the same for all particles
  double damping = 0;                    ///< N s/m, viscous
  double spring_damping = 0;             ///< N s/m, dampers along springs
  double mass_of_free = 1;               ///< kg
  double step = 0;                       ///< s
  bool drift_first = false;              ///< explicit Euler: the position follows the old velocity
  MeshStage stage;                       ///< of runge_kutta
  /// Output, for each block: sum of |v|^2 in (m/s)^2 before the step (Runge-Kutta: at the stage) and after
  /// it.
  double* squares[2] = {nullptr, nullptr};
  double* dampers = nullptr;  ///< output, for each block: W dissipated by dampers along springs
};

/// The passes of one instruction set; what they compute is in grid_pass.h.
struct MeshKernels {
  /// Copies the positions of the particles [begin, end), whole slices, to `vectors`, and with damped springs
  /// the velocities to `velocities`. Where the pass `kicks`, Verlet's kick and drift come first.
  void (*load)(const MeshPass& pass, int begin, int end);
  void (*euler)(const MeshPass& pass);
  void (*verlet)(const MeshPass& pass);  ///< the closing kick
  void (*verlet_between)(const MeshPass& pass);
  void (*runge_kutta)(const MeshPass& pass);  ///< one stage
  void (*evaluate)(const MeshPass& pass);
  void (*damp)(const MeshPass& pass);
  void (*sum_squares)(const MeshPass& pass);

  CLOTHLAB_KERNEL_TABLE(MeshKernels)
};

}  // namespace cloth::kernels
