#include "study/study_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "io/csv.h"
#include "io/machine.h"
#include "kernels/instruction_set.h"
#include "scene/scene_json.h"
#include "scene/scene_mesh.h"
#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/iterations_report.h"
#include "study/reference_solution.h"
#include "study/stability_report.h"
#include "study/study_index.h"
#include "study/study_recorder.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// JSON has no infinity: null.
json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json contents(const WorkPrecision& study) {
  json options{{"methods", json::array()}}, reference;
  for (const MethodStudy& method : study.methods) options["methods"].push_back(method.ladder.facts.name);
  visit_options(JsonFields(options), study);
  visit_reference(JsonFields(reference), study.reference);
  json root{{"options", options}, {"estimated_s", study.estimated}, {"reference", reference}};
  if (study.parts > 0) root["parts"] = study.parts;
  return root;
}

json contents(const StabilityMap& map) {
  json options{{"methods", map.options.methods}}, limits = json::object();
  visit_stability(JsonFields(options), map.options);
  for (const MethodMap& method : map.methods)
    for (const MeasuredLimit& limit : method.measured)
      limits[method.method].push_back({{"at", limit.other},
                                       {"longest_stable_s", limit.longest_stable},
                                       {"shortest_unstable_s", number(limit.shortest_unstable)},
                                       {"stable_beyond", limit.stable_beyond}});
  return {{"options", options}, {"rows", map.rows}, {"columns", map.columns}, {"limits", limits}};
}

json contents(const ExtremesTable& table) {
  json cases = json::array();
  for (const ExtremeCase& extreme : table.cases) cases.push_back(extreme.name);
  return {{"options", {{"methods", table.methods}, {"cases", cases}}}};
}

json contents(const GridConvergence& study) {
  return {
      {"options", {{"cells", study.cells}, {"outputs", study.outputs}, {"time_s", study.scene.duration}}}};
}

json contents(const ValidationStudy& study) {
  return {{"options", {{"protocols", study.protocols}}}};
}

json contents(const IterationsStudy& study) {
  return {{"options",
           {{"methods", study.asked},
            {"step_s", study.step},
            {"time_s", study.asked_time},
            {"most", study.most}}},
          {"left_out", study.left_out},
          {"time_s", study.time},
          {"particles", study.particles},
          {"failure", study.failure},
          {"fall_J", study.fall},
          {"residual_N_s", study.residual},
          {"is_minimum", study.is_minimum},
          {"floor", study.floor}};
}

/// What its numbers depend on beside scene and options.
json maker() {
  return {{"version", version()},
          {"instruction_set", name_of(active_instruction_set())},
          {"processor", machine_facts().processor}};
}

}  // namespace

const Scene* scene_of(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return &study->scene;
  if (const auto* map = std::get_if<StabilityMap>(&table)) return &map->scene;
  if (const auto* study = std::get_if<GridConvergence>(&table)) return &study->scene;
  if (const auto* study = std::get_if<IterationsStudy>(&table)) return &study->scene;
  const auto* extremes = std::get_if<ExtremesTable>(&table);
  return extremes && extremes->scene ? &*extremes->scene : nullptr;
}

const char* kind_of(const StudyTable& table) {
  constexpr const char* names[] = {"work-precision", "stability",  "extremes",
                                   "convergence",    "validation", "iterations"};
  return names[table.index()];
}

std::string title_of(const StudyTable& table) {
  if (const Scene* scene = scene_of(table)) return scene->title;
  const auto* validation = std::get_if<ValidationStudy>(&table);
  if (!validation) return "The fixed list of cases";
  if (validation->protocols == exact_protocols()) return "All protocols";
  return fmt::format("{}", fmt::join(validation->protocols, ", "));
}

bool is_complete(const StudyTable& table) {
  return std::visit([](const auto& of) { return of.is_complete(); }, table);
}

const char* csv_name(const StudyTable& table) {
  constexpr const char* names[] = {"work_precision.csv", "stability.csv",  "extremes.csv",
                                   "convergence.csv",    "validation.csv", "iterations.csv"};
  return names[table.index()];
}

std::string study_csv(const StudyTable& table) {
  return csv_text(std::visit([](const auto& of) { return table_of(of); }, table), "\r\n");
}

std::string study_text(const StudyTable& table) {
  return std::visit([](const auto& of) { return study_text(of); }, table);
}

std::string study_json(const StudyTable& table) {
  return std::visit([](const auto& of) { return study_json(of); }, table);
}

std::string study_index(const std::filesystem::path& folder, const StudyTable& table,
                        const std::string& command, double wall, const std::vector<FileDigest>& files,
                        const std::optional<FileDigest>& states, const std::optional<Shard>& shard) {
  json root{{"format", study_format}, {"kind", kind_of(table)}, {"title", title_of(table)},
            {"command", command},     {"wall_s", wall},         {"complete", is_complete(table)}};
  root["made_by"] = maker();
  root.update(std::visit([](const auto& kind) { return contents(kind); }, table));
  if (const Scene* scene = scene_of(table)) {
    root["scene_hash"] = scene_hash(*scene);
    root["scene"] = json::parse(write_scene(moved_to_folder(*scene, folder.string())));
  }
  if (states) root["reference"]["states"] = digests_json({*states});
  if (!files.empty()) root["files"] = digests_json(files);
  if (files.empty() || shard) root["complete"] = false;
  if (shard) root["shard"] = fmt::format("{}/{}", shard->index, shard->count);
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::vector<std::string> study_files(const StudyTable& table) {
  std::vector<std::string> names{"study.json", csv_name(table), "report.html"};
  if (std::holds_alternative<WorkPrecision>(table))
    names.insert(names.end(), {samples_name, reference_states_name});
  if (std::holds_alternative<GridConvergence>(table)) names.emplace_back(grid_errors_name);
  if (std::holds_alternative<ValidationStudy>(table)) names.emplace_back(validation_points_name);
  if (std::holds_alternative<IterationsStudy>(table)) names.emplace_back(iterations_time_name);
  names.push_back(std::filesystem::path(csv_name(table)).replace_extension("svg").string());
  return names;
}

}  // namespace cloth
