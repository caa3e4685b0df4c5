// The innermost loops of the springs of a mesh, once for each instruction set, behind one table of functions.
//
// This header is included by files that are compiled for other processors than the rest: it holds plain
// structs and nothing that the linker could merge.
#pragma once

namespace cloth {

/// Particles are taken in slices of eight neighbours in the numbering, whatever the width of the registers.
inline constexpr int slice_width = 8;

/// A mesh's springs and the scratch of one evaluation; see mesh_layout.h. `position` and `force` hold four
/// numbers for each particle, x y z 0, 32-byte aligned, for a whole number of slices.
struct MeshArrays {
  const int* slot_begin;    ///< slice s has the slots slot_begin[s] to slot_begin[s + 1]
  const int* neighbour;     ///< [slot][lane]: 4 times the number of the other end
  const double* stiffness;  ///< [slot][lane]: k, N/m; 0 in an empty lane
  const double* tension;    ///< [slot][lane]: k L, N
  double* position;         ///< m
  double* force;            ///< N
};

/// One sweep over all slices that takes positions in just before the first spring needs them, and gives
/// forces out after the last one has added to them, so that both stay in the caches and the loads and stores
/// hide behind divisions.
struct MeshSweep {
  const int* load_until;   ///< by slice: the particles up to this one must be loaded before it
  const int* store_until;  ///< by slice: after it the forces up to this particle are complete
  const double *x, *y, *z;
  double *fx, *fy, *fz;
  int loaded, stored;  ///< particles so far
};

/// Every set takes the springs in the same order. Baseline and AVX2 round each operation alike; AVX-512
/// refines a reciprocal root instead of dividing, and differs by rounding.
struct MeshKernel {
  const char* name;  ///< as in CLOTHLAB_INSTRUCTION_SET

  /// Takes the positions of the particles in [begin, end) into `to.position` and clears their forces.
  void (*load)(const double* x, const double* y, const double* z, int begin, int end, const MeshArrays& to);

  /// Adds the forces of all springs of the slices [begin, end) to both their ends.
  void (*add_springs)(const MeshArrays& mesh, int begin, int end);

  /// Adds the forces of the particles in [begin, end) to fx, fy, fz.
  void (*store)(const MeshArrays& from, int begin, int end, double* fx, double* fy, double* fz);

  /// All three for the slices [begin, end).
  void (*sweep)(const MeshArrays& mesh, MeshSweep& through, int begin, int end);
};

const MeshKernel& baseline_mesh_kernel();
#if defined(__x86_64__)
const MeshKernel& avx2_mesh_kernel();
const MeshKernel& avx512_mesh_kernel();
#endif

}  // namespace cloth
