// The work of one contact's impulses, for methods whose velocities do not follow from the corrected
// positions.
#pragma once

#include <algorithm>
#include <cmath>

#include "contact/contact_constraint.h"

namespace cloth {

/// Velocities of a contact's point, in m/s: at the beginning of the step, at its end after contact, and the
/// mean of its displacement over the step.
struct PointSpeeds {
  Vec3 before{0, 0, 0}, after{0, 0, 0}, gone{0, 0, 0};
};

/// N s, the part of the normal impulse that changes the point's velocity, where no other contact does.
/// Precondition, as of work_of(): mobility > 0.
inline double impact_of(const ContactConstraint& contact, const PointSpeeds& speeds) {
  const double along = contact.normal.dot(speeds.after - speeds.before);
  return std::clamp(along / contact.mobility, 0.0, contact.normal_impulse);
}

/// J. `impact` acts instantaneously: its work is taken with the mean of the velocities before and after. The
/// rest of the normal impulse balances a load that acted during the whole step: its work is taken along the
/// point's displacement. So a cloth at rest gets no work, whatever velocity the integrator gave it. Friction
/// likewise, as if the contact were the only one of its particles.
inline double work_of(const ContactConstraint& contact, const PointSpeeds& speeds, double impact) {
  const Vec3 mean = 0.5 * (speeds.before + speeds.after), change = speeds.after - speeds.before;
  double work =
      impact * contact.normal.dot(mean) + (contact.normal_impulse - impact) * contact.normal.dot(speeds.gone);

  const auto across = [&](const Vec3& v) -> Vec3 { return v - contact.normal.dot(v) * contact.normal; };
  const Vec3 turned = across(change);
  const bool slows =
      across(speeds.after - contact.rest).squaredNorm() < across(speeds.before - contact.rest).squaredNorm();
  Vec3 stopping = Vec3::Zero();
  if (slows && turned.squaredNorm() > 0)
    stopping =
        std::clamp(contact.friction_impulse.dot(turned) / turned.squaredNorm(), 0.0, 1 / contact.mobility) *
        turned;
  work += stopping.dot(mean) + (contact.friction_impulse - stopping).dot(speeds.gone);
  return work;
}

/// The largest part s of a change of velocities, at most 1, with a s^2 + b s <= most, which is >= 0; a > 0.
inline double part_within(double a, double b, double most) {
  if (a + b <= most) return 1;
  return std::clamp((std::sqrt(b * b + 4 * a * most) - b) / (2 * a), 0.0, 1.0);
}

}  // namespace cloth
