#include "simulation/simulation.h"

#include <algorithm>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "cloth/sums.h"
#include "contact/continuous_contact.h"
#include "contact/stiff_contact.h"
#include "integrators/registry.h"
#include "kernels/worker_team.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_parameters.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

double elastic_scale_of(const ClothSystem& system) {
  double energy = 0;
  for (const SpringRun& run : system.springs)
    energy += 0.5 * run.stiffness * run.rest_length * run.rest_length * run.count;
  return energy;
}

/// Takes from `material` only what exists, so that an absent block is a material of zeros.
SpringMaterial material_of(const Scene& scene) {
  return scene.springs.value_or(SpringMaterial{});
}

/// Whether one integrator serves both: the step may differ, and settings that the method does not have.
bool is_same_method(const IntegratorChoice& a, const IntegratorChoice& b) {
  if (a.method != b.method) return false;
  const Fields<IntegratorChoice>& fields = integrator_fields(a.method);
  return std::all_of(fields.begin(), fields.end(), [&](const Field<IntegratorChoice>& field) {
    return field.info.key == "time_step" || field.get(a) == field.get(b);
  });
}

}  // namespace

Simulation::Simulation(const Scene& scene, Preparation prepare)
    : scene_(scene), prepare_(std::move(prepare)) {
  system_ = make_cloth(scene_.cloth, material_of(scene_));
  state_ = starting_state(system_);
  if (prepare_) prepare_(system_, state_);
  take_step_of_scene();
  assemble();
  limit_start();
  ledger_.initial = total_energy();
  automatic_.least_error = 0;
}

Simulation::~Simulation() = default;

void Simulation::assemble() {
  forces_ = std::make_unique<ForceModel>(scene_, system_);
  share_work();
  const std::vector<double> tension = limiter_ ? limiter_->tension() : std::vector<double>();
  limiter_.reset();
  if (scene_.deformation && DeformationLimiter::is_needed(*scene_.deformation, system_)) {
    limiter_.emplace(*scene_.deformation, system_);
    limiter_->set_tension(tension);
  }
  contact_.reset();
  continuous_contact_.reset();
  if (has_continuous_contact(scene_))
    continuous_contact_ =
        std::make_unique<ContinuousContact>(scene_, system_, carries_, thickness_transition_, state_.time);
  else if (!scene_.obstacles.empty())
    contact_.emplace(scene_.obstacles, gravity_of(scene_).norm());
  stiff_contact_.reset();
  if (contact_ && time_step_ > explicit_step_limit(scene_)) stiff_contact_ = std::make_unique<StiffContact>();
  if (continuous_contact_) continuous_contact_->set_team(team_.get());
  if (continuous_contact_) continuous_contact_->set_stop_test(stop_test_);
  find_unreachable();
  elastic_scale_ = elastic_scale_of(system_);
  total_mass_ = system_.total_mass();
  obstacle_speed_ = std::max(obstacle_speed_, highest_obstacle_speed(scene_, carries_, state_.position));
  largest_mass_ = *std::max_element(system_.mass.begin(), system_.mass.end());
  was_finite_ = false;
  last_limit_ = {};
  last_contact_ = {};

  const bool brush = quantities_.brush, pull = quantities_.pull;  // a hand that acted keeps its column
  quantities_ = Quantities{
      .damping = scene_.damping.value_or(0) > 0 || (!system_.springs.empty() && scene_.springs->damping > 0),
      .air = scene_.air && scene_.air->drag > 0,
      .brush = brush,
      .pull = pull,
      .limiter = limiter_.has_value(),
      .contact = contact_ || continuous_contact_,
      .structural = system_.spring_count(SpringFamily::structural) > 0,
      .shear = system_.spring_count(SpringFamily::shear) > 0,
      .continuous_contact = continuous_contact_ != nullptr};

  strongest_pull_ = find_strongest_pull();
  apply_hand();
}

