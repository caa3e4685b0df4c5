#include "simulation/session.h"

#include <fmt/format.h>

#include "contact/start_check.h"
#include "io/fnv_hash.h"
#include "scene/scene_parameters.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

/// What only a new start can change: the sheet's particles and where they start.
std::vector<Problem> new_start_needed(const ClothSheet& before, const ClothSheet& after) {
  std::vector<Problem> problems;
  if (before.is_mesh() != after.is_mesh())
    return {{"cloth.mesh", after.mesh.file, "cannot change while a scene runs", "", 0, 0}};
  for (const Field<ClothSheet>& field : cloth_fields(before.is_mesh()))
    if (field.info.cost == EditCost::restart && field.get(before) != field.get(after))
      problems.push_back({"cloth." + field.info.key, value_text(field.info, field.get(after)),
                          "cannot change while a scene runs", "", 0, 0});
  return problems;
}

/// Contact keeps apart what it finds apart.
std::vector<Problem> own_meeting_now(const Simulation& simulation) {
  const std::optional<SelfIntersection> meeting = find_self_intersection(simulation.cloth_mesh());
  if (!meeting) return {};
  const Vec3 place = simulation.state().position[static_cast<std::size_t>(meeting->particle)];
  return {{"self_contact", "",
           fmt::format("the cloth {} itself now, first near particle {} at ({:.4g}, {:.4g}, {:.4g}) m",
                       meeting->passes ? "passes through" : "touches", meeting->particle, place.x(),
                       place.y(), place.z()),
           "", 0, 0}};
}

std::vector<Problem> carry_out_edits(const Edits& edits, Simulation& simulation) {
  SceneReading edited = edited_scene(simulation.scene(), edits);
  if (edited.scene) edited.problems = new_start_needed(simulation.scene().cloth, edited.scene->cloth);
  if (edited.problems.empty() && !resolved_time_step(*edited.scene))
    edited.problems.push_back({"integrator.time_step", "auto", no_stable_step_text(*edited.scene), "", 0, 0});
  if (edited.problems.empty() && edited.scene->self_contact && !simulation.scene().self_contact)
    edited.problems = own_meeting_now(simulation);
  for (Problem& problem : edited.problems) problem.path = "set." + problem.path;
  if (edited.problems.empty()) simulation.edit(*edited.scene);
  return std::move(edited.problems);
}

bool is_finite(const BrushGust& gust) {
  return gust.velocity.allFinite() && gust.world_to_screen.allFinite() && gust.cursor.allFinite() &&
         std::isfinite(gust.radius);
}

std::vector<Problem> carry_out_brush(const std::optional<BrushGust>& brush, Simulation& simulation) {
  if (brush && !is_finite(*brush)) return {{"brush", "", "must have numbers that are finite", "", 0, 0}};
  simulation.set_brush(brush);
  return {};
}

std::vector<Problem> carry_out_pull(const std::optional<Pull>& pull, Simulation& simulation) {
  const int particles = simulation.system().size();
  if (pull && (pull->particle < 0 || pull->particle >= particles))
    return {{"pull.particle", std::to_string(pull->particle),
             fmt::format("there is no such particle: this cloth has {}, from 0", particles), "", 0, 0}};
  if (pull && !pull->target.allFinite()) return {{"pull.target_m", "", "must be finite", "", 0, 0}};
  simulation.set_pull(pull);
  return {};
}

}  // namespace

std::string state_hash(const ClothState& state) {
  FnvHash hash;
  hash.add(state.position.flat());
  hash.add(state.velocity.flat());
  hash.add(std::span<const double>(&state.time, 1));
  hash.add(static_cast<std::uint64_t>(state.step));
  return hash.text();
}

std::vector<Problem> carry_out(const SessionAction& action, Simulation& simulation) {
  if (const auto* edits = std::get_if<Edits>(&action)) return carry_out_edits(*edits, simulation);
  if (const auto* brush = std::get_if<std::optional<BrushGust>>(&action))
    return carry_out_brush(*brush, simulation);
  return carry_out_pull(std::get<std::optional<Pull>>(action), simulation);
}

bool is_idle(const SessionAction& action, const Simulation& simulation) {
  if (const auto* edits = std::get_if<Edits>(&action)) return edits->empty();
  if (const auto* brush = std::get_if<std::optional<BrushGust>>(&action))
    return !*brush && !simulation.brush();
  return !std::get<std::optional<Pull>>(action) && !simulation.pull();
}

}  // namespace cloth
