// The velocity solve of continuous contact, and its work. First all contacts stop approaching velocities;
// then those with restitution return speed, in any island no more energy than its contacts have taken:
// Newton's restitution law for simultaneous contacts with friction could create energy (Stronge 1990).
#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "contact/contact_work.h"
#include "contact/continuous_contact.h"
#include "contact/islands.h"

namespace cloth {
namespace {

/// Two faces of the cloth that rest on one corner are nearly the same contact, and converge slowly.
constexpr int velocity_sweeps = 100;
constexpr double velocity_tolerance = 1e-7;  ///< m/s

/// J, the change from velocity `now` to `then`.
double kinetic_change(double mass, const Vec3& now, const Vec3& then) {
  return 0.5 * mass * (then - now).dot(then + now);
}

}  // namespace

/// The mean velocity of the step. A pair that began it nearer than its thickness was separated, which must
/// not become velocity: there the motion is solved for again, keeping the distance at the beginning of the
/// step. Returns whether there was such a pair.
bool ContinuousContact::find_motion(const ClothSystem& system, const Begin& begin) {
  if (motion_.size() != position_.size()) motion_ = Vec3Field(position_.size());
  for (std::size_t i = 0; i < position_.size(); ++i)
    motion_.set(i, (position_[i] - begin.position[i]) / begin.step);
  constraints_.clear();
  std::vector<double> gaps;  // m, beyond the thickness as the step began
  for (const Touch& touch : touches_) {
    if (!(touch.contact.normal_impulse > 0) || !(touch.contact.mobility > 0)) continue;
    ContactConstraint contact = touch.contact;
    gaps.push_back(contact.normal.dot(contact.rest) - contact.bound);
    contact.bound = contact.normal.dot(touch.velocity) - std::max(gaps.back(), 0.0) / begin.step;
    contact.rest = touch.velocity;
    contact.normal_impulse = 0, contact.friction_impulse.setZero();
    constraints_.push_back(contact);
  }
  const auto is_missing = [&](double gap) { return gap < -arrived_length(); };
  if (substeps_ > 1 || std::none_of(gaps.begin(), gaps.end(), is_missing)) return false;
  Vec3Field solved(position_.size());
  for (std::size_t i = 0; i < position_.size(); ++i)
    solved.set(i, (integrated_position_[i] - begin.position[i]) / begin.step);
  solve_contacts(constraints_, system.inverse_mass, velocity_sweeps, velocity_tolerance, solved);
  Islands islands(constraints_, system.inverse_mass);
  std::vector<std::uint8_t> recovers(position_.size(), 0);
  for (std::size_t c = 0; c < gaps.size(); ++c)
    if (is_missing(gaps[c]))
      recovers[at(islands.of(Islands::first_free(constraints_[c], system.inverse_mass)))] = 1;
  for (std::size_t i = 0; i < position_.size(); ++i)
    if (recovers[at(islands.of(static_cast<int>(i)))]) motion_.set(i, solved[i]);
  return true;
}

/// J, work of separating pairs that began too near: against the mean of the forces at the beginning and at
/// the end of the step.
double ContinuousContact::recovering_work(const Begin& begin, const VelocityCoupling& coupling) const {
  Vec3Field moved = begin.position, led = position_;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 put = position_[i] - begin.position[i] - begin.step * motion_[i];
    moved.add(i, put), led.add(i, -put);
  }
  return 0.5 * (coupling.potential(moved) - coupling.potential(begin.position) +
                coupling.potential(position_) - coupling.potential(led));
}

/// m/s: contact's change of the velocity at the beginning of the step.
Vec3 ContinuousContact::start_change_of(std::size_t i, const Begin& begin) const {
  return motion_[i] - (integrated_position_[i] - begin.position[i]) / begin.step;
}

/// m/s, relative normal velocity of a contact, negative where the two sides approach; 0 if that is no impact.
/// Without contact in the last step it is that of this step's integrated motion; with contact, that at the
/// beginning of the step, because what the step adds to it is load. Speeds below a few times what gravity or
/// the load adds in a step are no impact, or a cloth at rest would keep moving.
double ContinuousContact::approach_of(const Touch& touch, const Begin& begin,
                                      const VelocityCoupling& coupling) const {
  const ContactConstraint& contact = touch.contact;
  bool was_held = false;
  for (int k = 0; k < contact.count; ++k)
    was_held = was_held || (contact.weight[at(k)] != 0 && coupling.memory.held[at(contact.particle[at(k)])]);
  const double began = contact.normal.dot(contact.point(coupling.velocity_before) - touch.velocity);
  const double goes = contact.normal.dot(contact.point(integrated_position_) - contact.rest) / begin.step;
  const double coming = was_held ? began : goes;
  const double least = std::max(2 * gravity_ * begin.step, 4 * (began - goes));
  return coming < -least ? coming : 0;
}

