#include "study/study_folder.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "io/run_folder.h"
#include "scene/scene_json.h"
#include "study/extremes_report.h"
#include "study/stability_report.h"
#include "study/work_precision_report.h"
#include "study/work_precision_tables.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// JSON has no infinity: null.
json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json axis_json(const StudyAxis& axis) {
  return {{"path", axis.path},
          {"low", axis.low},
          {"high", axis.high},
          {"count", axis.count},
          {"logarithmic", axis.scale == AxisScale::logarithmic}};
}

json difference_json(const StateDifference& difference) {
  return {{"rms_position_m", difference.rms_position},
          {"largest_position_m", difference.largest_position},
          {"rms_velocity_m_s", difference.rms_velocity}};
}

json contents(const WorkPrecision& study) {
  json methods = json::array();
  for (const MethodStudy& method : study.methods) methods.push_back(method.ladder.facts.name);
  const ReferenceSolution& reference = study.reference;
  return {{"scene", json::parse(write_scene(study.scene))},
          {"options",
           {{"methods", methods},
            {"horizon_s", study.horizon},
            {"repeats", study.repeats},
            {"budget_s", study.budget}}},
          {"estimated_s", study.estimated},
          {"reference",
           {{"smooth", reference.smooth},
            {"first", reference.first},
            {"second", reference.second},
            {"failure", reference.failure},
            {"floor", difference_json(reference.floor)},
            {"excited_frequency_per_s", reference.excited_frequency},
            {"largest_kinetic_J", reference.largest_kinetic},
            {"evaluations", reference.evaluations}}}};
}

json contents(const StabilityMap& map) {
  const StabilityOptions& options = map.options;
  const StabilityCriterion& criterion = options.criterion;
  json limits = json::object();
  for (const MethodMap& method : map.methods)
    for (const MeasuredLimit& limit : method.measured)
      limits[method.method].push_back({{"at", limit.other},
                                       {"longest_stable_s", limit.longest_stable},
                                       {"shortest_unstable_s", number(limit.shortest_unstable)},
                                       {"stable_beyond", limit.stable_beyond}});
  return {{"scene", json::parse(write_scene(map.scene))},
          {"options",
           {{"methods", options.methods},
            {"x", axis_json(options.x)},
            {"y", axis_json(options.y)},
            {"full_size", options.full_size},
            {"criterion",
             {{"periods", criterion.periods},
              {"least_steps", criterion.least_steps},
              {"most_steps", criterion.most_steps},
              {"perturbation", criterion.perturbation},
              {"perturbation_seed", criterion.perturbation_seed},
              {"growth", criterion.growth},
              {"growth_factor", criterion.growth_factor},
              {"accuracy", criterion.accuracy}}}}},
          {"rows", map.rows},
          {"columns", map.columns},
          {"limits", limits}};
}

json contents(const ExtremesTable& table) {
  json cases = json::array();
  for (const ExtremeCase& extreme : table.cases) cases.push_back(extreme.name);
  json root{{"options", {{"methods", table.methods}, {"cases", cases}}}};
  if (table.scene) root["scene"] = json::parse(write_scene(*table.scene));
  return root;
}

std::string csv_text(const CsvTable& table) {
  std::string text;
  const auto add = [&text](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + csv_field(row[k]);
    text += "\r\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return text;
}

CsvTable extremes_table(const ExtremesTable& table) {
  CsvTable rows{extremes_columns(), {}};
  for (const ExtremeCell& cell : table.cells) rows.rows.push_back(extremes_row(cell));
  return rows;
}

template <class Table>
std::optional<IoError> write_start(const std::filesystem::path& folder, const Table& table,
                                   const std::string& command, double wall) {
  if (auto error = make_folder(folder)) return error;
  return write_study_json(folder, table, command, wall);
}

}  // namespace

const char* kind_of(const StudyTable& table) {
  constexpr const char* names[] = {"work-precision", "stability", "extremes"};
  return names[table.index()];
}

std::string title_of(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return study->scene.title;
  if (const auto* map = std::get_if<StabilityMap>(&table)) return map->scene.title;
  const auto& extremes = std::get<ExtremesTable>(table);
  return extremes.scene ? extremes.scene->title : "The fixed list of cases";
}

bool is_complete(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return !study->stopped;
  if (const auto* map = std::get_if<StabilityMap>(&table)) return map->complete;
  return std::get<ExtremesTable>(table).is_complete();
}

const char* csv_name(const StudyTable& table) {
  constexpr const char* names[] = {"work_precision.csv", "stability.csv", "extremes.csv"};
  return names[table.index()];
}

std::string study_csv(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return csv_text(run_table(*study));
  if (const auto* map = std::get_if<StabilityMap>(&table)) return stability_csv(*map);
  return csv_text(extremes_table(std::get<ExtremesTable>(table)));
}

std::string study_text(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return work_precision_text(*study);
  if (const auto* map = std::get_if<StabilityMap>(&table)) return stability_text(*map);
  return extremes_text(std::get<ExtremesTable>(table));
}

std::string study_json_text(const StudyTable& table) {
  if (const auto* study = std::get_if<WorkPrecision>(&table)) return work_precision_json(*study);
  if (const auto* map = std::get_if<StabilityMap>(&table)) return stability_json(*map);
  return extremes_json(std::get<ExtremesTable>(table));
}

std::optional<IoError> write_study_json(const std::filesystem::path& folder, const StudyTable& table,
                                        const std::string& command, double wall) {
  json root{{"format", study_format}, {"kind", kind_of(table)}, {"title", title_of(table)},
            {"command", command},     {"wall_s", wall},         {"complete", is_complete(table)}};
  root.update(std::visit([](const auto& kind) { return contents(kind); }, table));
  return write_text_file(folder / "study.json", root.dump(2) + "\n");
}

std::optional<IoError> write_study(const std::filesystem::path& folder, const WorkPrecision& study,
                                   const std::string& command, double wall) {
  if (auto error = write_start(folder, study, command, wall)) return error;
  if (auto error = write_text_file(folder / "work_precision.csv", csv_text(run_table(study)))) return error;
  if (auto error = write_text_file(folder / "work_precision_samples.csv", csv_text(sample_table(study))))
    return error;
  const std::string svg = to_svg(error_plot(study, PlotAgainst::run_time));
  if (auto error = write_text_file(folder / "work_precision.svg", svg)) return error;
  return write_text_file(folder / "report.html", work_precision_page(study, command));
}

std::optional<IoError> write_study(const std::filesystem::path& folder, const StabilityMap& map,
                                   const std::string& command, double wall) {
  if (auto error = write_start(folder, map, command, wall)) return error;
  const std::string svg = to_svg(stability_heat_map(map));
  if (auto error = write_text_file(folder / "stability.csv", stability_csv(map))) return error;
  if (auto error = write_text_file(folder / "stability.svg", svg)) return error;
  return write_text_file(folder / "report.html", stability_page(map, svg, command, wall));
}

std::optional<IoError> write_study(const std::filesystem::path& folder, const ExtremesTable& table,
                                   const std::string& command, double wall) {
  if (auto error = write_start(folder, table, command, wall)) return error;
  if (auto error = write_text_file(folder / "extremes.csv", csv_text(extremes_table(table)))) return error;
  if (auto error = write_text_file(folder / "extremes.svg", to_svg(extremes_map(table)))) return error;
  return write_text_file(folder / "report.html", extremes_html(table, command));
}

std::optional<IoError> write_study(const std::filesystem::path& folder, const Study& study) {
  return std::visit([&](const auto& table) { return write_study(folder, table, study.command, study.wall); },
                    study.table);
}

}  // namespace cloth