/// A hand as strong as the step allows: it may not push the fastest oscillation over the method's limit, in
/// any shape of the cloth. Half of that leaves room for the hand's own damping. A method without a limit
/// takes the strongest hand.
PullStrength Simulation::find_strongest_pull() const {
  const double mass = *std::min_element(system_.mass.begin(), system_.mass.end());
  const SpringMaterial material = material_of(scene_);
  const double omega = guaranteed_frequency(scene_.cloth, material);
  const double limit = guaranteed_step(scene_.integrator.method, scene_).value_or(0);
  const double step = automatic_.longest;
  const double allowed = limit > 0 && std::isfinite(limit) ? omega * limit / step : 1 / step;
  const double strongest =
      std::max(2 * (material.structural + material.shear + material.flexion), 1e3 * mass);
  const bool unlimited = omega > 0 && std::isinf(limit);  // the method divides its steps by itself
  if (unlimited || stable_at_every_step(scene_.integrator.method))
    return {strongest, std::sqrt(strongest * mass)};
  const double of_scene = scene_.cloth.mass / static_cast<double>(system_.size());
  const double held = mass / of_scene * strongest_held_spring(scene_.cloth, material, allowed);
  const double stiffness = std::clamp(0.5 * held, 0.0, strongest);
  return {stiffness, std::min(std::sqrt(stiffness * mass), 0.1 * mass / step)};
}

void Simulation::limit_pull(const std::optional<PullStrength>& most) {
  if (most == most_pull_) return;
  most_pull_ = most;
  apply_hand();
}

void Simulation::apply_hand() {
  pull_strength_ = strongest_pull_;
  if (most_pull_) {
    pull_strength_.stiffness = std::min(pull_strength_.stiffness, most_pull_->stiffness);
    pull_strength_.damping = std::min(pull_strength_.damping, most_pull_->damping);
  }
  forces_->set_brush(brush_);
  forces_->set_pull(pull_, pull_strength_.stiffness, pull_strength_.damping);
  choose_stepper();
}

/// Whenever forces or constraints have become others. Methods that remember more than forces have no fused
/// stepper, so that nothing is lost where one takes over from the other.
void Simulation::choose_stepper() {
  const bool fused = suits_fused_stepper(scene_.integrator.method, *forces_, limiter_.has_value());
  if (!integrator_ || fused != is_fused_)
    integrator_ = make_stepper(scene_.integrator, *forces_, limiter_.has_value());
  else
    integrator_->forget(Change::forces);
  is_fused_ = fused;
  limits_drift_ = integrator_->set_drift_constraint(limiter_ ? &*limiter_ : nullptr) && limiter_;
}

std::optional<Divergence> Simulation::step() {
  begin_step_length();
  const std::int64_t next = state_.step + 1;
  const StepTimes times{state_.time, first_time_ + static_cast<double>(next - first_step_) * time_step_,
                        time_step_};
  interrupted_ = false;
  if (contact_ || continuous_contact_) position_before_ = state_.position, velocity_before_ = state_.velocity;
  if (limiter_) limiter_->begin_step(time_step_, state_, integrator_->drifts_with_end_velocity());
  if (continuous_contact_ && stop_test_) {
    ledger_before_ = ledger_;
    if (limiter_) tension_before_ = limiter_->tension();
  }
  const IntegratorReport report = integrator_->step(system_, *forces_, times, state_, ledger_.forces);
  if (limiter_ && !report.failure) limit_deformation();
  if (contact_ && !report.failure) resolve_contact(times);
  if (continuous_contact_ && !report.failure) resolve_continuous_contact(times);
  if (last_contact_.interrupted && !report.failure) {
    take_back_step();
    return std::nullopt;
  }
  if (limiter_ && !report.failure) book_limiter();
  if (continuous_contact_ && report.failure) state_.position = position_before_;  // nothing has led it there
  state_.time = times.end;
  state_.step = next;
  count_step(report);

  if (last_contact_.exhausted && !report.failure) return stop_at_exhaustion(*last_contact_.pinch);
  if (last_contact_.pinch && !report.failure) return stop_at_pinch(*last_contact_.pinch);
  if (!report.failure) {
    auto divergence = find_divergence(report);
    if (!divergence && watches_step_) {
      const double squares = report.speed_squares.value_or(
          ordered_sum(state_.velocity.flat().size(),
                      [v = state_.velocity.flat().data()](std::size_t k) { return v[k] * v[k]; }));
      watch_step(!is_surely_slow(squares));
    }
    return divergence;
  }
  Divergence stop = stop_at(report.failure->particle, report.failure->cause);
  stop.solver_failed = true;
  return stop;
}

void Simulation::take_back_step() {
  state_.position = position_before_;
  state_.velocity = velocity_before_;
  ledger_ = ledger_before_;
  if (limiter_) limiter_->set_tension(tension_before_);
  last_contact_ = {};
  integrator_->forget(Change::state);
  interrupted_ = true;
}

void Simulation::set_stop_test(std::function<bool()> test) {
  stop_test_ = std::move(test);
  if (continuous_contact_) continuous_contact_->set_stop_test(stop_test_);
}

