#include "contact/continuous_contact.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "cloth/mesh_cloth.h"
#include "contact/particle_motion.h"
#include "contact/separations.h"
#include "contact/stagger.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Radius of a capsule as a part of the thickness, or of the displacement if that gives more.
constexpr double margin_part = 0.1, aside_part = 0.1;
/// Of a mean edge, see PairSearch. Of meshes, whose features are often smaller than the cloth's, more would
/// find too many overlaps.
constexpr double skin_part = 0.7, skin_part_with_meshes = 0.35;
/// Ten times as much lets a damped cloth creep over a ball by 0.4 mm in a second.
constexpr double solver_tolerance_part = 1e-6;
constexpr int solver_sweeps = 20;
/// Of the thickness: contacts that are kept by more are left out until others violate them.
constexpr double left_out_beyond_part = 0.003;
/// Stacks of layers need more: sweeps continue while some pair misses more than `missing_part` of its
/// thickness and that decreases.
constexpr double missing_part = 0.03, less_missing = 0.9;
constexpr int more_solver_sweeps = 100, max_solver_sweeps = 1000;

std::vector<ObstacleBody> bodies_of(const Scene& scene) {
  std::vector<ObstacleBody> bodies;
  for (const Obstacle& obstacle : scene.obstacles) bodies.push_back(body_of(obstacle));
  return bodies;
}

/// m, distance from the pivot of the furthest point that can touch the cloth.
double reach_of(const Obstacle& obstacle, const Vec3Field& position) {
  if (shape_of(obstacle).body != BodyKind::half_space) return body_of(obstacle).reach;
  double reach = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    reach = std::max(reach, (position[i] - obstacle.point).norm());
  return reach;
}

bool has_mesh(const std::vector<ObstacleBody>& bodies) {
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const ObstacleBody& body) { return body.kind == BodyKind::surface; });
}

double mean_edge(const Surface& surface, const Vec3Field& position) {
  double sum = 0;
  for (const auto& [a, b] : surface.edges) sum += (position[at(a)] - position[at(b)]).norm();
  return sum / static_cast<double>(std::max<std::size_t>(1, surface.edges.size()));
}

}  // namespace

bool has_continuous_contact(const Scene& scene) {
  return scene.contact || scene.self_contact ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                     [](const Obstacle& o) { return shape_of(o).body == BodyKind::surface || moves(o); });
}

double highest_obstacle_speed(const Scene& scene, const ObstacleTransitions& transitions,
                              const Vec3Field& position) {
  double transition = 0, highest = 0;
  for (std::size_t k = 0; k < transitions.size(); ++k)
    if (transitions[k].is_active())
      transition = std::max(
          transition,
          transitions[k].speed(transitions[k].reshapes() ? reach_of(scene.obstacles[k], position) : 0));
  for (const Obstacle& obstacle : scene.obstacles)
    if (moves(obstacle)) highest = std::max(highest, highest_speed(obstacle, body_of(obstacle).reach));
  return highest + transition;
}

ContinuousContact::ContinuousContact(const Scene& scene, const ClothSystem& system,
                                     ObstacleTransitions transitions, const ThicknessTransition& thickness,
                                     double time, bool long_steps)
    : surface_(make_surface(system.size(), triangles_of(system))),
      bodies_(bodies_of(scene)),
      obstacles_(scene.obstacles),
      transitions_(std::move(transitions)),
      close_pairs_(
          surface_, system.start, bodies_, scene.self_contact.has_value(),
          (has_mesh(bodies_) ? skin_part_with_meshes : skin_part) * mean_edge(surface_, system.start)),
      long_steps_(long_steps),
      mean_edge_(mean_edge(surface_, system.start)),
      thickness_transition_(thickness),
      full_thickness_(scene.contact.value_or(ContactSettings{}).thickness),
      gravity_(gravity_of(scene).norm()),
      poses_(bodies_.size()),
      next_poses_(bodies_.size()),
      end_poses_(bodies_.size()) {
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    starts_.push_back(pose_in_transition(obstacles_, transitions_, k, time));
  constexpr double edges_of_a_search = 4;
  if (scene.self_contact) {
    full_self_thickness_ = scene.self_contact->thickness;
    self_friction_ = scene.self_contact->friction;
  }
  if (long_steps && scene.deformation) rate_.emplace(*scene.deformation, system);
  is_staggered_ = needs_stagger(obstacles_, surface_, system.start);
  set_thickness(time);
  longest_path_ = scene.self_contact || has_mesh(bodies_) ? edges_of_a_search * mean_edge_ : infinity;
}

void ContinuousContact::restore(const std::vector<Pose>& poses, const ObstacleTransitions& transitions,
                                const ThicknessTransition& thickness) {
  assert(poses.size() == starts_.size());
  starts_ = poses, transitions_ = transitions, thickness_transition_ = thickness;
  touches_.clear();
}

/// Cached pairs are dropped where it changes.
void ContinuousContact::set_thickness(double time) {
  const double part = thickness_transition_.is_active() ? thickness_transition_.remaining(time) : 0;
  const double now = full_thickness_ - part * thickness_transition_.missing,
               own_now = full_self_thickness_ - part * thickness_transition_.own_missing;
  if (now == thickness_ && own_now == self_thickness_) return;
  thickness_ = now, self_thickness_ = own_now;
  close_pairs_.forget();
}

