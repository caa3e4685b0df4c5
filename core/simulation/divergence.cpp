// When a run has diverged, and what a stop says.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cloth/sums.h"
#include "contact/continuous_contact.h"
#include "forces/gravity.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_parameters.h"
#include "simulation/simulation.h"

namespace cloth {
namespace {

/// A run has diverged whose unexplained energy is this many times all that the scene can give.
constexpr double divergence_factor = 10;

/// Of the energy of all springs at twice their length: far above rounding, far below anything that moves.
constexpr double rounding_floor = 1e-6;

std::optional<int> first_not_finite(const Vec3Field& field) {
  for (std::size_t i = 0; i < field.size(); ++i)
    if (!field[i].allFinite()) return static_cast<int>(i);
  return std::nullopt;
}

/// As a form calls it and as a file does: "sphere 1 (obstacles.0)".
std::string obstacle_in_words(const Scene& scene, int obstacle) {
  const std::string path = fmt::format("obstacles.{}", obstacle);
  for (const Block& block : blocks_of(scene)) {
    if (block.path != path) continue;
    std::string title = block.title;
    title.front() = static_cast<char>(std::tolower(title.front()));
    return fmt::format("{} ({})", title, path);
  }
  return path;
}

std::string holder_in_words(const Scene& scene, const Pinch& pinch) {
  switch (pinch.holder) {
    case Pinch::Holder::pin:
      return " by a pin";
    case Pinch::Holder::obstacle:
      return " by " + obstacle_in_words(scene, pinch.holding_obstacle);
    case Pinch::Holder::itself:
      return " by other parts of it";
    case Pinch::Holder::unknown:
      break;
  }
  return "";
}

}  // namespace

/// The energy that the scene can put into motion whatever has been done to it: a fall over the cloth's own
/// length, the full wind, moving obstacles, what there was at the start.
double Simulation::steady_energy_scale() const {
  const double mass = total_mass_;
  const double drop = mass * gravity_of(scene_).norm() * system_.diagonal;
  double wind = 0;
  if (scene_.air) wind = scene_.air->wind.norm() * (1 + (scene_.air->gust ? scene_.air->gust->amplitude : 0));
  const double struck = 2 * run_.obstacle_speed;  // at most, off an obstacle that gives all speed back
  return drop + 0.5 * mass * (wind * wind + struck * struck) + std::abs(run_.ledger.initial) +
         rounding_floor * elastic_scale_;
}

/// The same with a longer fall so far, what the hand did and could ever have done, and what entered
/// elsewhere.
double Simulation::energy_scale_after(double fallen) const {
  const double drop = total_mass_ * gravity_of(scene_).norm() * system_.diagonal;
  const double hand = std::abs(run_.ledger.forces.brush) + std::abs(run_.ledger.forces.pull) +
                      std::max(run_.hand_energy, hand_energy());
  return steady_energy_scale() + std::max(0.0, fallen - drop) + hand + std::abs(run_.ledger.contact);
}

/// J, of the spring by which the hand pulls.
double Simulation::hand_energy() const {
  if (!run_.pull) return 0;
  const Vec3 way = run_.pull->target - run_.state.position[static_cast<std::size_t>(run_.pull->particle)];
  return 0.5 * pull_strength_.stiffness * way.squaredNorm();
}

double Simulation::energy_scale() const {
  return energy_scale_after(-gravity_energy(system_, gravity_of(scene_), run_.state.position));
}

/// Faster than the scene explains at a glance. Not yet diverged: contact may have given all of it.
bool Simulation::is_fast(double kinetic) const {
  return !(kinetic <= divergence_factor * energy_scale_after(0));
}

/// By the ledger: whether more energy has come or gone, kinetic, elastic or of height, than works and losses
/// and ten times what the scene could give explain. What a limiter has taken out may be missing once more; it
/// explains no gain.
bool Simulation::has_diverged() const {
  const Energy energy = energy_of(run_.state);
  const double unexplained = energy.total() - run_.ledger.initial - run_.ledger.entered();
  const double missing = unexplained < 0 ? std::abs(run_.ledger.limiter) : 0;
  return !(std::abs(unexplained) <= divergence_factor * (energy_scale_after(-energy.gravity) + missing));
}

/// Even if the heaviest mass were that of all. `speed_squares`: sum of |v|^2, (m/s)^2. Where the step is
/// watched, so slow that heating can wait for the next look at the ledger.
bool Simulation::is_surely_slow(double speed_squares) const {
  const double kinetic = 0.5 * largest_mass_ * speed_squares;
  if (watches_step_) return kinetic <= steady_energy_scale();
  return kinetic <= divergence_factor * energy_scale_after(0);
}

/// Finite positions and a finite sum of squares give finite positions; and where even the heaviest mass for
/// all does not make the speeds too much, nothing has diverged: unless contact, or a limiter after the
/// method's step, has changed them since. Only otherwise, and where a method without a limit or "auto" asks
/// for it every few steps, the ledger is looked at.
std::optional<Divergence> Simulation::find_divergence(const IntegratorReport& report) {
  const bool looks = watches_ledger_ && run_.state.step % ledger_interval == 0;
  const bool are_last = !contact_ && (!limiter_ || limits_drift_);
  if (!looks && report.speed_squares && was_finite_ && are_last && is_surely_slow(*report.speed_squares))
    return std::nullopt;
  const auto x = run_.state.position.flat();
  // A sum of finite terms is finite short of overflow; one that is not asks for a closer look.
  const double sum = ordered_sum(x.size(), [p = x.data()](std::size_t k) { return p[k]; });
  const bool lost = !std::isfinite(sum) && first_not_finite(run_.state.position);
  was_finite_ = !lost;
  if (!lost && !looks && !is_fast(kinetic_energy(system_, run_.state.velocity))) return std::nullopt;
  if (!lost && !has_diverged()) return std::nullopt;
  return stop_at_fastest("its energy is out of bounds");
}

Divergence Simulation::stop_at_fastest(const std::string& cause) const {
  if (const auto i = first_not_finite(run_.state.velocity)) return stop_at(*i, "its velocity is not finite");
  if (const auto i = first_not_finite(run_.state.position)) return stop_at(*i, "its position is not finite");
  int fastest = 0;
  double highest_speed = -1;
  for (std::size_t i = 0; i < run_.state.velocity.size(); ++i) {
    if (const double speed = run_.state.velocity[i].stableNorm(); speed > highest_speed) {
      highest_speed = speed;
      fastest = static_cast<int>(i);
    }
  }
  return stop_at(fastest, cause);
}

/// The longest step in s that is stable in every shape, 0 if there is none.
double Simulation::method_limit() const {
  const auto of_scene = guaranteed_step(scene_.integrator.method, scene_);
  if (!of_scene || !prepare_ || std::isinf(*of_scene)) return of_scene.value_or(0);
  const auto of_system =
      stable_step(scene_.integrator.method, guaranteed_frequency(system_), damping_rates(scene_));
  return std::min(*of_scene, of_system.value_or(0));
}

Divergence Simulation::stop_at_pinch(const Pinch& pinch) const {
  Divergence stop = stop_at(
      pinch.particle, fmt::format("{} cannot go on without passing through the cloth, which is held{} at "
                                  "({:.4g}, {:.4g}, {:.4g}) m",
                                  obstacle_in_words(scene_, pinch.obstacle), holder_in_words(scene_, pinch),
                                  pinch.place.x(), pinch.place.y(), pinch.place.z()));
  stop.pinched = true;
  return stop;
}

Divergence Simulation::stop_at_exhaustion(const Pinch& pinch) const {
  Divergence stop = stop_at(
      pinch.particle,
      fmt::format(
          "{} goes so far in a step that contact has not followed it within the work that a step may be, "
          "last at ({:.4g}, {:.4g}, {:.4g}) m",
          obstacle_in_words(scene_, pinch.obstacle), pinch.place.x(), pinch.place.y(), pinch.place.z()));
  stop.solver_failed = true;
  return stop;
}

Divergence Simulation::stop_at(int particle, std::string cause) const {
  Divergence divergence;
  divergence.step = run_.state.step;
  divergence.time = run_.state.time;
  divergence.particle = particle;
  divergence.cause = std::move(cause);
  divergence.time_step = run_.time_step;
  divergence.stable_step = method_limit();
  divergence.on_grid = !system_.is_mesh();
  divergence.row = divergence.particle / system_.columns;
  divergence.column = divergence.particle % system_.columns;
  return divergence;
}

}  // namespace cloth
