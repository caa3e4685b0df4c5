// The updates of the explicit methods, called by the passes of grids and meshes as soon as a force is
// complete: update(j, count, here, force) for the particles from j on, with their positions `here` (m) and
// the force (N) of springs, weight and load. There are `count` particles at an Edge and Lanes::width
// elsewhere. Damping is added here. The sums are of |v|^2, lane by lane. Included once for every instruction
// set, after its Lanes.
#pragma once

#include "kernels/kutta.h"
#include "kernels/lane_vectors.h"

namespace cloth::kernels {
namespace {

/// Whether all particles and springs are alike, or count by their share of cells (CellShares). Damping in
/// proportion to mass and sums of squares are taken by shares too.
enum class Share { equal, by_cell };

/// The shares of one row.
template <Share share>
struct RowShares {
  V of_row{};
  const double* of_columns = nullptr;

  CLOTHLAB_INLINE V at(int j) const { return Lanes::mul(of_row, Lanes::load(of_columns + j)); }
  CLOTHLAB_INLINE V of(V whole, int j) const {
    if constexpr (share == Share::equal) return whole;
    return Lanes::mul(whole, at(j));
  }
  CLOTHLAB_INLINE V plus_square(V sum, const Vector& v, int j) const {
    if constexpr (share == Share::equal) return kernels::plus_square(sum, v);
    return Lanes::fma(at(j), squared(v), sum);
  }
};

/// v' = v + h a(x, v); x' = x + h v', or x + h v.
template <Share share>
struct EulerUpdate {
  V step, damping;
  RowShares<share> shares{};
  bool drift_first;
  Row position, velocity;
  const double* inverse_mass;
  V before, after;

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector& x, const Vector& spring_force) {
    const Vector v = load_part<Edge>(velocity, j, count);
    const V h_over_m = Lanes::mul(
        step, Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero()) : Lanes::load(inverse_mass + j));
    const Vector next = plus(v, h_over_m, minus(spring_force, shares.of(damping, j), v));
    before = shares.plus_square(before, v, j);
    after = shares.plus_square(after, next, j);
    store<Edge>(velocity, j, count, next);
    store<Edge>(position, j, count, plus(x, step, drift_first ? v : next));
  }
};

/// v' solves m v' = m v_half + h/2 (p(x') - c v').
template <Share share>
struct VerletUpdate {
  RowShares<share> shares{};
  V half_step, centred;  ///< h/2, and 1 / (1 + h c / 2 m)
  Row velocity, force;
  const double* inverse_mass;
  V after;

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector&, const Vector& p) {
    const V scale = Lanes::mul(half_step, Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero())
                                               : Lanes::load(inverse_mass + j));
    const Vector next = scaled(centred, plus(load_part<Edge>(velocity, j, count), scale, p));
    after = shares.plus_square(after, next, j);
    store<Edge>(velocity, j, count, next);
    store<Edge>(force, j, count, p);
  }
};

inline double centring(double step, double damping, double mass) {
  return 1 / (1 + 0.5 * step * damping / mass);
}

/// v_half = v + h/2 (p - c v) / m, x' = x + h v_half for a row.
template <bool Edge>
CLOTHLAB_INLINE void kick_drift_block(const Row& x, const Row& v, const ConstRow& p,
                                      const double* inverse_mass, V half_step, V step, V damping, int j,
                                      int count) {
  const V scale = Lanes::mul(
      half_step, Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero()) : Lanes::load(inverse_mass + j));
  const Vector velocity = load_part<Edge>(v, j, count);
  const Vector half = plus(velocity, scale, minus(load_part<Edge>(p, j, count), damping, velocity));
  store<Edge>(v, j, count, half);
  store<Edge>(x, j, count, plus(load_part<Edge>(x, j, count), step, half));
}

/// The closing kick of one step of Verlet, then kick and drift of the next, with the same operations in the
/// same order as VerletUpdate and kick_drift_block.
template <Share share>
struct VerletBetweenUpdate {
  RowShares<share> shares{};
  V half_step, step, centred, damping;
  Row position, velocity;
  const double* inverse_mass;
  V after;  ///< the sum of squares of the velocity between the steps

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector& x, const Vector& p) {
    const V scale = Lanes::mul(half_step, Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero())
                                               : Lanes::load(inverse_mass + j));
    const Vector v = scaled(centred, plus(load_part<Edge>(velocity, j, count), scale, p));
    after = shares.plus_square(after, v, j);
    const Vector half = plus(v, scale, minus(p, shares.of(damping, j), v));
    store<Edge>(velocity, j, count, half);
    store<Edge>(position, j, count, plus(x, step, half));
  }
};

