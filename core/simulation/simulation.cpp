#include "simulation/simulation.h"

#include <algorithm>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "cloth/sums.h"
#include "contact/continuous_contact.h"
#include "forces/registry.h"
#include "integrators/registry.h"
#include "kernels/worker_team.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"
#include "scene/scene_parameters.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

double elastic_scale_of(const ClothSystem& system) {
  double energy = 0;
  for (const SpringRun& run : system.springs)
    energy += 0.5 * run.stiffness * run.rest_length * run.rest_length * run.count;
  for (const MembraneTriangle& t : system.membrane) {
    const std::array<double, 3> bound = edge_bounds(t);
    for (std::size_t e = 0; e < 3; ++e) energy += 0.5 * bound[e] * t.rest_square[e];
  }
  return energy;
}

/// N/m: no hand need be stronger than what it pulls at.
double strength_of(const Scene& scene) {
  if (!scene.material) {
    const SpringMaterial springs = scene.springs.value_or(SpringMaterial{});
    return 2 * (springs.structural + springs.shear + springs.flexion);
  }
  const Material& m = *scene.material;
  if (scene.cloth.is_mesh()) return 2 * (std::max(m.stretch_warp, m.stretch_weft) + m.shear);
  const CellSides cell = cell_sides(scene.cloth);
  const CellSprings k = cell_springs(*scene.material, cell.across, cell.down);
  return 2 * (std::max(k.across, k.down) + k.diagonal);
}

/// kg, of a particle as the scene has it, whatever a preparation made of it.
double mass_of_scene(const Scene& scene, const ClothSystem& system) {
  return scene.material ? particle_mass(scene) : scene.cloth.mass / static_cast<double>(system.size());
}

/// Whether one integrator serves both: the step may differ, and settings that the method does not have.
bool is_same_method(const IntegratorChoice& a, const IntegratorChoice& b) {
  if (a.method != b.method) return false;
  const Fields<IntegratorChoice>& fields = integrator_fields(a.method);
  return std::all_of(fields.begin(), fields.end(), [&](const Field<IntegratorChoice>& field) {
    return field.info.key == "time_step" || field.get(a) == field.get(b);
  });
}

bool differ_in_probes_alone(const Scene& a, const Scene& b) {
  if (a.probes == b.probes) return false;
  Scene other = b;
  other.probes = a.probes;
  return a == other;
}

}  // namespace

Simulation::Simulation(const Scene& scene, Preparation prepare)
    : scene_(scene), prepare_(std::move(prepare)) {
  system_ = make_cloth(scene_);
  surface_ = scene_.cloth.is_cut() ? surface_to_draw(system_) : scene_.cloth.mesh.loaded;
  run_.state = starting_state(system_);
  if (prepare_) prepare_(system_, run_.state);
  take_step_of_scene();
  assemble();
  limit_start();
  run_.ledger.initial = total_energy();
  run_.automatic.least_error = 0;
}

Simulation::~Simulation() = default;

void Simulation::assemble() {
  const std::vector<double> history = forces_ ? forces_->history() : std::vector<double>();
  forces_ = std::make_unique<ForceModel>(scene_, system_);
  forces_->set_history(history, run_.state.position);
  make_limiter(limiter_ ? limiter_->tension() : std::vector<double>());
  const MethodFacts& method = facts_of(scene_.integrator.method);
  const bool long_steps = method.a_stable && !method.has_inner_steps;
  contact_ = make_contact_stage(scene_, system_, run_.transitions, run_.thickness_transition, run_.state.time,
                                long_steps && run_.time_step > explicit_step_limit(scene_));
  share_work();
  if (contact_) contact_->set_stop_test(stop_test_);
  elastic_scale_ = elastic_scale_of(system_);
  total_mass_ = system_.total_mass();
  run_.obstacle_speed =
      std::max(run_.obstacle_speed, highest_obstacle_speed(scene_, run_.transitions, run_.state.position));
  largest_mass_ = *std::max_element(system_.mass.begin(), system_.mass.end());
  was_finite_ = false;
  run_.last_limit = {};
  run_.last_contact = {};

  quantities_ = Quantities{.damping = has_work(scene_, system_, &Work::damping_loss),
                           .air = has_work(scene_, system_, &Work::air),
                           .brush = run_.was_brushed,
                           .pull = run_.was_pulled,
                           .limiter = limiter_.has_value(),
                           .contact = contact_ != nullptr,
                           .structural = system_.spring_count(SpringFamily::structural) > 0,
                           .shear = system_.spring_count(SpringFamily::shear) > 0,
                           .bending = !system_.bending.empty(),
                           .hysteresis = forces_->has_history(),
                           .continuous_contact = has_continuous_contact()};

  find_probes();

  damping_loads_ = {infinity, infinity};
  if (facts_of(scene_.integrator.method).predicts_damping && forces_->has_damping())
    damping_loads_ = damping_loads(scene_, run_.automatic.longest);
  strongest_pull_ = find_strongest_pull();
  apply_hand();
}

