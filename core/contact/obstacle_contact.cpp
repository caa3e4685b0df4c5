#include "contact/obstacle_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "contact/contact_work.h"

namespace cloth {
namespace {

constexpr double above_rounding = 1e-9;  // m

/// J, of the impulse `change` times the mass on a particle.
double stopping_work(double mass, const Vec3& normal, const PointSpeeds& speeds, const Vec3& change,
                     double normal_load) {
  ContactConstraint contact;
  contact.normal = normal;
  contact.mobility = 1 / mass;
  contact.normal_impulse = normal_load + std::max(0.0, mass * change.dot(normal));
  contact.friction_impulse = mass * (change - change.dot(normal) * normal);
  return work_of(contact, speeds);
}

/// A signed measure of how far each particle is from the obstacle, at most 0 for every particle inside and
/// for some within rounding of its surface; the least of it and what `nearest` holds. Plain loops over all
/// particles: penetration() need only be asked for those.
void add_nearest(const Obstacle& obstacle, const Vec3Field& position, std::vector<double>& nearest) {
  const double *x = position.x(), *y = position.y(), *z = position.z();
  double* to = nearest.data();
  const Vec3 c = obstacle.center;
  switch (shape_of(obstacle).body) {
    case BodyKind::half_space: {
      const Vec3 n = obstacle.normal.normalized(), p = obstacle.point;
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        const double height = n.x() * (x[i] - p.x()) + n.y() * (y[i] - p.y()) + n.z() * (z[i] - p.z());
        to[i] = std::min(to[i], height - above_rounding);
      }
      break;
    }
    case BodyKind::ball: {
      const double reach = obstacle.radius + above_rounding, square = reach * reach;
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        const double dx = x[i] - c.x(), dy = y[i] - c.y(), dz = z[i] - c.z();
        to[i] = std::min(to[i], dx * dx + dy * dy + dz * dz - square);
      }
      break;
    }
    case BodyKind::box: {
      const Vec3 half = (0.5 * obstacle.size).array() + above_rounding;
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        const double dx = std::abs(x[i] - c.x()) - half.x(), dy = std::abs(y[i] - c.y()) - half.y(),
                     dz = std::abs(z[i] - c.z()) - half.z();
        to[i] = std::min(to[i], std::max(dx, std::max(dy, dz)));
      }
      break;
    }
    case BodyKind::surface:
      break;  // has no inside
  }
}

std::vector<double> nearest_of(const std::vector<Obstacle>& obstacles, const Vec3Field& position) {
  std::vector<double> nearest(position.size(), infinity);
  for (const Obstacle& obstacle : obstacles) add_nearest(obstacle, position, nearest);
  return nearest;
}

bool any_inside(const Obstacle& obstacle, const ClothSystem& system, const Vec3Field& position) {
  const std::vector<double> nearest = nearest_of({obstacle}, position);
  for (std::size_t i = 0; i < position.size(); ++i)
    if (nearest[i] <= 0 && !system.pinned[i] && penetration(obstacle, position[i])) return true;
  return false;
}

}  // namespace

/// The length first: it is asked of every particle in contact.
static bool reflects(const Obstacle& obstacle) {
  constexpr std::string_view name = "reflect";
  return obstacle.response.size() == name.size() && obstacle.response == name;
}

Obstacle grown(Obstacle obstacle, double length) {
  shape_of(obstacle).grow(obstacle, length);
  return obstacle;
}

Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity) {
  return contact_velocity(obstacle, normal, velocity, -velocity.dot(normal));
}

Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity, double approach,
                      double normal_load) {
  const double inward = velocity.dot(normal);
  if (!(inward < 0)) return velocity;
  if (reflects(obstacle)) return obstacle.friction * (velocity - 2 * inward * normal);
  const Vec3 tangential = velocity - inward * normal;
  const double rebound = obstacle.restitution * approach, change = rebound - inward;
  const double speed = tangential.norm();
  const double kept = speed > 0 ? std::max(0.0, 1 - obstacle.friction * (change + normal_load) / speed) : 0;
  return kept * tangential + rebound * normal;
}

std::optional<TunnellingRisk> find_tunnelling(const std::vector<Obstacle>& obstacles,
                                              const ClothSystem& system, const ClothState& state,
                                              double time_step) {
  std::optional<TunnellingRisk> risk;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const double thickness = shape_of(obstacles[k]).thickness(obstacles[k]);
    if (thickness == infinity) continue;
    if (!risk || thickness < risk->thickness) risk = TunnellingRisk{0, k, 0, thickness};
  }
  if (!risk) return std::nullopt;
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    if (system.pinned[i]) continue;
    const double travel = state.velocity[i].norm() * time_step;
    if (travel > risk->travel) risk->travel = travel, risk->particle = static_cast<int>(i);
  }
  return risk->travel > risk->thickness ? risk : std::nullopt;
}

std::string describe(const TunnellingRisk& risk) {
  return fmt::format(
      "particle {} moves {:.3g} m in a step and obstacle {} is {:.3g} m thick: it can pass it unseen",
      risk.particle, risk.travel, risk.obstacle, risk.thickness);
}

ObstacleContact::ObstacleContact(std::vector<Obstacle> obstacles, double gravity)
    : obstacles_(std::move(obstacles)), gravity_(gravity) {}

