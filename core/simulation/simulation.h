// The loop that owns time: integrate, limit, contact, advance; and the ledger of energy beside it.
//
//     Simulation simulation(scene);                       // a scene without problems and with a time step
//     while (simulation.time() < scene.duration)
//       if (auto divergence = simulation.step()) break;
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "contact/obstacle_contact.h"
#include "contact/obstacle_transition.h"
#include "contact/rigid_motion.h"
#include "forces/force_model.h"
#include "geometry/bounds.h"
#include "integrators/integrator.h"
#include "limiter/step_limiter.h"
#include "limiter/unreachable_rate.h"
#include "measure/energy.h"
#include "measure/strain.h"
#include "simulation/automatic_step.h"
#include "simulation/outcome.h"

namespace cloth {

class ContinuousContact;
class StiffContact;
class WorkerTeam;

/// What entered the cloth since t = 0, in J; the loss left it.
struct EnergyLedger {
  Work forces;
  double limiter = 0;
  double contact = 0;
  double initial = 0;  ///< total energy at t = 0, moved by what edits added
  double entered() const {
    return forces.air + forces.brush + forces.pull + limiter + contact - forces.damping_loss;
  }
};

/// Everything a row of a recording says about the present state.
struct Measurement {
  double time = 0;
  std::int64_t step = 0;
  Energy energy;
  EnergyLedger ledger;
  Strain strain;
  std::int64_t limiter_sweeps = 0;  ///< of the last step
  double limiter_excess = 0;
  int contacts = 0;
  int held_back = 0;              ///< particles that contact kept from getting where they should
  Vec3 contact_impulse{0, 0, 0};  ///< N s, given to the cloth since t = 0; only continuous contact says it
  /// total - total(0) - works + losses: what the method itself added or lost, J
  double energy_error() const { return energy.total() - ledger.initial - ledger.entered(); }
};

/// Which optional quantities the scene's stages give: columns, curves and rows of a form follow it.
struct Quantities {
  bool damping = false, air = false, brush = false, pull = false, limiter = false, contact = false;
  bool structural = false, shear = false;
  bool continuous_contact = false;
  bool operator==(const Quantities&) const = default;
};

/// How strongly the hand holds a particle.
struct PullStrength {
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool operator==(const PullStrength&) const = default;
};

/// Enough to go on from here later, to the bit: what is not a function of the scene in force. Later steps may
/// only cost something else, where a method fills a cache again.
struct Checkpoint {
  ClothState state;
  std::string method;  ///< that `memory` is of
  IntegratorMemory memory;
  EnergyLedger ledger;
  double time_step = 0;   ///< s, in force since `first_step`, which began at `first_time`
  double first_time = 0;  ///< s
  std::int64_t first_step = 0;
  AutomaticStep automatic;
  std::optional<BrushGust> brush;
  std::optional<Pull> pull;
  Quantities quantities;
  StepCount count;
  LimiterReport last_limit;
  ContactReport last_contact;
  std::vector<Pose> obstacle_poses;  ///< of continuous contact
  ObstacleTransitions carries;
  ThicknessTransition thickness_transition;
  double obstacle_speed = 0;      ///< m/s, the highest so far
  double hand_energy = 0;         ///< J, the most that the hand's spring has held so far
  Vec3 contact_impulse{0, 0, 0};  ///< N s, of continuous contact since t = 0
  ContactMemory contact_memory;
  std::vector<double> tension;  ///< N, of the limited springs, as the limiter holds them
  std::optional<RateBreach> rate_breach;

