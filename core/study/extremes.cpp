#include "study/extremes.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "contact/continuous_contact.h"
#include "contact/obstacle_contact.h"
#include "integrators/registry.h"
#include "simulation/memory_estimate.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"
#include "study/study_team.h"

namespace cloth {
namespace {

constexpr std::int64_t records_of_a_run = 50;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One cell on its way.
class CellRun {
 public:
  CellRun(const ExtremeCase& extreme, const Scene& scene, double time_step, int threads)
      : simulation_(scene, extreme.prepare),
        last_(std::min(extreme.max_steps, steps_to_cover(scene.duration, time_step))),
        stride_(std::max<std::int64_t>(1, last_ / records_of_a_run)),
        max_evaluations_(extreme.max_evaluations) {
    if (simulation_.system().size() > most_particles_alone) simulation_.set_threads(threads);
  }

  ExtremeCell to_end(ExtremeCell cell, const StopTest& stop) {
    record();
    simulation_.set_stop_test(stop);
    while (!divergence_ && simulation_.state().step < last_ &&
           simulation_.count().force_evaluations < max_evaluations_) {
      look_for_tunnelling();
      divergence_ = simulation_.step();
      if (divergence_ || simulation_.interrupted()) break;
      cell.steps = simulation_.state().step;
      if (cell.steps % stride_ == 0 || cell.steps == last_) record();
      if (is_to_stop(stop)) break;
    }
    cell.max_strain = max_strain_;
    cell.energy_ratio = energy_ratio_;
    cell.status = status();
    cell.ended_early = !divergence_ && cell.steps < last_;
    cell.detail = detail();
    return cell;
  }

 private:
  void record() {
    const Measurement now = simulation_.measure();
    const double scale = simulation_.energy_scale();
    const double held = now.energy.kinetic + now.energy.elastic;
    if (!std::isfinite(held) || !std::isfinite(now.strain.maximum())) {
      divergence_ = simulation_.stop_at_fastest("the energy of the cloth is not finite");
      return;
    }
    max_strain_ = std::max(max_strain_, now.strain.maximum());
    largest_excess_ = std::max(largest_excess_, now.limiter_excess);
    last_excess_ = now.limiter_excess;
    if (scale > 0) energy_ratio_ = held / scale;
    if (2 * now.step < last_ || !(scale > 0)) return;
    // Losses are not given back: a method that adds what damping takes would be a steady state.
    added_ += (now.energy_error() - now.ledger.forces.damping_loss) / scale;
    ++added_records_;
  }

  /// Of the energy scale, mean of the second half: some methods only lend energy for half an oscillation.
  double growth() const { return added_records_ > 0 ? added_ / added_records_ : 0; }

  void look_for_tunnelling() {
    if (tunnelling_ || has_continuous_contact(simulation_.scene())) return;
    const IntegratorChoice& method = simulation_.scene().integrator;
    const auto parts = method.method == "xpbd" ? static_cast<double>(method.substeps) : 1;
    tunnelling_ = find_tunnelling(simulation_.scene().obstacles, simulation_.system(), simulation_.state(),
                                  simulation_.time_step() / parts);
    tunnelling_step_ = simulation_.state().step + 1;
  }

  ExtremeStatus status() const {
    if (divergence_)
      return divergence_->solver_failed ? ExtremeStatus::solver_failed : ExtremeStatus::diverged;
    if (simulation_.unreachable_rate()) return ExtremeStatus::unreachable;
    if (growth() > growth_threshold) return ExtremeStatus::energy_growth;
    // XPBD does not solve a substep's equations, it visits each spring: its one visit is its residual.
    const bool open = facts_of(simulation_.scene().integrator.method).iterates_to_residual &&
                      simulation_.count().largest_residual > residual_threshold;
    return open ? ExtremeStatus::not_converged : ExtremeStatus::stable;
  }

  std::string detail() const {
    std::vector<std::string> facts;
    if (divergence_) facts.push_back(describe(*divergence_));
    if (!divergence_ && growth() > growth_threshold)
      facts.push_back(
          fmt::format("{:.3g} of the energy scale was added, more than {}", growth(), growth_threshold));
    if (!divergence_ && simulation_.count().steps < last_) facts.push_back(why_short());
    if (simulation_.unreachable_rate())
      facts.push_back(describe(*simulation_.unreachable_rate(), simulation_.system()));
    if (simulation_.quantities().limiter && largest_excess_ > 0 && !divergence_)
      facts.push_back(fmt::format("excess over the rate at most {:.2g}, at the end {:.2g}", largest_excess_,
                                  last_excess_));
    if (tunnelling_)
      facts.push_back(fmt::format("warning in step {}: {}", tunnelling_step_, describe(*tunnelling_)));
    add_costs(facts);
    return fmt::format("{}", fmt::join(facts, "; "));
  }

  std::string why_short() const {
    if (simulation_.count().force_evaluations < max_evaluations_) return "interrupted";
    return fmt::format("ended after {} of {} steps: a cell has {} force evaluations",
                       simulation_.count().steps, last_, max_evaluations_);
  }

