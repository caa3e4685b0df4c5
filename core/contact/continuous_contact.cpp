#include "contact/continuous_contact.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cloth/mesh_cloth.h"
#include "contact/at.h"
#include "contact/obstacle_substeps.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Of the thickness, and of the way if that is more: how far a particle may leave the straight line to where
/// it is wished without a new search.
constexpr double margin_part = 0.1, aside_part = 0.1;
constexpr std::size_t least_separated = 500;  ///< pairs that are worth a thread of their own
constexpr double skin_part = 0.25;  ///< of a mean edge: how far overlaps that were found serve again
constexpr double solver_tolerance_part = 1e-5;
constexpr int solver_sweeps = 20;
/// In stacks of layers that is too few: on it goes while a pair misses more than this part of its thickness,
/// and that becomes less, up to so many.
constexpr double missing_part = 0.03, less_missing = 0.9;
constexpr int more_solver_sweeps = 100, most_solver_sweeps = 1000;
constexpr int most_rounds_at_rest = 100, most_rounds_stuck = 15;
/// Rounds without a shorter way left, after which the few that are still on their way are held back.
constexpr int most_rounds_idle = 6;
constexpr double progress_part = 0.7;
constexpr double stagger_part = 0.005;  ///< of the thickness

/// Pairs and particles that the rounds of one step may look at, for a cloth of so many particles: some
/// seconds of work. Counted, so that a run does not depend on the machine.
double most_work_of(std::size_t particles) {
  constexpr double least = 1e7, for_a_particle = 2e3;
  return least + for_a_particle * static_cast<double>(particles);
}

bool all_finite(const Vec3Field& field) {
  const auto values = field.flat();
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::vector<ObstacleBody> bodies_of(const Scene& scene) {
  std::vector<ObstacleBody> bodies;
  for (const Obstacle& obstacle : scene.obstacles) bodies.push_back(body_of(obstacle));
  return bodies;
}

/// m, of the furthest point that can touch the cloth from the pivot.
double reach_of(const Obstacle& obstacle, const Vec3Field& position) {
  if (obstacle.shape != Shape::plane) return body_of(obstacle).reach;
  double reach = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    reach = std::max(reach, (position[i] - obstacle.point).norm());
  return reach;
}

/// Whether a cloth has started in one plane, but for rounding.
bool is_flat(const Surface& surface, const Vec3Field& position) {
  Vec3 normal = Vec3::Zero();
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 other = (position[at(b)] - position[at(a)]).cross(position[at(c)] - position[at(a)]);
    if (other.squaredNorm() > normal.squaredNorm()) normal = other;
  }
  constexpr double rounding = 1e-6;
  double extent = 0, height = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 from = position[i] - position[0];
    extent = std::max(extent, from.norm());
    height = std::max(height, std::abs(normal.normalized().dot(from)));
  }
  return height <= rounding * extent;
}

/// Whether a cloth could lie on one obstacle and be squeezed by others.
bool can_be_compressed(const std::vector<Obstacle>& obstacles) {
  const auto is_floor = [](const Obstacle& o) {
    return !moves(o) && (o.shape == Shape::plane || o.shape == Shape::box);
  };
  const auto is_press = [](const Obstacle& o) { return moves(o) && o.shape != Shape::sphere; };
  return std::any_of(obstacles.begin(), obstacles.end(), is_floor) &&
         std::any_of(obstacles.begin(), obstacles.end(), is_press);
}

/// In [0, 1), evenly spread over the particles (Knuth's multiplicative hash).
double stagger_of(int particle) {
  return static_cast<double>(static_cast<std::uint32_t>(particle) * 2654435761u) * 0x1p-32;
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
                     [](const Obstacle& o) { return o.shape == Shape::mesh || moves(o); });
}

double highest_obstacle_speed(const Scene& scene, const ObstacleTransitions& transitions,
                              const Vec3Field& position) {
  double carried = 0, highest = 0;
  for (std::size_t k = 0; k < transitions.size(); ++k)
    if (transitions[k].is_active())
      carried = std::max(
          carried,
          transitions[k].speed(transitions[k].reshapes() ? reach_of(scene.obstacles[k], position) : 0));
  for (const Obstacle& obstacle : scene.obstacles)
    if (moves(obstacle)) highest = std::max(highest, highest_speed(obstacle, body_of(obstacle).reach));
  return highest + carried;
}

