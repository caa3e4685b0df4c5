// The velocity solve of continuous contact, and its work. First all contacts stop approaching velocities;
// then those with restitution return speed, in any island no more energy than its contacts have taken:
// Newton's restitution law for simultaneous contacts with friction could create energy (Stronge 1990).
#include <algorithm>
#include <numeric>

#include "contact/contact_work.h"
#include "contact/continuous_contact.h"
#include "contact/particle_motion.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Where damping is evaluated at the velocities that a solve ends with, and another follows.
constexpr int first_velocity_sweeps = 10;
constexpr int velocity_sweeps = 100;
constexpr double velocity_tolerance = 1e-5;  ///< m/s

/// Groups of particles that are connected by contacts, directly or through other particles (union-find).
class Islands {
 public:
  /// Particles that cannot move do not connect.
  Islands(const std::vector<ContactConstraint>& contacts, const std::vector<double>& inverse_mass)
      : parent_(inverse_mass.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const ContactConstraint& contact : contacts) {
      const int first = contact.first_free(inverse_mass);
      contact.for_each([&](std::size_t i) {
        if (inverse_mass[i] > 0) parent_[at(of(static_cast<int>(i)))] = of(first);
      });
    }
  }

  /// The particle that represents the island of `i`.
  int of(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }

 private:
  std::vector<int> parent_;
};

/// J, the change from velocity `now` to `then`.
double kinetic_change(double mass, const Vec3& now, const Vec3& then) {
  return 0.5 * mass * (then - now).dot(then + now);
}

}  // namespace

ContactConstraint ContinuousContact::Touch::on_velocities(double step) const {
  ContactConstraint same = contact;
  same.bound = contact.normal.dot(velocity);
  same.rest = velocity;
  same.normal_impulse /= step, same.friction_impulse /= step;
  return same;
}

void ContinuousContact::apply_all_impulses(const ClothSystem& system, Vec3Field& velocity) const {
  for (const ContactConstraint& contact : constraints_)
    apply_impulses(contact, system.inverse_mass, velocity);
}

void ContinuousContact::solve_constraints(const ClothSystem& system, int sweeps, Vec3Field& velocity) {
  solver_.solve(constraints_, system.inverse_mass, {sweeps, velocity_tolerance}, velocity);
}

/// The mean velocity of the step. A pair that began it nearer than its thickness was separated, which must
/// not become velocity: there the motion is solved for again, keeping the distance at the beginning of the
/// step. Returns whether there was such a pair.
bool ContinuousContact::find_motion(const ContactStep& step) {
  find_mean_velocity(step.position_before, position_, step.times.step, team_, motion_);
  const auto gap_of = [](const Touch& touch) {  // m, beyond the thickness as the step began
    return touch.contact.normal.dot(touch.contact.rest) - touch.contact.bound;
  };
  const auto is_missing = [&](double gap) { return gap < -arrived_length(); };
  if (substeps_ > 1 || std::none_of(touches_.begin(), touches_.end(), [&](const Touch& touch) {
        return touch.acts() && is_missing(gap_of(touch));
      }))
    return false;
  constraints_.clear();
  std::vector<double> gaps;
  for (const Touch& touch : touches_) {
    if (!touch.acts()) continue;
    gaps.push_back(gap_of(touch));
    constraints_.push_back(touch.on_velocities(step.times.step));
    constraints_.back().bound -= std::max(gaps.back(), 0.0) / step.times.step;
  }
  Vec3Field solved;
  find_mean_velocity(step.position_before, integrated_position_, step.times.step, team_, solved);
  apply_all_impulses(step.system, solved);
  solve_constraints(step.system, velocity_sweeps, solved);
  Islands islands(constraints_, step.system.inverse_mass);
  std::vector<std::uint8_t> recovers(position_.size(), 0);
  for (std::size_t c = 0; c < gaps.size(); ++c)
    if (is_missing(gaps[c]))
      recovers[at(islands.of(constraints_[c].first_free(step.system.inverse_mass)))] = 1;
  for (std::size_t i = 0; i < position_.size(); ++i)
    if (recovers[at(islands.of(static_cast<int>(i)))]) motion_.set(i, solved[i]);
  return true;
}

/// J, work of separating pairs that began too near: against the mean of the forces at the beginning and at
/// the end of the step.
double ContinuousContact::recovering_work(const ContactStep& step) const {
  Vec3Field moved = step.position_before, led = position_;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 put = position_[i] - step.position_before[i] - step.times.step * motion_[i];
    moved.add(i, put), led.add(i, -put);
  }
  return 0.5 * (step.potential(moved) - step.potential(step.position_before) + step.potential(position_) -
                step.potential(led));
}

/// The particles that contact has moved, has held back from their targets or may change the velocity of, or
/// whose energy it deferred, ascending.
void ContinuousContact::find_changed(const ContactMemory& memory) {
  is_changed_.assign(position_.size(), 0);
  const auto take = [&](std::size_t i) { is_changed_[i] = 1; };
  for (const ContactConstraint& contact : constraints_) contact.for_each(take);
  visit_different(position_, integrated_position_, take);
  visit_different(position_, target_position_, take);
  changed_.clear();
  for (std::size_t i = 0; i < is_changed_.size(); ++i)
    if (is_changed_[i] != 0 || memory.deferred[i] != 0) changed_.push_back(i);
}