/// The constraints of the velocity solve: the contacts of the step, with bounds without and with restitution.
void ContinuousContact::take_touches(const Begin& begin, const VelocityCoupling& coupling) {
  constraints_.clear();
  bounce_bound_.clear();
  for (const Touch& touch : touches_) {
    if (!(touch.contact.normal_impulse > 0) || !(touch.contact.mobility > 0)) continue;
    ContactConstraint contact = touch.contact;
    double restitution = 0;
    if (touch.obstacle != FeaturePair::cloth_itself) {
      const ObstacleBody& body = bodies_[at(touch.obstacle)];
      restitution = body.reflects ? body.friction : body.restitution;
    }
    contact.bound = contact.normal.dot(touch.velocity);
    const double coming = restitution > 0 ? approach_of(touch, begin, coupling) : 0;
    bounce_bound_.push_back(contact.bound - restitution * coming);
    contact.rest = touch.velocity;
    contact.normal_impulse = 0, contact.friction_impulse.setZero();
    constraints_.push_back(contact);
  }
}

void ContinuousContact::solve_velocities(const ClothSystem& system, const Begin& begin,
                                         const VelocityCoupling& coupling, ClothState& state,
                                         ContactReport& report) {
  const bool follows = static_cast<bool>(coupling.positions);
  coupling.memory.resize(position_.size());
  if (find_motion(system, begin)) report.work += recovering_work(begin, coupling);
  if (follows) coupling.positions(motion_);
  take_touches(begin, coupling);
  free_velocity_ = state.velocity;
  solve_contacts(constraints_, system.inverse_mass, velocity_sweeps, velocity_tolerance, state.velocity);
  if (coupling.velocities) {
    coupling.velocities(motion_);
    free_velocity_ = state.velocity;
    for (const ContactConstraint& contact : constraints_)
      apply_impulses(contact, system.inverse_mass, state.velocity);
    solve_contacts(constraints_, system.inverse_mass, velocity_sweeps, velocity_tolerance, state.velocity);
  }
  work_.assign(position_.size(), 0.0);
  if (follows)
    add_half_steps_work(system, begin, coupling, state);
  else
    find_work(system, coupling, state);
  bounce(system, begin, follows, state);
  report.impulse = total_impulse(system);
  if (follows)
    for (std::size_t i = 0; i < position_.size(); ++i)
      if (!system.pinned[i]) report.impulse += system.mass[i] * start_change_of(i, begin);
  report.held_back = note_held_back(system, begin, state);
  remember(system, state, follows, coupling.memory);
  for (const double work : work_) report.work += work;
}

/// N s.
Vec3 ContinuousContact::total_impulse(const ClothSystem& system) const {
  Vec3 impulse = Vec3::Zero();
  for (const ContactConstraint& contact : constraints_) {
    double weight = 0;
    for (int k = 0; k < contact.count; ++k)
      if (!system.pinned[at(contact.particle[at(k)])]) weight += contact.weight[at(k)];
    impulse += weight * (contact.normal_impulse * contact.normal + contact.friction_impulse);
  }
  return impulse;
}

/// For methods whose velocity is complete before contact acts.
void ContinuousContact::find_work(const ClothSystem& system, const VelocityCoupling& coupling,
                                  const ClothState& state) {
  for (const ContactConstraint& contact : constraints_) {
    const PointSpeeds speeds{contact.point(coupling.velocity_before), contact.point(state.velocity),
                             contact.point(motion_)};
    work_[at(Islands::first_free(contact, system.inverse_mass))] += work_of(contact, speeds);
  }
}

/// For Verlet's method: contact acts at the beginning of the step and at its end, each as half a kick of the
/// leapfrog, impulse o at v_n and impulse c to v_n+1. The two halves around one state do the work of the
/// impulse times the mean velocity of the steps before and after, under which the energy balance of a
/// leapfrog closes. The energy m |l|^2/2 that c takes from the load's half kick l, and the next o returns, is
/// deferred.
void ContinuousContact::add_half_steps_work(const ClothSystem& system, const Begin& begin,
                                            const VelocityCoupling& coupling, const ClothState& state) {
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if (system.pinned[i]) continue;
    const double mass = system.mass[i];
    const Vec3 opening = start_change_of(i, begin);
    work_[i] = mass * opening.dot(coupling.velocity_before[i] + 0.5 * opening) +
               kinetic_change(mass, free_velocity_[i], state.velocity[i]) - coupling.memory.deferred[i];
  }
}