/// v += h/2 f/m, x += h v, v += ahead f/m for a row: the drift of velocity Verlet, and in `v` the velocity of
/// the next evaluation.
template <bool Edge>
CLOTHLAB_INLINE void drift_predict_block(const Row& x, const Row& v, const ConstRow& f,
                                         const double* inverse_mass, V half_step, V step, V ahead, int j,
                                         int count) {
  const V inverse =
      Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero()) : Lanes::load(inverse_mass + j);
  const Vector force = load_part<Edge>(f, j, count);
  const Vector half = plus(load_part<Edge>(v, j, count), Lanes::mul(half_step, inverse), force);
  store<Edge>(x, j, count, plus(load_part<Edge>(x, j, count), step, half));
  store<Edge>(v, j, count, plus(half, Lanes::mul(ahead, inverse), force));
}

/// An evaluation after drift_predict_block, or after another: f' = p(x') - c v, with dampers and air in p, at
/// the velocity v; then v += h/2 (gain f' - held f)/m. With half_step = 0 the velocity stays as it is.
template <Share share>
struct PredictedUpdate {
  RowShares<share> shares{};
  V half_step, gain, held, damping;
  Row velocity, force;
  const double* inverse_mass;
  V before, after;  ///< |v|^2 and |v'|^2

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector&, const Vector& p) {
    const V scale = Lanes::mul(half_step, Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero())
                                               : Lanes::load(inverse_mass + j));
    const Vector v = load_part<Edge>(velocity, j, count);
    const Vector total = minus(p, shares.of(damping, j), v);
    const Vector next = plus(v, scale, minus(scaled(gain, total), held, load_part<Edge>(force, j, count)));
    before = shares.plus_square(before, v, j);
    after = shares.plus_square(after, next, j);
    store<Edge>(velocity, j, count, next);
    store<Edge>(force, j, count, total);
  }
};

/// force = springs + weight + load
struct EvaluateUpdate {
  Row force;

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector&, const Vector& p) {
    store<Edge>(force, j, count, p);
  }
};

/// product = D v = minus the force of the dampers along springs.
struct DampUpdate {
  Row product;

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector&, const Vector& force) {
    const V zero = Lanes::zero();
    store<Edge>(product, j, count, Vector{zero, zero, zero} - force);
  }
};

/// One stage of Runge-Kutta: adds `weight` (s) times the stage's slope to the sums, and computes the next
/// stage, which is `ahead` (s) along this slope from the state at the beginning of the step.
template <Share share>
struct StageUpdate {
  RowShares<share> shares{};
  V weight, ahead, damping;
  bool is_last;
  ConstRow stage_velocity;
  const double* inverse_mass;
  ConstRow sum_position, sum_velocity;  ///< the state plus the weighted stages so far
  Row next_sum_position, next_sum_velocity;
  ConstRow state_position, state_velocity;
  Row next_position, next_velocity;  ///< the next stage's, unless this is the last
  V squares, after;

  template <bool Edge>
  CLOTHLAB_INLINE void operator()(int j, int count, const Vector&, const Vector& spring_force) {
    const Vector v = load_part<Edge>(stage_velocity, j, count);
    const V inverse =
        Edge ? Lanes::load(inverse_mass + j, count, Lanes::zero()) : Lanes::load(inverse_mass + j);
    const Vector a = scaled(inverse, minus(spring_force, shares.of(damping, j), v));
    const Vector sum_x = plus(load_part<Edge>(sum_position, j, count), weight, v);
    const Vector sum_v = plus(load_part<Edge>(sum_velocity, j, count), weight, a);
    squares = shares.plus_square(squares, v, j);
    if (is_last) {
      after = shares.plus_square(after, sum_v, j);
    } else {
      const Vector x0 = load_part<Edge>(state_position, j, count),
                   v0 = load_part<Edge>(state_velocity, j, count);
      store<Edge>(next_position, j, count, plus(x0, ahead, v));
      store<Edge>(next_velocity, j, count, plus(v0, ahead, a));
    }
    store<Edge>(next_sum_position, j, count, sum_x);
    store<Edge>(next_sum_velocity, j, count, sum_v);
  }
};

}  // namespace
}  // namespace cloth::kernels
