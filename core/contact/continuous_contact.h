// Continuous contact: no vertex, edge or face passes another, at any speed and step (conservative
// advancement). A plane separates the two features of each near pair, and a particle moves toward its target
// only as far as it stays on its side of all its planes. Each side of a plane is convex, so that the features
// cannot pass each other in between. The planes of a moving obstacle move with it. The remaining displacement
// follows in further rounds, with new planes. (Displacements are bounded by distance in Wu et al. 2020 and
// Chen et al. 2025; planes instead of balls do not restrict motion along and away from an obstacle.)
//
// The target positions are solved for in each round: as near as possible to the integrator's positions, in
// the norm of the masses, with every near pair a thickness apart and Coulomb friction against the slip of the
// step. Velocities follow by impulses over the same pairs (velocity_response.cpp).
#pragma once

#include "contact/close_pairs.h"
#include "contact/contact_solver.h"
#include "contact/contact_stage.h"
#include "contact/stiff_target.h"
#include "kernels/shared_job.h"

namespace cloth {

/// Whether the scene uses continuous contact: it has the block `contact` or `self_contact`, a moving obstacle
/// or one whose shape is a surface. Otherwise obstacles are tested particle by particle.
bool has_continuous_contact(const Scene& scene);

/// m/s, upper bound of the speed of any point of an obstacle that can touch the cloth; 0 where all are at
/// rest. `position` (m) bounds the distance from the pivot for planes that rotate in a transition.
double highest_obstacle_speed(const Scene& scene, const ObstacleTransitions& transitions,
                              const Vec3Field& position);

class ContinuousContact : public ContactStage {
 public:
  /// The obstacles' poses are those at `time` (s).
  ContinuousContact(const Scene& scene, const ClothSystem& system, ObstacleTransitions transitions,
                    const ThicknessTransition& thickness, double time, bool long_steps);
  ContinuousContact(const ContinuousContact&) = delete;
  ContinuousContact& operator=(const ContinuousContact&) = delete;

  /// Replaces the integrator's positions by positions that can be reached from the step's initial ones
  /// without crossings, and its velocities accordingly. With a pinch the positions are the last ones without
  /// a crossing.
  ContactReport resolve(const ContactStep& step, ClothState& state) override;
  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const override;
  bool is_continuous() const override { return true; }
  bool solves_rate() const override { return rate_.has_value(); }
  void set_team(WorkerTeam* team, ThreadUse use) override { job_.set_team(team, use); }
  void set_stop_test(const std::function<bool()>& test) override { stop_test_ = test; }
  const std::vector<Pose>& poses() const override { return starts_; }
  void restore(const std::vector<Pose>& poses, const ObstacleTransitions& transitions,
               const ThicknessTransition& thickness) override;
  int hierarchy_depth(int body) const override { return close_pairs_.search().hierarchy_depth(body); }
  void append_boxes(int body, int level, const Vec3Field& position, std::vector<Bounds>& boxes) override {
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

    bool acts() const { return contact.normal_impulse > 0 && contact.mobility > 0; }
    /// The same contact; its impulses are estimates, those that led to the positions in `step` seconds.
    ContactConstraint on_velocities(double step) const;
  };
  enum class RoundsEnd { arrived, pinched, exhausted, interrupted };

  bool is_near(const ContactStep& step, const ClothState& state);
  bool solve_long_step(const ContactStep& step, ClothState& state);
  void take_loads(const ContactStep& step, ClothState& state);
  ContactReport resolve_near(const ContactStep& step, ClothState& state);
  void begin(const StepTimes& times);
  bool note_still();
  void set_thickness(double time);
  bool find_pairs();
  PairState new_state(const FeaturePair& pair) const;
  void take_waiting();
  bool may_come_near() const;
  void begin_substep(std::int64_t substep, const Vec3Field& from, const Vec3Field& integrated);
  RoundsEnd go_rounds(const ClothSystem& system, const Vec3Field& from, double step, ContactReport& report);
  /// Keeps of each particle only the contacts of the last substep in which it had an impulse.
  void drop_superseded_touches(const Vec3Field& from, double step);
  void separate_all();
  void order_by_particles();
  void solve_target(const ClothSystem& system, const Vec3Field& from);
  Vec3 velocity_of_far_side(std::size_t pair, double step) const;
  double friction_of(const FeaturePair& pair) const;
  ContactConstraint constraint_of(std::size_t pair, const ClothSystem& system, const Vec3Field& from) const;
  double largest_violation() const;
  void keep_touches(double step);
  double move_cloth();
  void bound_by_planes();
  struct Approach {
    double room = 0;                ///< m, that the pair may take from its gap
    double near = 0, far = 0;       ///< m, furthest of its sides towards the other
    std::array<double, 4> ahead{};  ///< m, of its particles along the normal
    double of_both() const { return near + far; }
  };
  Approach approach_within(std::size_t pair) const;
  void bound_by_plane(std::size_t pair);
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