/// J, of a particle: the energy that the next step returns, that of the half step's load; the energy of an
/// impact is not returned. `stopped`, in m/s, is the velocity after the impulse.
double ContinuousContact::deferred_by_load(const ClothSystem& system, std::size_t i,
                                           const Vec3& stopped) const {
  const Vec3 impulse = stopped - free_velocity_[i];
  const double speed = impulse.norm();
  if (!(speed > 0)) return 0;
  const double load = std::clamp((motion_[i] - free_velocity_[i]).dot(impulse) / speed, 0.0, speed);
  return 0.5 * system.mass[i] * load * load;
}

/// Restitution, limited in each island to the energy that its contacts have taken, relative to the obstacles.
/// Any combination of two solutions of the contacts is a solution too: bounds and friction cones are convex.
void ContinuousContact::bounce(const ClothSystem& system, const Begin& begin, bool follows,
                               ClothState& state) {
  bounced_.assign(position_.size(), 0);
  deferred_of_bounced_.assign(position_.size(), 0.0);
  bool any = false;
  for (std::size_t c = 0; c < constraints_.size(); ++c) any = any || bounce_bound_[c] > constraints_[c].bound;
  if (!any) return;
  const std::vector<ContactConstraint> still = constraints_;
  const Vec3Field stopped = state.velocity;
  for (std::size_t c = 0; c < constraints_.size(); ++c) constraints_[c].bound = bounce_bound_[c];
  solve_contacts(constraints_, system.inverse_mass, velocity_sweeps, velocity_tolerance, state.velocity);

  Islands islands(constraints_, system.inverse_mass);
  std::vector<Vec3> obstacle_velocity(position_.size(), Vec3::Zero());
  std::vector<std::uint8_t> touched(position_.size(), 0);
  for (const ContactConstraint& contact : constraints_)
    for (int k = 0; k < contact.count; ++k) {
      const auto i = at(contact.particle[at(k)]);
      if (contact.weight[at(k)] == 0 || !(system.inverse_mass[i] > 0)) continue;
      touched[i] = 1;
      obstacle_velocity[i] = contact.rest;
    }
  struct Share {
    double taken = 0, square = 0, linear = 0;  ///< J
    double part = 1;
  };
  std::vector<Share> shares(position_.size());
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if (!touched[i]) continue;
    const double mass = system.mass[i];
    const Vec3 change = state.velocity[i] - stopped[i];
    Vec3 impulse = stopped[i] - free_velocity_[i];
    if (follows) impulse += start_change_of(i, begin);
    Share& share = shares[at(islands.of(static_cast<int>(i)))];
    if (follows) deferred_of_bounced_[i] = deferred_by_load(system, i, stopped[i]);
    share.taken -= work_[i] - mass * impulse.dot(obstacle_velocity[i]) + deferred_of_bounced_[i];
    share.square += 0.5 * mass * change.squaredNorm();
    share.linear += mass * change.dot(stopped[i] - obstacle_velocity[i]);
  }
  for (Share& share : shares)
    if (share.square > 0) share.part = part_within(share.square, share.linear, std::max(share.taken, 0.0));
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if (!touched[i]) continue;
    const Share& share = shares[at(islands.of(static_cast<int>(i)))];
    bounced_[i] = share.square > 0;
    if (share.part < 1) state.velocity.set(i, stopped[i] + share.part * (state.velocity[i] - stopped[i]));
    work_[i] += kinetic_change(system.mass[i], stopped[i], state.velocity[i]);
  }
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const int first = Islands::first_free(constraints_[c], system.inverse_mass);
    const double part = shares[at(islands.of(first))].part;
    constraints_[c].normal_impulse =
        still[c].normal_impulse + part * (constraints_[c].normal_impulse - still[c].normal_impulse);
    constraints_[c].friction_impulse =
        still[c].friction_impulse + part * (constraints_[c].friction_impulse - still[c].friction_impulse);
  }
}

void ContinuousContact::remember(const ClothSystem& system, const ClothState& state, bool follows,
                                 ContactMemory& memory) {
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 impulse = state.velocity[i] - free_velocity_[i];
    memory.held[i] = !bounced_[i] && !impulse.isZero(0);
    memory.deferred[i] = 0;
    if (follows && !system.pinned[i])
      memory.deferred[i] =
          bounced_[i] ? deferred_of_bounced_[i] : deferred_by_load(system, i, state.velocity[i]);
    work_[i] += memory.deferred[i];
  }
}

int ContinuousContact::note_held_back(const ClothSystem& system, const Begin& begin, ClothState& state) {
  int held = 0;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if ((target_position_[i] - position_[i]).norm() <= arrived_length()) continue;
    ++held;
    const Vec3 gone = (position_[i] - begin.position[i]) / begin.step, speed = state.velocity[i];
    if (!(gone.norm() < speed.norm())) continue;
    state.velocity.set(i, gone);
    if (!system.pinned[i]) work_[i] += kinetic_change(system.mass[i], speed, gone);
  }
  return held;
}

}  // namespace cloth
