// How far particles and obstacles may move in a round: no feature leaves its side of the plane of any pair.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "contact/continuous_contact.h"
#include "contact/particle_motion.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Features never come closer than this part of the thickness.
constexpr double least_part = 1e-3;
/// The part of a gap that a round may use up: few rounds suffice, and a gap always remains.
constexpr double used_part = 0.5;
/// Factor by which the radius of a capsule grows each time that it stopped its particle, and the factor's
/// bound.
constexpr double more_room = 2, max_room = 8;
constexpr double least_advance = 1e-9;  ///< of a step; less counts as none
/// The gap that must remain after a round.
double kept_gap(double gap, double thickness) {
  const double least = least_part * thickness;
  if (gap <= least) return gap;
  return std::max(least, (1 - used_part) * std::min(gap, thickness));
}

/// Solids: inside and outside are distinguished at any depth.
bool meets_solid(const FeaturePair& pair) {
  return pair.kind == PairKind::vertex_plane || pair.kind == PairKind::vertex_box ||
         pair.kind == PairKind::face_sphere;
}

/// The part of the straight line from `start`, which is inside, to `end` that stays in a cylinder inscribed
/// in the capsule, about the same axis.
double part_inside(const Capsule& capsule, const Vec3& start, const Vec3& end) {
  const double room = capsule.radius / std::sqrt(2.0);
  const double square = room * room;  // balls around the ends of the axis are inside
  if ((start - capsule.from).squaredNorm() <= square && (end - capsule.to).squaredNorm() <= square) return 1;
  const Vec3 line = capsule.to - capsule.from;
  const double length = line.norm();
  const Vec3 axis = length > 0 ? Vec3(line / length) : Vec3::UnitX();
  const auto across = [&](const Vec3& x) -> Vec3 { return x - axis.dot(x) * axis; };
  const Vec3 here = start - capsule.from, step = end - start;
  double part = 1;
  const double along = axis.dot(step), from = axis.dot(here);
  const double ahead = along > 0 ? length + room - from : room + from;
  if (std::abs(along) > ahead) part = std::max(ahead, 0.0) / std::abs(along);
  const Vec3 aside = across(here), drift = across(step);
  if ((aside + drift).squaredNorm() <= room * room) return part;
  // |aside + t drift| = room
  const double a = drift.squaredNorm(), b = aside.dot(drift), c = aside.squaredNorm() - room * room;
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  return std::min(part, std::clamp((root - b) / a, 0.0, 1.0));
}

}  // namespace

/// Bounds the fraction of its displacement that each particle can take without leaving its side of any plane.
void ContinuousContact::bound_by_planes() {
  fill_in_shares(team_, pairs_.size(), least_pairs, is_bound_, [&](std::size_t k) -> std::uint8_t {
    const Approach approach = approach_within(k);
    return separations_[k].gap() > 0 && approach.of_both() <= approach.room ? 0 : 1;
  });
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (is_bound_[k] != 0) bound_by_plane(k);
}

ContinuousContact::Approach ContinuousContact::approach_within(std::size_t k) const {
  const Separation& s = separations_[k];
  Approach approach{.room = s.gap() - kept_gap(s.gap(), memory_[k].thickness)};
  for (int j = 0; j < s.count; ++j) {
    const auto i = at(s.particle[at(j)]);
    const double ahead = approach.ahead[at(j)] = s.normal.dot(target_position_[i] - position_[i]);
    if (j < s.near_count)
      approach.near = std::max(approach.near, -ahead);
    else
      approach.far = std::max(approach.far, ahead);
  }
  return approach;
}

void ContinuousContact::bound_by_plane(std::size_t k) {
  const Separation& s = separations_[k];
  const Approach approach = approach_within(k);
  const double room = std::max(approach.room, 0.0);
  const double near_room = approach.of_both() > 0 ? room * approach.near / approach.of_both() : 0;
  for (int j = 0; j < s.count; ++j) {
    const auto i = at(s.particle[at(j)]);
    const bool is_near = j < s.near_count;
    const double level = s.normal.dot(position_[i]);
    const double slack = is_near ? level - s.near_level + near_room : s.far_level - level + room - near_room;
    const double step = is_near ? -approach.ahead[at(j)] : approach.ahead[at(j)];
    if (s.gap() <= 0 && (step > 0 || !meets_solid(pairs_[k])))
      fraction_[i] = 0;  // inside because of an edit: may only move out of a solid
    else if (step > slack)
      fraction_[i] = std::min(fraction_[i], std::max(slack, 0.0) / step);
  }
}

