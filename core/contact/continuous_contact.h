// Continuous contact: no vertex, edge or face passes another, at any speed and step (conservative
// advancement). A plane separates the two features of each near pair, and a particle moves toward its target
// only as far as it stays on its side of all its planes. Each side of a plane is convex, so that the features
// cannot pass each other on the way. Moving obstacles move their planes with them. The remaining displacement
// follows in further rounds, with new planes. (Displacements are bounded by distance in Wu et al. 2020 and
// Chen et al. 2025; planes instead of balls do not restrict motion along and away from an obstacle.)
//
// The target positions are solved for in each round: as near as possible to the integrator's positions, in
// the norm of the masses, with every near pair a thickness apart and Coulomb friction against the slip of the
// step. Velocities follow by impulses over the same pairs (velocity_response.cpp).
#pragma once

#include <functional>

#include "cloth/cloth_system.h"
#include "contact/close_pairs.h"
#include "contact/contact_mark.h"
#include "contact/contact_memory.h"
#include "contact/contact_report.h"
#include "contact/contact_solver.h"
#include "contact/obstacle_transition.h"

namespace cloth {

/// Whether the scene uses continuous contact; otherwise obstacles are tested particle by particle.
bool has_continuous_contact(const Scene& scene);

/// m/s, highest speed of any point of an obstacle that can touch the cloth; 0 where all are at rest. For a
/// plane that an edit has turned, the relevant distance from its pivot follows from the positions.
double highest_obstacle_speed(const Scene& scene, const ObstacleTransitions& transitions,
                              const Vec3Field& position);

/// Beginning, end and length of a step, in s.
struct ContactTimes {
  double begin = 0, end = 0, step = 0;
};

/// What the velocity solve needs from the caller. The functions are empty for methods whose velocities do not
/// follow from the corrected positions.
struct VelocityCoupling {
  const Vec3Field& velocity_before;                            ///< m/s, at the beginning of the step
  ContactMemory& memory;                                       ///< in: of the last step; out: of this one
  std::function<double(const Vec3Field& position)> potential;  ///< J, elastic and gravity
  /// Called once the corrected positions are in the state, before the velocity solve; `motion`, in m/s, is
  /// the displacement over the step.
  std::function<void(const Vec3Field& motion)> positions;
  std::function<void(const Vec3Field& motion)>
      velocities;  ///< called after the velocity solve, which is then repeated
};

class ContinuousContact {
 public:
  /// Obstacles have their poses of `time`, in s.
  ContinuousContact(const Scene& scene, const ClothSystem& system, ObstacleTransitions transitions,
                    const ThicknessTransition& thickness, double time);
  ContinuousContact(const ContinuousContact&) = delete;
  ContinuousContact& operator=(const ContinuousContact&) = delete;

  /// Of the obstacles at the beginning of the next step.
  const std::vector<Pose>& poses() const { return starts_; }
  void set_poses(const std::vector<Pose>& poses);  ///< one of each obstacle

  /// Whether anything is near enough in this step for `apply` to have work. Call it before `apply`.
  bool is_near(const Vec3Field& from, const ContactTimes& times, const ClothState& state);

  /// Replaces the integrator's positions in `state` by positions that can be reached from `from` without
  /// crossings, and its velocities accordingly. Where a pinch is reported the positions are the last ones
  /// without a crossing.
  ContactReport apply(const ClothSystem& system, const Vec3Field& from, const ContactTimes& times,
                      ClothState& state, const VelocityCoupling& coupling);

  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team) { team_ = team, close_pairs_.set_team(team); }

  /// Called in every round; when it returns true the step is abandoned.
  void set_stop_test(std::function<bool()> test) { stop_test_ = std::move(test); }

  /// From the next step on.
  void set_transitions(ObstacleTransitions transitions, const ThicknessTransition& thickness) {
    transitions_ = std::move(transitions), thickness_transition_ = thickness;
  }

  /// Appends the contacts of the last step; `position` is its result.
  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const;
  /// The state is not the one that was computed last: there are no contacts to report.
  void forget_touches() { touches_.clear(); }

  /// See PairSearch.
  int hierarchy_depth(int body) const { return close_pairs_.search().hierarchy_depth(body); }
  void append_boxes(int body, int level, const Vec3Field& position, std::vector<Bounds>& boxes) {
    close_pairs_.search().append_boxes(body, level, position, 0.5 * self_thickness_, boxes);
  }

 private:
  struct PairState {
    double thickness = 0;            ///< m, distance to keep
    double normal_impulse = 0;       ///< kg m, of the last round
    Vec3 friction_impulse{0, 0, 0};  ///< kg m
    int touch = -1;                  ///< in touches_
  };
  struct Plane {
    Vec3 point, normal;
  };
  struct Touch {
    ContactConstraint contact;
    int obstacle = FeaturePair::cloth_itself;
    Vec3 velocity{0, 0, 0};    ///< m/s, of the obstacle at the contact
    std::int64_t substep = 0;  ///< in which its impulse was last above 0
  };
  enum class RoundsEnd { arrived, pinched, exhausted, interrupted };

