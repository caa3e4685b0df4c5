#include "contact/limited_contact.h"

#include <algorithm>
#include <tuple>

#include "geometry/at.h"
#include "scene/obstacle_shape.h"

namespace cloth {

/// Turns the planes with their particles, and adds those of particles that are inside for the first time. A
/// particle stays on the side that it met, which is continued beyond its edges.
void LimitedContact::renew(const ClothSystem& system, const Vec3Field& begin, const Vec3Field& position) {
  for (std::size_t c = 0; c < sides_.size(); ++c) {
    const Obstacle& body = obstacles_[sides_[c].obstacle];
    ContactConstraint& plane = planes_[c];
    const auto beside = shape_of(body).along(body, plane.normal, position[sides_[c].particle]);
    if (beside) plane.normal = beside->normal, plane.bound = beside->normal.dot(beside->point);
  }
  for (std::size_t i = 0; i < position.size(); ++i)
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      std::uint8_t& is_met = is_met_[i * obstacles_.size() + k];
      if (system.pinned[i] || is_met) continue;
      const auto entry = shape_of(obstacles_[k]).entry(obstacles_[k], begin[i], position[i]);
      if (!entry) continue;
      is_met = 1;
      sides_.push_back({i, k});
      ContactConstraint& plane = planes_.emplace_back();
      plane.count = 1, plane.particle[0] = static_cast<int>(i), plane.weight[0] = 1;
      plane.normal = entry->normal, plane.bound = entry->normal.dot(entry->point);
      plane.mobility = system.inverse_mass[i];
    }
}

/// Moves particles with a load to their surface, and others out of it.
std::vector<HeldParticle> LimitedContact::hold(double weight, Vec3Field& position) const {
  std::vector<HeldParticle> held;
  for (std::size_t c = 0; c < sides_.size(); ++c) {
    const auto [i, k] = sides_[c];
    const double load = target_.loads()[c];
    const auto beside = shape_of(obstacles_[k]).along(obstacles_[k], planes_[c].normal, position[i]);
    if (!beside) continue;
    const bool is_inside = beside->normal.dot(position[i] - beside->point) < 0;
    if (load > 0 || is_inside) position.set(i, beside->point);
    if (load > 0) held.push_back({i, k, beside->normal, weight * load});
  }
  std::ranges::sort(held, {}, [](const HeldParticle& h) { return std::tuple(h.particle, h.obstacle); });
  return held;
}

std::vector<HeldParticle> LimitedContact::solve(const ClothSystem& system, ForceModel& forces,
                                                std::span<const Obstacle> obstacles, const LongStep& step,
                                                Vec3Field& position) {
  constexpr double accepted = 1e-5;  // m
  obstacles_ = obstacles;
  is_met_.assign(position.size() * obstacles.size(), 0);
  sides_.clear(), planes_.clear();
  const auto renewed = [&](const Vec3Field& there) -> std::span<const ContactConstraint> {
    renew(system, step.begin, there);
    return planes_;
  };
  target_.solve(system, forces, renewed(position), step, accepted, position, renewed);
  return hold(step.weight, position);
}

}  // namespace cloth
