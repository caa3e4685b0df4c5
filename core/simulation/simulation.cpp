#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/sums.h"
#include "contact/continuous_contact.h"
#include "forces/gravity.h"
#include "integrators/registry.h"
#include "kernels/worker_team.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_parameters.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

/// A kinetic energy this many times all that the scene can give is a run that has run away.
constexpr double runaway_factor = 10;

/// Of the energy of all springs at twice their length: far above rounding, far below anything that moves.
constexpr double rounding_floor = 1e-6;

double elastic_scale_of(const ClothSystem& system) {
  double energy = 0;
  for (const SpringRun& run : system.springs)
    energy += 0.5 * run.stiffness * run.rest_length * run.rest_length * run.count;
  return energy;
}

std::optional<int> first_not_finite(const Vec3Field& field) {
  for (std::size_t i = 0; i < field.size(); ++i)
    if (!field[i].allFinite()) return static_cast<int>(i);
  return std::nullopt;
}

Vec3 gravity_of(const Scene& scene) {
  return scene.gravity.value_or(Vec3::Zero());
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
  system_ = make_grid(scene_.cloth, material_of(scene_));
  state_ = starting_state(system_);
  if (prepare_) prepare_(system_, state_);
  time_step_ = resolved_time_step(scene_).value();
  integrator_ = make_integrator(scene_.integrator);
  assemble();
  limit_start();
  ledger_.initial = total_energy();
}

Simulation::~Simulation() = default;