void Simulation::find_probes() {
  probes_ = ProbeReader(scene_, system_);
  quantities_.probes = probes_.columns();
}

/// A hand as strong as the step allows: it may not push the fastest oscillation over the method's limit, in
/// any shape of the cloth. Half of that leaves room for the hand's own damping. A method without a limit
/// takes the strongest hand.
PullStrength Simulation::find_strongest_pull() const {
  const double mass = *std::min_element(system_.mass.begin(), system_.mass.end());
  const double omega = guaranteed_frequency(scene_);
  const double limit = guaranteed_step(scene_.integrator.method, scene_).value_or(0);
  const double step = run_.automatic.longest;
  const double allowed = limit > 0 && std::isfinite(limit) ? omega * limit / step : 1 / step;
  const double strongest = std::max(strength_of(scene_), 1e3 * mass);
  const bool unlimited = omega > 0 && std::isinf(limit);  // the method divides its steps by itself
  if (unlimited || stable_at_every_step(scene_.integrator.method))
    return {strongest, std::sqrt(strongest * mass)};
  const double held = mass / mass_of_scene(scene_, system_) * strongest_held_spring(scene_, allowed);
  const double stiffness = std::clamp(0.5 * held, 0.0, strongest);
  return {stiffness, std::min(std::sqrt(stiffness * mass), 0.1 * mass / step)};
}

void Simulation::limit_pull(const std::optional<PullStrength>& most) {
  if (most == max_pull_) return;
  max_pull_ = most;
  // Without a pull no force has changed, and what the method remembers stays.
  run_.pull ? apply_hand() : find_pull_strength();
}

void Simulation::find_pull_strength() {
  pull_strength_ = strongest_pull_;
  if (!max_pull_) return;
  pull_strength_.stiffness = std::min(pull_strength_.stiffness, max_pull_->stiffness);
  pull_strength_.damping = std::min(pull_strength_.damping, max_pull_->damping);
}

void Simulation::apply_hand() {
  find_pull_strength();
  forces_->set_brush(run_.brush);
  forces_->set_pull(run_.pull, pull_strength_.stiffness, pull_strength_.damping);
  choose_stepper();
}

/// The cheapest way that the damping, with that of the hand, allows at the longest step.
EndVelocity Simulation::end_velocity() const {
  DampingLoads loads = damping_loads_;
  if (run_.pull) {
    const double h = run_.automatic.longest,
                 mass = *std::min_element(system_.mass.begin(), system_.mass.end());
    const double damping = h * pull_strength_.damping / mass;
    loads.damping += damping;
    loads.whole += 0.25 * h * h * pull_strength_.stiffness / mass + damping;
  }
  return end_velocity_for(scene_, loads);
}

/// Whenever forces or constraints have become others. What one stepper remembers beside the state is lost
/// where one of another kind takes over: it begins with the forces at the state.
void Simulation::choose_stepper() {
  const StepperKind kind =
      stepper_kind(scene_.integrator.method, *forces_,
                   {.constrained = limiter_.has_value(), .end_velocity = end_velocity()});
  if (!integrator_ || kind != stepper_kind_)
    integrator_ = make_stepper(scene_.integrator, kind);
  else
    integrator_->forget(Change::forces);
  stepper_kind_ = kind;
  limits_drift_ = integrator_->set_drift_constraint(limiter_ ? &*limiter_ : nullptr) && limiter_;
  inner_contact_.reset();
  const bool limits_after = limiter_ && !limits_drift_;
  if (contact_ && facts_of(scene_.integrator.method).has_inner_steps &&
      !(limits_after &&
        contact_->is_continuous()))  // the rate would lead through what inner steps kept apart
    inner_contact_.emplace(
        [this](const StepTimes& times, const Vec3Field& position, const Vec3Field& velocity) {
          const auto found = contact_of(times, position, velocity);
          if (found) run_.ledger.contact += found->work;
          if (found && !found->acted && !found->interrupted) end_contact();
          return found;
        });
  integrator_->set_inner_contact(inner_contact_ ? &*inner_contact_ : nullptr);
}