/// visit(i) for each of the changed particles, in shares.
template <class Visit>
void ContinuousContact::visit_changed(const Visit& visit) const {
  in_shares(team_, changed_.size(), least_contacts, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) visit(changed_[k]);
  });
}

/// Contact's change of the velocity at the beginning of the step.
void ContinuousContact::find_start_change(const ContactStep& step) {
  if (start_change_.size() != position_.size()) start_change_ = Vec3Field(position_.size());
  visit_changed([&](std::size_t i) {
    start_change_.set(i, motion_[i] - (integrated_position_[i] - step.position_before[i]) / step.times.step);
  });
}

/// m/s, relative normal velocity of a contact, negative where the two sides approach; 0 if that is no impact.
/// Without contact in the last step it is that of this step's integrated motion; with contact, that at the
/// beginning of the step, because what the step adds to it is load. Speeds below a few times what gravity or
/// the load adds in a step are no impact, or a cloth at rest would keep moving.
double ContinuousContact::approach_of(const Touch& touch, const ContactStep& step) const {
  const ContactConstraint& contact = touch.contact;
  const bool was_held = contact.any_of([&](std::size_t i) { return step.memory.held[i] != 0; });
  const double before = contact.normal.dot(contact.point(step.velocity_before) - touch.velocity);
  const Vec3Field& integrated = force_work_ ? approach_position_ : integrated_position_;
  const double mean = contact.normal.dot(contact.point(integrated) - contact.rest) / step.times.step;
  const double approach = was_held ? before : mean;
  const double least = std::max(2 * gravity_ * step.times.step, 4 * (before - mean));
  return approach < -least ? approach : 0;
}

/// The constraints of the velocity solve: the contacts of the step, with bounds without and with restitution.
void ContinuousContact::take_touches(const ContactStep& step) {
  constraints_.clear();
  bounce_bound_.clear();
  for (const Touch& touch : touches_) {
    if (!touch.acts()) continue;
    double restitution = 0;
    if (touch.obstacle != FeaturePair::cloth_itself) {
      const ObstacleBody& body = bodies_[at(touch.obstacle)];
      restitution = body.reflects ? body.friction : body.restitution;
    }
    constraints_.push_back(touch.on_velocities(step.times.step));
    const double approach = restitution > 0 ? approach_of(touch, step) : 0;
    bounce_bound_.push_back(constraints_.back().bound - restitution * approach);
  }
}

void ContinuousContact::solve_velocities(const ContactStep& step, ClothState& state, ContactReport& report) {
  const ClothSystem& system = step.system;
  const bool follows = step.integrator.velocity_follows_positions();
  step.memory.resize(position_.size());
  if (find_motion(step)) report.work += recovering_work(step);
  if (follows)
    report.velocity_iterations =
        step.integrator.update_velocity_for_positions(step.forces, step.times, motion_, state);
  take_touches(step);
  copy(state.velocity, team_, free_velocity_);
  apply_all_impulses(system, state.velocity);
  const bool follows_damping = follows && step.forces.has_damping();
  solve_constraints(system, follows_damping ? first_velocity_sweeps : velocity_sweeps, state.velocity);
  if (follows_damping) {
    step.integrator.update_velocity_for_damping(step.forces, step.times, motion_, state);
    copy(state.velocity, team_, free_velocity_);
    apply_all_impulses(system, state.velocity);
    solver_.solve_again(constraints_, system.inverse_mass, {velocity_sweeps, velocity_tolerance},
                        state.velocity);
  }
  work_.assign(position_.size(), 0.0);
  find_changed(step.memory);
  if (follows) find_start_change(step);
  if (follows)
    add_half_steps_work(step, state);
  else
    find_work(step, state);
  bounce(step, follows, state);
  report.impulse = total_impulse(system);
  if (follows)
    for (const std::size_t i : changed_)
      if (!system.pinned[i]) report.impulse += system.mass[i] * start_change_[i];
  report.held_back = limit_held_back(step, state);
  remember(system, state, follows, step.memory);
  for (const std::size_t i : changed_) report.work += work_[i];
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
void ContinuousContact::find_work(const ContactStep& step, const ClothState& state) {
  const std::vector<double> parts = force_work_ ? impact_parts(step, state) : std::vector<double>();
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const ContactConstraint& contact = constraints_[c];
    PointSpeeds speeds{contact.point(step.velocity_before), contact.point(state.velocity),
                       contact.point(motion_)};
    const double impact = force_work_ ? parts[c] * contact.normal_impulse : impact_of(contact, speeds);
    if (force_work_)  // the load of springs acts while the two sides touch
      speeds.gone += contact.normal.dot(contact.rest - speeds.gone) * contact.normal;
    work_[at(contact.first_free(step.system.inverse_mass))] += work_of(contact, speeds, impact);
  }
}

