// The loop that owns time: integrate, limit, contact, advance; and the ledger of energy beside it.
//
//     Simulation simulation(scene);                       // a scene without problems and with a time step
//     while (simulation.time() < scene.duration)
//       if (auto divergence = simulation.step()) break;
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "contact/contact_stage.h"
#include "forces/force_model.h"
#include "geometry/bounds.h"
#include "integrators/integrator.h"
#include "limiter/step_limiter.h"
#include "limiter/unreachable_rate.h"
#include "measure/energy.h"
#include "measure/strain.h"
#include "simulation/run_state.h"

namespace cloth {

class WorkerTeam;

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
  const std::optional<BrushGust>& brush() const { return run_.brush; }
  const std::optional<Pull>& pull() const { return run_.pull; }

  /// The strongest hand that the method stands at its step; and no stronger than `most` from now on, so that
  /// one hand can hold several simulations alike.
  const PullStrength& strongest_pull() const { return strongest_pull_; }
  void limit_pull(const std::optional<PullStrength>& most);

  const Scene& scene() const { return scene_; }
  const ClothSystem& system() const { return system_; }
  const ClothState& state() const { return run_.state; }
  double time() const { return run_.state.time; }
  double time_step() const { return run_.time_step; }
  /// The step after which the present time step came in force.
  std::int64_t first_step() const { return run_.first_step; }
  /// The time then, s.
  double first_time() const { return run_.first_time; }
  /// Steps of the present length in a record interval, or in what was left of one at first_step().
  std::int64_t steps_to_row() const;
  bool is_within_interval() const { return run_.automatic.next_change >= 0; }
  /// Where "auto" has shortened the step since t = 0.
  const std::vector<StepChange>& step_changes() const { return run_.automatic.changes; }
  const Quantities& quantities() const { return quantities_; }
  const StepCount& count() const { return run_.count; }
  /// Of the last step.
  const LimiterReport& last_limit() const { return run_.last_limit; }
  /// Where so far the deformation rate was not kept within its tolerance.
  const std::optional<RateBreach>& rate_breach() const { return run_.rate_breach; }
  const ContactReport& last_contact() const { return run_.last_contact; }  ///< of the last step
  const std::optional<UnreachableRate>& unreachable_rate() const { return unreachable_; }

  /// Where an obstacle is at a time, in s, with the transition after an edit included.
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
  void make_limiter(const std::vector<double>& tension);
  void limit_start();
  void limit_deformation();
  void book_limiter();
  void note_breach(bool by_contact);
  void resolve_contact(const StepTimes& times);
  void book_contact(const StepTimes& times);
  void end_contact();
  ObstacleTransitions find_transitions(const Scene& edited) const;
  void restore_obstacles(const std::vector<Pose>& poses);
  bool has_continuous_contact() const { return contact_ && contact_->is_continuous(); }
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
  bool has_diverged() const;

  Scene scene_;
  Preparation prepare_;
  ClothSystem system_;
  RunState run_;
  std::unique_ptr<WorkerTeam> team_;  ///< none: one thread
  ThreadUse thread_use_ = ThreadUse::where_they_gain;
  std::unique_ptr<ForceModel> forces_;
  std::unique_ptr<Integrator> integrator_;
  bool is_fused_ = false;  ///< `integrator_` is a fused stepper
  std::optional<StepLimiter> limiter_;
  bool limits_drift_ = false;  ///< the method asks the limiter itself, within the step
  std::unique_ptr<ContactStage> contact_;
  Vec3Field position_before_, velocity_before_;  ///< m, m/s, at the step's start, for contact

  std::function<bool()> stop_test_;
  bool interrupted_ = false;

  bool watches_step_ = false, watches_ledger_ = false;  ///< by the ledger: every few steps
  EnergyLedger ledger_before_;                          ///< at the begin of a step that may be taken back
  Quantities quantities_;
  std::vector<double> tension_before_;  ///< N, at the begin of a step that may be taken back
  std::optional<UnreachableRate> unreachable_;
  PullStrength strongest_pull_, pull_strength_;
  std::optional<PullStrength> most_pull_;
  double elastic_scale_ = 0;                  ///< J, all springs at twice their length
  double total_mass_ = 0, largest_mass_ = 0;  ///< kg
  bool was_finite_ = false;                   ///< every position was finite after the last step
  ClothState before_batch_;                   ///< to go back to
};

}  // namespace cloth