void ContinuousContact::bound_by_swept_volumes() {
  std::atomic<bool> any = false;
  in_shares(team_, position_.size(), least_particles, [&](int, std::size_t begin, std::size_t end) {
    bool any_here = false;
    for (std::size_t i = begin; i < end; ++i) {
      if (swept_.to[i] == target_position_[i]) continue;  // to the end of its capsule's axis
      const double part = part_inside(swept_[i], position_[i], target_position_[i]);
      if (fraction_[i] <= part) continue;
      fraction_[i] = part;
      radius_scale_[i] = std::min(max_room, more_room * radius_scale_[i]);
      any_here = true;
    }
    if (any_here) any = true;
  });
  reached_bounds_ = any;
}

/// Moves the particles; returns the longest remaining displacement, in m.
double ContinuousContact::move_cloth() {
  fraction_.assign(position_.size(), 1.0);
  bound_by_planes();
  bound_by_swept_volumes();
  double left = 0;
  if (std::all_of(fraction_.begin(), fraction_.end(), [](double part) { return part == 1; })) {
    copy(target_position_, team_, position_);
    return left;
  }
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if (fraction_[i] == 1) {
      position_.set(i, target_position_[i]);
      continue;
    }
    const Vec3 step = target_position_[i] - position_[i];
    left = std::max(left, (1 - fraction_[i]) * step.norm());
    position_.add(i, fraction_[i] * step);
  }
  return left;
}

/// A plane moved along with its obstacle; the rotation of a sphere does not move planes.
ContinuousContact::Plane ContinuousContact::moved_plane(int obstacle, const Plane& plane,
                                                        const std::vector<Pose>& to) const {
  const ObstacleBody& body = bodies_[at(obstacle)];
  const Pose &from = poses_[at(obstacle)], &end = to[at(obstacle)];
  if (body.kind == BodyKind::ball && end.stretch == from.stretch)
    return {plane.point + end.at(body.center) - from.at(body.center), plane.normal};
  if (body.kind == BodyKind::ball) {
    const double growth = end.stretch.x() / from.stretch.x();
    return {end.at(body.center) + growth * (plane.point - from.at(body.center)), plane.normal};
  }
  return {end.at(from.inverse(plane.point)), end.rotation * (from.rotation.transpose() * plane.normal)};
}

/// The part of the step in which the points of a rotating obstacle leave the chords of their paths by less
/// than a quarter of the smallest gap: the second derivative of a path is at most angle^2 radius + 2 angle
/// shift.
double ContinuousContact::turn_limit(std::size_t obstacle) const {
  const PoseInterpolation& path = paths_[obstacle];
  if (!(path.angle() > 0) || bodies_[obstacle].kind == BodyKind::ball) return 1;
  const Vec3 pivot = path.pivot(part_);
  double gap = infinity, radius = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].obstacle != static_cast<int>(obstacle)) continue;
    gap = std::min(gap, reached_gap(separations_[k]));
    for (int j = 0; j < separations_[k].near_count; ++j)
      radius = std::max(radius, (position_[at(separations_[k].particle[at(j)])] - pivot).norm());
  }
  const double shift = (path.pivot(1) - path.pivot(0)).norm();
  const double bend = path.angle() * (path.angle() * radius + 2 * shift);
  return bend > 0 ? std::sqrt(2 * std::max(gap, 0.0) / bend) : 1;
}

/// The gap of a pair after the cloth has moved, in m.
double ContinuousContact::reached_gap(const Separation& s) const {
  double level = infinity;
  for (int j = 0; j < s.near_count; ++j)
    level = std::min(level, s.normal.dot(position_[at(s.particle[at(j)])]));
  return level - s.far_level;
}

/// The extent of an obstacle's feature along the normal, in m, except for planes. The points of a growing
/// shape move straight, so that between two poses its extent is at most that at one of them.
double ContinuousContact::reach_along(const Vec3& normal, const FeaturePair& pair, const Pose& pose) const {
  const ObstacleBody& body = bodies_[at(pair.obstacle)];
  const auto vertex = [&](int i) { return normal.dot(pose.at(body.vertices[at(i)])); };
  double furthest = -infinity;
  if (pair.kind == PairKind::face_sphere)
    return normal.dot(pose.at(body.center)) + pose.stretch.x() * body.radius;
  if (pair.kind == PairKind::face_vertex) return vertex(pair.far_feature);
  if (pair.kind == PairKind::vertex_box)
    for (int corner = 0; corner < 8; ++corner) furthest = std::max(furthest, vertex(corner));
  if (pair.kind == PairKind::edge_edge)
    for (const int end : body.surface.edges[at(pair.far_feature)]) furthest = std::max(furthest, vertex(end));
  if (pair.kind == PairKind::vertex_face)
    for (const int end : body.surface.triangles[at(pair.far_feature)])
      furthest = std::max(furthest, vertex(end));
  return furthest;
}

