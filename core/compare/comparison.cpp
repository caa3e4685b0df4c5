#include "compare/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <set>

#include "contact/start_check.h"
#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_parameters.h"
#include "simulation/time_step.h"
#include "study/reference_solution.h"

namespace cloth {
namespace {

const std::string method_path = "integrator.method";
constexpr double controlled_tolerance = 1e-11;         // of the diagonal, for each inner step
constexpr double controlled_limiter_tolerance = 1e-6;  // of the rest length
constexpr double controlled_part = 0.125;              // of the panes' shortest step

void apply(const OwnValue& own, Scene& scene) {
  const auto parameter = find_parameter(scene, own.path);
  if (!parameter) return;
  parameter->set(scene, own.value);
  load_meshes(scene);  // what cannot be read is found with the scene's other problems
}

double shortest_step(const Comparison& comparison) {
  double shortest = infinity;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    shortest = std::min(shortest, resolved_time_step(scene_of(comparison, i)).value_or(infinity));
  return shortest;
}

const char* first_free_name(const Comparison& comparison) {
  for (const char* name : pane_names)
    if (!find_pane(comparison, name)) return name;
  return nullptr;
}

std::string place_of(std::size_t pane, const std::string& key) {
  return fmt::format("panes.{}.{}", pane, key);
}

/// The rules of the comparison itself.
void check_panes(const Comparison& comparison, std::vector<Problem>& problems) {
  const std::size_t count = comparison.panes.size();
  if (count < least_panes || count > max_panes)
    problems.push_back({"panes", fmt::format("{} panes", count),
                        fmt::format("must be {} to {}", least_panes, max_panes), "", 0, 0});
  std::set<std::string> names;
  for (std::size_t i = 0; i < count && count <= max_panes; ++i) {  // of too many, some have no name
    const std::string& name = comparison.panes[i].name;
    const std::string shown = fmt::format("\"{}\"", name);
    if (std::find(std::begin(pane_names), std::end(pane_names), name) == std::end(pane_names))
      problems.push_back({place_of(i, "name"), shown,
                          fmt::format("must be one of {}", fmt::join(pane_names, ", ")), "", 0, 0});
    else if (!names.insert(name).second)
      problems.push_back({place_of(i, "name"), shown, "is another pane's name too", "", 0, 0});
  }
  const std::string& reference = comparison.reference;
  if (reference != controlled_reference && reference != no_reference && !find_pane(comparison, reference))
    problems.push_back(
        {"reference", fmt::format("\"{}\"", reference),
         fmt::format("must be the name of a pane, \"{}\" or \"{}\"", controlled_reference, no_reference), "",
         0, 0});
}

/// What is wrong with the paths of the pane's own values.
void check_own_paths(const Comparison& comparison, std::size_t pane, std::vector<Problem>& problems) {
  const Scene scene = scene_of(comparison, pane);
  std::set<std::string> paths;
  for (const OwnValue& own : comparison.panes[pane].own) {
    const std::string place = place_of(pane, "own." + own.path);
    if (const auto rule = must_be_shared(own.path))
      problems.push_back({place, "", *rule, "", 0, 0});
    else if (!find_parameter(scene, own.path))
      problems.push_back({place, "", "there is no such parameter in this pane's scene", "", 0, 0});
    else if (!paths.insert(own.path).second)
      problems.push_back({place, "", "is given more than once", "", 0, 0});
  }
}

/// What is wrong with the pane's scene and not with the shared one.
void check_pane_scene(const Comparison& comparison, std::size_t pane, const std::vector<Problem>& shared,
                      std::vector<Problem>& problems) {
  const Scene scene = scene_of(comparison, pane);
  bool sound = shared.empty();
  for (Problem& problem : find_problems(scene)) {
    sound = false;
    const bool known = std::any_of(shared.begin(), shared.end(), [&](const Problem& other) {
      return other.path == problem.path && other.value == problem.value && other.rule == problem.rule;
    });
    if (known) continue;
    problem.path = own_value(comparison.panes[pane], problem.path) ? place_of(pane, "own." + problem.path)
                                                                   : place_of(pane, problem.path);
    problems.push_back(std::move(problem));
  }
  if (sound && !resolved_time_step(scene))
    problems.push_back({fmt::format("panes.{}", pane), "", no_stable_step_text(scene), "", 0, 0});
}

/// Whether a new pane can go on from the state of the one before it, as duplicate_pane leaves them.
bool is_copy(const Comparison& before, const Comparison& after, std::size_t pane) {
  if (pane == 0 || !find_pane(before, after.panes[pane - 1].name)) return false;
  return scene_of(after, pane) == scene_of(after, pane - 1);
}

}  // namespace

std::vector<Pane> panes_for(const std::vector<std::string>& methods) {
  assert(methods.size() <= max_panes);
  std::vector<Pane> panes;
  for (const std::string& method : methods)
    panes.push_back({.name = pane_names[panes.size()], .title = {}, .own = {{method_path, method}}});
  return panes;
}

Comparison comparison_of_one(Scene scene, const std::string& reference) {
  return {.title = {},
          .scene = std::move(scene),
          .panes = {{.name = pane_names[0], .title = {}, .own = {}}},
          .reference = reference};
}

Scene scene_of(const Comparison& comparison, std::size_t pane) {
  Scene scene = comparison.scene;
  const std::vector<OwnValue>& own = comparison.panes[pane].own;
  for (const OwnValue& value : own)  // first, as the method decides which settings there are
    if (value.path == method_path) apply(value, scene);
  for (const OwnValue& value : own)
    if (value.path != method_path) apply(value, scene);
  return scene;
}

ControlledScenes controlled_scenes(const Comparison& comparison) {
  Scene scene = comparison.scene;
  const double interval = scene.record.interval;
  if (is_smooth(scene)) {
    scene.integrator = {.method = "dormand-prince", .time_step = interval, .tolerance = controlled_tolerance};
    Scene check = scene;
    check.integrator.tolerance = 10 * controlled_tolerance;
    return {std::move(scene), std::move(check)};
  }
  scene.integrator = {.method = "verlet"};
  const double stable = stable_step("verlet", scene).value_or(infinity);
  const double longest = controlled_part * std::min({shortest_step(comparison), stable, interval});
  if (scene.deformation)
    scene.deformation->tolerance = std::min(scene.deformation->tolerance, controlled_limiter_tolerance);
  Scene check = scene;
  check.integrator.time_step = step_dividing(interval, 2 * longest);
  scene.integrator.time_step = *check.integrator.time_step / 2;
  return {std::move(scene), std::move(check)};
}

std::string title_of(const Comparison& comparison, std::size_t pane) {
  const std::string& title = comparison.panes[pane].title;
  return title.empty() ? facts_of(scene_of(comparison, pane).integrator.method).title : title;
}

std::optional<std::size_t> find_pane(const Comparison& comparison, const std::string& name) {
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    if (comparison.panes[i].name == name) return i;
  return std::nullopt;
}

int style_of(const Pane& pane) {
  const auto* found = std::find(std::begin(pane_names), std::end(pane_names), pane.name);
  return static_cast<int>(found - std::begin(pane_names));
}

std::optional<std::string> must_be_shared(const std::string& path) {
  if (path == "cloth.rows" || path == "cloth.columns" || path == "cloth.cut" || path == "cloth.mesh")
    return "must be shared: each particle of a pane is compared with the same one of the others";
  if (path.rfind("cloth.pins", 0) == 0) return "must be shared: pins act on all panes alike";
  if (path == "duration" || path == "record.interval")
    return "must be shared: the panes are compared at the same times";
  if (path.rfind("probes", 0) == 0) return "must be shared: probes measure all panes alike";
  if (path == "title") return "must be shared: a pane has a \"title\" of its own beside its values";
  return std::nullopt;
}

const ParameterValue* own_value(const Pane& pane, const std::string& path) {
  for (const OwnValue& own : pane.own)
    if (own.path == path) return &own.value;
  return nullptr;
}

std::vector<std::string> own_paths(const Comparison& comparison) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    for (const Parameter& parameter : parameters_of(scene_of(comparison, i)))
      if (own_value(comparison.panes[i], parameter.path) &&
          std::find(paths.begin(), paths.end(), parameter.path) == paths.end())
        paths.push_back(parameter.path);
  return paths;
}

