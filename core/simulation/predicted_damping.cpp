#include "simulation/predicted_damping.h"

#include <algorithm>
#include <cmath>

#include "contact/continuous_contact.h"
#include "measure/stability_limit.h"
#include "scene/method_facts.h"

namespace cloth {
namespace {

/// Chosen so that the ledgers of `ball`, `cube` and `tablecloth` close to two per cent.
constexpr double largest_load_in_contact = 0.55;
/// So many steps take no more time than one that solves for its damping (docs/performance.md): where their
/// damping is in the pass of the forces, and where contact particle by particle costs its share of each step.
constexpr double steps_for_a_solve = 24, contact_steps_for_a_solve = 8;

bool touches_by_particles(const Scene& scene) {
  return !scene.obstacles.empty() && !has_continuous_contact(scene);
}

/// Dampers that couple the particles of a grid, in a scene whose steps cost little beside them.
bool has_dampers_to_predict(const Scene& scene) {
  if (!facts_of(scene.integrator.method).predicts_damping) return false;
  if (scene.cloth.is_mesh() || scene.cloth.is_cut() || has_continuous_contact(scene)) return false;
  if (scene.material) return scene.material->stretch_damping > 0 || scene.material->bending_damping > 0;
  return scene.springs && scene.springs->damping > 0;
}

double steps_for_a_solve_of(const Scene& scene) {
  return touches_by_particles(scene) ? contact_steps_for_a_solve : steps_for_a_solve;
}

}  // namespace

DampingLoads damping_loads(const Scene& scene, double step) {
  return {predicted_damping_load(scene, step), damping_load(scene, step)};
}

EndVelocity end_velocity_for(const Scene& scene, const DampingLoads& loads) {
  if (loads.whole <= allowed_damping_load(scene)) return EndVelocity::predicted;
  if (loads.damping <= largest_corrected_load) return EndVelocity::corrected;
  return loads.damping <= largest_corrected_twice_load ? EndVelocity::corrected_twice : EndVelocity::solved;
}

double allowed_damping_load(const Scene& scene) {
  return touches_by_particles(scene) ? largest_load_in_contact : largest_predicted_load;
}

double parts_to_predict(const Scene& scene, double interval, double parts) {
  if (!has_dampers_to_predict(scene)) return parts;
  const auto predicts = [&](double n) {
    return predicted_damping_load(scene, interval / n) <= allowed_damping_load(scene);
  };
  double too_few = parts - 1;
  double enough = std::max(parts + 1, std::floor(steps_for_a_solve_of(scene) * parts));
  if (!predicts(enough)) return parts;
  while (enough - too_few > 1) {
    const double half = std::floor(0.5 * (too_few + enough));
    (predicts(half) ? enough : too_few) = half;
  }
  return enough;
}

}  // namespace cloth
