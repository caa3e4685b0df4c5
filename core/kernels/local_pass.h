// The interface of the kernels of the local methods on any cloth: the visits of springs by XPBD and of
// particles by VBD where no grid gives their order. Plain data only, for the reason given in grid_pass.h.
//
// Fields of particles are 4-vectors here, x y z 0 of one particle after the other, 64-byte aligned, so that
// an index reads all of a particle at once; indices are multiplied by 4.
#pragma once

#include "kernels/descent_fields.h"
#include "kernels/kernel_table.h"
#include "kernels/projected_pass.h"

namespace cloth::kernels {

/// Lists are filled up to whole multiples of this with entries that change nothing.
inline constexpr int widest_vector = 8;

/// One visit of every spring by XPBD, see coloured_visits.h: moves the velocities alone. Springs that one
/// vector holds share no particle; `springs` is a multiple of widest_vector.
struct ColouredProjection : ProjectedParticles {
  int springs = 0;
  const int *first = nullptr, *second = nullptr;  ///< of each spring: its ends, times 4
  /// Of each spring, with q = 1 + h (h k + k_d) (w_i + w_j): h k/q, h k L/q, h k_d/q and h (h k + k_d)/q; and
  /// w_i + w_j in 1/kg. `turn` is read only with drag, `both` only with impulses.
  const double *stretch = nullptr, *tension = nullptr, *damper = nullptr, *turn = nullptr, *both = nullptr;
  bool is_damped = false;
  double* impulse[3] = {nullptr, nullptr, nullptr};  ///< N s, of each spring, in place; null: 0 before
};

/// Bending by the rows of its matrix, see descent_elements.h: a slot holds one entry of each particle's row.
struct BendingSlots {
  const int* begin = nullptr;      ///< slice s has the slots begin[s] to begin[s + 1] - 1; null: no bending
  const int* neighbour = nullptr;  ///< [slot][lane]: 4 times the other's place
  const double *coupling = nullptr,
               *own = nullptr;  ///< N/m: K_ij [slot][lane], 0 where there is none, and K_ii [place]
  const double* held[3] = {nullptr, nullptr,
                           nullptr};  ///< N [place]: damping's force at the positions of the start
  double scale = 1;                   ///< 1 + damping time over the step
};

/// A slot holds one triangle of each particle of a slice. Numbers: L^2 in m^2 of the edge out of the
/// particle, of that into it and of the third (0 where there is no triangle), then in N/m^3 K of out with
/// itself, in with itself, out with in, out with the third, in with the third.
inline constexpr int triangle_numbers = 8;
struct TriangleSlots {
  const int* begin = nullptr;                    ///< as of bending
  const int *next = nullptr, *before = nullptr;  ///< [slot][lane]: 4 times the places of the other corners
  const double* numbers = nullptr;               ///< [slot][number][lane]
  double time = 0;                               ///< damping time over the step
};

/// A slot holds one slider of each particle of a slice. Numbers: the normal, the slip in 1/m, stiffness and
/// largest moment, both times the area, in N m^3 and N m^2; the particle's coefficient c in 1/m^2 and 1/|c|.
inline constexpr int slider_numbers = 8;
struct SliderSlots {
  const int* begin = nullptr;           ///< as of bending
  const int* points = nullptr;          ///< slot s has the points points[s] to points[s + 1] - 1
  const int* neighbour = nullptr;       ///< [point][lane]: 4 times the place
  const double* coefficient = nullptr;  ///< [point][lane]: 1/m^2, 0 where there is none
  const double* numbers = nullptr;      ///< [slot][number][lane]
};

/// One visit of every particle by VBD, see coloured_descent.h. Eight places are a slice, all of one colour;
/// a slot holds one spring of each particle of a slice.
struct ColouredDescent : DescentFields {
  int slices = 0;
  const int* slot_begin = nullptr;  ///< slice s has the slots slot_begin[s] to slot_begin[s + 1] - 1
  const int* neighbour = nullptr;   ///< [slot][lane]: 4 times the place at the other end
  const double *stiffness = nullptr, *rest_length = nullptr;  ///< [slot][lane]: N/m, m; 0 where there is none
  double damper_per_stiffness = 0;                            ///< a damping time of the springs over the step
  BendingSlots bending;
  TriangleSlots triangles;
  SliderSlots sliders;
  double* vectors = nullptr;  ///< m: `position` as 4-vectors, and after it one far from any particle
  const double* start_vectors = nullptr;  ///< m: `start` likewise; null: there are no dampers
};

struct LocalKernels {
  void (*project)(ColouredProjection& projection);
  /// One visit of every element: bending, sliders, triangles.
  void (*project_elements)(ElementProjection& elements, ProjectedParticles& particles);
  void (*descend)(ColouredDescent& descent);
  /// The step of Chebyshev's semi-iteration after a visit of every particle; `position` alone, no 4-vectors.
  void (*extrapolate)(const DescentFields& descent, double weight);
  /// Of particles [0, count): to 4-vectors, whose fourth number is 0, and back.
  void (*to_vectors)(const double* x, const double* y, const double* z, double* vectors, int count);
  void (*from_vectors)(const double* vectors, double* x, double* y, double* z, int count);

  CLOTHLAB_KERNEL_TABLE(LocalKernels)
};

}  // namespace cloth::kernels
