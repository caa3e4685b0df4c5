#include "contact/stiff_contact.h"

#include <algorithm>
#include <cmath>

#include "cloth/sums.h"
#include "geometry/at.h"
#include "integrators/integrator.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

constexpr int max_iterations = 12;
constexpr int max_trials = 6;          // of a length
constexpr double accepted_work = 0.5;  // of the residual along a step that is short enough
constexpr double least_work = 1e-3;    // of the first iteration's work: stops below
constexpr double on_surface = 1e-9;    // m, above rounding

}  // namespace

void StiffContact::begin_solve(std::span<const Obstacle> obstacles, const Vec3Field& begin,
                               std::size_t particles) {
  begin_ = begin;
  obstacles_ = obstacles;
  reached_.clear();
  for (const Obstacle& obstacle : obstacles) reached_.push_back(grown(obstacle, on_surface));
  sides_.assign(particles * obstacles.size(), {});
}

/// The point of the surface that the particle is inside of or on, or that it is held on; it stays on the side
/// that it met first, which is continued beyond its edges.
std::optional<SurfacePoint> StiffContact::place_on(std::size_t obstacle, const Side& side, const Vec3& begin,
                                                   const Vec3& point) const {
  const Obstacle& body = obstacles_[obstacle];
  if (side.is_met) {
    const auto on = shape_of(body).along(body, side.normal, point);
    if (!on || side.is_active || on->normal.dot(point - on->point) <= on_surface) return on;
    return std::nullopt;
  }
  if (const auto out = shape_of(body).entry(body, begin, point)) return out;
  if (const auto on = penetration(reached_[obstacle], point)) return SurfacePoint{point, on->normal};
  return std::nullopt;
}

/// Moves particles out of the obstacles, and the active ones back to the surface along which they have moved;
/// lists the particles on a surface.
void StiffContact::hold(const ClothSystem& system, Vec3Field& position) {
  held_.clear();
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (system.pinned[i]) continue;
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      Side& side = side_of(i, k);
      const auto place = place_on(k, side, begin_[i], position[i]);
      if (!place) continue;
      position.set(i, place->point);
      side.normal = place->normal;
      side.is_met = true;
      held_.push_back({i, k, place->normal, 0});
    }
  }
}

/// N; its normal component becomes the normal load of the particles in contact.
void StiffContact::find_residual(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                                 const Vec3Field& position) {
  solver_.find_residual(system, forces, step, position, residual_);
  for (HeldParticle& held : held_) held.normal_load = held.normal.dot(residual_[held.particle]);
}

/// Releases the particles that are pulled away from their surface.
void StiffContact::release() {
  std::erase_if(held_, [](const HeldParticle& held) { return !(held.normal_load > 0); });
  for (Side& side : sides_) side.is_active = false;
  for (const HeldParticle& held : held_) side_of(held.particle, held.obstacle).is_active = true;
}

void StiffContact::keep_along_surfaces(Vec3Field& field) const {
  for (const HeldParticle& held : held_)
    field.add(held.particle, -held.normal.dot(field[held.particle]) * held.normal);
}

/// Constrained normal directions get a stiffness far above all others, so that the matrix keeps its pattern.
bool StiffContact::find_direction(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                                  const Vec3Field& position) {
  constexpr double holding = 1e6;
  Linearisation& matrix = solver_.linearise(system, forces, step, position);
  for (const HeldParticle& held : held_) {
    const SymmetricBlock node = matrix.nodes[held.particle];
    matrix.nodes.add(held.particle, block_along(0, holding * (node.xx + node.yy + node.zz), held.normal));
  }
  along_ = residual_;
  keep_along_surfaces(along_);
  for (double& value : along_.flat()) value *= -step.weight * step.weight;
  const bool solved = solver_.solve(system, position, along_, direction_);
  keep_along_surfaces(direction_);
  return solved;
}

std::vector<HeldParticle> StiffContact::solve(const ClothSystem& system, ForceModel& forces,
                                              std::span<const Obstacle> obstacles, const LongStep& step,
                                              Vec3Field& position) {
  if (residual_.size() != position.size())
    residual_ = direction_ = start_ = along_ = Vec3Field(position.size());
  begin_solve(obstacles, step.begin, position.size());
  solver_.begin(forces, step, position);
  hold(system, position);
  find_residual(system, forces, step, position);
  double first = 0;  // J, negative
  for (int n = 0; n < max_iterations; ++n) {
    release();
    if (!find_direction(system, forces, step, position)) break;
    start_ = position;
    sides_at_start_ = sides_;
    const double before = dot(direction_.flat(), residual_.flat());
    if (n == 0) first = before;
    if (before >= least_work * first) break;
    double length = 1;
    for (int trial = 1;; ++trial) {
      position = start_;
      sides_ = sides_at_start_;
      add_scaled(length, direction_, position);
      hold(system, position);
      find_residual(system, forces, step, position);
      const double after = dot(direction_.flat(), residual_.flat());
      if (trial == max_trials || after <= -accepted_work * before) break;
      length *= 0.5;
    }
  }
  release();
  const Vec3Field& force = solver_.force();
  for (HeldParticle& held : held_) {
    Vec3 load = solver_.integrated_force()[held.particle] - force[held.particle];
    if (step.force) load += (*step.force)[held.particle];
    held.normal_load = std::max(0.0, step.weight * held.normal.dot(load));
  }
  return held_;
}

}  // namespace cloth