std::optional<Divergence> Simulation::step() {
  begin_step_length();
  const std::int64_t next = run_.state.step + 1;
  const StepTimes times{run_.state.time,
                        run_.first_time + static_cast<double>(next - run_.first_step) * run_.time_step,
                        run_.time_step};
  interrupted_ = false;
  if (contact_) position_before_ = run_.state.position, velocity_before_ = run_.state.velocity;
  if (limiter_) limiter_->begin_step(run_.time_step, run_.state, integrator_->drifts_with_end_velocity());
  if (has_continuous_contact() && stop_test_) {
    ledger_before_ = run_.ledger;
    if (limiter_) tension_before_ = limiter_->tension();
    memory_before_ = integrator_->remember();
    if (inner_contact_) before_inner_steps_ = {contact_->poses(), run_.contact_memory};
  }
  Work& work = run_.ledger.forces;
  const bool waits = has_continuous_contact() && !limiter_ && integrator_->waits_for_contact(*forces_);
  IntegratorReport report = waits ? integrator_->open_step(*forces_, times, run_.state, work)
                                  : integrator_->step(*forces_, times, run_.state, work);
  if (limiter_ && !report.failure && !leaves_rate_to_contact()) limit_between_contacts(times);
  if (contact_ && (!report.failure || inner_contact_)) resolve_contact(times);
  report.velocity_iterations += run_.last_contact.velocity_iterations;
  if (waits && !run_.last_contact.acted && !run_.last_contact.interrupted)
    integrator_->close_step(*forces_, times, run_.state, work, report);
  if (run_.last_contact.interrupted && !report.failure) {
    take_back_step();
    return std::nullopt;
  }
  if (limiter_ && !report.failure) book_limiter();
  if (has_continuous_contact() && report.failure && !inner_contact_)
    run_.state.position = position_before_;  // nothing has led it there
  run_.state.time = times.end;
  run_.state.step = next;
  if (forces_->has_history() && !report.failure)
    run_.ledger.forces.hysteresis_loss += forces_->end_step(run_.state.position, integrator_->held_force());
  count_step(report);

  if (run_.last_contact.exhausted && !report.failure) return stop_at_exhaustion(*run_.last_contact.pinch);
  if (run_.last_contact.pinch && !report.failure) return stop_at_pinch(*run_.last_contact.pinch);
  if (!report.failure) {
    auto divergence = find_divergence(report);
    if (!divergence && watches_step_) {
      const double squares = report.speed_squares.value_or(
          ordered_sum(run_.state.velocity.flat().size(),
                      [v = run_.state.velocity.flat().data()](std::size_t k) { return v[k] * v[k]; }));
      watch_step(!is_surely_slow(squares));
    }
    return divergence;
  }
  Divergence stop = stop_at(report.failure->particle, report.failure->cause);
  stop.solver_failed = true;
  return stop;
}

void Simulation::take_back_step() {
  run_.state.position = position_before_;
  run_.state.velocity = velocity_before_;
  run_.ledger = ledger_before_;
  if (limiter_) limiter_->set_tension(tension_before_);
  run_.last_contact = {};
  integrator_->recall(memory_before_);
  if (inner_contact_) {
    contact_->restore(before_inner_steps_.poses, run_.transitions, run_.thickness_transition);
    run_.contact_memory = before_inner_steps_.contact;
  }
  interrupted_ = true;
}

void Simulation::set_stop_test(std::function<bool()> test) {
  stop_test_ = std::move(test);
  if (contact_) contact_->set_stop_test(stop_test_);
}

void Simulation::count_step(const IntegratorReport& report) {
  ++run_.count.steps;
  run_.count.force_evaluations += report.force_evaluations;
  run_.count.velocity_iterations += report.velocity_iterations;
  run_.count.limiter_sweeps += run_.last_limit.sweeps;
  run_.count.inner_steps += report.inner_steps;
  run_.count.rejected_steps += report.rejected_steps;
  run_.count.iterations += report.iterations;
  run_.count.linear_iterations += report.linear_iterations;
  run_.count.factorisations += report.factorisations;
  if (report.held_normals > 0 && !report.failure) ++run_.count.held_normals;
  run_.count.largest_residual = std::max(run_.count.largest_residual, report.residual);
}

TriangleMesh Simulation::cloth_mesh() const {
  TriangleMesh mesh{{}, triangles_of(system_)};
  for (std::size_t i = 0; i < run_.state.position.size(); ++i)
    mesh.vertices.push_back(run_.state.position[i]);
  return mesh;
}

/// Of the obstacles that an edit makes other ones than they are.
ObstacleTransitions Simulation::find_transitions(const Scene& edited) const {
  if (!cloth::has_continuous_contact(edited)) return {};
  if (has_continuous_contact() && edited.obstacles == scene_.obstacles) return run_.transitions;
  const std::vector<Pose> poses = contact_ ? contact_->poses() : std::vector<Pose>{};
  return transitions_after({scene_.obstacles, poses, run_.transitions}, edited, run_.state.time,
                           cloth_mesh());
}

