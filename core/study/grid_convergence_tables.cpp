#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/text_table.h"
#include "scene/scene_json.h"
#include "study/grid_convergence_report.h"
#include "study/run_output.h"

namespace cloth {
namespace {

using Json = nlohmann::ordered_json;

/// What a grid and those before it say of an output.
struct GridReading {
  double difference = NAN;
  Richardson found;
};

GridReading reading_of(const GridConvergence& study, std::size_t output, std::size_t run) {
  GridReading reading;
  if (!std::isfinite(study.runs[run].values[output])) return reading;
  reading.found = richardson_of(study, output, run + 1);
  if (!reading.found.differences.empty()) reading.difference = reading.found.differences.back();
  return reading;
}

/// The place of a run in the study, so far as it is in it.
std::size_t place_of(const GridConvergence& study, const GridRun& run) {
  for (std::size_t k = 0; k < study.runs.size(); ++k)
    if (study.runs[k].cells == run.cells) return k;
  return study.runs.size();
}

std::string shown_or_empty(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

std::string csv_or_empty(double value) {
  return std::isfinite(value) ? csv_number(value) : "";
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

TextTable terminal_table(const GridConvergence& study, std::size_t output) {
  TextTable table{{{"Cells", true},
                   {"Cell (m)", true},
                   {"Step (s)", true},
                   {"Value", true},
                   {"Difference", true},
                   {"Order", true},
                   {"Richardson", true},
                   {"GCI", true},
                   {"Status"}},
                  {}};
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const GridRun& run = study.runs[k];
    const GridRow row = row_of(study, output, k);
    table.rows.push_back(
        {fmt::format("{} x {}", run.columns - 1, run.rows - 1), fmt::format("{:.5g}", run.cell),
         run.time_step > 0 ? fmt::format("{:.4g}", run.time_step) : "", row.value, row.difference, row.order,
         row.extrapolate, row.index, run.status == GridRunStatus::finished ? "" : name_of(run.status)});
  }
  return table;
}

Json json_of(const GridConvergence& study, std::size_t output) {
  const Richardson found = richardson_of(study, output);
  Json root{{"output", study.outputs[output]}, {"unit", unit_of_output(study.outputs[output])}};
  root["verdict"] = name_of(found.verdict);
  root["words"] = found.words;
  root["order"] = number_or_null(found.order);
  root["asymptotic"] = found.is_asymptotic;
  root["range_ratio"] = number_or_null(found.range_ratio);
  root["extrapolated"] = number_or_null(found.extrapolate);
  root["band"] = number_or_null(found.band);
  root["index"] = number_or_null(found.index);
  root["safety_factor"] = number_or_null(found.safety);
  root["values"] = Json::array();
  for (const GridRun& run : study.runs) root["values"].push_back(number_or_null(run.values[output]));
  return root;
}

}  // namespace

GridRow row_of(const GridConvergence& study, std::size_t output, std::size_t run) {
  const GridReading reading = reading_of(study, output, run);
  const Richardson& found = reading.found;
  // Of two grids only the last word of a study: the order is assumed.
  const bool is_known = found.verdict != GridVerdict::two_grids || run + 1 == study.cells.size();
  GridRow row{.value = shown_or_empty(study.runs[run].values[output], 8),
              .difference = shown_or_empty(reading.difference, 3)};
  if (!found.orders.empty()) {
    const double order = found.orders.back();
    row.order = std::isfinite(order) ? fmt::format("{:.2f}", order) : name_of(found.verdict);
  }
  if (!is_known || found.verdict == GridVerdict::too_few) return row;
  row.extrapolate = shown_or_empty(found.extrapolate, 8);
  if (std::isfinite(found.index) && found.verdict != GridVerdict::unchanged)
    row.index = fmt::format("{:.3g} %", 100 * found.index);
  return row;
}

void visit_fields(CsvFields& fields, GridRun& run, const GridConvergence& study) {
  fields.derived("cells", std::to_string(run.cells));
  fields.derived("columns", std::to_string(run.columns));
  fields.derived("rows", std::to_string(run.rows));
  fields.derived("cell_m", csv_number(run.cell));
  fields.status(run.status, grid_run_status_names);
  fields.text("detail", run.detail);
  fields.number("time_step_s", run.time_step);
  fields.whole("step_changed", run.step_changed, true, 0, 1);
  fields.whole("steps", run.steps);
  fields.number("end_time_s", run.end_time);
  fields.number("wall_s", run.wall);
  run.values.resize(study.outputs.size(), NAN);
  const std::size_t place = place_of(study, run);
  for (std::size_t k = 0; k < study.outputs.size(); ++k) {
    const std::string& output = study.outputs[k];
    fields.finite(output.c_str(), run.values[k]);
    const GridReading reading = place < study.runs.size() ? reading_of(study, k, place) : GridReading{};
    const std::vector<double>& orders = reading.found.orders;
    fields.derived((output + ":difference").c_str(), csv_or_empty(reading.difference));
    fields.derived((output + ":order").c_str(), orders.empty() ? "" : csv_or_empty(orders.back()));
    const bool is_known = orders.size() > 0 || reading.found.verdict == GridVerdict::unchanged;
    fields.derived((output + ":extrapolated").c_str(),
                   is_known ? csv_or_empty(reading.found.extrapolate) : "");
    fields.derived((output + ":index").c_str(), is_known ? csv_or_empty(reading.found.index) : "");
  }
}

CsvTable table_of(const GridConvergence& study) {
  CsvTable table{written(GridRun{}, study).names, {}};
  for (const GridRun& run : study.runs) table.rows.push_back(written(run, study).texts);
  return table;
}

std::string name_of_output(const std::string& output) {
  const RunOutput parsed = parse_output(output);
  const std::string over = parsed.reduce == Reduction::maximum   ? ", largest"
                           : parsed.reduce == Reduction::minimum ? ", smallest"
                           : parsed.reduce == Reduction::mean    ? ", mean"
                                                                 : "";
  const std::string unit = unit_of_output(output);
  const auto probe = words_of_probe_column(parsed.of);
  if (probe) return probe->label + over;
  std::string name = parsed.of;
  for (const char* ending : {"_J", "_Ns", "_m", "_s"})
    if (!unit.empty() && name.ends_with(ending)) name.resize(name.size() - std::string(ending).size());
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + over;
}

std::string words_of_output(const std::string& output) {
  const std::string unit = unit_of_output(output);
  return name_of_output(output) + (unit.empty() ? "" : " (" + unit + ")");
}

std::string study_text(const GridConvergence& study) {
  std::string text = fmt::format("{}\n{:.6g} s simulated\n", study.scene.title, study.scene.duration);
  for (std::size_t k = 0; k < study.outputs.size(); ++k) {
    const Richardson found = richardson_of(study, k);
    text += fmt::format("\n{}\n{}{}\n", words_of_output(study.outputs[k]), to_text(terminal_table(study, k)),
                        found.words);
    if (std::isfinite(found.extrapolate) && found.verdict != GridVerdict::unchanged)
      text += fmt::format(
          "Extrapolated to cells without size: {:.8g}. Error of the finest value: {:.2g}, with a safety "
          "factor "
          "of {:.3g}.\n",
          found.extrapolate, found.band, found.safety);
  }
  bool any = false;
  for (const GridRun& run : study.runs)
    if (!run.detail.empty()) {
      text += fmt::format(
          "{}{} cells: {}{}\n", any ? "" : "\n", run.cells,
          run.status == GridRunStatus::finished ? "" : std::string(name_of(run.status)) + ": ", run.detail);
      any = true;
    }
  text += "\n";
  for (const std::string& caution : cautions_of(study)) text += "- " + caution + "\n";
  return text;
}

std::string study_json(const GridConvergence& study) {
  Json root{{"title", study.scene.title},      {"scene_hash", scene_hash(study.scene)},
            {"complete", study.is_complete()}, {"time_s", study.scene.duration},
            {"grids", Json::array()},          {"outputs", Json::array()},
            {"cautions", cautions_of(study)}};
  for (const GridRun& run : study.runs)
    root["grids"].push_back({{"cells", run.cells},
                             {"columns", run.columns},
                             {"rows", run.rows},
                             {"cell_m", run.cell},
                             {"status", name_of(run.status)},
                             {"detail", run.detail},
                             {"time_step_s", run.time_step},
                             {"steps", run.steps},
                             {"end_time_s", run.end_time},
                             {"wall_s", run.wall}});
  for (std::size_t k = 0; k < study.outputs.size(); ++k) root["outputs"].push_back(json_of(study, k));
  return root.dump(2) + "\n";
}

}  // namespace cloth