ContinuousContact::ContinuousContact(const Scene& scene, const ClothSystem& system,
                                     ObstacleTransitions transitions, const ThicknessTransition& thickness,
                                     double time)
    : surface_(make_surface(system.size(), triangles_of(system))),
      bodies_(bodies_of(scene)),
      obstacles_(scene.obstacles),
      transitions_(std::move(transitions)),
      close_pairs_(surface_, bodies_, scene.self_contact.has_value(),
                   skin_part * mean_edge(surface_, system.start)),
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
  const bool has_mesh = std::any_of(obstacles_.begin(), obstacles_.end(),
                                    [](const Obstacle& o) { return o.shape == Shape::mesh; });
  is_staggered_ = can_be_compressed(obstacles_) && is_flat(surface_, system.start);
  set_thickness(time);
  longest_path_ = scene.self_contact || has_mesh ? edges_of_a_search * mean_edge_ : infinity;
}

void ContinuousContact::set_poses(const std::vector<Pose>& poses) {
  assert(poses.size() == starts_.size());
  starts_ = poses;
}

/// Pairs that were found for others do not serve.
void ContinuousContact::set_thickness(double time) {
  const double left = thickness_transition_.is_active() ? thickness_transition_.left(time) : 0;
  const double now = full_thickness_ - left * thickness_transition_.missing,
               own_now = full_self_thickness_ - left * thickness_transition_.own_missing;
  if (now == thickness_ && own_now == self_thickness_) return;
  thickness_ = now, self_thickness_ = own_now;
  close_pairs_.forget();
}

void ContinuousContact::begin(const ContactTimes& times) {
  set_thickness(times.end);
  starts_before_ = starts_;
  paths_.clear();
  bool all_rest = true;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    poses_[k] = starts_[k];
    end_poses_[k] = pose_in_transition(obstacles_, transitions_, k, times.end);
    const Obstacle& obstacle = obstacles_[k];
    const Vec3 spun = obstacle.keyframes.empty() ? Vec3(times.step * obstacle.spin) : Vec3(Vec3::Zero());
    paths_.emplace_back(bodies_[k].pivot, poses_[k], end_poses_[k], spun);
    all_rest = all_rest && paths_[k].rests();
  }
  starts_ = end_poses_;
  part_ = all_rest ? 1 : 0;
  was_rebased_ = false;
  radius_scale_.assign(position_.size(), 1.0);
  touches_.clear();
  substep_ = 0, work_count_ = 0, has_moved_ = false;
  substeps_ = substeps_for(bodies_, paths_, mean_edge_);
  if (substeps_ > 1) whole_paths_ = paths_;
}

/// All that can meet in a step of several substeps, roughly.
bool ContinuousContact::may_come_near() const {
  if (full_self_thickness_ > 0) return true;
  Bounds cloth;
  for (std::size_t i = 0; i < position_.size(); ++i)
    cloth.add(bounds_of(Vec3(position_[i]), Vec3(target_position_[i])));
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (comes_near(bodies_[k], whole_paths_[k], cloth, thickness_)) return true;
  return false;
}

/// Particles go an even share of the way that the integrator has led them, from where the last substep has
/// put them.
void ContinuousContact::begin_substep(std::int64_t substep, const Vec3Field& from,
                                      const Vec3Field& integrated) {
  substep_ = substep;
  const double share = 1 / static_cast<double>(substeps_);
  if (substep == 0) target_position_ = from;
  for (std::size_t i = 0; i < position_.size(); ++i)
    target_position_.add(i, share * (integrated[i] - from[i]));
  free_position_ = target_position_;
  was_rebased_ = was_rebased_ || substep > 0;
  substep_from_ = position_;
  radius_scale_.assign(position_.size(), 1.0);
  bool all_rest = true;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    end_poses_[k] =
        whole_paths_[k].at(substep + 1 == substeps_ ? 1 : share * static_cast<double>(substep + 1));
    paths_[k] = PoseInterpolation(bodies_[k].pivot, poses_[k], end_poses_[k]);
    all_rest = all_rest && paths_[k].rests();
  }
  part_ = all_rest ? 1 : 0;
  find_pairs();
}

/// Whether there are any, or may be some further on a way than one search goes. Forgets what was pushed in
/// earlier rounds.
bool ContinuousContact::find_pairs() {
  const double least = margin_part * std::max(thickness_, self_thickness_);
  swept_.reach = thickness_, swept_.own_reach = self_thickness_;
  swept_.particles.resize(position_.size());
  bool are_whole = true;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const Vec3 here = position_[i];
    const Vec3 way = target_position_[i] - here;
    const double length = way.norm();
    are_whole = are_whole && length <= longest_path_;
    const Vec3 end = length > longest_path_ ? Vec3(here + longest_path_ / length * way) : target_position_[i];
    swept_.particles[i] = {here, end, radius_scale_[i] * std::max(least, aside_part * length)};
  }
  close_pairs_.find({position_, swept_, paths_, poses_}, pairs_, separations_);
  memory_.assign(pairs_.size(), {});
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    memory_[k].thickness = pairs_[k].obstacle == FeaturePair::cloth_itself ? self_thickness_ : thickness_;
  is_separated_ = true;
  return !pairs_.empty() || !are_whole;
}