void Simulation::edit(const Scene& scene) {
  if (scene == scene_) return;
  if (differ_in_probes_alone(scene, scene_)) {
    scene_.probes = scene.probes;
    return find_probes();
  }
  const double before = total_energy();
  const bool new_method = !is_same_method(scene.integrator, scene_.integrator);
  run_.transitions = find_transitions(scene);
  run_.thickness_transition = has_continuous_contact() && cloth::has_continuous_contact(scene)
                                  ? thickness_after(scene_, run_.thickness_transition, scene, run_.state.time)
                                  : ThicknessTransition{};
  scene_ = scene;
  const Vec3Field start = std::move(system_.start);
  system_ = make_cloth(scene_);
  if (prepare_) {
    ClothState unused = starting_state(system_);
    prepare_(system_, unused);
  }
  system_.start = start;
  for (std::size_t i = 0; i < run_.state.velocity.size(); ++i)
    if (system_.pinned[i]) run_.state.velocity.set(i, Vec3::Zero());

  take_step_of_scene();
  if (new_method) integrator_.reset();
  assemble();
  if (new_method || !contact_) end_contact();
  integrator_->forget(Change::state);
  run_.ledger.initial += total_energy() - before;
}

void Simulation::set_threads(int threads, ThreadUse use) {
  auto team = threads > 1 ? std::make_unique<WorkerTeam>(threads) : nullptr;
  thread_use_ = use;
  team_.swap(team);
  share_work();
}

/// Among the threads of the team, if there is one. Continuous contact goes through all particles between two
/// passes, mostly on one thread, and has to fetch what other cores wrote: for a small cloth that costs more
/// than sharing the pass saves.
void Simulation::share_work() {
  constexpr int small = 4000;  // particles
  const bool keeps_one_thread = contact_ && contact_->is_continuous() &&
                                thread_use_ == ThreadUse::where_they_gain && system_.size() < small;
  WorkerTeam* const of_forces = keeps_one_thread ? nullptr : team_.get();
  if (forces_->sweep()) forces_->sweep()->set_team(of_forces, thread_use_);
  forces_->set_team(of_forces, thread_use_);
  if (contact_) contact_->set_team(team_.get(), thread_use_);
}

int Simulation::threads() const {
  if (team_ && contact_ && contact_->is_continuous()) return team_->size();
  return forces_->sweep() ? forces_->sweep()->threads() : 1;
}

void Simulation::set_brush(const std::optional<BrushGust>& brush) {
  run_.brush = brush;
  if (brush && quantities_.air) quantities_.brush = run_.was_brushed = true;
  forces_->set_brush(brush);
  choose_stepper();
}

void Simulation::set_pull(const std::optional<Pull>& pull) {
  run_.pull = pull;
  if (pull) quantities_.pull = run_.was_pulled = true;
  run_.hand_energy = std::max(run_.hand_energy, hand_energy());
  forces_->set_pull(pull, pull_strength_.stiffness, pull_strength_.damping);
  choose_stepper();
}

Pose Simulation::obstacle_pose(std::size_t obstacle, double time) const {
  if (has_continuous_contact() && time == run_.state.time) return contact_->poses()[obstacle];
  return pose_in_transition(scene_.obstacles, run_.transitions, obstacle, time);
}

void Simulation::append_contact_marks(std::vector<ContactMark>& marks) const {
  if (contact_) contact_->append_marks(run_.state.position, marks);
}

int Simulation::hierarchy_depth(int obstacle) const {
  return contact_ ? contact_->hierarchy_depth(obstacle) : 0;
}

void Simulation::append_hierarchy_boxes(int obstacle, int level, std::vector<Bounds>& boxes) {
  if (contact_) contact_->append_boxes(obstacle, level, run_.state.position, boxes);
}

Energy Simulation::energy_of(const ClothState& state) const {
  Energy energy = measure_energy(system_, gravity_of(scene_), state);
  const double stored = forces_->stored_energy(state.position);
  energy.bending += stored, energy.elastic += stored;
  return energy;
}

double Simulation::total_energy() const {
  return energy_of(run_.state).total();
}

Measurement Simulation::measure() const {
  return {.time = run_.state.time,
          .step = run_.state.step,
          .energy = energy_of(run_.state),
          .ledger = run_.ledger,
          .strain = measure_strain(system_, run_.state.position),
          .limiter_sweeps = run_.last_limit.sweeps,
          .limiter_excess = run_.last_limit.excess,
          .contacts = run_.last_contact.contacts,
          .held_back = run_.last_contact.held_back,
          .contact_impulse = run_.contact_impulse,
          .probes = probes_.read(system_, run_.state)};
}

}  // namespace cloth
