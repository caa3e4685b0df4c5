// The equation of one particle in a visit by VBD, H dx = f, in lanes: what grid_visits.h and
// coloured_descent.h share. Included once for every instruction set; everything here has internal linkage.
#pragma once

#include "kernels/kernel_table.h"
#include "kernels/lane_vectors.h"

namespace cloth::kernels {
namespace {

/// f and H of a vector of particles.
struct VisitSums {
  Vector force;
  V alike;  ///< of H's diagonal, in every direction
  V xx, xy, xz, yy, yz, zz;
  V reach;  ///< m
};

CLOTHLAB_INLINE Vector read_lanes(double* const (&field)[3], long at) {
  return {Lanes::load(field[0] + at), Lanes::load(field[1] + at), Lanes::load(field[2] + at)};
}
CLOTHLAB_INLINE void write_lanes(double* const (&field)[3], long at, const Vector& value) {
  Lanes::store(field[0] + at, value.x), Lanes::store(field[1] + at, value.y);
  Lanes::store(field[2] + at, value.z);
}

/// M I and -M u
CLOTHLAB_INLINE VisitSums inertia_of(V mass, const Vector& shift) {
  const V none = Lanes::zero();
  return {minus({none, none, none}, mass, shift), mass, none, none, none, none, none, none, none};
}

/// b d^T
CLOTHLAB_INLINE void add_product(const Vector& b, const Vector& d, VisitSums& sums) {
  sums.xx = Lanes::fma(b.x, d.x, sums.xx), sums.xy = Lanes::fma(b.x, d.y, sums.xy);
  sums.xz = Lanes::fma(b.x, d.z, sums.xz), sums.yy = Lanes::fma(b.y, d.y, sums.yy);
  sums.yz = Lanes::fma(b.y, d.z, sums.yz), sums.zz = Lanes::fma(b.z, d.z, sums.zz);
}

/// b b^T and -(b . u) b
CLOTHLAB_INLINE void add_drag(const Vector& b, const Vector& shift, VisitSums& sums) {
  sums.force = minus(sums.force, product(b, shift), b);
  add_product(b, b, sums);
}

/// The force t d, the stiffness `across` I + `along` d d^T, and how far the spring could ask for.
CLOTHLAB_INLINE void add_element(const Vector& d, V tension, V across, V along, V reach, VisitSums& sums) {
  sums.force = plus(sums.force, tension, d);
  sums.alike = Lanes::add(sums.alike, across);
  sums.reach = Lanes::max(reach, sums.reach);
  add_product(scaled(along, d), d, sums);
}

/// H^-1 f where `free` is 1, and 0 where it is 0.
CLOTHLAB_INLINE Vector solved(const VisitSums& sums, V free) {
  const V xx = Lanes::add(sums.xx, sums.alike), yy = Lanes::add(sums.yy, sums.alike),
          zz = Lanes::add(sums.zz, sums.alike);
  const V xy = sums.xy, xz = sums.xz, yz = sums.yz;
  const V cxx = Lanes::fnma(yz, yz, Lanes::mul(yy, zz)), cxy = Lanes::fnma(xy, zz, Lanes::mul(xz, yz)),
          cxz = Lanes::fnma(xz, yy, Lanes::mul(xy, yz)), cyy = Lanes::fnma(xz, xz, Lanes::mul(xx, zz)),
          cyz = Lanes::fnma(xx, yz, Lanes::mul(xy, xz)), czz = Lanes::fnma(xy, xy, Lanes::mul(xx, yy));
  const V determinant = Lanes::fma(xx, cxx, Lanes::fma(xy, cxy, Lanes::mul(xz, cxz)));
  const V share = Lanes::div(free, determinant);
  const Vector f = sums.force;
  return scaled(share,
                {product({cxx, cxy, cxz}, f), product({cxy, cyy, cyz}, f), product({cxz, cyz, czz}, f)});
}

/// Where the squared distance is beyond the squared reach, as far as that.
[[gnu::noinline]] Vector shortened(const Vector& change, V distance, V reach) {
  const V length = Lanes::mul(reach, Lanes::inverse_root<true>(reach));
  const V ratio = Lanes::mul(length, Lanes::inverse_root<true>(distance)), one = Lanes::set(1);
  return scaled(Lanes::sub(one, Lanes::max(Lanes::sub(one, ratio), Lanes::zero())), change);
}

/// The move that the sums ask for, not further than their reach or |u|.
CLOTHLAB_INLINE Vector move_of(const VisitSums& sums, V free, const Vector& shift) {
  const Vector change = solved(sums, free);
  const V reach = Lanes::max(Lanes::mul(sums.reach, sums.reach), squared(shift)), distance = squared(change);
  if (Lanes::any_positive(Lanes::sub(distance, reach))) [[unlikely]]
    return shortened(change, distance, reach);
  return change;
}

CLOTHLAB_INLINE void note_move(const Vector& change, V& largest, V& squares) {
  const V distance = squared(change);
  largest = Lanes::max(distance, largest);
  squares = Lanes::add(squares, distance);
}

CLOTHLAB_INLINE double largest_lane(V lanes) {
  double numbers[Lanes::width], most = 0;
  Lanes::store(numbers, lanes);
  for (const double number : numbers) most = number > most ? number : most;
  return most;
}

}  // namespace
}  // namespace cloth::kernels