/// The factor by which the advance to `next_poses_` must be shortened for the cloth to stay beyond every
/// moved plane.
double ContinuousContact::shrink_to_planes() {
  constexpr double caution = 0.9;
  double shrink = 1;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const FeaturePair& pair = pairs_[k];
    if (pair.obstacle == FeaturePair::cloth_itself || paths_[at(pair.obstacle)].is_still()) continue;
    const Separation& s = separations_[k];
    const Vec3 on_plane = s.far_point + (s.far_level - s.normal.dot(s.far_point)) * s.normal;
    const Plane moved = moved_plane(pair.obstacle, {on_plane, s.normal}, next_poses_);
    const double grown =
        paths_[at(pair.obstacle)].grows()
            ? reach_along(moved.normal, pair, next_poses_[at(pair.obstacle)]) - moved.normal.dot(moved.point)
            : 0;  // beyond the plane
    double gap = infinity;
    for (int j = 0; j < s.near_count; ++j)
      gap = std::min(gap, moved.normal.dot(position_[at(s.particle[at(j)])] - moved.point) - grown);
    const double now = reached_gap(s), kept = kept_gap(now, memory_[k].thickness);
    if (gap >= kept) continue;
    const double factor = caution * std::max(now - kept, 0.0) / (now - gap);
    if (factor < shrink) shrink = factor, blocking_pair_ = k;
  }
  return shrink;
}

/// Moves the obstacles as far as the present cloth allows; returns how far, as a part of the step.
double ContinuousContact::advance_obstacles() {
  double advance = 1 - part_;
  blocking_pair_.reset();
  for (std::size_t k = 0; k < paths_.size(); ++k) advance = std::min(advance, turn_limit(k));
  while (advance > least_advance) {
    const bool to_end = advance >= 1 - part_;
    for (std::size_t k = 0; k < paths_.size(); ++k)
      next_poses_[k] = paths_[k].at(to_end ? 1 : part_ + advance);
    const double shrink = shrink_to_planes();
    if (shrink >= 1) {
      poses_ = next_poses_;
      part_ = to_end ? 1 : part_ + advance;
      return advance;
    }
    advance *= shrink;
  }
  return 0;
}

/// The pair that stopped a moving obstacle: that of the last advance, else the nearest.
std::optional<std::size_t> ContinuousContact::blocking_pair() const {
  if (blocking_pair_) return blocking_pair_;
  std::optional<std::size_t> nearest;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].obstacle == FeaturePair::cloth_itself || paths_[at(pairs_[k].obstacle)].is_still())
      continue;
    if (!nearest || separations_[k].distance < separations_[*nearest].distance) nearest = k;
  }
  return nearest;
}

/// Describes where an obstacle could not move on, and what holds the cloth: a pinned particle of the pair if
/// there is one, else the contact on the other side of the cloth.
Pinch ContinuousContact::pinch(const ClothSystem& system) const {
  const std::optional<std::size_t> blocking = blocking_pair();
  if (!blocking) return {};
  const Separation& s = separations_[*blocking];
  Pinch pinch{pairs_[*blocking].obstacle, s.particle[0], s.far_point};
  for (int j = 0; j < s.near_count; ++j) {
    if (!system.pinned[at(s.particle[at(j)])]) continue;
    pinch.particle = s.particle[at(j)];
    pinch.holder = Pinch::Holder::pin;
    return pinch;
  }
  double largest_opposition = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Separation& other = separations_[k];
    const bool holds = other.distance < near_factor * memory_[k].thickness &&
                       std::any_of(other.particle.begin(), other.particle.begin() + other.count, [&](int i) {
                         return std::find(s.particle.begin(), s.particle.begin() + s.near_count, i) !=
                                s.particle.begin() + s.near_count;
                       });
    const double against = -other.normal.dot(s.normal);
    if (!holds || pairs_[k].obstacle == pinch.obstacle) continue;
    const bool is_own = pairs_[k].obstacle == FeaturePair::cloth_itself;
    if ((is_own ? std::abs(against) : against) <= largest_opposition) continue;
    largest_opposition = against;
    pinch.holder = is_own ? Pinch::Holder::itself : Pinch::Holder::obstacle;
    pinch.holding_obstacle = pairs_[k].obstacle;
  }
  return pinch;
}

}  // namespace cloth