void Simulation::count_step(const IntegratorReport& report) {
  ++count_.steps;
  count_.force_evaluations += report.force_evaluations;
  count_.velocity_iterations += report.velocity_iterations;
  count_.limiter_sweeps += last_limit_.sweeps;
  count_.inner_steps += report.inner_steps;
  count_.rejected_steps += report.rejected_steps;
  count_.iterations += report.iterations;
  count_.linear_iterations += report.linear_iterations;
  count_.factorisations += report.factorisations;
  count_.largest_residual = std::max(count_.largest_residual, report.residual);
}

TriangleMesh Simulation::cloth_mesh() const {
  TriangleMesh mesh{{}, triangles_of(system_)};
  for (std::size_t i = 0; i < state_.position.size(); ++i) mesh.vertices.push_back(state_.position[i]);
  return mesh;
}

/// Of the obstacles that an edit makes other ones than they are.
ObstacleTransitions Simulation::find_transitions(const Scene& edited) const {
  if (!has_continuous_contact(edited)) return {};
  if (continuous_contact_ && edited.obstacles == scene_.obstacles) return carries_;
  const std::vector<Pose> poses = continuous_contact_ ? continuous_contact_->poses() : std::vector<Pose>{};
  return transitions_after({scene_.obstacles, poses, carries_}, edited, state_.time, cloth_mesh());
}

void Simulation::edit(const Scene& scene) {
  const double before = total_energy();
  const bool new_method = !is_same_method(scene.integrator, scene_.integrator);
  carries_ = find_transitions(scene);
  thickness_transition_ = continuous_contact_ && has_continuous_contact(scene)
                              ? thickness_after(scene_, thickness_transition_, scene, state_.time)
                              : ThicknessTransition{};
  scene_ = scene;
  const Vec3Field start = std::move(system_.start);
  system_ = make_cloth(scene_.cloth, material_of(scene_));
  if (prepare_) {
    ClothState unused = starting_state(system_);
    prepare_(system_, unused);
  }
  system_.start = start;
  for (std::size_t i = 0; i < state_.velocity.size(); ++i)
    if (system_.pinned[i]) state_.velocity.set(i, Vec3::Zero());

  take_step_of_scene();
  if (new_method) integrator_.reset();
  assemble();
  if (new_method || !(contact_ || continuous_contact_)) end_contact();
  integrator_->forget(Change::state);
  ledger_.initial += total_energy() - before;
}

std::size_t Checkpoint::bytes() const {
  std::size_t numbers =
      tension.size() + memory.numbers.size() + state.position.flat().size() + state.velocity.flat().size();
  for (const Vec3Field& field : memory.fields) numbers += field.flat().size();
  numbers += contact_memory.deferred.size();
  return sizeof(Checkpoint) + sizeof(StepChange) * automatic.changes.size() + sizeof(double) * numbers +
         contact_memory.held.size() + sizeof(Pose) * obstacle_poses.size() +
         sizeof(ObstacleTransition) * carries.size();
}

Checkpoint Simulation::checkpoint() const {
  return {.state = state_,
          .method = scene_.integrator.method,
          .memory = integrator_->remember(),
          .ledger = ledger_,
          .time_step = time_step_,
          .first_time = first_time_,
          .first_step = first_step_,
          .automatic = automatic_,
          .brush = brush_,
          .pull = pull_,
          .quantities = quantities_,
          .count = count_,
          .last_limit = last_limit_,
          .last_contact = last_contact_,
          .obstacle_poses = continuous_contact_ ? continuous_contact_->poses() : std::vector<Pose>{},
          .carries = carries_,
          .thickness_transition = thickness_transition_,
          .obstacle_speed = obstacle_speed_,
          .hand_energy = hand_energy_,
          .contact_impulse = contact_impulse_,
          .contact_memory = contact_memory_,
          .tension = limiter_ ? limiter_->tension() : std::vector<double>(),
          .rate_breach = rate_breach_};
}

