#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cloth/cut_grid.h"
#include "cloth/mesh_cloth.h"
#include "commands.h"
#include "console.h"
#include "integrators/implicit/linear_choice.h"
#include "integrators/projective_matrix.h"
#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/stages.h"
#include "simulation/time_step.h"

namespace clothlab::cli {
namespace {

struct ExplainArguments {
  std::string scene;
  std::vector<std::string> settings;
  bool json = false;
};

using json = nlohmann::ordered_json;

struct MethodLimit {
  cloth::MethodFacts facts;
  std::optional<double> stable_step;      ///< s, of the flat cloth
  std::optional<double> guaranteed_step;  ///< s, in every shape
  std::optional<double> auto_step;        ///< s
};

/// How an implicit method would solve its linear systems in this scene.
struct LinearSolve {
  std::string method;
  cloth::LinearChoice choice;
};

struct Explanation {
  cloth::Scene scene;
  std::vector<cloth::StageInfo> stages;
  double largest_frequency = 0, guaranteed_frequency = 0, provot_step = 0;
  std::vector<MethodLimit> methods;
  std::vector<LinearSolve> linear_solves;
  std::string global_solve;  ///< of projective dynamics, if that is the scene's method
};

std::vector<LinearSolve> linear_solves(const cloth::Scene& scene, const std::vector<MethodLimit>& methods) {
  std::vector<LinearSolve> solves;
  const cloth::ClothSystem system = cloth::make_cloth(scene);
  for (const MethodLimit& method : methods) {
    const auto weight = method.facts.stage_weight;
    const auto step = scene.integrator.time_step ? scene.integrator.time_step : method.auto_step;
    if (!weight || !step) continue;
    const double h = *weight * *step;
    const cloth::LinearisationWeights weights{.position = h * h, .velocity = h, .clamped = false};
    solves.push_back({method.facts.name, cloth::choose_linear_method(system, weights)});
  }
  return solves;
}

std::string global_solve(const cloth::Scene& scene) {
  const auto step = cloth::resolved_time_step(scene);
  if (scene.integrator.method != "projective" || !step) return "";
  cloth::ProjectiveMatrix::Coefficients numbers;
  numbers.step = *step;
  cloth::ProjectiveMatrix matrix;
  bool usable = false;
  matrix.prepare(cloth::make_cloth(scene), numbers, &usable);
  if (matrix.uses_multigrid())
    return fmt::format("one cycle of multigrid an iteration, which leaves {:.2g} of an error",
                       *matrix.cycle_factor());
  if (matrix.cycle_factor())
    return fmt::format("Cholesky factors: a cycle of multigrid would leave {:.2g} of an error, more than {}",
                       *matrix.cycle_factor(), cloth::ProjectiveMatrix::largest_factor);
  return fmt::format("Cholesky factors: multigrid is for grids of {} particles and more",
                     cloth::ProjectiveMatrix::fewest_particles);
}

Explanation explain_scene(const cloth::Scene& scene) {
  Explanation e{.scene = scene,
                .stages = cloth::explain_stages(scene),
                .methods = {},
                .linear_solves = {},
                .global_solve = global_solve(scene)};
  if (cloth::has_stiffness(scene)) {
    e.largest_frequency = cloth::largest_frequency(scene);
    e.guaranteed_frequency = cloth::guaranteed_frequency(scene);
  }
  e.provot_step = cloth::provot_step(scene);
  for (const cloth::MethodFacts& facts : cloth::integrator_facts()) {
    cloth::Scene automatic = scene;
    automatic.integrator = {facts.name, std::nullopt};
    e.methods.push_back({facts, cloth::stable_step(facts.name, scene),
                         cloth::guaranteed_step(facts.name, scene), cloth::resolved_time_step(automatic)});
  }
  e.linear_solves = linear_solves(scene, e.methods);
  return e;
}

std::string step_text(const std::optional<double>& step) {
  if (!step) return "none";
  return std::isfinite(*step) ? fmt::format("{:.6g} s", *step) : "any";
}

std::string evaluations_text(const cloth::MethodFacts& facts) {
  return facts.evaluations_per_step > 0 ? fmt::format("{}", facts.evaluations_per_step) : "as needed";
}

std::string shape_text(const cloth::ClothSheet& sheet) {
  if (!sheet.is_mesh())
    return fmt::format("{} rows x {} columns{}", sheet.rows, sheet.columns,
                       sheet.is_cut() ? ", cut round" : "");
  return fmt::format("{}: {} triangles", sheet.mesh.file, sheet.mesh.loaded->surface.triangles.size());
}

std::string to_text(const Explanation& e) {
  std::string text =
      fmt::format("{}\n{} particles ({}), {} pinned\n", e.scene.title, cloth::particle_count(e.scene.cloth),
                  shape_text(e.scene.cloth), cloth::pinned_particles(e.scene.cloth).size());
  for (const std::string& notice : cloth::scene_notices(e.scene)) text += notice + '\n';
  text += "\nStages of a step\n";
  for (const cloth::StageInfo& stage : e.stages)
    text += fmt::format("  {:<9} {:<19} {}\n", stage.present ? "in" : "left out", stage.name, stage.reason);

  text += fmt::format(
      "\nLargest frequency       {:.6g} 1/s ({} at rest)\n"
      "Guaranteed bound        {:.6g} 1/s ({})\n"
      "Provot's criterion      {} (historical; 3 to 5 times too long for a grid)\n",
      e.largest_frequency,
      e.scene.cloth.is_mesh()  ? "at most, the mesh"
      : e.scene.cloth.is_cut() ? "the flat cloth"
                               : "flat grid",
      e.guaranteed_frequency,
      e.scene.material && e.scene.cloth.is_mesh()
          ? fmt::format("every shape, no edge over {} of its length", cloth::covered_stretch)
          : "every shape and stretch",
      step_text(e.provot_step));
  text += fmt::format("\n  {:<22} {:>5} {:>12} {:>16} {:>16} {:>16}\n", "method", "order", "evaluations",
                      "stable: flat", "in every shape", "auto");
  for (const MethodLimit& method : e.methods)
    text += fmt::format("{} {:<22} {:>5} {:>12} {:>16} {:>16} {:>16}\n",
                        method.facts.name == e.scene.integrator.method ? "*" : " ", method.facts.name,
                        method.facts.order, evaluations_text(method.facts), step_text(method.stable_step),
                        step_text(method.guaranteed_step), step_text(method.auto_step));
  if (!e.linear_solves.empty())
    text +=
        fmt::format("\nLinear solves of implicit methods (estimated cost of one; the cheapest is taken)\n");
  for (const LinearSolve& solve : e.linear_solves) {
    text +=
        fmt::format("  {:<22} {:<20} factors {:.3g} ms, conjugate gradients {:.3g} ms in {:.0f} iterations",
                    solve.method, cloth::name_of(solve.choice.method), 1e3 * solve.choice.factors,
                    1e3 * solve.choice.gradients, solve.choice.iterations);
    text += solve.choice.multigrid ? fmt::format(", multigrid {:.3g} ms\n", 1e3 * *solve.choice.multigrid)
                                   : ", no multigrid\n";
  }
  if (!e.global_solve.empty()) text += fmt::format("\nGlobal solve of projective  {}\n", e.global_solve);
  const auto step = cloth::resolved_time_step(e.scene);
  text += step ? fmt::format("\nRun with {} at {:.6g} s{}\n", e.scene.integrator.method, *step,
                             e.scene.integrator.time_step ? "" : " (auto)")
               : "\n" + cloth::no_stable_step_text(e.scene) + "\n";
  if (const std::string beyond = cloth::too_long_step_text(e.scene); !beyond.empty()) text += beyond + '\n';
  return text;
}

json finite(const std::optional<double>& value) {
  if (!value) return nullptr;
  return std::isfinite(*value) ? json(*value) : json("infinity");
}

json evaluations_json(const cloth::MethodFacts& facts) {
  return facts.evaluations_per_step > 0 ? json(facts.evaluations_per_step) : json(nullptr);
}

std::string to_json(const Explanation& e) {
  json root{{"title", e.scene.title},
            {"stages", json::array()},
            {"springs", json::object()},
            {"methods", json::array()},
            {"linear_solves", json::array()}};
  if (const std::vector<std::string> notices = cloth::scene_notices(e.scene); !notices.empty())
    root["notices"] = notices;
  for (const cloth::StageInfo& stage : e.stages)
    root["stages"].push_back({{"name", stage.name}, {"in", stage.present}, {"reason", stage.reason}});
  const cloth::ClothSystem system = cloth::make_cloth(e.scene);
  for (const cloth::SpringFamily family : cloth::spring_families)
    root["springs"][cloth::name_of(family)] = system.spring_count(family);
  root["largest_frequency_per_s"] = e.largest_frequency;
  root["guaranteed_frequency_per_s"] = e.guaranteed_frequency;
  root["provot_step_s"] = finite(e.provot_step);
  for (const MethodLimit& method : e.methods)
    root["methods"].push_back({{"name", method.facts.name},
                               {"order", method.facts.order},
                               {"evaluations_per_step", evaluations_json(method.facts)},
                               {"stable_step_s", finite(method.stable_step)},
                               {"guaranteed_step_s", finite(method.guaranteed_step)},
                               {"auto_step_s", finite(method.auto_step)}});
  if (!e.global_solve.empty()) root["global_solve"] = e.global_solve;
  for (const LinearSolve& solve : e.linear_solves)
    root["linear_solves"].push_back(
        {{"method", solve.method},
         {"solver", cloth::name_of(solve.choice.method)},
         {"factors_s", solve.choice.factors},
         {"conjugate_gradients_s", solve.choice.gradients},
         {"iterations", solve.choice.iterations},
         {"multigrid_s", solve.choice.multigrid ? json(*solve.choice.multigrid) : json(nullptr)}});
  root["method"] = e.scene.integrator.method;
  root["time_step_s"] = finite(cloth::resolved_time_step(e.scene));
  if (const std::string beyond = cloth::too_long_step_text(e.scene); !beyond.empty())
    root["time_step_notice"] = beyond;
  return root.dump(2) + "\n";
}

int explain(const ExplainArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const Explanation explanation = explain_scene(*loaded.scene);
  return print(arguments.json ? to_json(explanation) : to_text(explanation));
}

}  // namespace

void add_explain(Program& program) {
  auto [command, arguments] = add_command(
      program, "explain",
      "The stages a scene is run with, what was left out and why, and each method's stable time step",
      explain);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
