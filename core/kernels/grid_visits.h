// VBD's visits of the particles of a grid of springs (integrators/vbd.h), many at a time. With u = x - y,
// what a particle has moved from where its inertia takes it, and of each of its springs d
// = x_j - x_i, l = |d|, d_0 = d at the start of the step, c = k_d/h (N/m), a visit is
//
//     t = k (1 - L/l) + c (1 - d . d_0/l^2),   f = sum t d - M u - (b . u) b
//     H = M I + b b^T + sum max(t, 0) I + (k + c - max(t, 0)) d d^T/l^2
//     u += H^-1 f,  x += H^-1 f;   not further than the longest l + L, or |u|
//
// which is the visit of that file in positions, W^-1/h^2 = M I + b b^T. d/l and L/l are 0 where l is. H^-1 is
// made of cofactors (particle_equation.h).
//
// Particles (row, column) of one colour, (row + 2 column) mod 5, share no spring, and are visited together;
// the colours follow one another. Their storage (grid_descent.h) has in each row first the columns 0, 5, 10,
// ..., then 1, 6, ...: so the columns of a colour in a row lie side by side, and so do their neighbours.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/lane_vectors.h"
#include "kernels/particle_equation.h"

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

template <bool damped, bool dragged>
class ParticleVisits {
 public:
  explicit ParticleVisits(const Descent& descent)
      : descent_(descent), largest_(Lanes::zero()), squares_(Lanes::zero()) {}

  void all() {
    for (int colour = 0; colour < visit_colours; ++colour)
      for (int row = 0; row < descent_.grid.rows; ++row) visit_row(row, colour);
  }

  double largest() const { return largest_lane(largest_); }
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

  /// `edge`: some of the springs may not be there.
  template <bool edge>
  CLOTHLAB_INLINE void visit(int row, int residue, int at) {
    const long place = descent_.place(row, residue, at);
    const Vector here = read_lanes(descent_.position, place), shift = read_lanes(descent_.shift, place);
    const V mass = Lanes::load(descent_.mass + place), none = Lanes::zero();
    Vector start{none, none, none};
    if constexpr (damped) start = read_lanes(descent_.start, place);
    VisitSums sums = inertia_of(mass, shift);
    add_springs<edge, 0>(row, residue, at, here, start, sums);
    if constexpr (dragged) add_drag(read_lanes(descent_.drag, place), shift, sums);
    const Vector change = move_of(sums, Lanes::load(descent_.free + place), shift);
    note_move(change, largest_, squares_);
    write_lanes(descent_.shift, place, shift + change);
    write_lanes(descent_.position, place, here + change);
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
    const Vector d = read_lanes(descent_.position, place) - here;
    const V s = squared(d), inverse = Lanes::inverse_root<divided>(s), square = Lanes::mul(inverse, inverse);
    V stiffness = Lanes::set(descent_.grid.kind[kind].stiffness);
    V tension = Lanes::fnma(Lanes::set(descent_.grid.kind[kind].rest_tension), inverse, stiffness);
    if constexpr (damped) {
      const V damper = Lanes::set(descent_.damper),
              first = product(d, read_lanes(descent_.start, place) - start);
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
    add_element(d, tension, across, along, reach, sums);
  }

  const Descent& descent_;
  V largest_, squares_;
};

template <bool damped, bool dragged>
void descend_with(Descent& descent) {
  ParticleVisits<damped, dragged> visits(descent);
  visits.all();
  descent.largest_change = visits.largest();
  descent.squares = visits.squares();
}

void descend_all(Descent& descent) {
  if (descent.drag[0])
    descent.damper > 0 ? descend_with<true, true>(descent) : descend_with<false, true>(descent);
  else
    descent.damper > 0 ? descend_with<true, false>(descent) : descend_with<false, false>(descent);
}

}  // namespace
}  // namespace cloth::kernels