void Simulation::restore(const Checkpoint& checkpoint) {
  state_ = checkpoint.state;
  was_finite_ = false;
  ledger_ = checkpoint.ledger;
  count_ = checkpoint.count;
  set_brush(checkpoint.brush);
  set_pull(checkpoint.pull);
  quantities_.brush = checkpoint.quantities.brush;
  quantities_.pull = checkpoint.quantities.pull;
  const bool same_step = checkpoint.automatic.longest == automatic_.longest;
  first_time_ = same_step ? checkpoint.first_time : state_.time;
  first_step_ = same_step ? checkpoint.first_step : state_.step;
  if (same_step && watches_step_) time_step_ = checkpoint.time_step;
  if (same_step && watches_step_) automatic_ = checkpoint.automatic;
  last_limit_ = checkpoint.last_limit;
  if (limiter_) limiter_->set_tension(checkpoint.tension);
  rate_breach_ = checkpoint.rate_breach;
  last_contact_ = checkpoint.last_contact;
  const bool same_obstacles = checkpoint.carries.size() == scene_.obstacles.size();
  carries_ = same_obstacles ? checkpoint.carries : ObstacleTransitions{};
  thickness_transition_ = checkpoint.thickness_transition;
  obstacle_speed_ = checkpoint.obstacle_speed;
  hand_energy_ = checkpoint.hand_energy;
  contact_impulse_ = checkpoint.contact_impulse;
  contact_memory_ = checkpoint.contact_memory;
  if (checkpoint.method != scene_.integrator.method) end_contact();
  if (continuous_contact_) {
    continuous_contact_->set_transitions(carries_, thickness_transition_);
    restore_obstacles(checkpoint.obstacle_poses);
    continuous_contact_->forget_touches();
  }
  find_unreachable();
  if (checkpoint.method == scene_.integrator.method)
    integrator_->recall(checkpoint.memory);
  else
    integrator_->forget(Change::state);
}

/// Where the checkpoint's scene had others, they are where the present scene says.
void Simulation::restore_obstacles(const std::vector<Pose>& poses) {
  std::vector<Pose> of_scene;
  for (std::size_t k = 0; k < scene_.obstacles.size(); ++k)
    of_scene.push_back(pose_in_transition(scene_.obstacles, carries_, k, state_.time));
  continuous_contact_->set_poses(poses.size() == of_scene.size() ? poses : of_scene);
}

void Simulation::set_threads(int threads, ThreadUse use) {
  auto team = threads > 1 ? std::make_unique<WorkerTeam>(threads) : nullptr;
  thread_use_ = use;
  team_.swap(team);
  share_work();
}

/// Among the threads of the team, if there is one.
void Simulation::share_work() {
  if (forces_->sweep()) forces_->sweep()->set_team(team_.get(), thread_use_);
  if (continuous_contact_) continuous_contact_->set_team(team_.get());
}

int Simulation::threads() const {
  return forces_->sweep() ? forces_->sweep()->threads() : 1;
}

void Simulation::set_brush(const std::optional<BrushGust>& brush) {
  brush_ = brush;
  if (brush && quantities_.air) quantities_.brush = true;
  forces_->set_brush(brush);
  choose_stepper();
}

void Simulation::set_pull(const std::optional<Pull>& pull) {
  pull_ = pull;
  if (pull) quantities_.pull = true;
  hand_energy_ = std::max(hand_energy_, hand_energy());
  forces_->set_pull(pull, pull_strength_.stiffness, pull_strength_.damping);
  choose_stepper();
}

Pose Simulation::obstacle_pose(std::size_t obstacle, double time) const {
  if (continuous_contact_ && time == state_.time) return continuous_contact_->poses()[obstacle];
  return pose_in_transition(scene_.obstacles, carries_, obstacle, time);
}

void Simulation::append_contact_marks(std::vector<ContactMark>& marks) const {
  if (contact_) contact_->append_marks(state_.position, marks);
  if (continuous_contact_) continuous_contact_->append_marks(state_.position, marks);
}

int Simulation::hierarchy_depth(int obstacle) const {
  return continuous_contact_ ? continuous_contact_->hierarchy_depth(obstacle) : 0;
}

void Simulation::append_hierarchy_boxes(int obstacle, int level, std::vector<Bounds>& boxes) {
  if (continuous_contact_) continuous_contact_->append_boxes(obstacle, level, state_.position, boxes);
}

double Simulation::total_energy() const {
  return measure_energy(system_, gravity_of(scene_), state_).total();
}

Measurement Simulation::measure() const {
  return {.time = state_.time,
          .step = state_.step,
          .energy = measure_energy(system_, gravity_of(scene_), state_),
          .ledger = ledger_,
          .strain = measure_strain(system_, state_.position),
          .limiter_sweeps = last_limit_.sweeps,
          .limiter_excess = last_limit_.excess,
          .contacts = last_contact_.contacts,
          .held_back = last_contact_.held_back,
          .contact_impulse = contact_impulse_};
}

}  // namespace cloth
