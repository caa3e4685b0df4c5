// The springs of a general mesh: F_i = k (|d| - L) d/|d|, d = x_j - x_i, as in forces/springs.h, for springs
// without constant offset.
#pragma once

#include <functional>
#include <vector>

#include "kernels/mesh_layout.h"

namespace cloth {

/// The kernel for this processor, or that which the environment variable CLOTHLAB_INSTRUCTION_SET names
/// (baseline, avx2, avx512) where the processor has it.
const MeshKernel& chosen_mesh_kernel();

/// All that this processor can run, baseline first.
std::vector<const MeshKernel*> supported_mesh_kernels();

/// Calls part(0) ... part(parts - 1), in any order or at once, and returns when all are done.
using RunParts = std::function<void(int parts, const std::function<void(int)>& part)>;

class MeshSprings {
 public:
  /// Whether the springs of a system are mostly runs too short for the kernels of a grid.
  static bool suits(const ClothSystem& system);

  /// `system` is not referred to afterwards.
  explicit MeshSprings(const ClothSystem& system, const MeshKernel& kernel = chosen_mesh_kernel());

  /// force += the springs' forces, in N. The same bits again and on any number of threads.
  void add_forces(const Vec3Field& position, Vec3Field& force);

  /// The same in `threads` parts at a time, carried out by `run`.
  void add_forces(const Vec3Field& position, Vec3Field& force, int threads, const RunParts& run);

  const MeshLayout& layout() const { return layout_; }

 private:
  struct alignas(32) Vector {
    double x = 0, y = 0, z = 0, zero = 0;
  };
  MeshArrays arrays();

  MeshLayout layout_;
  const MeshKernel* kernel_;
  std::vector<Vector> position_, force_;
};

}  // namespace cloth