void set_own(Pane& pane, const std::string& path, ParameterValue value) {
  assert(!must_be_shared(path));
  for (OwnValue& own : pane.own)
    if (own.path == path) {
      own.value = std::move(value);
      return;
    }
  pane.own.push_back({path, std::move(value)});
}

void set_shared(Pane& pane, const std::string& path) {
  std::erase_if(pane.own, [&](const OwnValue& own) { return own.path == path; });
}

void set_shared_value(Comparison& comparison, const std::string& path, const ParameterValue& value) {
  const auto parameter = find_parameter(comparison.scene, path);
  assert(parameter);
  parameter->set(comparison.scene, value);
  load_meshes(comparison.scene);
}

Comparison moved_to_folder(const Comparison& comparison, const std::string& folder) {
  Comparison moved = comparison;
  moved.scene = moved_to_folder(comparison.scene, folder);
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    const Scene from = scene_of(comparison, i), to = moved_to_folder(from, folder);
    for (OwnValue& own : moved.panes[i].own) {
      const auto parameter = find_parameter(from, own.path);
      if (parameter && parameter->get(from) != parameter->get(to)) own.value = parameter->get(to);
    }
  }
  return moved;
}

std::vector<std::string> mesh_files(const Comparison& comparison) {
  std::set<std::string> files;
  const auto add = [&](const Scene& scene) {
    for (const std::string& file : mesh_files(scene)) files.insert(file);
  };
  add(comparison.scene);
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) add(scene_of(comparison, i));
  return {files.begin(), files.end()};
}

