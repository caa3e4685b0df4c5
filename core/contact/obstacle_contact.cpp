#include "contact/obstacle_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact/touch_kernels.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr double above_rounding = 1e-9;  // m

void copy(const Vec3Field& field, std::size_t first, std::size_t count, TouchBlock::Vectors& to) {
  std::copy_n(field.x() + first, count, to[0]);
  std::copy_n(field.y() + first, count, to[1]);
  std::copy_n(field.z() + first, count, to[2]);
}
void copy(const TouchBlock::Vectors& from, std::size_t first, std::size_t count, Vec3Field& field) {
  std::copy_n(from[0], count, field.x() + first);
  std::copy_n(from[1], count, field.y() + first);
  std::copy_n(from[2], count, field.z() + first);
}
void set(TouchBlock::Vectors& to, std::size_t k, const Vec3& v) {
  to[0][k] = v.x(), to[1][k] = v.y(), to[2][k] = v.z();
}
Vec3 get(const TouchBlock::Vectors& from, std::size_t k) {
  return {from[0][k], from[1][k], from[2][k]};
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

bool is_near(double nearest) {
  return nearest <= 0;
}

void set(double (&to)[3], const Vec3& v) {
  to[0] = v.x(), to[1] = v.y(), to[2] = v.z();
}

std::vector<double> nearest_of(const std::vector<Obstacle>& obstacles, const Vec3Field& position) {
  std::vector<double> nearest(position.size(), infinity);
  for (const Obstacle& obstacle : obstacles) add_nearest(obstacle, position, nearest);
  return nearest;
}

bool any_inside(const Obstacle& obstacle, const ClothSystem& system, const Vec3Field& position) {
  const std::vector<double> nearest = nearest_of({obstacle}, position);
  for (std::size_t i = 0; i < position.size(); ++i)
    if (is_near(nearest[i]) && !system.pinned[i] && penetration(obstacle, position[i])) return true;
  return false;
}

}  // namespace

static bool reflects(const Obstacle& obstacle) {
  return obstacle.response == "reflect";
}

std::optional<TouchSolid> solid_of(const Obstacle& obstacle) {
  TouchSolid solid;
  switch (shape_of(obstacle).body) {
    case BodyKind::half_space:
      solid.kind = TouchSolid::Kind::half_space;
      set(solid.center, obstacle.point), set(solid.normal, obstacle.normal.normalized());
      return solid;
    case BodyKind::ball:
      solid.kind = TouchSolid::Kind::ball;
      set(solid.center, obstacle.center), solid.radius = obstacle.radius;
      return solid;
    case BodyKind::box:
      solid.kind = TouchSolid::Kind::box;
      set(solid.center, obstacle.center), set(solid.half, 0.5 * obstacle.size);
      return solid;
    case BodyKind::surface:
      break;
  }
  return std::nullopt;
}

