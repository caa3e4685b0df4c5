#include "integrators/kick_work.h"

#include <algorithm>
#include <utility>

#include "cloth/sums.h"

namespace cloth {
namespace {

/// The part of `impulse`, between none and all of it, that has become a change of momentum.
Vec3 part_in(const Vec3& change, const Vec3& impulse) {
  const double square = impulse.squaredNorm();
  const double part = square > 0 ? std::clamp(change.dot(impulse) / square, 0.0, 1.0) : 0;
  return part * impulse;
}

}  // namespace

void KickWork::open(double step, const Vec3Field& velocity, const Vec3Field& force,
                    const Vec3Field& position_force) {
  step_ = step;
  begin_.velocity = velocity, begin_.force = force, begin_.position_force = position_force;
  is_known_ = true, is_closed_ = false;
}

void KickWork::open_as_closed(double step) {
  step_ = step;
  std::swap(begin_, end_);
  is_known_ = true, is_closed_ = false;
}

void KickWork::drift(const Vec3Field& velocity, const SparseField* later) {
  drift_ = velocity;
  if (later) add_scaled(-1, *later, drift_);
}

void KickWork::close(const Vec3Field& velocity, const Vec3Field& force, const Vec3Field& position_force) {
  end_.velocity = velocity, end_.force = force, end_.position_force = position_force;
  is_closed_ = true;
}

double KickWork::beside_trapezoid(const ClothSystem& system) const {
  const double half = 0.5 * step_, *inverse_mass = system.inverse_mass.data();
  const auto along = [&](const double* (Vec3Field::*axis)() const) {
    const double *v = (begin_.velocity.*axis)(), *f = (begin_.force.*axis)(),
                 *p = (begin_.position_force.*axis)(), *end_v = (end_.velocity.*axis)(),
                 *end_f = (end_.force.*axis)(), *end_p = (end_.position_force.*axis)(), *u = (drift_.*axis)();
    return ordered_sum(system.size(), [=](std::size_t i) {
      const double squares = end_f[i] * end_f[i] - end_p[i] * end_p[i] - f[i] * f[i] + p[i] * p[i];
      return half * ((f[i] - p[i]) * (u[i] - v[i]) + (end_f[i] - end_p[i]) * (u[i] - end_v[i])) +
             0.5 * half * half * inverse_mass[i] * squares;
    });
  };
  return along(&Vec3Field::x) + along(&Vec3Field::y) + along(&Vec3Field::z);
}

double KickWork::beside_trapezoid(const ClothSystem& system, const Vec3Field& integrated,
                                  const ClothState& state, const Vec3Field& position_force) const {
  return ordered_sum(system.size(), [&](std::size_t i) {
    if (system.pinned[i]) return 0.0;
    const double mass = system.mass[i], half = 0.5 * step_;
    const Vec3 force = begin_.force[i], end_force = end_.force[i], u = drift_[i];
    const Vec3 damping = force - begin_.position_force[i], end_damping = end_force - end_.position_force[i];
    const Vec3 impulse = mass * (state.velocity[i] - end_.velocity[i]);
    const Vec3 gone = u + (state.position[i] - integrated[i]) / step_;
    const Vec3 begun = u - half / mass * force, ended = u + (half * end_force + impulse) / mass;
    const Vec3 change = mass * (ended - begun);
    const double squares = position_force[i].squaredNorm() - begin_.position_force[i].squaredNorm();
    return half * (damping + end_damping).dot(gone) +
           (change - part_in(change, impulse)).dot(0.5 * (begun + ended) - gone) -
           0.5 * half * half / mass * squares -
           half * (damping.dot(begin_.velocity[i]) + end_damping.dot(end_.velocity[i]));
  });
}

}  // namespace cloth
