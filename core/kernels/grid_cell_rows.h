// The forces of a block of a grid that is assembled cell by cell: structural and shear springs, those at the
// borders of half the stiffness, and bending elements (CellShares). Included once for every instruction set,
// after its Lanes; everything here has internal linkage.
#pragma once

#include "kernels/grid_rows.h"

namespace cloth::kernels {
namespace {

/// What a bending element (cloth/bending.h) pulls with: k (s(x) + t s(v)), s the weighted sum of its points
/// and t the damping time. Adds the power that the damper takes, k t |s(v)|^2 in W.
template <Law law>
CLOTHLAB_INLINE Vector bend(V stiffness, const Springs& springs, const Particles& sum, V& loss) {
  if constexpr (law == Law::elastic) return scaled(stiffness, sum.position);
  const V damper = Lanes::mul(stiffness, springs.bending_time);
  loss = Lanes::fma(damper, squared(sum.velocity), loss);
  return plus(scaled(stiffness, sum.position), damper, sum.velocity);
}

/// a - 2 b + c
template <Law law>
CLOTHLAB_INLINE Particles second_difference(const Particles& a, const Particles& b, const Particles& c) {
  const Vector x = (a.position - b.position) + (c.position - b.position);
  if constexpr (law == Law::elastic) return {x, x};
  return {x, (a.velocity - b.velocity) + (c.velocity - b.velocity)};
}
/// a - b - c + d
template <Law law>
CLOTHLAB_INLINE Particles twist_of(const Particles& a, const Particles& b, const Particles& c,
                                   const Particles& d) {
  const Vector x = (a.position - b.position) + (d.position - c.position);
  if constexpr (law == Law::elastic) return {x, x};
  return {x, (a.velocity - b.velocity) + (d.velocity - c.velocity)};
}

template <bool Edge>
CLOTHLAB_INLINE V stiffness_at(const double* row, int j, int count) {
  if constexpr (Edge) return Lanes::load(row + j, count, Lanes::zero());
  return Lanes::load(row + j);
}

/// The force before any spring is added, of particles of a row with this share.
template <bool Edge>
CLOTHLAB_INLINE Vector initial_share(const ConstRow& load_row, const RowWork& work, V of_row, int j,
                                     int count) {
  const Vector weight = scaled(Lanes::mul(of_row, Lanes::load(work.part + j)), work.weight);
  return initial<Edge>(load_row, weight, j, count);
}

/// As block_force() for grids of equal springs; `Full`: a row that is not one of the last two, of a cloth
/// that bends and has both families.
template <Law law, bool Full, bool Edge>
CLOTHLAB_INLINE Vector block_force_by_cell(const RowWork& work, int j, int count, const Particles& here,
                                           Carry& carry, V& loss) {
  const Springs& springs = *work.springs;
  const auto has = [&](unsigned bits) { return Full || (work.present & bits) != 0; };
  const bool has_below = Full || work.has_below;
  const bool bends = law != Law::damper && (Full || work.bending.across != nullptr);
  const auto ahead = [&](const ParticleRow& row, int columns) {
    if constexpr (Edge) return particles_at<law>(row, j + columns, count - columns, here);
    return particles_at<law>(row, j + columns);
  };
  const Vector nothing{Lanes::zero(), Lanes::zero(), Lanes::zero()};
  Vector force = load(work.a, j);
  Vector below_force = nothing;
  if (has_below)
    below_force =
        work.uses_b ? load(work.b, j) : initial_share<Edge>(work.load_below, work, work.of_below, j, count);
  Vector one = nothing, two = nothing, one_below = nothing;
  Vector d;

  const Particles right = ahead(work.here, 1);
  if (has(right_one)) {
    const V s = springs.pull<law, right_one>(work.of_row, here, right, d, loss);
    force = plus(force, s, d);
    one = minus(one, s, d);
  }
  if (has_below) {
    const Particles below = ahead(work.below, 0), below_right = ahead(work.below, 1);
    if (has(down_one)) {
      const V s = springs.pull<law, down_one>(Lanes::load(work.part + j), here, below, d, loss);
      force = plus(force, s, d);
      below_force = minus(below_force, s, d);
    }
    if (has(antidiagonal)) {
      Particles from = right;
      if constexpr (Edge) from = particles_at<law>(work.here, j + 1, count - 1, below);
      const V s = springs.pull<law, antidiagonal>(from, below, d, loss);
      one = plus(one, s, d);
      below_force = minus(below_force, s, d);
    }
    if (has(diagonal)) {
      Particles to = below_right;
      const V s = springs.pull<law, diagonal>(here, to, d, loss);
      force = plus(force, s, d);
      one_below = scaled(s, d);
    }
    if (bends) {
      const Vector f = bend<law>(stiffness_at<Edge>(work.bending.twist, j, count), springs,
                                 twist_of<law>(here, right, below, below_right), loss);
      force = force - f;
      one = one + f;
      below_force = below_force + f;
      one_below = one_below + f;
    }
    if (bends && (Full || work.has_second)) {
      const Vector f = bend<law>(stiffness_at<Edge>(work.bending.down, j, count), springs,
                                 second_difference<law>(here, below, ahead(work.second, 0)), loss);
      force = force - f;
      below_force = below_force + (f + f);
      store(work.b, j, initial_share<Edge>(work.load_second, work, work.of_second, j, count) - f);
    }
    below_force = below_force - moved_one(carry.one_below, one_below);
  }
  if (bends) {
    two = bend<law>(stiffness_at<Edge>(work.bending.across, j, count), springs,
                    second_difference<law>(here, right, ahead(work.here, 2)), loss);
    force = force - two - moved_two(carry.two, two);
    one = one + (two + two);
  }
  force = force + moved_one(carry.one, one);
  if (has_below) store(work.a, j, below_force);
  carry = {one, two, one_below};
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
