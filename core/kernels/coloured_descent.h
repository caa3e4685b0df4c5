// VBD's visits of the particles of any cloth (integrators/vbd.h), many at a time: the visit of grid_visits.h,
// with the springs of each particle in slots, and the elements of a material (descent_elements.h). The
// particles of a slice (mesh_descent.h) are of one colour and share no element; slice follows slice.
#pragma once

#include "kernels/descent_elements.h"

namespace cloth::kernels {
namespace {

template <bool damped, bool dragged>
class ColouredParticles {
 public:
  explicit ColouredParticles(ColouredDescent& descent)
      : descent_(descent), largest_(Lanes::zero()), squares_(Lanes::zero()) {}

  void all() {
    for (int slice = 0; slice < descent_.slices; ++slice)
      for (int part = 0; part < widest_vector; part += Lanes::width) visit(slice, part);
    descent_.largest_change = largest_lane(largest_);
    descent_.squares = Lanes::sum(squares_);
  }

 private:
  CLOTHLAB_INLINE void visit(int slice, int part) {
    const int place = slice * widest_vector + part;
    const Vector here = read_lanes(descent_.position, place), shift = read_lanes(descent_.shift, place);
    const V none = Lanes::zero();
    Vector start{none, none, none};
    if constexpr (damped) start = read_lanes(descent_.start, place);
    VisitSums sums = inertia_of(Lanes::load(descent_.mass + place), shift);
    const int end = descent_.slot_begin[slice + 1] * widest_vector + part;
    for (int at = descent_.slot_begin[slice] * widest_vector + part; at < end; at += widest_vector)
      add_spring(at, here, start, sums);
    add_elements(slice, part, here, start, sums);
    if constexpr (dragged) add_drag(read_lanes(descent_.drag, place), shift, sums);
    const Vector change = move_of(sums, Lanes::load(descent_.free + place), shift), next = here + change;
    note_move(change, largest_, squares_);
    write_lanes(descent_.shift, place, shift + change);
    write_lanes(descent_.position, place, next);
    Lanes::put(descent_.vectors + 4 * place, next.x, next.y, next.z);
  }

  /// Of a lane without a spring the stiffness is 0, and its other end far away.
  CLOTHLAB_INLINE void add_spring(int at, const Vector& here, const Vector& start, VisitSums& sums) {
    Vector other;
    Lanes::gather(descent_.vectors, descent_.neighbour + at, other.x, other.y, other.z);
    const Vector d = other - here;
    const V s = squared(d), inverse = Lanes::inverse_root<false>(s), square = Lanes::mul(inverse, inverse);
    const V k = Lanes::load(descent_.stiffness + at), rest_length = Lanes::load(descent_.rest_length + at);
    V stiffness = k, tension = Lanes::fnma(Lanes::mul(k, rest_length), inverse, k);
    if constexpr (damped) {
      Vector first;
      Lanes::gather(descent_.start_vectors, descent_.neighbour + at, first.x, first.y, first.z);
      const V each = Lanes::where_positive(k, Lanes::set(descent_.damper));
      const V damper = Lanes::fma(Lanes::set(descent_.damper_per_stiffness), k, each);
      const V part = Lanes::fnma(product(d, first - start), square, Lanes::set(1));
      tension = Lanes::fma(damper, part, tension);
      stiffness = Lanes::add(stiffness, damper);
    }
    const V across = Lanes::max(tension, Lanes::zero());
    const V along = Lanes::mul(Lanes::sub(stiffness, across), square);
    const V reach = Lanes::where_positive(k, Lanes::fma(s, inverse, rest_length));
    add_element(d, tension, across, along, reach, sums);
  }

  CLOTHLAB_INLINE void add_elements(int slice, int part, const Vector& here, const Vector& start,
                                    VisitSums& sums) {
    const BendingSlots& bending = descent_.bending;
    const TriangleSlots& triangles = descent_.triangles;
    const SliderSlots& sliders = descent_.sliders;
    if (bending.begin) add_bending(bending, slice, part, descent_.vectors, here, sums);
    if (triangles.begin)
      for (int slot = triangles.begin[slice]; slot < triangles.begin[slice + 1]; ++slot)
        add_triangle<damped>(triangles, slot, part, descent_.vectors, descent_.start_vectors, here, start,
                             sums);
    if (sliders.begin)
      for (int slot = sliders.begin[slice]; slot < sliders.begin[slice + 1]; ++slot)
        add_slider(sliders, slot, part, descent_.vectors, sums);
  }

  ColouredDescent& descent_;
  V largest_, squares_;
};

template <bool damped, bool dragged>
void descend_coloured_with(ColouredDescent& descent) {
  ColouredParticles<damped, dragged>(descent).all();
}
void descend_coloured(ColouredDescent& descent) {
  if (descent.drag[0])
    descent.start_vectors ? descend_coloured_with<true, true>(descent)
                          : descend_coloured_with<false, true>(descent);
  else
    descent.start_vectors ? descend_coloured_with<true, false>(descent)
                          : descend_coloured_with<false, false>(descent);
}

/// u' = before + weight (u - before), x' = x + u' - u.
void extrapolate_all(const DescentFields& descent, double weight) {
  const V w = Lanes::set(weight);
  for (int axis = 0; axis < 3; ++axis) {
    double *position = descent.position[axis], *shift = descent.shift[axis];
    const double* before = descent.before[axis];
    for (int at = 0; at < descent.places; at += Lanes::width) {
      const V old = Lanes::load(before + at), u = Lanes::load(shift + at);
      const V next = Lanes::fma(w, Lanes::sub(u, old), old);
      Lanes::store(position + at, Lanes::add(Lanes::load(position + at), Lanes::sub(next, u)));
      Lanes::store(shift + at, next);
    }
  }
}

}  // namespace
}  // namespace cloth::kernels
