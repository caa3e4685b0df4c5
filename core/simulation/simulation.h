// Runs a scene step by step. Simulation::step runs the stages integrate, limit the deformation, contact,
// advance time, in this order, and keeps the energy ledger; with Verlet the limiter acts within the
// integrator's step, between drift and closing kick, and methods with inner steps meet contact at the end of
// each of these (inner_contact.h). The stages are integrators/integrator.h,
// limiter/step_limiter.h and contact/contact_stage.h; a stage that the scene does not need is not made and
// costs nothing. explain_stages() (stages.h) lists the stages of a scene and what each does in a step;
// StepCount (outcome.h) counts the work done.
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
#include "integrators/registry.h"
#include "limiter/step_limiter.h"
#include "limiter/unreachable_rate.h"
#include "measure/energy.h"
#include "measure/probe_reader.h"
#include "measure/strain.h"
#include "simulation/inner_contact.h"
#include "simulation/predicted_damping.h"
#include "simulation/run_state.h"

namespace cloth {

class WorkerTeam;

/// The values of one row of a recording.
struct Measurement {
  double time = 0;
  std::int64_t step = 0;
  Energy energy;
  EnergyLedger ledger;
  Strain strain;
  std::int64_t limiter_sweeps = 0;  ///< of the last step
  double limiter_excess = 0;
  int contacts = 0;
  int held_back = 0;              ///< particles that contact kept from their target positions
  Vec3 contact_impulse{0, 0, 0};  ///< N s, given to the cloth since t = 0; 0 without continuous contact
  std::vector<double> probes{};   ///< of ProbeReader::columns(); not a number where one is not defined
  /// total - total(0) - works + losses in J: energy that the method itself added or lost
  double energy_error() const { return energy.total() - ledger.initial - ledger.entered(); }
};

/// The optional quantities that the scene's stages produce. Columns, curves and the rows of forms follow from
/// it.
struct Quantities {
  bool damping = false, air = false, brush = false, pull = false, limiter = false, contact = false;
  bool structural = false, shear = false, bending = false, hysteresis = false;
  bool continuous_contact = false;
  std::vector<std::string> probes{};  ///< their columns
  bool operator==(const Quantities&) const = default;
};

/// The spring and the damper by which the hand holds a particle.
struct PullStrength {
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool operator==(const PullStrength&) const = default;
};

/// Changes the start of a run in ways that no scene file describes: masses, rest lengths, positions,
/// velocities. Positions that exceed the deformation rate are brought within it before the first step.
using Preparation = std::function<void(ClothSystem&, ClothState&)>;

class Simulation {
 public:
  /// Precondition: find_problems(scene) is empty and resolved_time_step(scene) has a value.
  explicit Simulation(const Scene& scene, Preparation prepare = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Takes one step. Returns a Divergence where the new state is not finite or has diverged; the state is
  /// then that bad one.
  std::optional<Divergence> step();

  /// Takes `steps` steps, with bitwise the same result as step(). Ends early at the first step that diverges
  /// or that the stop test interrupts. Where nothing needs the states in between, steps are taken in batches,
  /// which are faster with some methods.
  std::optional<Divergence> advance(std::int64_t steps);

  /// `test` is called during steps with continuous contact, which may take long. When it returns true the
  /// step is cancelled: the state stays as it was before, and interrupted() is true until the next step.
  void set_stop_test(std::function<bool()> test);
  bool interrupted() const { return interrupted_; }

  /// Uses an edited scene from the next step on and keeps the state. Preconditions: those of the constructor,
  /// and only pins, probes and parameters of EditCost::live differ. The ledger's initial energy changes by
  /// the jump in energy. Where only probes differ the motion goes on as it would have, to the bit.
  void edit(const Scene& scene);

  Checkpoint checkpoint() const;
  /// Restores a checkpoint of this simulation, or of another one with the same start. The scene stays as it
  /// is; bitwise equal results need the scene that was used at the checkpoint.
  void restore(const Checkpoint& checkpoint);

  /// How many threads a step may use (1 without this call), and whether it uses them always or only while
  /// measurements show that they save time. The motion is bitwise the same for any number.
  void set_threads(int threads, ThreadUse use = ThreadUse::where_they_gain);
  /// How many threads a step can use, in passes over the springs or in contact.
  int threads() const;
  /// How the method steps now.
  const StepperKind& stepper() const { return stepper_kind_; }

  /// The hand, from the next step on.
  void set_brush(const std::optional<BrushGust>& brush);
  void set_pull(const std::optional<Pull>& pull);
  const std::optional<BrushGust>& brush() const { return run_.brush; }
  const std::optional<Pull>& pull() const { return run_.pull; }

  /// The strongest pull that is stable with the method and its time step. limit_pull() bounds the pull by
  /// `most` as well, so that several simulations can be pulled equally.
  const PullStrength& strongest_pull() const { return strongest_pull_; }
  void limit_pull(const std::optional<PullStrength>& most);

  const Scene& scene() const { return scene_; }
  const ClothSystem& system() const { return system_; }
  /// The cloth at rest where it is a mesh or cut from a grid; null: a grid.
  const std::shared_ptr<const LoadedMesh>& surface() const { return surface_; }
  const ClothState& state() const { return run_.state; }
  double time() const { return run_.state.time; }
  double time_step() const { return run_.time_step; }
  /// The step number at which the present time step came into use.
  std::int64_t first_step() const { return run_.first_step; }
  /// The time then, s.
  double first_time() const { return run_.first_time; }
  /// Steps of the present length in a record interval, or in the rest of the interval that began at
  /// first_step().
  std::int64_t steps_to_row() const;
  bool is_within_interval() const { return run_.automatic.next_change >= 0; }
  /// Where "auto" has shortened the step since t = 0.
  const std::vector<StepChange>& step_changes() const { return run_.automatic.changes; }
  const Quantities& quantities() const { return quantities_; }
  const ProbeReader& probes() const { return probes_; }
  const StepCount& count() const { return run_.count; }
  /// Of the last step.
  const LimiterReport& last_limit() const { return run_.last_limit; }
  /// Where so far the deformation rate was not kept within its tolerance.
  const std::optional<RateBreach>& rate_breach() const { return run_.rate_breach; }
  const ContactReport& last_contact() const { return run_.last_contact; }  ///< of the last step
  const std::optional<UnreachableRate>& unreachable_rate() const { return unreachable_; }

  /// Where an obstacle is at a time, in s, with the transition after an edit included.
  Pose obstacle_pose(std::size_t obstacle, double time) const;

  // Data for showing contact, computed only in these calls.
  /// Appends the points where the cloth touched something at the end of the last step. With continuous
  /// contact there are none between an edit or restore() and the next step.
  void append_contact_marks(std::vector<ContactMark>& marks) const;
  /// Levels of the hierarchy of boxes around an obstacle's mesh, or with -1 around the cloth; 0: there is
  /// none.
  int hierarchy_depth(int obstacle) const;
  /// Appends its boxes `level` below the root; of a mesh as the scene has it, before any motion.
  void append_hierarchy_boxes(int obstacle, int level, std::vector<Bounds>& boxes);

  /// The cloth's surface at the present positions, m.
  TriangleMesh cloth_mesh() const;

  Measurement measure() const;

  /// An upper estimate in J of the energy that the scene can have put into motion so far. A run has diverged
  /// where the ledger cannot explain ten times as much.
  double energy_scale() const;

  /// The report of a stop at the present state: the particle that is not finite, else the fastest one.
  Divergence stop_at_fastest(const std::string& cause) const;

 private:
  void assemble();
  void find_probes();
  std::int64_t advance_batch(std::int64_t count);
  void begin_step_length();
  void watch_step(bool at_once);
  void shorten_step();
  void take_step_of_scene();
  bool is_surely_slow(double speed_squares) const;
  void count_step(const IntegratorReport& report);
  PullStrength find_strongest_pull() const;
  void find_pull_strength();
  void apply_hand();
  EndVelocity end_velocity() const;
  void choose_stepper();
  void share_work();
  void make_limiter(const std::vector<double>& tension);
  void limit_start();
  bool limit_deformation();
  bool leaves_rate_to_contact() const;
  void limit_between_contacts(const StepTimes& times);
  void book_limiter();
  void note_breach(bool by_contact);
  void resolve_contact(const StepTimes& times);
  std::optional<ContactReport> contact_of(const StepTimes& times, const Vec3Field& position_before,
                                          const Vec3Field& velocity_before);
  void book_contact(const StepTimes& times);
  void end_contact();
  ObstacleTransitions find_transitions(const Scene& edited) const;
  void restore_obstacles(const std::vector<Pose>& poses);
  bool has_continuous_contact() const { return contact_ && contact_->is_continuous(); }
  void take_back_step();
  /// With what forces that depend on what has been store.
  Energy energy_of(const ClothState& state) const;
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
  std::shared_ptr<const LoadedMesh> surface_;
  RunState run_;
  std::unique_ptr<WorkerTeam> team_;  ///< none: one thread
  ThreadUse thread_use_ = ThreadUse::where_they_gain;
  std::unique_ptr<ForceModel> forces_;
  std::unique_ptr<Integrator> integrator_;
  StepperKind stepper_kind_;    ///< of `integrator_`
  DampingLoads damping_loads_;  ///< at the longest step; infinity: not asked
  std::optional<StepLimiter> limiter_;
  bool limits_drift_ = false;  ///< the method asks the limiter itself, within the step
  std::unique_ptr<ContactStage> contact_;
  std::optional<InnerContact> inner_contact_;    ///< none: contact follows each step
  Vec3Field position_before_, velocity_before_;  ///< m, m/s, at the step's start, for contact

  std::function<bool()> stop_test_;
  bool interrupted_ = false;

  bool watches_step_ = false, watches_ledger_ = false;  ///< by the ledger: every few steps
  EnergyLedger ledger_before_;                          ///< at the begin of a step that may be taken back
  Quantities quantities_;
  ProbeReader probes_;
  struct BeforeInnerSteps {
    std::vector<Pose> poses;
    ContactMemory contact;
  } before_inner_steps_;                ///< at the begin of a step that may be taken back
  std::vector<double> tension_before_;  ///< N, likewise
  IntegratorMemory memory_before_;      ///< likewise
  std::optional<UnreachableRate> unreachable_;
  PullStrength strongest_pull_, pull_strength_;
  std::optional<PullStrength> max_pull_;
  double elastic_scale_ = 0;                  ///< J, all springs at twice their length
  double total_mass_ = 0, largest_mass_ = 0;  ///< kg
  bool was_finite_ = false;                   ///< every position was finite after the last step
  ClothState before_batch_;                   ///< to go back to
};

}  // namespace cloth
