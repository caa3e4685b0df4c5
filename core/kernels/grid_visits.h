// VBD's visits of the particles of a grid of springs (integrators/vbd.h), many at a time. With u = x - y,
// what a particle has moved from where its inertia takes it, M = W^-1/h^2 (N/m) and of each of its springs d
// = x_j - x_i, l = |d|, d_0 = d at the start of the step, c = k_d/h (N/m), a visit is
//
//     t = k (1 - L/l) + c (1 - d . d_0/l^2),   f = sum t d - M u
//     H = M I + sum max(t, 0) I + (k + c - max(t, 0)) d d^T/l^2
//     u += H^-1 f,  x += H^-1 f;   not further than the longest l + L, or |u|
//
// which is the visit of that file in positions. d/l and L/l are 0 where l is. H^-1 is made of cofactors.
//
// Particles (row, column) of one colour, (row + 2 column) mod 5, share no spring, and are visited together;
// the colours follow one another. Their storage (grid_descent.h) has in each row first the columns 0, 5, 10,
// ..., then 1, 6, ...: so the columns of a colour in a row lie side by side, and so do their neighbours.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/lane_vectors.h"

namespace cloth::kernels {
namespace {

/// Where a spring leads from a particle, and its direction's number.
struct SpringTo {
  int down, right, kind;
};
constexpr SpringTo springs_of_particle[] = {{-2, 0, 3}, {-1, -1, 4}, {-1, 0, 2}, {-1, 1, 5},
                                            {0, -2, 1}, {0, -1, 0},  {0, 1, 0},  {0, 2, 1},
                                            {1, -1, 5}, {1, 0, 2},   {1, 1, 4},  {2, 0, 3}};
constexpr int visit_colours = 5;

/// f and H of a vector of particles.
struct VisitSums {
  Vector force;
  V alike;  ///< of H's diagonal, in every direction
  V xx, xy, xz, yy, yz, zz;
  V reach;  ///< m
};

template <bool damped>
class ParticleVisits {
 public:
  explicit ParticleVisits(const Descent& descent)
      : descent_(descent), largest_(Lanes::zero()), squares_(Lanes::zero()) {}

  void all() {
    for (int colour = 0; colour < visit_colours; ++colour)
      for (int row = 0; row < descent_.grid.rows; ++row) visit_row(row, colour);
  }

  double largest() const {
    double lanes[Lanes::width], most = 0;
    Lanes::store(lanes, largest_);
    for (const double lane : lanes) most = lane > most ? lane : most;
    return most;
  }
  double squares() const { return Lanes::sum(squares_); }

 private:
  /// The columns with row + 2 column = colour mod 5 are those with column = 3 (colour - row) mod 5.
  void visit_row(int row, int colour) {
    const int columns = descent_.grid.columns;
    const int residue = ((3 * (colour - row)) % visit_colours + visit_colours) % visit_colours;
    const bool has_rows = row >= 2 && row + 2 < descent_.grid.rows;
    for (int at = 0; visit_colours * at + residue < columns; at += Lanes::width) {
      const int first = visit_colours * at + residue, last = first + visit_colours * (Lanes::width - 1);
      if (has_rows && first >= 2 && last + 2 < columns)
        visit<false>(row, residue, at);
      else
        visit<true>(row, residue, at);
    }
  }

  CLOTHLAB_INLINE static Vector read(double* const (&field)[3], long at) {
    return {Lanes::load(field[0] + at), Lanes::load(field[1] + at), Lanes::load(field[2] + at)};
  }
  CLOTHLAB_INLINE static void write(double* const (&field)[3], long at, const Vector& value) {
    Lanes::store(field[0] + at, value.x), Lanes::store(field[1] + at, value.y);
    Lanes::store(field[2] + at, value.z);
  }

  /// `edge`: some of the springs may not be there.
  template <bool edge>
  CLOTHLAB_INLINE void visit(int row, int residue, int at) {
    const long place = descent_.place(row, residue, at);
    const Vector here = read(descent_.position, place), shift = read(descent_.shift, place);
    const V mass = Lanes::load(descent_.mass + place), none = Lanes::zero();
    Vector start{none, none, none};
    if constexpr (damped) start = read(descent_.start, place);
    VisitSums sums{minus({none, none, none}, mass, shift), mass, none, none, none, none, none, none, none};
    add_springs<edge, 0>(row, residue, at, here, start, sums);
    Vector change = solved(sums, Lanes::load(descent_.free + place));
    const V reach = Lanes::max(Lanes::mul(sums.reach, sums.reach), squared(shift));
    V distance = squared(change);
    if (Lanes::any_positive(Lanes::sub(distance, reach))) [[unlikely]] {
      change = shortened(change, distance, reach);
      distance = squared(change);
    }
    largest_ = Lanes::max(distance, largest_);
    squares_ = Lanes::add(squares_, distance);
    write(descent_.shift, place, shift + change);
    write(descent_.position, place, here + change);
  }