  void apply_all_impulses(const ClothSystem& system, Vec3Field& velocity) const;
  void solve_constraints(const ClothSystem& system, int sweeps, Vec3Field& velocity);
  bool find_motion(const ContactStep& step);
  void take_touches(const ContactStep& step);
  double approach_of(const Touch& touch, const ContactStep& step) const;
  void solve_velocities(const ContactStep& step, ClothState& state, ContactReport& report);
  Vec3 total_impulse(const ClothSystem& system) const;
  void find_work(const ContactStep& step, const ClothState& state);
  std::vector<double> impact_parts(const ContactStep& step, const ClothState& state) const;
  double recovering_work(const ContactStep& step) const;
  void find_changed(const ContactMemory& memory);
  template <class Visit>
  void visit_changed(const Visit& visit) const;
  void find_start_change(const ContactStep& step);
  void add_half_steps_work(const ContactStep& step, const ClothState& state);
  double deferred_by_load(const ClothSystem& system, std::size_t particle, const Vec3& stopped) const;
  void bounce(const ContactStep& step, bool follows, ClothState& state);
  void remember(const ClothSystem& system, const ClothState& state, bool follows, ContactMemory& memory);
  /// Limits the speed of particles that did not reach their target position to their actual displacement in
  /// the step, and returns their number.
  int limit_held_back(const ContactStep& step, ClothState& state);

  Surface surface_;
  std::vector<ObstacleBody> bodies_;
  std::vector<Obstacle> obstacles_;
  ObstacleTransitions transitions_;
  ClosePairs close_pairs_;
  PlacedBodies placed_;
  SharedJob job_;               ///< a step near obstacles or itself
  WorkerTeam* team_ = nullptr;  ///< of this step
  std::function<bool()> stop_test_;
  bool long_steps_ = false;  ///< contact and springs have to be solved together
  StiffTarget stiff_target_;
  std::optional<RateTensions> rate_;  ///< with long_steps_
  double rate_work_ = 0;              ///< J, of the present step, solved by StiffTarget
  double mean_edge_ = 0;              ///< m, of the cloth at its start
  bool is_staggered_ = false;         ///< see stagger.h
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
  double operation_count_ =
      0;  ///< cost of all rounds so far: pairs and particles of each, and the solver's extra sweeps
  bool has_moved_ = false;
  Vec3Field substep_from_;
  // of the substep in progress
  std::vector<PoseInterpolation> paths_;
  std::vector<std::uint8_t> is_still_;  ///< of each obstacle, on its path
  std::vector<Pose> poses_, next_poses_, end_poses_;
  double part_ = 0;                ///< of the obstacles' paths that they have completed
  Vec3Field free_position_;        ///< m, target without contact in this round
  Vec3Field target_position_;      ///< m, target with contact
  Vec3Field position_;             ///< m, reached so far
  Vec3Field round_from_;           ///< m, position_ as the round began, while obstacles move
  Vec3Field integrated_position_;  ///< m, where the integrator put the particles, or those of StiffTarget
  Vec3Field approach_position_;    ///< m, where the integrator put the particles, with force_work_
  std::vector<double> fraction_;
  std::vector<std::uint8_t> is_bound_;  ///< of each pair, by its plane
  std::vector<double>
      radius_scale_;  ///< of each capsule, larger each time that the capsule stopped its particle
  std::vector<double> path_length_;  ///< m, of each particle's way to its target
  SweptBounds swept_;                ///< particles stay in these until the next search for pairs
  std::vector<FeaturePair> pairs_;
  std::vector<WaitingPair> waiting_;
  std::vector<PairState> memory_;
  std::vector<Separation> separations_;
  std::vector<ContactConstraint> constraints_;
  ContactSolver solver_;
  std::vector<std::size_t> constraint_pair_;
  std::vector<std::size_t> first_of_particle_, ordered_;  ///< scratch
  std::vector<Touch> touches_;
  std::optional<Work> force_work_;            ///< of a step solved by StiffTarget, see ContactReport
  std::vector<Touch> loaded_;                 ///< contacts of StiffTarget, with impulses of their loads
  std::optional<std::size_t> blocking_pair_;  ///< stopped an obstacle in this round
  bool reached_bounds_ = false;               ///< a capsule stopped its particle in this round
  bool is_separated_ = false;                 ///< the separations are those of the present positions
  bool free_contains_contacts_ = false;       ///< free_position_ contains contacts of earlier rounds

  // of the velocity solve
  Vec3Field motion_;                      ///< m/s, mean of the step, without the recovery of too near pairs
  std::vector<std::size_t> changed_;      ///< see find_changed()
  std::vector<std::uint8_t> is_changed_;  ///< scratch
  Vec3Field start_change_;                ///< m/s, of these, by contact at the beginning of the step
  Vec3Field free_velocity_;               ///< m/s, before the velocity solve
  std::vector<double> bounce_bound_;      ///< m/s, of each constraint, with restitution
  std::vector<double> work_;              ///< J, of each particle, 0 but of those in changed_
  std::vector<std::uint8_t> bounced_;     ///< of each particle
  std::vector<double> deferred_of_bounced_;  ///< J, of each particle
};

}  // namespace cloth