/// Whether there are pairs, or may be some beyond the displacement that one search covers. Resets the
/// accumulated impulses.
bool ContinuousContact::find_pairs() {
  const double least = margin_part * std::max(thickness_, self_thickness_);
  swept_.reach = thickness_, swept_.own_reach = self_thickness_;
  copy(position_, team_, swept_.from);
  copy(target_position_, team_, swept_.to);
  swept_.radius.resize(position_.size());
  const double longest = find_distances(position_, target_position_, team_, path_length_);
  for (std::size_t i = 0; i < position_.size(); ++i)
    swept_.radius[i] = radius_scale_[i] * std::max(least, aside_part * path_length_[i]);
  const bool are_whole = longest <= longest_path_;
  for (std::size_t i = 0; !are_whole && i < position_.size(); ++i)
    if (path_length_[i] > longest_path_)
      swept_.to.set(i, position_[i] + longest_path_ / path_length_[i] * (target_position_[i] - position_[i]));
  placed_.update(bodies_, poses_);
  close_pairs_.find({position_, swept_, paths_, poses_, &placed_}, pairs_, separations_, waiting_);
  memory_.clear();
  for (const FeaturePair& pair : pairs_) memory_.push_back(new_state(pair));
  is_separated_ = true;
  return !pairs_.empty() || !are_whole;
}

ContinuousContact::PairState ContinuousContact::new_state(const FeaturePair& pair) const {
  return {pair.obstacle == FeaturePair::cloth_itself ? self_thickness_ : thickness_};
}

/// Puts the pairs that waited among the others, in the order in which all were found: after the cloth has
/// moved they may be contacts.
void ContinuousContact::take_waiting() {
  if (waiting_.empty()) return;
  std::size_t from = pairs_.size();
  pairs_.resize(from + waiting_.size()), memory_.resize(pairs_.size());
  for (std::size_t left = waiting_.size(); left > 0;) {
    const std::size_t to = from + left - 1;
    if (waiting_[left - 1].place == from) {
      pairs_[to] = waiting_[--left].pair, memory_[to] = new_state(pairs_[to]);
    } else {
      --from;
      pairs_[to] = pairs_[from], memory_[to] = memory_[from];
    }
  }
  waiting_.clear();
}

void ContinuousContact::separate_all() {
  take_waiting();
  separations_.resize(pairs_.size());
  placed_.update(bodies_, poses_);
  const PairSetting setting{surface_, position_, bodies_, poses_, &placed_};
  const NearDistances within{near_factor * thickness_, near_factor * self_thickness_};
  const auto separate_share = [&](int, std::size_t begin, std::size_t end) {
    PairBatch(setting).separate(std::span(pairs_).subspan(begin, end - begin), within,
                                separations_.data() + begin);
  };
  in_shares(team_, pairs_.size(), least_pairs, separate_share);
}

double ContinuousContact::friction_of(const FeaturePair& pair) const {
  if (pair.obstacle == FeaturePair::cloth_itself) return self_friction_;
  const ObstacleBody& body = bodies_[at(pair.obstacle)];
  return body.reflects ? 0 : body.friction;
}

/// The constraint at the end of the step, with the plane moved along with the obstacle.
ContactConstraint ContinuousContact::constraint_of(std::size_t k, const ClothSystem& system,
                                                   const Vec3Field& from) const {
  const FeaturePair& pair = pairs_[k];
  const Separation& s = separations_[k];
  ContactConstraint contact;
  contact.count = s.count;
  contact.particle = s.particle;
  contact.weight = s.weight;
  contact.normal = s.normal;
  contact.bound = memory_[k].thickness;
  if (is_staggered_ && (pair.kind == PairKind::vertex_plane || pair.kind == PairKind::vertex_box) &&
      !moves(obstacles_[at(pair.obstacle)]))
    contact.bound = staggered(contact.bound, pair.feature);
  contact.friction = force_work_ ? 0 : friction_of(pair);  // after a long step it acts on velocities alone
  contact.rest = contact.point(from);
  if (pair.obstacle != FeaturePair::cloth_itself) {
    Vec3 point = s.far_point;
    if (!is_still_[at(pair.obstacle)]) {
      const PoseInterpolation& path = paths_[at(pair.obstacle)];
      const Plane at_end = moved_plane(pair.obstacle, {s.far_point, s.normal}, end_poses_);
      const Vec3 local = poses_[at(pair.obstacle)].inverse(s.far_point);
      contact.normal = at_end.normal, point = at_end.point;
      contact.rest += path.to().at(local) - path.from().at(local);
    }
    contact.bound += contact.normal.dot(point);
  }
  contact.mobility = mobility_of(contact, system.inverse_mass);
  contact.normal_impulse = memory_[k].normal_impulse;
  contact.friction_impulse =
      memory_[k].friction_impulse - contact.normal.dot(memory_[k].friction_impulse) * contact.normal;
  return contact;
}