  template <bool edge, int number>
  CLOTHLAB_INLINE void add_springs(int row, int residue, int at, const Vector& here, const Vector& start,
                                   VisitSums& sums) {
    constexpr SpringTo to = springs_of_particle[number];
    const bool is_there = (descent_.grid.springs & (1u << to.kind)) &&
                          (!edge || (row + to.down >= 0 && row + to.down < descent_.grid.rows));
    if (is_there) add_spring<edge, number>(row + to.down, residue + to.right, at, here, start, sums);
    if constexpr (number + 1 < 12) add_springs<edge, number + 1>(row, residue, at, here, start, sums);
  }

  /// The spring to `column` = residue + right of `row`.
  template <bool edge, int number>
  CLOTHLAB_INLINE void add_spring(int row, int column, int at, const Vector& here, const Vector& start,
                                  VisitSums& sums) {
    constexpr int kind = springs_of_particle[number].kind;
    constexpr bool divided = (Lanes::divided & (1u << kind)) != 0;
    const int turn = column < 0 ? -1 : column >= visit_colours ? 1 : 0;
    const int residue = column - turn * visit_colours;
    const long place = descent_.place(row, residue, at + turn);
    const Vector d = read(descent_.position, place) - here;
    const V s = squared(d), inverse = Lanes::inverse_root<divided>(s), square = Lanes::mul(inverse, inverse);
    V stiffness = Lanes::set(descent_.grid.kind[kind].stiffness);
    V tension = Lanes::fnma(Lanes::set(descent_.grid.kind[kind].rest_tension), inverse, stiffness);
    if constexpr (damped) {
      const V damper = Lanes::set(descent_.damper), first = product(d, read(descent_.start, place) - start);
      tension = Lanes::fma(damper, Lanes::fnma(first, square, Lanes::set(1)), tension);
      stiffness = Lanes::add(stiffness, damper);
    }
    V across = Lanes::max(tension, Lanes::zero());
    V along = Lanes::mul(Lanes::sub(stiffness, across), square);
    V reach = Lanes::fma(s, inverse, Lanes::set(descent_.rest_length[kind]));
    if constexpr (edge) {
      const V there = Lanes::load(descent_.there + residue * descent_.residue_stride + at + turn);
      tension = Lanes::mul(there, tension), across = Lanes::mul(there, across);
      along = Lanes::mul(there, along), reach = Lanes::mul(there, reach);
    }
    sums.force = plus(sums.force, tension, d);
    sums.alike = Lanes::add(sums.alike, across);
    sums.reach = Lanes::max(reach, sums.reach);
    const Vector b = scaled(along, d);
    sums.xx = Lanes::fma(b.x, d.x, sums.xx), sums.xy = Lanes::fma(b.x, d.y, sums.xy);
    sums.xz = Lanes::fma(b.x, d.z, sums.xz), sums.yy = Lanes::fma(b.y, d.y, sums.yy);
    sums.yz = Lanes::fma(b.y, d.z, sums.yz), sums.zz = Lanes::fma(b.z, d.z, sums.zz);
  }

  /// H^-1 f where `free` is 1, and 0 where it is 0.
  CLOTHLAB_INLINE static Vector solved(const VisitSums& sums, V free) {
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
  [[gnu::noinline]] static Vector shortened(const Vector& change, V distance, V reach) {
    const V length = Lanes::mul(reach, Lanes::inverse_root<true>(reach));
    const V ratio = Lanes::mul(length, Lanes::inverse_root<true>(distance)), one = Lanes::set(1);
    return scaled(Lanes::sub(one, Lanes::max(Lanes::sub(one, ratio), Lanes::zero())), change);
  }

  const Descent& descent_;
  V largest_, squares_;
};

template <bool damped>
void descend_with(Descent& descent) {
  ParticleVisits<damped> visits(descent);
  visits.all();
  descent.largest_change = visits.largest();
  descent.squares = visits.squares();
}

void descend_all(Descent& descent) {
  descent.damper > 0 ? descend_with<true>(descent) : descend_with<false>(descent);
}

/// u' = before + weight (u - before), x' = x + u' - u.
void extrapolate_all(const Descent& descent, double weight) {
  const V w = Lanes::set(weight);
  for (int axis = 0; axis < 3; ++axis) {
    double *position = descent.position[axis], *shift = descent.shift[axis];
    const double* before = descent.before[axis];
    const long end = descent.place(descent.grid.rows, 0, 0);
    for (long at = 0; at < end; at += Lanes::width) {
      const V old = Lanes::load(before + at), u = Lanes::load(shift + at);
      const V next = Lanes::fma(w, Lanes::sub(u, old), old);
      Lanes::store(position + at, Lanes::add(Lanes::load(position + at), Lanes::sub(next, u)));
      Lanes::store(shift + at, next);
    }
  }
}

}  // namespace
}  // namespace cloth::kernels