  void begin(const ContactTimes& times);
  void set_thickness(double time);
  bool find_pairs();
  bool may_come_near() const;
  void begin_substep(std::int64_t substep, const Vec3Field& from, const Vec3Field& integrated);
  RoundsEnd go_rounds(const ClothSystem& system, const Vec3Field& from, double step, ContactReport& report);
  void forget_overtaken_touches(const Vec3Field& from, double step);
  void separate_all();
  void solve_target(const ClothSystem& system, const Vec3Field& from);
  ContactConstraint constraint_of(std::size_t pair, const ClothSystem& system, const Vec3Field& from) const;
  double most_missing() const;
  void keep_touches(double step);
  double move_cloth();
  void bound_by_planes();
  void bound_by_swept_volumes();
  double advance_obstacles();
  double turn_limit(std::size_t obstacle) const;
  double shrink_to_planes();
  double reached_gap(const Separation& separation) const;
  double furthest_move(const Vec3Field& before) const;
  double reach_along(const Vec3& normal, const FeaturePair& pair, const Pose& pose) const;
  Plane moved_plane(int obstacle, const Plane& plane, const std::vector<Pose>& to) const;
  std::optional<std::size_t> blocking_pair() const;
  Pinch pinch(const ClothSystem& system) const;
  int count_touched() const;
  /// m: a remaining displacement below this counts as none.
  double arrived_length() const { return 1e-3 * thickness_; }

  struct Begin {
    const Vec3Field& position;  ///< m, as the step began
    double step = 0;            ///< s
  };
  bool find_motion(const ClothSystem& system, const Begin& begin);
  void take_touches(const Begin& begin, const VelocityCoupling& coupling);
  double approach_of(const Touch& touch, const Begin& begin, const VelocityCoupling& coupling) const;
  void solve_velocities(const ClothSystem& system, const Begin& begin, const VelocityCoupling& coupling,
                        ClothState& state, ContactReport& report);
  Vec3 total_impulse(const ClothSystem& system) const;
  void find_work(const ClothSystem& system, const VelocityCoupling& coupling, const ClothState& state);
  double recovering_work(const Begin& begin, const VelocityCoupling& coupling) const;
  Vec3 start_change_of(std::size_t particle, const Begin& begin) const;
  void add_half_steps_work(const ClothSystem& system, const Begin& begin, const VelocityCoupling& coupling,
                           const ClothState& state);
  double deferred_by_load(const ClothSystem& system, std::size_t particle, const Vec3& stopped) const;
  void bounce(const ClothSystem& system, const Begin& begin, bool follows, ClothState& state);
  void remember(const ClothSystem& system, const ClothState& state, bool follows, ContactMemory& memory);
  int note_held_back(const ClothSystem& system, const Begin& begin, ClothState& state);

  Surface surface_;
  std::vector<ObstacleBody> bodies_;
  std::vector<Obstacle> obstacles_;
  ObstacleTransitions transitions_;
  ClosePairs close_pairs_;
  WorkerTeam* team_ = nullptr;
  std::function<bool()> stop_test_;
  double mean_edge_ = 0;       ///< m, of the cloth at its start
  bool is_staggered_ = false;  ///< see stagger.h
  ThicknessTransition thickness_transition_;
  double full_thickness_ = 0, full_self_thickness_ = 0, self_friction_ = 0;  ///< m, m; of the scene
  double thickness_ = 0, self_thickness_ = 0;                                ///< m, in this step
  double gravity_ = 0;                                                       ///< m/s^2
  double longest_path_ = 0;  ///< m, displacement that one search for pairs covers

  std::vector<Pose> starts_;  ///< of the next step

  // of the step in progress
  std::vector<PoseInterpolation> whole_paths_;
  std::vector<Pose> starts_before_;
  std::int64_t substeps_ = 1, substep_ = 0;
  double work_count_ = 0;  ///< pairs and particles, of all rounds so far
  bool has_moved_ = false;
  Vec3Field substep_from_;
  // of the substep in progress
  std::vector<PoseInterpolation> paths_;
  std::vector<Pose> poses_, next_poses_, end_poses_;
  double part_ = 0;                ///< of the obstacles' paths that they have completed
  Vec3Field free_position_;        ///< m, target without contact in this round
  Vec3Field target_position_;      ///< m, target with contact
  Vec3Field position_;             ///< m, reached so far
  Vec3Field integrated_position_;  ///< m, where the integrator put the particles
  std::vector<double> fraction_;
  std::vector<double>
      radius_scale_;   ///< of each capsule, larger each time that the capsule stopped its particle
  SweptBounds swept_;  ///< particles stay in these until the next search for pairs
  std::vector<FeaturePair> pairs_;
  std::vector<PairState> memory_;
  std::vector<Separation> separations_;
  std::vector<ContactConstraint> constraints_;
  std::vector<std::size_t> constraint_pair_;
  std::vector<Touch> touches_;
  std::optional<std::size_t> blocking_pair_;  ///< stopped an obstacle in this round
  bool reached_bounds_ = false;               ///< a capsule stopped its particle in this round
  bool is_separated_ = false;                 ///< the separations are those of the present positions
  bool was_rebased_ = false;                  ///< free_position_ contains contacts of earlier rounds

  // of the velocity solve
  Vec3Field motion_;                   ///< m/s, mean of the step, without the recovery of too near pairs
  Vec3Field free_velocity_;            ///< m/s, before the velocity solve
  std::vector<double> bounce_bound_;   ///< m/s, of each constraint, with restitution
  std::vector<double> work_;           ///< J, of each particle
  std::vector<std::uint8_t> bounced_;  ///< of each particle
  std::vector<double> deferred_of_bounced_;  ///< J, of each particle
};

}  // namespace cloth