void ContinuousContact::separate_all() {
  separations_.resize(pairs_.size());
  const auto separate_share = [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      separations_[k] =
          separate(pairs_[k], surface_, position_, bodies_, poses_, near_factor * memory_[k].thickness);
  };
  in_shares(team_, pairs_.size(), least_separated, separate_share);
}

/// The pair at the end of the step: its plane is carried along by the obstacle.
///
/// A cloth that lies exactly flat never buckles, however it is squeezed: no force leads out of its plane. So
/// an obstacle at rest keeps its particles up to half a hundredth of the thickness further away, each by a
/// part of its own, where such a cloth can be squeezed.
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
    contact.bound *= 1 + stagger_part * stagger_of(pair.feature);
  contact.friction = self_friction_;
  contact.rest = contact.point(from);
  if (pair.obstacle != FeaturePair::cloth_itself) {
    const PoseInterpolation& path = paths_[at(pair.obstacle)];
    const Plane at_end = moved_plane(pair.obstacle, {s.far_point, s.normal}, end_poses_);
    const Vec3 local = poses_[at(pair.obstacle)].back(s.far_point);
    contact.normal = at_end.normal;
    contact.bound += contact.normal.dot(at_end.point);
    contact.rest += path.to().at(local) - path.from().at(local);
    const ObstacleBody& body = bodies_[at(pair.obstacle)];
    contact.friction = body.reflects ? 0 : body.friction;
  }
  contact.mobility = mobility_of(contact, system.inverse_mass);
  contact.normal_impulse = memory_[k].normal_impulse;
  contact.friction_impulse =
      memory_[k].friction_impulse - contact.normal.dot(memory_[k].friction_impulse) * contact.normal;
  return contact;
}

void ContinuousContact::solve_target(const ClothSystem& system, const Vec3Field& from) {
  constraints_.clear();
  constraint_pair_.clear();
  target_position_ = free_position_;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Separation& s = separations_[k];
    const bool holds = s.nearest && s.distance < near_factor * memory_[k].thickness && !s.normal.isZero(0);
    if (!holds) {
      memory_[k].normal_impulse = 0, memory_[k].friction_impulse.setZero();
      continue;
    }
    constraints_.push_back(constraint_of(k, system, from));
    constraint_pair_.push_back(k);
    apply_impulses(constraints_.back(), system.inverse_mass, target_position_);
  }
  double last_missing = infinity;
  int sweeps = solver_sweeps;
  for (int all = 0; all < most_solver_sweeps; all += sweeps, sweeps = more_solver_sweeps) {
    const int taken = solve_contacts(constraints_, system.inverse_mass, sweeps,
                                     solver_tolerance_part * thickness_, target_position_);
    if (taken < sweeps) return;
    const double missing = most_missing();
    if (missing <= missing_part || missing > less_missing * last_missing) return;
    last_missing = missing;
    work_count_ += static_cast<double>(constraints_.size()) * more_solver_sweeps / solver_sweeps;
  }
}

/// Of its thickness, by what is wished, of any pair that can move.
double ContinuousContact::most_missing() const {
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
      if (memory.touch >= 0 && !was_rebased_) touches_[at(memory.touch)].contact.normal_impulse = 0;
      continue;
    }
    if (memory.touch < 0) {
      memory.touch = static_cast<int>(touches_.size());
      touches_.emplace_back();
    }
    Touch& touch = touches_[at(memory.touch)];
    touch.contact = contact;
    touch.substep = substep_;
    touch.obstacle = pairs_[constraint_pair_[c]].obstacle;
    touch.velocity.setZero();
    if (touch.obstacle == FeaturePair::cloth_itself) continue;
    const Vec3 local = poses_[at(touch.obstacle)].back(separations_[constraint_pair_[c]].far_point);
    const PoseInterpolation& path = paths_[at(touch.obstacle)];
    touch.velocity = (path.to().at(local) - path.from().at(local)) / step;
  }
}

/// What is not finite is left as it is: the run stops there.
bool ContinuousContact::is_near(const Vec3Field& from, const ContactTimes& times, const ClothState& state) {
  if (!all_finite(state.position) || !all_finite(state.velocity)) return false;
  free_position_ = target_position_ = state.position;
  position_ = from;
  begin(times);
  return substeps_ == 1 ? find_pairs() : may_come_near();
}

