#include "fuzz/small_scene.h"

#include <nlohmann/json.hpp>

#include "io/json_syntax.h"
#include "scene/scene_checks.h"
#include "simulation/simulation.h"
#include "simulation/stages.h"
#include "simulation/time_step.h"

namespace cloth::test {
namespace {

using json = nlohmann::json;

double number_in(const json& object, const char* key, double otherwise) {
  if (!object.is_object()) return otherwise;
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

/// Of the cloth of a scene, or of a scene within.
bool is_small(const json& value) {
  if (!value.is_structured()) return true;
  constexpr double max_particles = 3000;
  if (value.is_object() && number_in(value, "rows", 33) * number_in(value, "columns", 33) > max_particles)
    return false;
  return std::all_of(value.begin(), value.end(), is_small);
}

}  // namespace

bool stays_small(const std::string& json_text) {
  return syntax_problem(json_text, "") || is_small(json::parse(json_text));
}

void take_few_steps(const Scene& scene) {
  constexpr int max_particles = 100, steps = 3;
  if (scene.cloth.rows * scene.cloth.columns > max_particles) return;
  explain_stages(scene);
  const auto time_step = resolved_time_step(scene);
  if (!time_step || scene.contact || scene.self_contact || too_many_steps(scene.duration, *time_step)) return;
  Simulation simulation(scene);
  simulation.advance(steps);
  simulation.measure();
}

}  // namespace cloth::test