Obstacle grown(Obstacle obstacle, double length) {
  shape_of(obstacle).grow(obstacle, length);
  return obstacle;
}

Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity) {
  TouchBlock block{};
  std::fill_n(block.mass, TouchBlock::size, 1.0);
  block.touched[0] = 1;
  set(block.normal, 0, normal);
  block.held[0] = 1;  // it comes at this velocity
  for (TouchBlock::Vectors* each :
       {&block.start_velocity, &block.integrated_velocity, &block.velocity, &block.before})
    set(*each, 0, velocity);
  active_kernels<TouchKernels>().respond({obstacle.friction, obstacle.restitution, reflects(obstacle), 1, 0},
                                         block);
  return get(block.velocity, 0);
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
    : obstacles_(std::move(obstacles)), gravity_(gravity) {
  for (const Obstacle& obstacle : obstacles_) {
    solids_.push_back(solid_of(obstacle));
    rebounds_ = rebounds_ || obstacle.restitution > 0;
  }
}

ContactReport ObstacleContact::apply(const ClothSystem& system, const ContactBegin& begin,
                                     ClothState& state) const {
  ContactReport report;
  const std::size_t particles = state.position.size();
  begin.memory.resize(particles);
  std::span<const HeldParticle> held;
  if (begin.constrained) held = begin.constrained->held;
  const std::vector<double> nearest =
      begin.constrained ? std::vector<double>() : nearest_of(obstacles_, state.position);
  TouchBlock block{};
  for (std::size_t first = 0; first < particles; first += TouchBlock::size) {
    Piece piece{first, std::min<std::size_t>(TouchBlock::size, particles - first), {}};
    const auto after = std::find_if(held.begin(), held.end(),
                                    [&](const HeldParticle& h) { return h.particle >= first + piece.count; });
    piece.held = held.first(static_cast<std::size_t>(after - held.begin()));
    held = held.subspan(piece.held.size());
    if (begin.constrained || std::ranges::any_of(std::span(nearest).subspan(first, piece.count), is_near))
      respond(system, begin, piece, block, state, report);
    else
      std::fill_n(begin.memory.held.begin() + static_cast<std::ptrdiff_t>(first), piece.count,
                  std::uint8_t{0});
  }
  report.acted = report.contacts > 0;
  return report;
}

/// One obstacle after the other.
void ObstacleContact::respond(const ClothSystem& system, const ContactBegin& begin, const Piece& piece,
                              TouchBlock& block, ClothState& state, ContactReport& report) const {
  const TouchKernels& kernels = active_kernels<TouchKernels>();
  const auto& [first, count, held] = piece;
  std::fill_n(block.mass, TouchBlock::size, 1.0);
  std::copy_n(system.mass.data() + first, count, block.mass);
  std::fill_n(block.is_free, TouchBlock::size, 0.0);
  for (std::size_t k = 0; k < count; ++k) block.is_free[k] = system.pinned[first + k] ? 0 : 1;
  copy(begin.position, first, count, block.start), copy(begin.velocity, first, count, block.before);
  if (rebounds_) {  // what a rebound alone asks for
    std::copy_n(begin.memory.held.data() + first, count, block.held);
    copy(begin.velocity, first, count, block.start_velocity);
    copy(state.position, first, count, block.integrated_position);
    copy(state.velocity, first, count, block.integrated_velocity);
  }
  copy(state.position, first, count, block.position), copy(state.velocity, first, count, block.velocity);
  std::fill_n(block.work, TouchBlock::size, 0.0), std::fill_n(block.outcome, TouchBlock::size, 0.0);
  if (begin.constrained) move_to_constrained(system, *begin.constrained, piece, block);
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const Obstacle& obstacle = obstacles_[k];
    const int touched = begin.constrained ? find_held(k, piece, block)
                        : solids_[k]      ? kernels.find_touched(*solids_[k], block)
                                          : 0;
    if (touched == 0) continue;
    kernels.respond(
        {obstacle.friction, obstacle.restitution, reflects(obstacle), begin.step, gravity_ * begin.step},
        block);
    report.contacts += touched;
  }
  copy(block.position, first, count, state.position), copy(block.velocity, first, count, state.velocity);
  for (std::size_t k = 0; k < count; ++k) {
    begin.memory.held[first + k] = block.outcome[k] == 1 ? 1 : 0;
    report.work += block.work[k];
  }
}

/// The particles that touch an obstacle after a step that was solved with contact; returns their number.
int ObstacleContact::find_held(std::size_t obstacle, const Piece& piece, TouchBlock& block) {
  int number = 0;
  std::fill_n(block.touched, TouchBlock::size, 0.0);
  for (const HeldParticle& held : piece.held) {
    const std::size_t k = held.particle - piece.first;
    if (held.obstacle != obstacle || block.touched[k] != 0) continue;
    block.touched[k] = 1, ++number;
    set(block.point, k, get(block.position, k)), set(block.normal, k, held.normal);
    block.normal_load[k] = held.normal_load;
  }
  return number;
}

/// Moves particles to their constrained positions. Their velocities change by the displacement along the
/// surfaces that hold them; the normal velocities stay.
void ObstacleContact::move_to_constrained(const ClothSystem& system, const ConstrainedStep& constrained,
                                          const Piece& piece, TouchBlock& block) {
  auto held = piece.held.begin();
  for (std::size_t k = 0; k < piece.count; ++k) {
    const std::size_t i = piece.first + k;
    if (system.pinned[i]) continue;
    Vec3 moved = constrained.position[i] - get(block.position, k);
    for (; held != piece.held.end() && held->particle == i; ++held)
      moved -= held->normal.dot(moved) * held->normal;
    set(block.position, k, constrained.position[i]);
    set(block.velocity, k, get(block.velocity, k) + moved / constrained.weight);
  }
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
    if (is_near(nearest[i]) && !system.pinned[i] && is_touched(i)) return true;
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