  void add_costs(std::vector<std::string>& facts) const {
    const StepCount& count = simulation_.count();
    const double steps = static_cast<double>(std::max<std::int64_t>(1, count.steps));
    if (count.iterations > 0)
      facts.push_back(fmt::format("{:.3g} iterations a step", static_cast<double>(count.iterations) / steps));
    if (count.inner_steps > count.steps || count.rejected_steps > 0)
      facts.push_back(
          fmt::format("{:.3g} inner steps a step", static_cast<double>(count.inner_steps) / steps));
    if (count.held_normals > 0)
      facts.push_back(fmt::format("air along the normals of the beginning in {} steps", count.held_normals));
    if (count.largest_residual > 1e-3)
      facts.push_back(fmt::format("residual up to {:.2g}", count.largest_residual));
  }

  Simulation simulation_;
  std::int64_t last_, stride_, max_evaluations_;
  std::optional<Divergence> divergence_;
  std::optional<TunnellingRisk> tunnelling_;
  std::int64_t tunnelling_step_ = 0;
  int added_records_ = 0;
  double max_strain_ = 0, energy_ratio_ = 0, added_ = 0, largest_excess_ = 0, last_excess_ = 0;
};

/// Of all cells.
std::vector<Scene> scenes_of(const ExtremesTable& table) {
  std::vector<Scene> scenes;
  for (const ExtremeCase& extreme : table.cases)
    for (const std::string& method : table.methods) {
      scenes.push_back(extreme.scene);
      scenes.back().integrator.method = method;
    }
  return scenes;
}

}  // namespace

ExtremeCell run_extreme(const ExtremeCase& extreme, const std::string& method, const StopTest& stop,
                        int threads) {
  ExtremeCell cell{.case_name = extreme.name, .method = method, .detail = {}};
  Scene scene = extreme.scene;
  scene.integrator.method = method;
  const auto time_step = resolved_time_step(scene);
  if (!time_step) {
    cell.status = ExtremeStatus::refused;
    cell.detail = no_stable_step_text(scene);
    return cell;
  }
  cell.time_step = *time_step;
  const auto start = std::chrono::steady_clock::now();
  cell = CellRun(extreme, scene, *time_step, threads).to_end(std::move(cell), stop);
  cell.wall = seconds_since(start);
  return cell;
}

std::int64_t ExtremesTable::number_of(const ExtremeCell& cell) const {
  const auto extreme = std::find_if(cases.begin(), cases.end(),
                                    [&](const ExtremeCase& one) { return one.name == cell.case_name; });
  const auto method = std::find(methods.begin(), methods.end(), cell.method);
  return (extreme - cases.begin()) * std::ssize(methods) + (method - methods.begin());
}

const ExtremeCell* ExtremesTable::cell(std::size_t extreme, std::size_t method) const {
  const auto number = static_cast<std::int64_t>(extreme * methods.size() + method);
  const auto at =
      std::ranges::lower_bound(cells, number, {}, [&](const ExtremeCell& cell) { return number_of(cell); });
  return at != cells.end() && number_of(*at) == number ? &*at : nullptr;
}

ExtremesTable empty_table(const ExtremesOptions& options) {
  const auto is_asked = [](const std::vector<std::string>& asked, const std::string& name) {
    return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
  };
  ExtremesTable table;
  table.scene = options.scene;
  for (const ExtremeCase& extreme : options.scene ? extreme_cases_of(*options.scene) : extreme_cases())
    if (is_asked(options.cases, extreme.name)) table.cases.push_back(extreme);
  for (const std::string& method : integrator_names())
    if (is_asked(options.methods, method)) table.methods.push_back(method);
  return table;
}

ExtremesTable run_extremes(const ExtremesOptions& options) {
  ExtremesTable table = empty_table(options);
  if (options.earlier) table.cells = options.earlier->cells;
  const std::size_t methods = table.methods.size(), all = table.cases.size() * methods;
  std::vector<std::size_t> missing;
  for (std::size_t number = 0; number < all; ++number)
    if (options.shard.has(static_cast<std::int64_t>(number)) &&
        !table.cell(number / methods, number % methods))
      missing.push_back(number);
  StudyTeam team({.jobs = options.jobs,
                  .at_once = runs_that_fit(scenes_of(table), options.jobs),
                  .stop = options.stop,
                  .progress = options.progress});
  std::size_t there = all - missing.size();
  team.run(missing.size(), [&](std::size_t k) {
    const ExtremeCase& extreme = table.cases[missing[k] / methods];
    const std::string& method = table.methods[missing[k] % methods];
    {
      const auto lock = team.alone();
      team.report({static_cast<double>(there) / static_cast<double>(all), extreme.name + ", " + method});
    }
    if (team.is_stopped()) return false;
    ExtremeCell cell = run_extreme(
        extreme, method, [&] { return team.is_stopped(); }, team.threads());
    if (team.is_stopped()) return false;  // half a cell is none
    const auto lock = team.alone();
    const auto place = std::ranges::lower_bound(table.cells, table.number_of(cell), {},
                                                [&](const ExtremeCell& of) { return table.number_of(of); });
    table.cells.insert(place, std::move(cell));
    ++there;
    if (options.partial) options.partial(table);
    return true;
  });
  return table;
}

}  // namespace cloth
