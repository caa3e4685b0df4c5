// The forces of a block of a grid that is assembled cell by cell: structural and shear springs, those at the
// borders of half the stiffness, and bending elements (CellShares). Included once for every instruction set,
// after its Lanes; everything here has internal linkage.
#pragma once

#include "kernels/grid_rows.h"

namespace cloth::kernels {
namespace {

/// What a bending element of stiffness k (cloth/bending.h) pulls with, over k: s(x) + t s(v), s the weighted
/// sum of its points and t the damping time; of the damper alone t s(v). Adds the power that the damper
/// takes, k t |s(v)|^2 in W.
template <Law law>
CLOTHLAB_INLINE Vector bend(V stiffness, const Springs& springs, const Particles& sum, V& loss) {
  if constexpr (law == Law::elastic) return sum.position;
  loss = Lanes::fma(Lanes::mul(stiffness, springs.bending_time), squared(sum.velocity), loss);
  if constexpr (law == Law::damper) return scaled(springs.bending_time, sum.velocity);
  return plus(sum.position, springs.bending_time, sum.velocity);
}

/// (d - c) - (b - a): of three points in a row, with c = b, the second difference; of a cell's corners the
/// twist. The differences are those of springs, which are computed anyway.
template <Law law>
CLOTHLAB_INLINE Particles difference(const Particles& a, const Particles& b, const Particles& c,
                                     const Particles& d) {
  const Vector x = (d.position - c.position) - (b.position - a.position);
  if constexpr (law == Law::elastic) return {x, x};
  return {x, (d.velocity - c.velocity) - (b.velocity - a.velocity)};
}

template <bool Edge>
CLOTHLAB_INLINE V stiffness_at(const double* row, int j, int count) {
  if constexpr (Edge) return Lanes::load(row + j, count, Lanes::zero());
  return Lanes::load(row + j);
}

/// The particles `columns` ahead of a block; at an Edge those that are missing are replaced by `otherwise`.
template <Law law, bool Edge>
CLOTHLAB_INLINE Particles particles_ahead(const ParticleRow& row, int j, int columns, int count,
                                          const Particles& otherwise) {
  if constexpr (Edge) return particles_at<law>(row, j + columns, count - columns, otherwise);
  return particles_at<law>(row, j + columns);
}

/// The force before any spring is added, of particles of a row with this share.
template <bool Edge>
CLOTHLAB_INLINE Vector initial_share(const ConstRow& load_row, const RowWork& work, V of_row, int j,
                                     int count) {
  const Vector weight = scaled(Lanes::mul(of_row, Lanes::load(work.part + j)), work.weight);
  return initial<Edge>(load_row, weight, j, count);
}

/// Forces of the elements that begin in one block: on its particles, on those below, and on later columns, of
/// this row and of the row below.
struct BlockForces {
  Vector here, below, one, two, one_below;
};
/// The particles of a cell's corners.
struct Corners {
  Particles here, right, below, below_right;
};

/// Springs of a block's cells that reach the row below.
template <Law law, bool Full, bool Edge>
CLOTHLAB_INLINE void add_springs_below(const RowWork& work, int j, int count, const Corners& at,
                                       BlockForces& f, V& loss) {
  const Springs& springs = *work.springs;
  const auto has = [&](unsigned bits) { return Full || (work.present & bits) != 0; };
  Vector d;
  if (has(down_one)) {
    const V s = springs.pull<law, down_one>(Lanes::load(work.part + j), at.here, at.below, d, loss);
    f.here = plus(f.here, s, d);
    f.below = minus(f.below, s, d);
  }
  if (has(antidiagonal)) {
    Particles from = at.right;
    if constexpr (Edge) from = particles_at<law>(work.here, j + 1, count - 1, at.below);
    const V s = springs.pull<law, antidiagonal>(from, at.below, d, loss);
    f.one = plus(f.one, s, d);
    f.below = minus(f.below, s, d);
  }
  if (has(diagonal)) {
    const V s = springs.pull<law, diagonal>(at.here, at.below_right, d, loss);
    f.here = plus(f.here, s, d);
    f.one_below = scaled(s, d);
  }
}

/// The twist of a block's cells, and the bending of columns.
template <Law law, bool Full, bool Edge>
CLOTHLAB_INLINE void add_bending_below(const RowWork& work, int j, int count, const Corners& at,
                                       BlockForces& f, V& loss) {
  const Springs& springs = *work.springs;
  const V k = stiffness_at<Edge>(work.bending.twist, j, count);
  const Vector twist =
      bend<law>(k, springs, difference<law>(at.here, at.right, at.below, at.below_right), loss);
  f.here = minus(f.here, k, twist);
  f.one = plus(f.one, k, twist);
  f.below = plus(f.below, k, twist);
  f.one_below = plus(f.one_below, k, twist);
  if (!Full && !work.has_second) return;
  const Particles second = particles_ahead<law, Edge>(work.second, j, 0, count, at.here);
  const V b = stiffness_at<Edge>(work.bending.down, j, count);
  const Vector down = bend<law>(b, springs, difference<law>(at.here, at.below, at.below, second), loss);
  f.here = minus(f.here, b, down);
  f.below = plus(f.below, Lanes::add(b, b), down);
  store(work.b, j, minus(initial_share<Edge>(work.load_second, work, work.of_second, j, count), b, down));
}

/// As block_force() for grids of equal springs; `Full`: a row that is not one of the last two, of a cloth
/// that bends and has both families.
template <Law law, bool Full, bool Edge>
CLOTHLAB_INLINE Vector block_force_by_cell(const RowWork& work, int j, int count, const Particles& here,
                                           Carry& carry, V& loss) {
  const Springs& springs = *work.springs;
  const bool has_below = Full || work.has_below;
  const bool bends = Full || work.bending.across != nullptr;
  const auto ahead = [&](const ParticleRow& row, int columns) {
    return particles_ahead<law, Edge>(row, j, columns, count, here);
  };
  const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  BlockForces f{load(work.a, j), nothing, nothing, nothing, nothing};
  Corners at{here, ahead(work.here, 1), here, here};
  if (Full || (work.present & right_one) != 0) {
    Vector d;
    const V s = springs.pull<law, right_one>(work.of_row, here, at.right, d, loss);
    f.here = plus(f.here, s, d);
    f.one = minus(f.one, s, d);
  }
  if (bends) {
    const V k = stiffness_at<Edge>(work.bending.across, j, count);
    const Vector across =
        bend<law>(k, springs, difference<law>(here, at.right, at.right, ahead(work.here, 2)), loss);
    f.two = scaled(k, across);
    f.here = minus(f.here, k, across) - moved_two(carry.two, f.two);
    f.one = plus(f.one, Lanes::add(k, k), across);
  }
  if (has_below) {
    f.below =
        work.uses_b ? load(work.b, j) : initial_share<Edge>(work.load_below, work, work.of_below, j, count);
    at.below = ahead(work.below, 0), at.below_right = ahead(work.below, 1);
    add_springs_below<law, Full, Edge>(work, j, count, at, f, loss);
    if (bends) add_bending_below<law, Full, Edge>(work, j, count, at, f, loss);
    store(work.a, j, f.below - moved_one(carry.one_below, f.one_below));
  }
  const Vector force = f.here + moved_one(carry.one, f.one);
  carry = {f.one, f.two, f.one_below};
  return force;
}

template <Law law, Share share, bool Full, bool Edge>
CLOTHLAB_INLINE Vector block_force_of(const RowWork& work, int j, int count, const Particles& here,
                                      Carry& carry, V& loss) {
  if constexpr (share == Share::by_cell)
    return block_force_by_cell<law, Full, Edge>(work, j, count, here, carry, loss);
  return block_force<law, Full, Edge>(work, j, count, here, carry, loss);
}

/// One row: its force, and `update(j, count, here, force)` for every block; an update<Edge> is a call
/// operator with that template argument. A row of another band has no update. Returns the power that the
/// row's dampers dissipate, in W.
template <Law law, Share share, bool Full, class Update>
CLOTHLAB_INLINE V row_pass(const RowWork& work, bool own, Update& update) {
  const V zero = Lanes::zero();
  const Vector nothing{zero, zero, zero};
  Carry carry{nothing, nothing, nothing};
  V loss = zero;
  int j = 0;
  for (; j + Lanes::width + 2 <= work.columns; j += Lanes::width) {
    const Particles here = particles_at<law>(work.here, j);
    const Vector force = block_force_of<law, share, Full, false>(work, j, Lanes::width, here, carry, loss);
    if (Full || own) update.template operator()<false>(j, Lanes::width, here.position, force);
  }
  for (; j < work.columns; j += Lanes::width) {
    const int count = work.columns - j;
    const Particles here = particles_at<law>(work.here, j, count, {nothing, nothing});
    const Vector force = block_force_of<law, share, Full, true>(work, j, count, here, carry, loss);
    if (Full || own) update.template operator()<true>(j, count, here.position, force);
  }
  return loss;
}

}  // namespace
}  // namespace cloth::kernels