std::size_t duplicate_pane(Comparison& comparison, std::size_t pane) {
  assert(comparison.panes.size() < max_panes);
  Pane copy = comparison.panes[pane];
  copy.name = first_free_name(comparison);
  comparison.panes.insert(comparison.panes.begin() + static_cast<std::ptrdiff_t>(pane) + 1, std::move(copy));
  return pane + 1;
}

void remove_pane(Comparison& comparison, std::size_t pane) {
  assert(comparison.panes.size() > 1);
  if (comparison.reference == comparison.panes[pane].name) comparison.reference = controlled_reference;
  comparison.panes.erase(comparison.panes.begin() + static_cast<std::ptrdiff_t>(pane));
}

std::vector<Problem> find_problems(const Comparison& comparison) {
  std::vector<Problem> problems;
  const std::vector<Problem> shared = find_problems(comparison.scene);
  for (Problem problem : shared) {
    problem.path = "scene." + problem.path;
    problems.push_back(std::move(problem));
  }
  check_panes(comparison, problems);
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    check_own_paths(comparison, i, problems);
    check_pane_scene(comparison, i, shared, problems);
  }
  return problems;
}

std::vector<Problem> find_start_problems(const Comparison& comparison) {
  const auto starts_alike = [](const Scene& a, const Scene& b) {
    return a.cloth == b.cloth && a.obstacles == b.obstacles && a.contact == b.contact &&
           a.self_contact == b.self_contact;
  };
  std::vector<Problem> problems;
  bool shared_is_checked = false;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    const Scene scene = scene_of(comparison, i);
    const bool shared = starts_alike(scene, comparison.scene);
    if (shared && shared_is_checked) continue;
    shared_is_checked = shared_is_checked || shared;
    for (Problem& problem : find_start_problems(scene)) {
      problem.path = shared ? "scene." + problem.path : place_of(i, problem.path);
      problems.push_back(std::move(problem));
    }
  }
  return problems;
}

bool acts_at_once(const Comparison& before, const Comparison& after) {
  if (after.reference == controlled_reference && before.reference != controlled_reference) return false;
  for (std::size_t i = 0; i < after.panes.size(); ++i) {
    const auto was = find_pane(before, after.panes[i].name);
    if (!was && !is_copy(before, after, i)) return false;
    if (!was) continue;
    const Scene one = scene_of(before, *was), other = scene_of(after, i);
    // What needs a new start belongs to the cloth and the recording, which every scene has.
    for (const Parameter& parameter : parameters_of(other))
      if (parameter.info.cost == EditCost::restart && parameter.get(one) != parameter.get(other))
        return false;
  }
  return true;
}

}  // namespace cloth
