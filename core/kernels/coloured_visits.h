// XPBD's visits of any springs (integrators/xpbd.h), many at a time. With d = x_j - x_i + h (v_j - v_i), l =
// |d| and u = v_j - v_i a visit of the spring from i to j, whose impulse is 0 before it, is
//
//     P = -h (k (1 - L/l) + k_d u . d/l^2) / (1 + h (h k + k_d) d . (W_i + W_j) d/l^2) d
//     v_i -= W_i P,  v_j += W_j P,  W = w I - b b^T
//
// Macklin et al. 2016, Eq. (18) and (26), with velocities for positions. Where a spring keeps an impulse from
// earlier visits, the whole of it is turned into the present direction; xpbd.cpp has that visit for one
// spring at a time. d/l is 0 where l is.
//
// The vectors d of a register's springs are made particle by particle, in one register each, and turned into
// lanes for what needs roots and divisions.
#pragma once

#include "kernels/four.h"
#include "kernels/kernel_table.h"
#include "kernels/lane_vectors.h"
#include "kernels/local_pass.h"

namespace cloth::kernels {
namespace {

constexpr int one_by_one[] = {0, 4, 8, 12, 16, 20, 24, 28};

/// A 4-vector for each lane.
struct alignas(64) Turned {
  double of[4 * Lanes::width];
  CLOTHLAB_INLINE double* lane(int k) { return of + 4 * k; }
  CLOTHLAB_INLINE const double* lane(int k) const { return of + 4 * k; }
  CLOTHLAB_INLINE Vector lanes() const { return lanes_at(of, one_by_one); }
  CLOTHLAB_INLINE static Vector lanes_at(const double* vectors, const int* at) {
    Vector v;
    Lanes::gather(vectors, at, v.x, v.y, v.z);
    return v;
  }
};
struct alignas(64) LaneNumbers {
  double of[Lanes::width];
  explicit LaneNumbers(V lanes) { Lanes::store(of, lanes); }
};

template <bool damped, bool dragged, bool measured>
class ColouredVisits {
 public:
  explicit ColouredVisits(ColouredProjection& pass) : pass_(pass), largest_(Lanes::zero()) {}

  void first_visits() {
    for (int at = 0; at < pass_.springs; at += Lanes::width) first_visit(at);
    if (measured) pass_.largest_change = largest();
  }
  void later_visits() {
    for (int at = 0; at < pass_.springs; at += Lanes::width) later_visit(at);
    if (measured) pass_.largest_change = largest();
  }

 private:
  double largest() const {
    const LaneNumbers lanes(largest_);
    double most = 0;
    for (const double lane : lanes.of) most = lane > most ? lane : most;
    return most;
  }

  CLOTHLAB_INLINE Vector drag_at(const int* ends) const { return Turned::lanes_at(pass_.drag, ends); }

  CLOTHLAB_INLINE void first_visit(int at) {
    const int *i = pass_.first + at, *j = pass_.second + at;
    Turned between, speed;
    for (int k = 0; k < Lanes::width; ++k) {
      const Four u = load_four(pass_.velocity + j[k]) - load_four(pass_.velocity + i[k]);
      const Four x = load_four(pass_.position + j[k]) - load_four(pass_.position + i[k]);
      store_four(between.lane(k), x + pass_.step * u);
      if constexpr (damped) store_four(speed.lane(k), u);
    }
    const Vector d = between.lanes();
    const V inverse = Lanes::inverse_root<false>(squared(d));
    V scale = Lanes::fnma(Lanes::load(pass_.tension + at), inverse, Lanes::load(pass_.stretch + at));
    if constexpr (damped) {
      const V rate = Lanes::mul(product(speed.lanes(), d), Lanes::mul(inverse, inverse));
      scale = Lanes::fma(Lanes::load(pass_.damper + at), rate, scale);
    }
    if constexpr (!dragged) {
      const V none = Lanes::zero();
      return give(i, j, between, scale, none, none);
    } else {
      const V along_i = product(drag_at(i), d), along_j = product(drag_at(j), d);
      const V both = Lanes::fma(along_i, along_i, Lanes::mul(along_j, along_j));
      const V part = Lanes::mul(both, Lanes::mul(inverse, inverse));
      scale = Lanes::div(scale, Lanes::fnma(Lanes::load(pass_.turn + at), part, Lanes::set(1)));
      give(i, j, between, scale, Lanes::mul(scale, along_i), Lanes::mul(scale, along_j));
    }
  }

  /// v_i += s (w_i d - (b_i . d) b_i), v_j -= s (w_j d - (b_j . d) b_j); `along`: s (b . d)
  CLOTHLAB_INLINE void give(const int* i, const int* j, const Turned& direction, V scale, V along_i,
                            V along_j) {
    const LaneNumbers s(scale), of_i(along_i), of_j(along_j);
    Turned changes_i, changes_j;
    for (int k = 0; k < Lanes::width; ++k) {
      const Four d = load_four(direction.lane(k));
      Four change_i = pass_.mobility[i[k] >> 2] * s.of[k] * d,
           change_j = pass_.mobility[j[k] >> 2] * s.of[k] * d;
      if constexpr (dragged) {
        change_i -= of_i.of[k] * load_four(pass_.drag + i[k]);
        change_j -= of_j.of[k] * load_four(pass_.drag + j[k]);
      }
      double *vi = pass_.velocity + i[k], *vj = pass_.velocity + j[k];
      store_four(vi, load_four(vi) + change_i);
      store_four(vj, load_four(vj) - change_j);
      if constexpr (measured)
        store_four(changes_i.lane(k), change_i), store_four(changes_j.lane(k), change_j);
    }
    if constexpr (measured)
      largest_ = Lanes::max(Lanes::max(squared(changes_i.lanes()), squared(changes_j.lanes())), largest_);
  }

