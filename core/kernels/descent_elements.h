// What bending, triangles and sliders add to a particle's equation in a visit by VBD: the part of
// coloured_descent.h beside springs. With x = the places now, s those at the start of the step and t a
// damping time over the step:
//
//     bending    f += (1 + t) sum K_ij (x_i - x_j) + held,   held = t sum K_ij (s_j - s_i),   H += (1 + t)
//     K_ii I triangles  q_e = |d_e|^2 - L_e^2 + 2 t d_e . (d_e - s_e),   p = K q,   f += 2 (p_out d_out -
//     p_in d_in),
//                H += 4 (1 + t) [K_oo d_o d_o^T + K_ii d_i d_i^T - K_oi (d_o d_i^T + d_i d_o^T)] + 2 max(p,
//                0) I
//     sliders    f -= c M n,   M = clamp(w (n . sum c_q x_q - slip), -most, most),   H += w c^2 n n^T
//
// K_ii = -sum K_ij; d_out = d_o leads from the particle to the triangle's next corner, d_in = d_i to the
// particle from the one before. Sources: cloth/bending_rows.h, membrane.h and bending_sliders.h. Included
// once for every instruction set; everything here has internal linkage.
#pragma once

#include "kernels/local_pass.h"
#include "kernels/particle_equation.h"

namespace cloth::kernels {
namespace {

CLOTHLAB_INLINE Vector gathered(const double* vectors, const int* at) {
  Vector value;
  Lanes::gather(vectors, at, value.x, value.y, value.z);
  return value;
}
CLOTHLAB_INLINE V length_of(V square) {
  return Lanes::mul(square, Lanes::inverse_root<false>(square));
}
CLOTHLAB_INLINE void reach_for(V reach, VisitSums& sums) {
  sums.reach = Lanes::max(reach, sums.reach);
}

/// Bending alone would move the particle by its force over its stiffness.
CLOTHLAB_INLINE void add_bending(const BendingSlots& bending, int slice, int part, const double* vectors,
                                 const Vector& here, VisitSums& sums) {
  const int place = slice * widest_vector + part, end = bending.begin[slice + 1] * widest_vector;
  const V none = Lanes::zero(), scale = Lanes::set(bending.scale);
  Vector pull{none, none, none};
  for (int at = bending.begin[slice] * widest_vector + part; at < end; at += widest_vector)
    pull = minus(pull, Lanes::load(bending.coupling + at), gathered(vectors, bending.neighbour + at) - here);
  const Vector held{Lanes::load(bending.held[0] + place), Lanes::load(bending.held[1] + place),
                    Lanes::load(bending.held[2] + place)};
  const Vector force = plus(held, scale, pull);
  const V own = Lanes::mul(scale, Lanes::load(bending.own + place));
  sums.force = sums.force + force;
  sums.alike = Lanes::add(sums.alike, own);
  reach_for(Lanes::where_positive(own, Lanes::div(length_of(squared(force)), own)), sums);
}

/// The edges that meet in a corner, and the one opposite.
struct TriangleEdges {
  Vector out, in, opposite;
};
CLOTHLAB_INLINE TriangleEdges edges_at(const Vector& here, const Vector& next, const Vector& before) {
  return {next - here, here - before, before - next};
}

template <bool damped>
CLOTHLAB_INLINE V square_change(const Vector& now, const Vector& start, V rest_square, V twice_time) {
  const V change = Lanes::sub(squared(now), rest_square);
  if constexpr (!damped) return change;
  return Lanes::fma(twice_time, product(now, now - start), change);
}

template <bool damped>
CLOTHLAB_INLINE void add_triangle(const TriangleSlots& triangles, int slot, int part, const double* vectors,
                                  const double* start_vectors, const Vector& here, const Vector& start,
                                  VisitSums& sums) {
  const int at = slot * widest_vector + part;
  const double* numbers = triangles.numbers + slot * triangle_numbers * widest_vector + part;
  const auto number = [numbers](int n) { return Lanes::load(numbers + n * widest_vector); };
  const TriangleEdges d =
      edges_at(here, gathered(vectors, triangles.next + at), gathered(vectors, triangles.before + at));
  TriangleEdges first = d;
  if constexpr (damped)
    first = edges_at(start, gathered(start_vectors, triangles.next + at),
                     gathered(start_vectors, triangles.before + at));
  const V twice_time = Lanes::set(2 * triangles.time), rest_out = number(0), rest_in = number(1);
  const V q_out = square_change<damped>(d.out, first.out, rest_out, twice_time),
          q_in = square_change<damped>(d.in, first.in, rest_in, twice_time),
          q_opposite = square_change<damped>(d.opposite, first.opposite, number(2), twice_time);
  const V k_out = number(3), k_in = number(4), k_both = number(5);
  const V out = Lanes::fma(k_out, q_out, Lanes::fma(k_both, q_in, Lanes::mul(number(6), q_opposite))),
          in = Lanes::fma(k_both, q_out, Lanes::fma(k_in, q_in, Lanes::mul(number(7), q_opposite)));
  const V two = Lanes::set(2), weight = Lanes::set(4 * (1 + triangles.time)), none = Lanes::zero();
  sums.force = plus(sums.force, Lanes::mul(two, out), d.out);
  sums.force = minus(sums.force, Lanes::mul(two, in), d.in);
  const V across = Lanes::add(Lanes::max(out, none), Lanes::max(in, none));
  sums.alike = Lanes::fma(two, across, sums.alike);
  // b_o d_o^T + b_i d_i^T with b_o = K_oo d_o - K_oi d_i: symmetric in sum, of which the upper half is added.
  add_product(scaled(weight, minus(scaled(k_out, d.out), k_both, d.in)), d.out, sums);
  add_product(scaled(weight, minus(scaled(k_in, d.in), k_both, d.out)), d.in, sums);
  reach_for(Lanes::where_positive(rest_out, Lanes::add(length_of(squared(d.out)), length_of(rest_out))),
            sums);
  reach_for(Lanes::where_positive(rest_in, Lanes::add(length_of(squared(d.in)), length_of(rest_in))), sums);
}

/// With the stiffness of a slider that does not yield, which is never too little.
CLOTHLAB_INLINE void add_slider(const SliderSlots& sliders, int slot, int part, const double* vectors,
                                VisitSums& sums) {
  const double* numbers = sliders.numbers + slot * slider_numbers * widest_vector + part;
  const auto number = [numbers](int n) { return Lanes::load(numbers + n * widest_vector); };
  const V none = Lanes::zero(), stiffness = number(4), most = number(5);
  const Vector n{number(0), number(1), number(2)};
  Vector sum{none, none, none};
  for (int point = sliders.points[slot]; point < sliders.points[slot + 1]; ++point) {
    const int at = point * widest_vector + part;
    sum = plus(sum, Lanes::load(sliders.coefficient + at), gathered(vectors, sliders.neighbour + at));
  }
  const V stretch = Lanes::sub(product(n, sum), number(3));
  const V moment = Lanes::max(Lanes::min(Lanes::mul(stiffness, stretch), most), Lanes::sub(none, most));
  const Vector pull = scaled(number(6), n);  // c n
  sums.force = minus(sums.force, moment, pull);
  add_product(scaled(stiffness, pull), pull, sums);
  const V distance = Lanes::mul(stretch, number(7));
  reach_for(Lanes::max(distance, Lanes::sub(none, distance)), sums);
}

}  // namespace
}  // namespace cloth::kernels
