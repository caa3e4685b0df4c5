#include "integrators/kick_impulse.h"

#include "cloth/sums.h"
#include "integrators/integrator.h"

namespace cloth {

void KickImpulse::reset(std::size_t particles) {
  if (impulse_.size() != particles) impulse_ = Vec3Field(particles);
  impulse_.fill(0);
}

void KickImpulse::add(double duration, const Vec3Field& position_force) {
  add_scaled(duration, position_force, impulse_);
}

void KickImpulse::close(const ClothSystem& system, const Vec3Field& begin, const Vec3Field& end) {
  begin_ = begin, end_ = end;
  for (std::size_t i = 0; i < end.size(); ++i)
    impulse_.set(i,
                 system.pinned[i] ? Vec3::Zero() : Vec3(system.mass[i] * (end[i] - begin[i]) - impulse_[i]));
}

/// Air and hand have a part that does not depend on the velocity, and changes its sign with it; what is left
/// of J's work is that of dampers.
Work KickImpulse::work(const ForceModel& forces, const Vec3Field& position, double step) {
  mean_ = begin_;
  add_scaled(1, end_, mean_);
  for (double& v : mean_.flat()) v *= 0.5;
  const double all = dot(impulse_.flat(), mean_.flat());
  Work work = step * forces.power(position, mean_);
  for (double& v : mean_.flat()) v = -v;
  const Work back = step * forces.power(position, mean_);
  work.damping_loss = 0.5 * (work.air + back.air + work.brush + back.brush + work.pull + back.pull) - all;
  return work;
}

double KickImpulse::work_of_change(const Vec3Field& changed) const {
  double work = 0;
  for (std::size_t i = 0; i < changed.size(); ++i) work += 0.5 * impulse_[i].dot(changed[i] - end_[i]);
  return work;
}

}  // namespace cloth
