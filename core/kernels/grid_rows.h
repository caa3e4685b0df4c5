// The spring forces of a grid, row by row, in one pass that may update the state in place. Included once for
// every instruction set, after its Lanes; everything here has internal linkage.
//
// Every particle is the first end of at most six springs, to columns and rows ahead of it. A row is
// processed in blocks of as many columns as there are lanes. The forces of a block's springs on later columns
// are passed on in registers, shifted by lanes; those on the next two rows are stored in two row buffers:
//
//     A  the force so far on the row below: from springs of this row and the one above
//     B  the force so far on the row below that: from springs of this row
//
// A row's force is therefore complete when the row has been processed, and the method can update the row's
// particles at once: nothing later in the pass reads them. Both buffers begin with weight and load.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/lane_vectors.h"
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

struct Springs {
  Lanes::Spring kind[spring_kinds];
  V damping[spring_kinds];
  V bending_time;  ///< s
  explicit Springs(const Pass& pass) : bending_time(Lanes::set(pass.bending_time)) {
    for (int k = 0; k < spring_kinds; ++k) {
      kind[k] = Lanes::spring(pass.grid.kind[k].stiffness, pass.grid.kind[k].rest_tension);
      damping[k] = Lanes::set(pass.spring_damping[k]);
    }
  }
  /// Sets d = to - from and returns s, so that the force on `from` is s d. Adds the power dissipated by the
  /// damper, in W, to `loss`.
  template <Law law, unsigned Bit>
  CLOTHLAB_INLINE V pull(const Particles& from, const Particles& to, Vector& d, V& loss) const {
    constexpr bool divided = (Bit & Lanes::divided) != 0;
    const Lanes::Spring& spring = kind[__builtin_ctz(Bit)];
    d = to.position - from.position;
    const V s = squared(d);
    if constexpr (law == Law::elastic) return Lanes::spring_scale<divided>(s, spring);
    const V inverse = Lanes::inverse_root<divided>(s);
    const V damper = damper_scale(from, to, d, inverse, damping[__builtin_ctz(Bit)], loss);
    if constexpr (law == Law::damper) return damper;
    return Lanes::add(Lanes::scale_at(inverse, spring), damper);
  }
  /// The same of a spring that counts for `part`.
  template <Law law, unsigned Bit>
  CLOTHLAB_INLINE V pull(V part, const Particles& from, const Particles& to, Vector& d, V& loss) const {
    V whole = Lanes::zero();
    const V scale = pull<law, Bit>(from, to, d, whole);
    if constexpr (law != Law::elastic) loss = Lanes::fma(part, whole, loss);
    return Lanes::mul(part, scale);
  }
};

/// The positions (m) and velocities (m/s) of a row's particles.
struct ParticleRow {
  ConstRow position, velocity;
};

/// The stiffness of the bending elements that begin in a row, see CellShares.
struct BendingRow {
  const double *across = nullptr, *down = nullptr, *twist = nullptr;
};

/// The input of one row's spring forces.
struct RowWork {
  int columns;
  ParticleRow here, below, second;   ///< only those that exist are read
  ConstRow load_below, load_second;  ///< null: only `weight`
  Row a, b;                          ///< the row buffers A and B, see above
  Vector weight;
  const Springs* springs;
  unsigned present = 0;  ///< this row's directions of springs
  bool has_below = true, has_second = true;
  bool uses_b = true;  ///< the grid has springs that reach two rows down

  // Of a grid by cells (CellShares):
  const double* part = nullptr;   ///< of the columns
  V of_row, of_below, of_second;  ///< shares of these rows
  BendingRow bending{};           ///< null pointers: none
};

/// Forces of the present block's springs on the columns of the next block: one and two columns ahead in this
/// row, and one column ahead in the row below.
struct Carry {
  Vector one, two, one_below;
};