/// By the last of their particles (a counting sort): contacts of all kinds at one place get the first
/// colours, and what a sweep reads lies together. In the order of pairs `fold` takes 7 % longer.
void ContinuousContact::order_by_particles() {
  const auto last_particle = [&](std::size_t pair) {
    const Separation& s = separations_[pair];
    return at(*std::max_element(s.particle.begin(), s.particle.begin() + s.count));
  };
  first_of_particle_.assign(position_.size() + 1, 0);
  for (const std::size_t pair : constraint_pair_) ++first_of_particle_[last_particle(pair) + 1];
  std::partial_sum(first_of_particle_.begin(), first_of_particle_.end(), first_of_particle_.begin());
  ordered_.resize(constraint_pair_.size());
  for (const std::size_t pair : constraint_pair_) ordered_[first_of_particle_[last_particle(pair)]++] = pair;
  constraint_pair_.swap(ordered_);
}

void ContinuousContact::solve_target(const ClothSystem& system, const Vec3Field& from) {
  constraint_pair_.clear();
  copy(free_position_, team_, target_position_);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (!is_contact(separations_[k], memory_[k].thickness)) {
      memory_[k].normal_impulse = 0, memory_[k].friction_impulse.setZero();
      continue;
    }
    constraint_pair_.push_back(k);
  }
  order_by_particles();
  fill_in_shares(team_, constraint_pair_.size(), least_contacts, constraints_,
                 [&](std::size_t c) { return constraint_of(constraint_pair_[c], system, from); });
  for (const ContactConstraint& contact : constraints_)
    apply_impulses(contact, system.inverse_mass, target_position_);
  double last_missing = infinity;
  SolveLimits limits{solver_sweeps, solver_tolerance_part * thickness_, left_out_beyond_part * thickness_};
  for (int all = 0; all < max_solver_sweeps; all += limits.sweeps, limits.sweeps = more_solver_sweeps) {
    const int taken = solver_.solve(constraints_, system.inverse_mass, limits, target_position_);
    if (taken < limits.sweeps) return;
    const double missing = largest_violation();
    if (missing <= missing_part || missing > less_missing * last_missing) return;
    last_missing = missing;
    operation_count_ += static_cast<double>(constraints_.size()) * more_solver_sweeps / solver_sweeps;
  }
}

/// The largest violation of a constraint by the target positions, as a part of the thickness.
double ContinuousContact::largest_violation() const {
  double most = 0;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const ContactConstraint& contact = constraints_[c];
    if (!(contact.mobility > 0)) continue;
    const double missing = contact.bound - contact.normal.dot(contact.point(target_position_));
    most = std::max(most, missing / memory_[constraint_pair_[c]].thickness);
  }
  return most;
}

void ContinuousContact::keep_touches(double step) {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    PairState& memory = memory_[constraint_pair_[c]];
    const ContactConstraint& contact = constraints_[c];
    memory.normal_impulse = contact.normal_impulse, memory.friction_impulse = contact.friction_impulse;
    if (!(contact.normal_impulse > 0)) {
      if (memory.touch >= 0 && !free_contains_contacts_)
        touches_[at(memory.touch)].contact.normal_impulse = 0;
      continue;
    }
    const std::size_t pair = constraint_pair_[c];
    Touch touch{contact, pairs_[pair].obstacle, velocity_of_far_side(pair, step), substep_};
    touch.contact.friction = friction_of(pairs_[pair]);
    if (memory.touch >= 0) {
      touches_[at(memory.touch)] = touch;
    } else {
      memory.touch = static_cast<int>(touches_.size());
      touches_.push_back(touch);
    }
  }
}

/// m/s, of the obstacle at the contact, over `step` seconds.
Vec3 ContinuousContact::velocity_of_far_side(std::size_t pair, double step) const {
  const int obstacle = pairs_[pair].obstacle;
  if (obstacle == FeaturePair::cloth_itself || is_still_[at(obstacle)]) return Vec3::Zero();
  const Vec3 local = poses_[at(obstacle)].inverse(separations_[pair].far_point);
  const PoseInterpolation& path = paths_[at(obstacle)];
  return (path.to().at(local) - path.from().at(local)) / step;
}

int ContinuousContact::count_touched() const {
  std::vector<std::uint8_t> touched(position_.size(), 0);
  for (const Touch& touch : touches_)
    if (touch.contact.normal_impulse > 0) touch.contact.for_each([&](std::size_t i) { touched[i] = 1; });
  return static_cast<int>(std::count(touched.begin(), touched.end(), 1));
}

void ContinuousContact::append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const {
  for (const Touch& touch : touches_) {
    if (!(touch.contact.normal_impulse > 0)) continue;
    ContactMark mark{Vec3::Zero(), touch.contact.normal, touch.contact.normal_impulse};
    for (int k = 0; k < touch.contact.count; ++k)  // the weights of the near side add up to 1
      if (const double weight = touch.contact.weight[at(k)]; weight > 0)
        mark.point += weight * position[at(touch.contact.particle[at(k)])];
    marks.push_back(mark);
  }
}

}  // namespace cloth