ContactReport ContinuousContact::apply(const ClothSystem& system, const Vec3Field& from,
                                       const ContactTimes& times, ClothState& state,
                                       const VelocityCoupling& coupling) {
  ContactReport report;
  RoundsEnd end = RoundsEnd::arrived;
  if (substeps_ == 1) end = go_rounds(system, from, times.step, report);
  const double substep_time = times.step / static_cast<double>(substeps_);
  for (std::int64_t k = 0; substeps_ > 1 && k < substeps_ && end == RoundsEnd::arrived; ++k) {
    begin_substep(k, from, state.position);
    end = go_rounds(system, substep_from_, substep_time, report);
  }
  if (end == RoundsEnd::interrupted) {
    starts_ = starts_before_;
    report.interrupted = true;
    return report;
  }
  if (end != RoundsEnd::arrived) report.pinch = pinch(system);
  report.exhausted = end == RoundsEnd::exhausted;
  if (substeps_ > 1) forget_overtaken_touches(from, times.step);
  if (!has_moved_ && touches_.empty()) return report;
  report.acted = true;
  report.pairs = pairs_.size();
  report.contacts = count_touched();
  integrated_position_ = state.position;
  state.position = position_;
  solve_velocities(system, {from, times.step}, coupling, state, report);
  return report;
}

/// Leads cloth and obstacles to the end of a substep, `step` seconds long, that has begun at `from`.
ContinuousContact::RoundsEnd ContinuousContact::go_rounds(const ClothSystem& system, const Vec3Field& from,
                                                          double step, ContactReport& report) {
  int stuck = 0, rounds_at_rest = 0, idle = 0;
  double least_left = infinity;
  const double arrived = arrived_length();
  while (true) {
    if (stop_test_ && stop_test_()) return RoundsEnd::interrupted;
    ++report.rounds;
    work_count_ += static_cast<double>(pairs_.size() + position_.size());
    if (!is_separated_) separate_all();
    is_separated_ = false;
    solve_target(system, from);
    keep_touches(step);
    const Vec3Field before = position_;
    const double left = move_cloth();
    has_moved_ = has_moved_ || left > 0;
    const bool is_exhausted = work_count_ > most_work_of(position_.size());
    if (part_ < 1) {
      const double advance = advance_obstacles();
      if (part_ < 1) free_position_ = target_position_, was_rebased_ = true;
      stuck = advance > 0 || furthest_move(before) > arrived ? 0 : stuck + 1;
      if (stuck > most_rounds_stuck) return RoundsEnd::pinched;
      if (part_ < 1 && is_exhausted) return RoundsEnd::exhausted;
    }
    if (part_ == 1) {
      if (left <= arrived || ++rounds_at_rest > most_rounds_at_rest || is_exhausted) break;
      idle = left < progress_part * least_left ? 0 : idle + 1;
      least_left = std::min(least_left, left);
      if (idle > most_rounds_idle) break;
    }
    if (reached_bounds_) find_pairs();
  }
  const bool is_last = substeps_ == 1 || substep_ + 1 == substeps_;
  return work_count_ > most_work_of(position_.size()) && !is_last ? RoundsEnd::exhausted : RoundsEnd::arrived;
}

/// Of several substeps: a particle's velocity follows from the last in which something pushed it, with what
/// touched it as fast as then.
void ContinuousContact::forget_overtaken_touches(const Vec3Field& from, double step) {
  std::vector<std::int64_t> last(position_.size(), -1);
  const auto any_of = [](const ContactConstraint& contact, const auto& test) {
    for (int k = 0; k < contact.count; ++k)
      if (contact.weight[at(k)] != 0 && test(at(contact.particle[at(k)]))) return true;
    return false;
  };
  for (const Touch& touch : touches_)
    any_of(touch.contact, [&](std::size_t i) {
      if (touch.contact.normal_impulse > 0) last[i] = std::max(last[i], touch.substep);
      return false;
    });
  std::erase_if(touches_, [&](const Touch& touch) {
    return !any_of(touch.contact, [&](std::size_t i) { return last[i] == touch.substep; });
  });
  for (Touch& touch : touches_) touch.contact.rest = touch.contact.point(from) + step * touch.velocity;
}

double ContinuousContact::furthest_move(const Vec3Field& before) const {
  double furthest = 0;
  for (std::size_t i = 0; i < position_.size(); ++i)
    furthest = std::max(furthest, (position_[i] - before[i]).norm());
  return furthest;
}

int ContinuousContact::count_touched() const {
  std::vector<std::uint8_t> touched(position_.size(), 0);
  for (const Touch& touch : touches_)
    for (int k = 0; k < touch.contact.count; ++k)
      if (touch.contact.normal_impulse > 0 && touch.contact.weight[at(k)] != 0)
        touched[at(touch.contact.particle[at(k)])] = 1;
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
