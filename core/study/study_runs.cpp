#include "study/study_runs.h"

#include <fmt/format.h>

#include <cmath>

#include "integrators/registry.h"
#include "study/iterations_report.h"
#include "study/stability_report.h"

namespace cloth {
namespace {

std::optional<StudyRun> run_at(const WorkPrecision& study, std::size_t number) {
  for (const MethodStudy& method : study.methods) {
    if (number >= method.runs.size()) {
      number -= method.runs.size();
      continue;
    }
    const WorkPrecisionRun& run = method.runs[number];
    if (run.status == RunStatus::refused) return std::nullopt;
    StudyRun found{.name = method.ladder.facts.title, .status = name_of(run.status), .scene = {}, .note = {}};
    found.name += run.tolerance > 0 ? fmt::format(", tolerance {:.0e}", run.tolerance)
                                    : fmt::format(", step {:.4g} s", run.time_step);
    found.scene = scene_of(study, method, run);
    found.scene.duration = study.horizon;
    return found;
  }
  return std::nullopt;
}

std::optional<StudyRun> run_at(const StabilityMap& map, std::size_t number) {
  for (const MethodMap& method : map.methods) {
    if (number >= method.cells.size()) {
      number -= method.cells.size();
      continue;
    }
    const StabilityCell& cell = method.cells[number];
    if (cell.status != CellStatus::run) return std::nullopt;
    StudyRun found{.name = {},
                   .status = status_of(cell),
                   .scene = cell_scene(map.scene, map.options, method.method, cell.x, cell.y),
                   .note =
                       "In the study every free particle was moved a little at the start, so that what "
                       "can grow has something to grow from; here it starts from rounding alone."};
    found.name = fmt::format("{}, {} = {:.4g}, {} = {:.4g}", facts_of(method.method).title,
                             map.options.x.path, cell.x, map.options.y.path, cell.y);
    return found;
  }
  return std::nullopt;
}

std::optional<StudyRun> run_at(const ExtremesTable& table, std::size_t number) {
  if (number >= table.cases.size() * table.methods.size()) return std::nullopt;
  const ExtremeCase& extreme = table.cases[number / table.methods.size()];
  const ExtremeCell* made = table.cell(number / table.methods.size(), number % table.methods.size());
  if (!made) return std::nullopt;
  const ExtremeCell& cell = *made;
  if (cell.status == ExtremeStatus::refused) return std::nullopt;
  StudyRun found{.name = fmt::format("{}, {}", extreme.name, facts_of(cell.method).title),
                 .status = name_of(cell.status),
                 .scene = extreme.scene,
                 .note = {}};
  found.scene.integrator.method = cell.method;
  found.scene.integrator.time_step = cell.time_step;
  found.scene.duration = static_cast<double>(extreme.max_steps) * cell.time_step;
  if (extreme.prepare) found.note = "A scene cannot say how this case is started: " + extreme.what;
  return found;
}

std::optional<StudyRun> run_at(const GridConvergence& study, std::size_t number) {
  if (number >= study.runs.size()) return std::nullopt;
  const GridRun& run = study.runs[number];
  if (run.status == GridRunStatus::refused) return std::nullopt;
  return StudyRun{.name = fmt::format("{} x {} cells", run.columns - 1, run.rows - 1),
                  .status = name_of(run.status),
                  .scene = scene_of(study, run),
                  .note = {}};
}

/// A row: its strip with 20 cells.
std::optional<StudyRun> run_at(const ValidationStudy& study, std::size_t number) {
  if (number >= study.rows.size()) return std::nullopt;
  const ValidationRow& row = study.rows[number];
  const auto scene = scene_of(row);
  if (!scene) return std::nullopt;
  return StudyRun{
      .name = name_of(row),
      .status = row.holds() ? "holds" : "does not hold",
      .scene = *scene,
      .note =
          "In the study the rest of this strip was found from the exact curve on, without any step; here "
          "it starts straight and swings, by implicit Euler, until that has come to rest."};
}

std::optional<StudyRun> run_at(const IterationsStudy& study, std::size_t number) {
  for (const MethodIterations& method : study.methods) {
    if (number >= method.steps.size()) {
      number -= method.steps.size();
      continue;
    }
    const IteratedStep& step = method.steps[number];
    return StudyRun{
        .name = fmt::format("{}, {} iterations", title_of_iterated(method.method), step.iterations),
        .status = std::isfinite(step.objective) ? "finished" : "failed",
        .scene = scene_of(study, method, step),
        .note = fmt::format("In the study one step was solved so, from the state that implicit Euler had "
                            "reached after {:.4g} s; here every step is.",
                            study.time)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<StudyRun> run_of(const StudyTable& table, int number) {
  if (number < 0) return std::nullopt;
  auto found =
      std::visit([&](const auto& kind) { return run_at(kind, static_cast<std::size_t>(number)); }, table);
  if (!found) return std::nullopt;
  const std::string title = title_of(table);
  found->scene.title = title.empty() ? found->name : title + " – " + found->name;
  return found;
}

int finished_runs(const StudyTable& table) {
  std::size_t count = 0;
  if (const auto* study = std::get_if<WorkPrecision>(&table))
    for (const MethodStudy& method : study->methods) count += method.runs.size();
  else if (const auto* map = std::get_if<StabilityMap>(&table))
    for (const MethodMap& method : map->methods)
      for (const StabilityCell& cell : method.cells) count += cell.status != CellStatus::not_run ? 1 : 0;
  else if (const auto* grids = std::get_if<GridConvergence>(&table))
    count = grids->runs.size();
  else if (const auto* validation = std::get_if<ValidationStudy>(&table))
    count = validation->rows.size();
  else if (const auto* iterations = std::get_if<IterationsStudy>(&table))
    for (const MethodIterations& method : iterations->methods) count += method.steps.size();
  else
    count = std::get<ExtremesTable>(table).cells.size();
  return static_cast<int>(count);
}

}  // namespace cloth