  std::size_t bytes() const;
};

/// Puts a run into a start that no scene file describes: other masses, rest lengths, positions, velocities.
/// Positions beyond the deformation rate are then brought within it, before the first step.
using Preparation = std::function<void(ClothSystem&, ClothState&)>;

class Simulation {
 public:
  /// Precondition: find_problems(scene) is empty and resolved_time_step(scene) has a value.
  explicit Simulation(const Scene& scene, Preparation prepare = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// One step; or, where the new state is not finite or has diverged, why. The state is then the bad one.
  std::optional<Divergence> step();

  /// `steps` steps, or fewer to the first that step() would have stopped at; the motion of step() to the bit.
  /// Where nothing needs the states in between, steps are taken in batches, which some methods do faster.
  /// Fewer also where the stop test interrupted one.
  std::optional<Divergence> advance(std::int64_t steps);

  /// Asked within a step that takes long, where contact is continuous; once it says so the step is not taken:
  /// the state stays the one before it, and interrupted() is true until the next step.
  void set_stop_test(std::function<bool()> test);
  bool interrupted() const { return interrupted_; }

  /// Puts an edited scene in force from the next step on, keeping the state. Precondition: as for the
  /// constructor, and only parameters of EditCost::live differ (and pins). The ledger takes up the jump in
  /// energy.
  void edit(const Scene& scene);

  Checkpoint checkpoint() const;
  /// Goes to a checkpoint of this simulation, or of another one of the same start. The scene in force stays
  /// as it is: to go on to the bit it must be the one that was in force at the checkpoint.
  void restore(const Checkpoint& checkpoint);

  /// Threads that a step may use, 1 without this call: while they are seen to gain, or always. The motion is
  /// the same to the bit.
  void set_threads(int threads, ThreadUse use = ThreadUse::where_they_gain);
  /// How many of them: one where the cloth is too small to share, or the method cannot.
  int threads() const;

  /// The hand, from the next step on.
  void set_brush(const std::optional<BrushGust>& brush);
  void set_pull(const std::optional<Pull>& pull);
  const std::optional<BrushGust>& brush() const { return brush_; }
  const std::optional<Pull>& pull() const { return pull_; }

  /// The strongest hand that the method stands at its step; and no stronger than `most` from now on, so that
  /// one hand can hold several simulations alike.
  const PullStrength& strongest_pull() const { return strongest_pull_; }
  void limit_pull(const std::optional<PullStrength>& most);

  const Scene& scene() const { return scene_; }
  const ClothSystem& system() const { return system_; }
  const ClothState& state() const { return state_; }
  double time() const { return state_.time; }
  double time_step() const { return time_step_; }
  /// The step after which the present time step came in force.
  std::int64_t first_step() const { return first_step_; }
  /// The time then, s.
  double first_time() const { return first_time_; }
  /// Steps of the present length in a record interval, or in what was left of one at first_step().
  std::int64_t steps_to_row() const;
  bool is_within_interval() const { return automatic_.next_change >= 0; }
  /// Where "auto" has shortened the step since t = 0.
  const std::vector<StepChange>& step_changes() const { return automatic_.changes; }
  const Quantities& quantities() const { return quantities_; }
  const StepCount& count() const { return count_; }
  /// Of the last step.
  const LimiterReport& last_limit() const { return last_limit_; }
  /// Where so far the deformation rate was not kept within its tolerance.
  const std::optional<RateBreach>& rate_breach() const { return rate_breach_; }
  const ContactReport& last_contact() const { return last_contact_; }  ///< of the last step
  const std::optional<UnreachableRate>& unreachable_rate() const { return unreachable_; }

  /// Where an obstacle is at a time, in s, with what edits still carry of it.
  Pose obstacle_pose(std::size_t obstacle, double time) const;

  // Contact as one can see it. Nothing of it is computed unless it is asked for.
  /// Appends where the cloth touched something at the end of the last step; nothing after an edit or a
  /// restore(), until there is a next step, where contact is continuous.
  void append_contact_marks(std::vector<ContactMark>& marks) const;
  /// Levels of the hierarchy of boxes around an obstacle's mesh, or with -1 around the cloth; 0: there is
  /// none.
  int hierarchy_depth(int obstacle) const;
  /// Appends its boxes `level` below the root; of a mesh as the scene has it, before any motion.
  void append_hierarchy_boxes(int obstacle, int level, std::vector<Bounds>& boxes);

  /// The cloth as it is now.
  TriangleMesh cloth_mesh() const;

  Measurement measure() const;

  /// The most energy in J that the scene could have put into motion so far. A run whose ledger leaves ten
  /// times as much unexplained has diverged.
  double energy_scale() const;

  /// What a stop here would say of the particle that is not finite or else the fastest.
  Divergence stop_at_fastest(const std::string& cause) const;

 private:
  void assemble();
  std::int64_t advance_batch(std::int64_t count);
  void begin_step_length();
  void watch_step(bool at_once);
  void shorten_step();
  void take_step_of_scene();
  bool is_surely_slow(double speed_squares) const;
  void count_step(const IntegratorReport& report);
  PullStrength find_strongest_pull() const;
  void apply_hand();
  void choose_stepper();
  void share_work();
  void find_unreachable();
  void limit_start();
  void limit_deformation();
  void book_limiter();
  void note_breach(bool by_contact);
  void resolve_contact(const StepTimes& times);
  void book_contact(const StepTimes& times);
  void end_contact();
  ObstacleTransitions find_transitions(const Scene& edited) const;
  void restore_obstacles(const std::vector<Pose>& poses);
  void resolve_continuous_contact(const StepTimes& times);
  void take_back_step();
  double total_energy() const;
  std::optional<Divergence> find_divergence(const IntegratorReport& report);
  Divergence stop_at(int particle, std::string cause) const;
  Divergence stop_at_pinch(const Pinch& pinch) const;
  Divergence stop_at_exhaustion(const Pinch& pinch) const;
  double method_limit() const;
  double steady_energy_scale() const;
  double hand_energy() const;
  double energy_scale_after(double fallen) const;
  bool is_fast(double kinetic) const;
  bool has_run_away() const;

  Scene scene_;
  Preparation prepare_;
  ClothSystem system_;
  ClothState state_;
  std::unique_ptr<WorkerTeam> team_;  ///< none: one thread
  ThreadUse thread_use_ = ThreadUse::where_they_gain;
  std::unique_ptr<ForceModel> forces_;
  std::unique_ptr<Integrator> integrator_;
  bool is_fused_ = false;  ///< `integrator_` is a fused stepper
  std::optional<StepLimiter> limiter_;
  bool limits_drift_ = false;                    ///< the method asks the limiter itself, within the step
  std::optional<ObstacleContact> contact_;       ///< particle by particle
  std::unique_ptr<StiffContact> stiff_contact_;  ///< of that, after methods that take long steps
  std::unique_ptr<ContinuousContact> continuous_contact_;  ///< or without gaps
  Vec3Field position_before_, velocity_before_;            ///< m, m/s, at the step's start, for contact
  ContactMemory contact_memory_;

  std::function<bool()> stop_test_;
  bool interrupted_ = false;

  double time_step_ = 0;
  double first_time_ = 0;  ///< time and step at which the present time step came in force
  std::int64_t first_step_ = 0;
  AutomaticStep automatic_;
  bool watches_step_ = false, watches_ledger_ = false;  ///< by the ledger: every few steps
  EnergyLedger ledger_, ledger_before_;
  Quantities quantities_;
  StepCount count_;
  LimiterReport last_limit_;
  std::vector<double> tension_before_;  ///< N, at the begin of a step that may be taken back
  std::optional<RateBreach> rate_breach_;
  ContactReport last_contact_;
  Vec3 contact_impulse_{0, 0, 0};  ///< N s, of continuous contact since t = 0
  std::optional<UnreachableRate> unreachable_;
  std::optional<BrushGust> brush_;
  std::optional<Pull> pull_;
  PullStrength strongest_pull_, pull_strength_;
  std::optional<PullStrength> most_pull_;
  double elastic_scale_ = 0;                  ///< J, all springs at twice their length
  double total_mass_ = 0, largest_mass_ = 0;  ///< kg
  double obstacle_speed_ = 0;                 ///< m/s, the highest of any point so far
  double hand_energy_ = 0;                    ///< J, the most that the hand's spring has held so far
  ObstacleTransitions carries_;
  ThicknessTransition thickness_transition_;
  bool was_finite_ = false;  ///< every position was finite after the last step
  ClothState before_batch_;  ///< to go back to
};

}  // namespace cloth