  CLOTHLAB_INLINE void later_visit(int at) {
    const int *i = pass_.first + at, *j = pass_.second + at;
    Turned firsts, speeds;
    for (int k = 0; k < Lanes::width; ++k) {
      store_four(speeds.lane(k), load_four(pass_.velocity + j[k]) - load_four(pass_.velocity + i[k]));
      store_four(firsts.lane(k), load_four(pass_.position + j[k]) - load_four(pass_.position + i[k]));
    }
    const V h = Lanes::set(pass_.step), none = Lanes::zero(), one = Lanes::set(1);
    const Vector first = firsts.lanes(), speed = speeds.lanes(), between = plus(first, h, speed);
    const Vector given{Lanes::load(pass_.impulse[0] + at), Lanes::load(pass_.impulse[1] + at),
                       Lanes::load(pass_.impulse[2] + at)};
    const V both = Lanes::load(pass_.both + at), moves = Lanes::mul(h, both);

    // The direction; a stretched spring's is that without its impulse.
    const V pushes = product(given, between);
    const Vector line = minus(between, Lanes::sub(moves, Lanes::where_positive(pushes, moves)), given);
    const V square = squared(line), inverse = Lanes::inverse_root<false>(square);
    const Vector d = scaled(inverse, line);

    // What of the impulse lies across, and how much of that a compressed spring keeps.
    const V reach = Lanes::mul(Lanes::set(4), Lanes::mul(Lanes::mul(moves, moves), squared(given)));
    const V turned = Lanes::mul(Lanes::mul(square, inverse), Lanes::inverse_root<false>(reach));
    const V kept = Lanes::where_positive(pushes, Lanes::max(Lanes::sub(one, turned), none));
    const Vector across = scaled(kept, minus(given, product(given, d), d));

    // Along d.
    Vector change = across - given;
    V rate = product(d, plus(speed, both, change)), give_less = none;
    Vector drag_i{none, none, none}, drag_j{none, none, none};
    if constexpr (dragged) {
      drag_i = drag_at(i), drag_j = drag_at(j);
      const V on_i = product(drag_i, d), on_j = product(drag_j, d);
      rate = Lanes::fnma(on_i, product(drag_i, change), rate);
      rate = Lanes::fnma(on_j, product(drag_j, change), rate);
      give_less = Lanes::fma(on_i, on_i, Lanes::mul(on_j, on_j));
    }
    const V length = Lanes::fma(h, rate, product(d, first));
    V lambda = Lanes::fnma(Lanes::load(pass_.stretch + at), length, Lanes::load(pass_.tension + at));
    if constexpr (damped) lambda = Lanes::fnma(Lanes::load(pass_.damper + at), rate, lambda);
    if constexpr (dragged)
      lambda = Lanes::div(lambda, Lanes::fnma(Lanes::load(pass_.turn + at), give_less, one));
    const V has_length = Lanes::where_positive(square, one);
    change = scaled(has_length, plus(change, lambda, d));
    Lanes::store(pass_.impulse[0] + at, Lanes::add(given.x, change.x));
    Lanes::store(pass_.impulse[1] + at, Lanes::add(given.y, change.y));
    Lanes::store(pass_.impulse[2] + at, Lanes::add(given.z, change.z));
    Turned changes;
    Lanes::put(changes.of, change.x, change.y, change.z);
    V along_i = none, along_j = none;
    if constexpr (dragged) along_i = product(drag_i, change), along_j = product(drag_j, change);
    give(i, j, changes, Lanes::set(-1), Lanes::sub(none, along_i), Lanes::sub(none, along_j));
  }

  ColouredProjection& pass_;
  V largest_;
};

template <bool damped, bool dragged, bool measured>
void project_coloured_with(ColouredProjection& pass) {
  ColouredVisits<damped, dragged, measured> visits(pass);
  pass.impulse[0] ? visits.later_visits() : visits.first_visits();
}
template <bool damped, bool dragged>
void project_coloured_of(ColouredProjection& pass) {
  pass.measures ? project_coloured_with<damped, dragged, true>(pass)
                : project_coloured_with<damped, dragged, false>(pass);
}
void project_coloured(ColouredProjection& pass) {
  if (pass.is_damped)
    pass.drag ? project_coloured_of<true, true>(pass) : project_coloured_of<true, false>(pass);
  else
    pass.drag ? project_coloured_of<false, true>(pass) : project_coloured_of<false, false>(pass);
}

void field_to_vectors(const double* x, const double* y, const double* z, double* vectors, int count) {
  const ConstRow row{x, y, z};
  int k = 0;
  for (; k + Lanes::width <= count; k += Lanes::width) {
    const Vector v = load(row, k);
    Lanes::put(vectors + 4 * k, v.x, v.y, v.z);
  }
  for (; k < count; ++k) {
    vectors[4 * k] = x[k], vectors[4 * k + 1] = y[k], vectors[4 * k + 2] = z[k];
    vectors[4 * k + 3] = 0;
  }
}

void field_from_vectors(const double* vectors, double* x, double* y, double* z, int count) {
  const Row row{x, y, z};
  int k = 0;
  for (; k + Lanes::width <= count; k += Lanes::width)
    store(row, k, Turned::lanes_at(vectors + 4 * k, one_by_one));
  for (; k < count; ++k) x[k] = vectors[4 * k], y[k] = vectors[4 * k + 1], z[k] = vectors[4 * k + 2];
}

}  // namespace
}  // namespace cloth::kernels