void Simulation::assemble() {
  forces_ = std::make_unique<ForceModel>(scene_, system_);
  forces_->set_team(team_.get());
  limiter_.reset();
  if (scene_.deformation && DeformationLimiter::is_needed(*scene_.deformation, system_))
    limiter_.emplace(*scene_.deformation, system_);
  contact_.reset();
  continuous_contact_.reset();
  if (has_continuous_contact(scene_))
    continuous_contact_ = std::make_unique<ContinuousContact>(scene_, system_);
  else if (!scene_.obstacles.empty())
    contact_.emplace(scene_.obstacles);
  unreachable_ = find_unreachable_rate(scene_, system_, state_.position);
  elastic_scale_ = elastic_scale_of(system_);
  total_mass_ = system_.total_mass();
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

/// A hand as strong as the step allows: it may not push the fastest oscillation over the method's limit. A
/// method without a limit takes the strongest hand.
PullStrength Simulation::find_strongest_pull() const {
  const double mass = *std::min_element(system_.mass.begin(), system_.mass.end());
  const SpringMaterial material = material_of(scene_);
  const double omega = largest_frequency(scene_.cloth, material);
  const double limit = stable_step(scene_.integrator.method, scene_).value_or(0);
  const double allowed = limit > 0 && std::isfinite(limit) ? omega * limit / time_step_ : 1 / time_step_;
  const double strongest =
      std::max(2 * (material.structural + material.shear + material.flexion), 1e3 * mass);
  if (stable_at_every_step(scene_.integrator.method)) return {strongest, std::sqrt(strongest * mass)};
  const double stiffness = std::clamp(0.5 * mass * (allowed * allowed - omega * omega), 0.0, strongest);
  return {stiffness, std::min(std::sqrt(stiffness * mass), 0.1 * mass / time_step_)};
}

void Simulation::limit_pull(const std::optional<PullStrength>& most) {
  if (most == most_pull_) return;
  most_pull_ = most;
  apply_hand();
  integrator_->forget(Change::forces);
}

void Simulation::apply_hand() {
  pull_strength_ = strongest_pull_;
  if (most_pull_) {
    pull_strength_.stiffness = std::min(pull_strength_.stiffness, most_pull_->stiffness);
    pull_strength_.damping = std::min(pull_strength_.damping, most_pull_->damping);
  }
  forces_->set_brush(brush_);
  forces_->set_pull(pull_, pull_strength_.stiffness, pull_strength_.damping);
}

std::optional<Divergence> Simulation::step() {
  const std::int64_t next = state_.step + 1;
  const StepTimes times{state_.time, first_time_ + static_cast<double>(next - first_step_) * time_step_,
                        time_step_};
  if (continuous_contact_) position_before_ = state_.position;
  const IntegratorReport report = integrator_->step(system_, *forces_, times, state_, ledger_.forces);
  if (limiter_ && !report.failure) limit_deformation();
  if (contact_ && !report.failure) resolve_contact();
  if (continuous_contact_ && !report.failure) resolve_continuous_contact(times);
  state_.time = times.end;
  state_.step = next;
  count_step(report);

  if (last_contact_.pinch && !report.failure) return stop_at_pinch(*last_contact_.pinch);
  if (!report.failure) return find_divergence(report);
  Divergence stop = stop_at(report.failure->particle, report.failure->cause);
  stop.solver_failed = true;
  return stop;
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

/// A start beyond the rate was not reached by any motion, so that bringing it within the rate makes none.
void Simulation::limit_start() {
  if (!prepare_ || !limiter_ || limiter_->accepts(limiter_->excess(state_.position))) return;
  const Vec3Field velocity = state_.velocity;
  limiter_->set_unreachable(unreachable_.has_value());
  limiter_->apply(system_, time_step_, state_);
  state_.velocity = velocity;
}

void Simulation::limit_deformation() {
  last_limit_ = {.sweeps = 0, .direct_iterations = 0, .excess = limiter_->excess(state_.position)};
  if (limiter_->accepts(last_limit_.excess)) return;
  limiter_->set_unreachable(unreachable_.has_value());
  last_limit_ = limiter_->apply(system_, time_step_, state_);
  ledger_.limiter += limiter_->work(system_, gravity_of(scene_), time_step_, state_);
  integrator_->forget(Change::state);
}

void Simulation::resolve_contact() {
  last_contact_ = {};
  if (!contact_->touches(system_, state_)) return;
  const double before = total_energy();
  last_contact_ = contact_->apply(system_, state_);
  ledger_.contact += total_energy() - before;
  integrator_->forget(Change::state);
}

void Simulation::resolve_continuous_contact(const StepTimes& times) {
  last_contact_ = {};
  const ContactTimes contact_times{times.begin, times.end, times.step};
  if (!continuous_contact_->is_near(position_before_, contact_times, state_)) return;
  const double before = total_energy();
  last_contact_ = continuous_contact_->apply(system_, position_before_, contact_times, state_);
  if (!last_contact_.acted) return;
  ledger_.contact += total_energy() - before;
  integrator_->forget(Change::state);
}

void Simulation::edit(const Scene& scene) {
  const double before = total_energy();
  const bool new_method = !is_same_method(scene.integrator, scene_.integrator);
  scene_ = scene;
  const Vec3Field start = std::move(system_.start);
  system_ = make_grid(scene_.cloth, material_of(scene_));
  if (prepare_) {
    ClothState unused = starting_state(system_);
    prepare_(system_, unused);
  }
  system_.start = start;
  for (std::size_t i = 0; i < state_.velocity.size(); ++i)
    if (system_.pinned[i]) state_.velocity.set(i, Vec3::Zero());

  const double time_step = resolved_time_step(scene_).value();
  if (time_step != time_step_) {
    first_time_ = state_.time;
    first_step_ = state_.step;
    time_step_ = time_step;
  }
  if (new_method) integrator_ = make_integrator(scene_.integrator);
  assemble();
  integrator_->forget(Change::state);
  ledger_.initial += total_energy() - before;
}

std::size_t Checkpoint::bytes() const {
  std::size_t numbers = memory.numbers.size() + state.position.flat().size() + state.velocity.flat().size();
  for (const Vec3Field& field : memory.fields) numbers += field.flat().size();
  return sizeof(Checkpoint) + sizeof(double) * numbers;
}

Checkpoint Simulation::checkpoint() const {
  return {.state = state_,
          .method = scene_.integrator.method,
          .memory = integrator_->remember(),
          .ledger = ledger_,
          .time_step = time_step_,
          .first_time = first_time_,
          .first_step = first_step_,
          .brush = brush_,
          .pull = pull_,
          .quantities = quantities_,
          .count = count_,
          .last_limit = last_limit_,
          .last_contact = last_contact_};
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
  const bool same_step = checkpoint.time_step == time_step_;
  first_time_ = same_step ? checkpoint.first_time : state_.time;
  first_step_ = same_step ? checkpoint.first_step : state_.step;
  last_limit_ = checkpoint.last_limit;
  last_contact_ = checkpoint.last_contact;
  unreachable_ = find_unreachable_rate(scene_, system_, state_.position);
  if (checkpoint.method == scene_.integrator.method)
    integrator_->recall(checkpoint.memory);
  else
    integrator_->forget(Change::state);
}

void Simulation::set_threads(int threads) {
  forces_->set_team(nullptr);
  team_ = threads > 1 ? std::make_unique<WorkerTeam>(threads) : nullptr;
  forces_->set_team(team_.get());
}

int Simulation::threads() const {
  return forces_->threads();
}

void Simulation::set_brush(const std::optional<BrushGust>& brush) {
  brush_ = brush;
  if (brush && quantities_.air) quantities_.brush = true;
  forces_->set_brush(brush);
  integrator_->forget(Change::forces);
}

void Simulation::set_pull(const std::optional<Pull>& pull) {
  pull_ = pull;
  if (pull) quantities_.pull = true;
  forces_->set_pull(pull, pull_strength_.stiffness, pull_strength_.damping);
  integrator_->forget(Change::forces);
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
          .held_back = last_contact_.held_back};
}

/// The kinetic energy that the scene can give: the fall so far (or over the cloth's own length), the full
/// wind, what the hand did, what there was at the start.
double Simulation::energy_scale_after(double fallen) const {
  const double mass = total_mass_;
  const double drop = mass * gravity_of(scene_).norm() * system_.diagonal;
  double wind = 0;
  if (scene_.air) wind = scene_.air->wind.norm() * (1 + (scene_.air->gust ? scene_.air->gust->amplitude : 0));
  return std::max(drop, fallen) + 0.5 * mass * wind * wind + std::abs(ledger_.forces.brush) +
         std::abs(ledger_.forces.pull) + std::abs(ledger_.initial) + rounding_floor * elastic_scale_;
}

double Simulation::energy_scale() const {
  return energy_scale_after(-gravity_energy(system_, gravity_of(scene_), state_.position));
}

bool Simulation::has_run_away(double kinetic) const {
  if (!std::isfinite(kinetic)) return true;
  if (kinetic <= runaway_factor * energy_scale_after(0)) return false;
  return !(kinetic <= runaway_factor * energy_scale());
}

/// Finite positions and a finite sum of squares give finite positions; and where even the heaviest mass for
/// all does not make the speeds too much, nothing has run away. Only else the state is looked at.
std::optional<Divergence> Simulation::find_divergence(const IntegratorReport& report) {
  if (report.speed_squares && was_finite_ && !limiter_ && !contact_ && !continuous_contact_ &&
      0.5 * largest_mass_ * *report.speed_squares <= runaway_factor * energy_scale_after(0))
    return std::nullopt;
  const auto x = state_.position.flat();
  // A sum of finite terms is finite short of overflow; one that is not asks for a closer look.
  const double sum = ordered_sum(x.size(), [p = x.data()](std::size_t k) { return p[k]; });
  const bool lost = !std::isfinite(sum) && first_not_finite(state_.position);
  was_finite_ = !lost;
  if (!lost && !has_run_away(kinetic_energy(system_, state_.velocity))) return std::nullopt;
  return stop_at_fastest("its speed has run away");
}

Divergence Simulation::stop_at_fastest(const std::string& cause) const {
  if (const auto i = first_not_finite(state_.velocity)) return stop_at(*i, "its velocity is not finite");
  if (const auto i = first_not_finite(state_.position)) return stop_at(*i, "its position is not finite");
  int fastest = 0;
  double highest_speed = -1;
  for (std::size_t i = 0; i < state_.velocity.size(); ++i) {
    if (const double speed = state_.velocity[i].stableNorm(); speed > highest_speed) {
      highest_speed = speed;
      fastest = static_cast<int>(i);
    }
  }
  return stop_at(fastest, cause);
}

/// The longest stable step in s, 0 if there is none. Of a prepared cloth only the bound for any shape is
/// known.
double Simulation::method_limit() const {
  const auto of_scene = stable_step(scene_.integrator.method, scene_);
  if (!of_scene || !prepare_ || std::isinf(*of_scene)) return of_scene.value_or(0);
  const auto of_system =
      stable_step(scene_.integrator.method, guaranteed_frequency(system_), damping_rates(scene_));
  return std::min(*of_scene, of_system.value_or(0));
}

Divergence Simulation::stop_at_pinch(const Pinch& pinch) const {
  Divergence stop = stop_at(
      pinch.particle, fmt::format("obstacle {} cannot go on without passing through the cloth, which is held "
                                  "at ({:.4g}, {:.4g}, {:.4g}) m",
                                  pinch.obstacle, pinch.place.x(), pinch.place.y(), pinch.place.z()));
  stop.pinched = true;
  return stop;
}

Divergence Simulation::stop_at(int particle, std::string cause) const {
  Divergence divergence;
  divergence.step = state_.step;
  divergence.time = state_.time;
  divergence.particle = particle;
  divergence.cause = std::move(cause);
  divergence.time_step = time_step_;
  divergence.stable_step = method_limit();
  divergence.row = divergence.particle / system_.columns;
  divergence.column = divergence.particle % system_.columns;
  return divergence;
}

}  // namespace cloth
