// The cells of a stability map: one run each, judged by its energy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "geometry/split_mix.h"
#include "integrators/registry.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"
#include "simulation/step_batches.h"
#include "simulation/time_step.h"
#include "study/stability_map.h"
#include "study/study_team.h"

namespace cloth {
namespace {

constexpr int samples_of_a_run = 400;
/// m, between neighbours at rest.
double shortest_spacing(const ClothSheet& sheet) {
  if (!sheet.is_mesh()) {
    const GridCell grid = cell_of(sheet);
    return std::min(grid.across.norm(), grid.down.norm());
  }
  const LoadedMesh& mesh = *sheet.mesh.loaded;
  double shortest = infinity;
  for (const auto& [a, b] : mesh.edges)
    shortest = std::min(shortest, (mesh.surface.vertices[static_cast<std::size_t>(a)] -
                                   mesh.surface.vertices[static_cast<std::size_t>(b)])
                                      .norm());
  return shortest;
}

/// Moves every free particle at random, so that every motion that can grow has something to grow from.
Preparation perturbation(const Scene& cell, const StabilityCriterion& criterion) {
  const double length = criterion.perturbation * shortest_spacing(cell.cloth);
  return [length, seed = criterion.perturbation_seed](ClothSystem& system, ClothState& state) {
    SplitMix random(seed);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      const double x = random.number(), y = random.number(), z = random.number();
      if (!system.pinned[i]) state.position.add(i, length * Vec3(x, y, z));
    }
  };
}

/// The energy that the scene can give, in J: falling by its own size, the full wind, what it starts with; and
/// a trace of all springs at twice their length, so that a scene in which nothing moves has a scale too.
double energy_scale(const Simulation& run) {
  constexpr double trace = 1e-6;
  const Scene& scene = run.scene();
  const double mass = run.system().total_mass();
  double wind = 0;
  if (scene.air) wind = scene.air->wind.norm() * (1 + (scene.air->gust ? scene.air->gust->amplitude : 0));
  double elastic = 0;
  for (const SpringRun& springs : run.system().springs)
    elastic += 0.5 * springs.stiffness * springs.rest_length * springs.rest_length * springs.count;
  return mass * gravity_of(scene).norm() * run.system().diagonal + 0.5 * mass * wind * wind +
         std::abs(run.checkpoint().ledger.initial) + trace * elastic;
}

/// A mesh stays as it is: no smaller one has the same triangles.
void make_smaller(ClothSheet& cloth) {
  if (cloth.is_mesh()) return;
  const int rows = std::min(cloth.rows, study_grid), columns = std::min(cloth.columns, study_grid);
  const auto scaled = [](int index, int from, int to) {
    return static_cast<int>(std::lround(static_cast<double>(index) * (to - 1) / (from - 1)));
  };
  for (Pin& pin : cloth.pins)
    if (auto* disc = std::get_if<PinnedDisc>(&pin))
      disc->radius *= static_cast<double>(columns - 1) / (cloth.columns - 1);
    else if (auto* particle = std::get_if<PinnedParticle>(&pin))
      *particle = {scaled(particle->row, cloth.rows, rows), scaled(particle->column, cloth.columns, columns)};
  cloth.mass *= static_cast<double>(rows) * columns / (static_cast<double>(cloth.rows) * cloth.columns);
  cloth.width *= static_cast<double>(columns - 1) / (cloth.columns - 1);
  cloth.height *= static_cast<double>(rows - 1) / (cloth.rows - 1);
  cloth.rows = rows;
  cloth.columns = columns;
}

}  // namespace

Scene cell_scene(const Scene& scene, const StabilityOptions& options, const std::string& method, double x,
                 double y) {
  Scene cell = scene;
  cell.integrator.method = method;
  if (facts_of(method).settings == MethodSettings::error_control) cell.integrator.tolerance = 0;
  cell.probes.clear();  // the map records none
  set_number(cell, options.x.path, x, "--x");
  set_number(cell, options.y.path, y, "--y");
  if (!options.full_size && cell.obstacles.empty()) make_smaller(cell.cloth);
  return cell;
}

PredictedLimits predict_limits(const Scene& cell) {
  const std::string& method = cell.integrator.method;
  PredictedLimits limits{.predicted = stable_step(method, cell).value_or(0),
                         .guaranteed = guaranteed_step(method, cell).value_or(0),
                         .provot = provot_step(cell),
                         .spectrum = infinity};
  if (!std::isfinite(limits.predicted)) return limits;
  const ClothSystem system = make_cloth(cell);
  const double omega = measure_spectrum(system, system.start).largest_frequency();
  limits.spectrum = stable_step(method, omega, damping_rates(cell)).value_or(0);
  return limits;
}

std::int64_t wanted_steps(const Scene& cell, double time_step, const StabilityCriterion& criterion) {
  const double omega = largest_frequency(cell);
  double steps = criterion.least_steps;
  if (omega > 0)
    steps = std::max(steps, std::ceil(criterion.periods * 2 * std::numbers::pi / (omega * time_step)));
  return static_cast<std::int64_t>(std::min(steps, 1e15));
}

StabilityCell run_cell(const Scene& scene, const StabilityCriterion& criterion, const StopTest& stop,
                       int threads) {
  StabilityCell cell;
  const auto time_step = resolved_time_step(scene);
  if (!time_step) {
    cell.status = CellStatus::refused;
    cell.detail = "no stable step that \"auto\" could take";
    return cell;
  }
  cell.time_step = *time_step;
  cell.wanted_steps = wanted_steps(scene, *time_step, criterion);
  const std::int64_t steps = std::min<std::int64_t>(cell.wanted_steps, criterion.max_steps);
  const std::int64_t stride = std::max<std::int64_t>(1, steps / samples_of_a_run);

  Simulation run(scene, perturbation(scene, criterion));
  const double scale = energy_scale(run);
  std::vector<EnergySample> samples{{0, 0}};
  if (run.system().size() > most_particles_alone) run.set_threads(threads);
  StepBatches batches(run, stop);
  const std::optional<Divergence>& divergence = batches.divergence();
  for (std::int64_t step = 0; step < steps && !divergence;) {
    step = std::min(step + stride, steps);
    if (!batches.run_to(step) && !divergence) return cell;
    if (step % stride == 0 && !divergence) samples.push_back({run.time(), run.measure().energy_error()});
  }
  const EnergyVerdict verdict = judge_energy(samples, scale, criterion);
  cell.status = CellStatus::run;
  cell.steps = run.state().step;
  cell.run_class = verdict.run_class;
  cell.growth_rate = verdict.growth_rate;
  cell.energy_ratio = verdict.largest_ratio;
  if (divergence) {
    cell.run_class = divergence->solver_failed ? RunClass::solver_failed : RunClass::diverged;
    const double last = std::abs(run.measure().energy_error()) / scale;
    cell.energy_ratio = std::isfinite(last) ? std::max(last, cell.energy_ratio) : infinity;
    cell.detail =
        fmt::format("step {}, particle {}: {}", divergence->step, divergence->particle, divergence->cause);
  } else if (cell.wanted_steps > steps) {
    cell.detail = fmt::format("cut short: {} of {} steps", steps, cell.wanted_steps);
  }
  return cell;
}

}  // namespace cloth