template <Law law>
CLOTHLAB_INLINE Particles particles_at(const ParticleRow& row, int j) {
  const Vector x = load(row.position, j);
  if constexpr (law == Law::elastic) return {x, x};
  return {x, load(row.velocity, j)};
}
template <Law law>
CLOTHLAB_INLINE Particles particles_at(const ParticleRow& row, int j, int count, const Particles& otherwise) {
  const Vector x = load(row.position, j, count, otherwise.position);
  if constexpr (law == Law::elastic) return {x, x};
  return {x, load(row.velocity, j, count, otherwise.velocity)};
}

/// The force so far on the block in the row below.
template <bool Full, bool Edge>
CLOTHLAB_INLINE Vector force_below(const RowWork& work, int j, int count) {
  if (Full || (work.has_below && work.uses_b)) return load(work.b, j);
  if (work.has_below) return initial<Edge>(work.load_below, work.weight, j, count);
  return {Lanes::zero(), Lanes::zero(), Lanes::zero()};
}

/// The force on the particles of one block. `Full`: all springs of all six directions are there, which holds
/// in all but the last two rows of a cloth with all families; otherwise it tests `present`. An `Edge` block
/// may lack columns: a missing neighbour is replaced by the particle itself, whose distance to itself gives
/// no force.
template <Law law, bool Full, bool Edge>
CLOTHLAB_INLINE Vector block_force(const RowWork& work, int j, int count, const Particles& here, Carry& carry,
                                   V& loss) {
  const Springs& springs = *work.springs;
  const auto has = [&](unsigned bits) { return Full || (work.present & bits) != 0; };
  const auto ahead = [&](const ParticleRow& row, int columns, const Particles& otherwise) {
    if constexpr (Edge) return particles_at<law>(row, j + columns, count - columns, otherwise);
    return particles_at<law>(row, j + columns);
  };
  const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  Vector force = load(work.a, j);
  Vector below_force = force_below<Full, Edge>(work, j, count);
  Vector one = nothing, two = nothing, one_below = nothing;  // forces on later columns
  Vector d;

  Particles right = here;
  if (has(right_one | antidiagonal)) right = ahead(work.here, 1, here);
  if (has(right_one)) {
    const V s = springs.pull<law, right_one>(here, right, d, loss);
    force = plus(force, s, d);
    one = minus(one, s, d);
  }
  if (has(right_two)) {
    const V s = springs.pull<law, right_two>(here, ahead(work.here, 2, here), d, loss);
    force = plus(force, s, d);
    two = scaled(s, d);
  }
  if (Full || (work.has_second && work.uses_b)) {
    const V s = springs.pull<law, down_two>(here, ahead(work.second, 0, here), d, loss);
    force = plus(force, s, d);
    store(work.b, j, minus(initial<Edge>(work.load_second, work.weight, j, count), s, d));
  }
  Particles below = here;
  if (has(down_one | antidiagonal)) below = ahead(work.below, 0, here);
  if (has(down_one)) {
    const V s = springs.pull<law, down_one>(here, below, d, loss);
    force = plus(force, s, d);
    below_force = minus(below_force, s, d);
  }
  if (has(antidiagonal)) {
    Particles from = right;
    if constexpr (Edge) from = ahead(work.here, 1, below);
    const V s = springs.pull<law, antidiagonal>(from, below, d, loss);
    one = plus(one, s, d);
    below_force = minus(below_force, s, d);
  }
  if (has(diagonal)) {
    const V s = springs.pull<law, diagonal>(here, ahead(work.below, 1, here), d, loss);
    force = plus(force, s, d);
    one_below = scaled(s, d);
    below_force = below_force - moved_one(carry.one_below, one_below);
  }
  if (has(right_one | antidiagonal)) force = force + moved_one(carry.one, one);
  if (has(right_two)) force = force - moved_two(carry.two, two);
  if (Full || work.has_below) store(work.a, j, below_force);
  carry = {one, two, one_below};
  return force;
}

}  // namespace
}  // namespace cloth::kernels
