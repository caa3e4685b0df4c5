#include "contact/obstacle_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

std::optional<SurfacePoint> sphere_penetration(const Obstacle& sphere, const Vec3& position) {
  const Vec3 out = position - sphere.center;
  const double squared = out.squaredNorm();
  if (!(squared < sphere.radius * sphere.radius)) return std::nullopt;
  // The centre itself is equally far from every point of the surface: up is as good as any.
  const Vec3 normal = squared > 0 ? Vec3(out / std::sqrt(squared)) : Vec3(0, 1, 0);
  return SurfacePoint{sphere.center + sphere.radius * normal, normal};
}

std::optional<SurfacePoint> box_penetration(const Obstacle& box, const Vec3& position) {
  const Vec3 inside = position - box.center;
  const Vec3 depth = 0.5 * box.size - inside.cwiseAbs();
  int axis = 0;
  if (!(depth.minCoeff(&axis) > 0)) return std::nullopt;
  const double side = inside[axis] < 0 ? -1 : 1;
  SurfacePoint surface{position, Vec3::Zero()};
  surface.normal[axis] = side;
  surface.point[axis] = box.center[axis] + side * 0.5 * box.size[axis];
  return surface;
}

std::optional<SurfacePoint> plane_penetration(const Obstacle& plane, const Vec3& position) {
  const Vec3 normal = plane.normal.normalized();
  const double height = normal.dot(position - plane.point);
  if (!(height < 0)) return std::nullopt;
  return SurfacePoint{position - height * normal, normal};
}

}  // namespace

std::optional<SurfacePoint> penetration(const Obstacle& obstacle, const Vec3& position) {
  switch (obstacle.shape) {
    case Shape::sphere:
      return sphere_penetration(obstacle, position);
    case Shape::box:
      return box_penetration(obstacle, position);
    case Shape::plane:
      return plane_penetration(obstacle, position);
    case Shape::mesh:
      return std::nullopt;  // a surface without a thickness of its own: no particle is inside it
  }
  return std::nullopt;
}

Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity) {
  const double inward = velocity.dot(normal);
  if (!(inward < 0)) return velocity;
  if (obstacle.response == "reflect") return obstacle.friction * (velocity - 2 * inward * normal);
  const Vec3 tangential = velocity - inward * normal;
  const double change = (1 + obstacle.restitution) * -inward;
  const double speed = tangential.norm();
  const double kept = speed > 0 ? std::max(0.0, 1 - obstacle.friction * change / speed) : 0;
  return kept * tangential - obstacle.restitution * inward * normal;
}

std::optional<TunnellingRisk> find_tunnelling(const std::vector<Obstacle>& obstacles,
                                              const ClothSystem& system, const ClothState& state,
                                              double time_step) {
  std::optional<TunnellingRisk> risk;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k].shape == Shape::plane || obstacles[k].shape == Shape::mesh) continue;
    const double thickness =
        obstacles[k].shape == Shape::sphere ? 2 * obstacles[k].radius : obstacles[k].size.minCoeff();
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

ObstacleContact::ObstacleContact(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)) {}

ContactReport ObstacleContact::apply(const ClothSystem& system, ClothState& state) const {
  ContactReport report;
  for (const Obstacle& obstacle : obstacles_) {
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      if (system.pinned[i]) continue;
      const auto surface = penetration(obstacle, state.position[i]);
      if (!surface) continue;
      state.position.set(i, surface->point);
      state.velocity.set(i, contact_velocity(obstacle, surface->normal, state.velocity[i]));
      ++report.contacts;
    }
  }
  return report;
}

bool ObstacleContact::touches(const ClothSystem& system, const ClothState& state) const {
  return std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& obstacle) {
    for (std::size_t i = 0; i < state.position.size(); ++i)
      if (!system.pinned[i] && penetration(obstacle, state.position[i])) return true;
    return false;
  });
}

void ObstacleContact::append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const {
  constexpr double rounding = 1e-9;  // m, far above it
  for (Obstacle grown : obstacles_) {
    grown.radius += rounding;
    grown.size += Vec3::Constant(2 * rounding);
    grown.point += rounding * grown.normal.normalized();
    for (std::size_t i = 0; i < position.size(); ++i)
      if (const auto surface = penetration(grown, position[i]))
        marks.push_back({position[i], surface->normal, 0});
  }
}

}  // namespace cloth