/// m/s, the approach speed to which restitution applies. A particle without contact in the last step: its
/// mean speed in this step. One with contact: its speed at the beginning of the step, because what the step
/// adds is load. 0 below twice what gravity or the load adds in a step, or a cloth at rest would keep
/// bouncing.
double ObstacleContact::approach_of(const Particle& particle, const Vec3& normal,
                                    const ContactBegin& begin) const {
  const std::size_t i = particle.index;
  const Vec3 began = begin.velocity[i];
  const Vec3 speed =
      begin.memory.held[i] ? began : Vec3((particle.integrated_position - begin.position[i]) / begin.step);
  const double load = normal.dot(began - particle.integrated_velocity);
  const double approach = -speed.dot(normal);
  return approach > 2 * std::max(gravity_ * begin.step, load) ? approach : 0;
}

ContactReport ObstacleContact::apply(const ClothSystem& system, const ContactBegin& begin,
                                     ClothState& state) const {
  ContactReport report;
  begin.memory.resize(state.position.size());
  std::span<const HeldParticle> held;
  if (begin.constrained) held = begin.constrained->held;
  const std::vector<double> nearest =
      begin.constrained ? std::vector<double>() : nearest_of(obstacles_, state.position);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (system.pinned[i]) continue;
    if (!begin.constrained && !(nearest[i] <= 0)) {
      begin.memory.held[i] = 0;
      continue;
    }
    Particle particle{i, state.position[i], state.velocity[i], {}, begin.velocity[i]};
    while (particle.held.size() < held.size() && held[particle.held.size()].particle == i)
      particle.held = held.first(particle.held.size() + 1);
    held = held.subspan(particle.held.size());
    if (begin.constrained) move_to_constrained(particle, *begin.constrained, state);
    const bool touched = touch(system, particle, begin, state, report);
    if (!touched) begin.memory.held[i] = 0;
  }
  report.acted = report.contacts > 0;
  return report;
}

/// Moves a particle to its constrained position. Its velocity changes by the displacement along the surfaces
/// that hold it; the normal velocity stays.
void ObstacleContact::move_to_constrained(const Particle& particle, const ConstrainedStep& constrained,
                                          ClothState& state) {
  const std::size_t i = particle.index;
  Vec3 moved = constrained.position[i] - particle.integrated_position;
  for (const HeldParticle& held : particle.held) moved -= held.normal.dot(moved) * held.normal;
  state.position.set(i, constrained.position[i]);
  state.velocity.add(i, moved / constrained.weight);
}

/// The surface point and the normal load of the particle, if it touches the obstacle.
std::optional<ObstacleContact::Touched> ObstacleContact::touched(std::size_t obstacle,
                                                                 const Particle& particle,
                                                                 const Vec3& position,
                                                                 bool constrained) const {
  if (!constrained) {
    const auto surface = penetration(obstacles_[obstacle], position);
    return surface ? std::optional(Touched{*surface, 0}) : std::nullopt;
  }
  for (const HeldParticle& held : particle.held)
    if (held.obstacle == obstacle) return Touched{{position, held.normal}, held.normal_load};
  return std::nullopt;
}

/// One particle and all obstacles, in their order.
bool ObstacleContact::touch(const ClothSystem& system, Particle& particle, const ContactBegin& begin,
                            ClothState& state, ContactReport& report) const {
  const std::size_t i = particle.index;
  const double mass = system.mass[i];
  bool is_touched = false, bounced = false;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const auto place = touched(k, particle, state.position[i], begin.constrained != nullptr);
    if (!place) continue;
    const auto& [surface, normal_load] = *place;
    const Vec3 speed = state.velocity[i];
    const double approach = approach_of(particle, surface.normal, begin);
    const Vec3 stopped = contact_velocity(obstacles_[k], surface.normal, speed, 0, normal_load / mass);
    Vec3 answer = stopped;
    if (approach > 0)
      answer = contact_velocity(obstacles_[k], surface.normal, speed, approach, normal_load / mass);
    const PointSpeeds speeds{particle.before, stopped, (surface.point - begin.position[i]) / begin.step};
    const double work = stopping_work(mass, surface.normal, speeds, stopped - speed, normal_load);
    const double square = 0.5 * mass * (answer - stopped).squaredNorm();
    if (square > 0) {  // returns no more energy than contact has taken
      const double linear = mass * stopped.dot(answer - stopped);
      answer = stopped + part_within(square, linear, std::max(-work, 0.0)) * (answer - stopped);
    }
    state.position.set(i, surface.point);
    state.velocity.set(i, answer);
    report.work += work + 0.5 * mass * (answer.squaredNorm() - stopped.squaredNorm());
    particle.before = answer;
    bounced = bounced || answer != stopped;
    is_touched = true;
    ++report.contacts;
  }
  if (is_touched) begin.memory.held[i] = !bounced;
  return is_touched;
}

bool ObstacleContact::is_inside(const ClothSystem& system, const Vec3Field& position) const {
  return std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& obstacle) {
    return any_inside(grown(obstacle, -above_rounding), system, position);
  });
}

bool ObstacleContact::touches(const ClothSystem& system, const ClothState& state) const {
  const std::vector<double> nearest = nearest_of(obstacles_, state.position);
  const auto is_touched = [&](std::size_t i) {
    return std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& obstacle) {
      return penetration(obstacle, state.position[i]).has_value();
    });
  };
  for (std::size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i] <= 0 && !system.pinned[i] && is_touched(i)) return true;
  return false;
}

void ObstacleContact::append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const {
  for (const Obstacle& obstacle : obstacles_) {
    const Obstacle reached = grown(obstacle, above_rounding);
    for (std::size_t i = 0; i < position.size(); ++i)
      if (const auto surface = penetration(reached, position[i]))
        marks.push_back({position[i], surface->normal, 0});
  }
}

}  // namespace cloth