/// Of the normal impulse of each contact, the part that changes velocities. Contacts that share a particle
/// share the change of its velocity: each has of it as much as of the particle's normal impulses.
std::vector<double> ContinuousContact::impact_parts(const ContactStep& step, const ClothState& state) const {
  const ClothSystem& system = step.system;
  std::vector<Vec3> given(position_.size(), Vec3::Zero());  // N s, along normals
  for (const ContactConstraint& contact : constraints_)
    for (std::size_t k = 0; k < at(contact.count); ++k)
      given[at(contact.particle[k])] += contact.weight[k] * contact.normal_impulse * contact.normal;
  std::vector<double> parts;
  for (const ContactConstraint& contact : constraints_) {
    double part = 0;  // the mean of its particles'
    for (std::size_t k = 0; k < at(contact.count); ++k) {
      const auto i = at(contact.particle[k]);
      const double square = given[i].squaredNorm();
      if (system.pinned[i] || !(square > 0)) continue;
      const double gained = system.mass[i] * (state.velocity[i] - step.velocity_before[i]).dot(given[i]);
      part += contact.weight[k] * contact.weight[k] * system.inverse_mass[i] *
              (gained < square ? std::max(gained, 0.0) / square : 1);
    }
    parts.push_back(part / contact.mobility);
  }
  return parts;
}

/// For Verlet's method: contact acts at the beginning of the step and at its end, each as half a kick of the
/// leapfrog, impulse o at v_n and impulse c to v_n+1. The two halves around one state do the work of the
/// impulse times the mean velocity of the steps before and after, under which the energy balance of a
/// leapfrog closes. The energy m |l|^2/2 that c takes from the load's half kick l, and the next o returns, is
/// deferred.
void ContinuousContact::add_half_steps_work(const ContactStep& step, const ClothState& state) {
  visit_changed([&](std::size_t i) {
    if (step.system.pinned[i]) return;
    const double mass = step.system.mass[i];
    const Vec3 opening = start_change_[i];
    work_[i] = mass * opening.dot(step.velocity_before[i] + 0.5 * opening) +
               kinetic_change(mass, free_velocity_[i], state.velocity[i]) - step.memory.deferred[i];
  });
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
void ContinuousContact::bounce(const ContactStep& step, bool follows, ClothState& state) {
  bounced_.assign(position_.size(), 0);
  bool any = false;
  for (std::size_t c = 0; c < constraints_.size(); ++c) any = any || bounce_bound_[c] > constraints_[c].bound;
  if (!any) return;
  deferred_of_bounced_.assign(position_.size(), 0.0);
  const std::vector<ContactConstraint> still = constraints_;
  const Vec3Field stopped = state.velocity;
  for (std::size_t c = 0; c < constraints_.size(); ++c) constraints_[c].bound = bounce_bound_[c];
  solve_constraints(step.system, velocity_sweeps, state.velocity);
  const ClothSystem& system = step.system;
  Islands islands(constraints_, system.inverse_mass);
  std::vector<Vec3> obstacle_velocity(position_.size(), Vec3::Zero());
  std::vector<std::uint8_t> touched(position_.size(), 0);
  for (const ContactConstraint& contact : constraints_)
    contact.for_each([&](std::size_t i) {
      if (!(system.inverse_mass[i] > 0)) return;
      touched[i] = 1;
      obstacle_velocity[i] = contact.rest;
    });
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
    if (follows) impulse += start_change_[i];
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
    const double part = shares[at(islands.of(constraints_[c].first_free(system.inverse_mass)))].part;
    constraints_[c].normal_impulse =
        still[c].normal_impulse + part * (constraints_[c].normal_impulse - still[c].normal_impulse);
    constraints_[c].friction_impulse =
        still[c].friction_impulse + part * (constraints_[c].friction_impulse - still[c].friction_impulse);
  }
}

void ContinuousContact::remember(const ClothSystem& system, const ClothState& state, bool follows,
                                 ContactMemory& memory) {
  std::fill(memory.held.begin(), memory.held.end(), 0);
  std::fill(memory.deferred.begin(), memory.deferred.end(), 0.0);
  visit_changed([&](std::size_t i) {
    const Vec3 impulse = state.velocity[i] - free_velocity_[i];
    memory.held[i] = !bounced_[i] && !impulse.isZero(0);
    if (follows && !system.pinned[i])
      memory.deferred[i] =
          bounced_[i] ? deferred_of_bounced_[i] : deferred_by_load(system, i, state.velocity[i]);
    work_[i] += memory.deferred[i];
  });
}

int ContinuousContact::limit_held_back(const ContactStep& step, ClothState& state) {
  int held = 0;
  for (const std::size_t i : changed_) {
    if ((target_position_[i] - position_[i]).norm() <= arrived_length()) continue;
    ++held;
    const Vec3 gone = (position_[i] - step.position_before[i]) / step.times.step, speed = state.velocity[i];
    if (!(gone.norm() < speed.norm())) continue;
    state.velocity.set(i, gone);
    if (!step.system.pinned[i]) work_[i] += kinetic_change(step.system.mass[i], speed, gone);
  }
  return held;
}

}  // namespace cloth
