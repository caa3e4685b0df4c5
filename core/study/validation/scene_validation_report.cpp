#include "study/validation/scene_validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "report/html_page.h"
#include "report/text_table.h"
#include "study/run_output.h"

namespace cloth {
namespace {

const char* const value_words[] = {"rms distance", "value at the last time", "value"};

/// What the column "value" has, with its unit.
std::string words_of_value(const SceneValidation& study) {
  const std::string unit =
      study.data.kind == MeasuredKind::profile ? "m" : unit_of_output(study.scene.measured->output);
  return value_words[static_cast<std::size_t>(study.data.kind)] + (unit.empty() ? "" : ", " + unit);
}

std::string in_percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string words_of_order(const SceneValidation& study) {
  return std::isfinite(study.order()) ? fmt::format("{:.2f}", study.order()) : "";
}

/// How a run came to its state.
std::string words_of_method(const SceneValidation& study, const MeasuredRun& run) {
  if (study.scene.measured->state == "rest") return "rest by Newton's method";
  return fmt::format("{}, step {:.4g} s, to {:g} s", study.scene.integrator.method, run.time_step,
                     study.scene.duration);
}

std::string grid_of(const MeasuredRun& run) {
  return fmt::format("{} x {}", run.columns - 1, run.rows - 1);
}

std::string words_of_verdict(const SceneValidation& study) {
  const double tolerance = study.scene.measured->tolerance;
  if (!study.is_complete()) return "not complete";
  return fmt::format("{} {}", study.holds() ? "within" : "not within", in_percent(tolerance));
}

/// A line or a point for each grid; the measured points over them.
PlotSeries series_of_run(const SceneValidation& study, const MeasuredRun& run, std::size_t x, std::size_t y) {
  PlotSeries series{.name = fmt::format("{} cells", grid_of(run)),
                    .detail = "error " + in_percent(run.error),
                    .markers = false};
  for (const Vec3& point : run.line)
    series.points.push_back({point[static_cast<Eigen::Index>(x)], point[static_cast<Eigen::Index>(y)]});
  if (study.data.kind == MeasuredKind::history)
    for (std::size_t k = 0; k < run.times.size(); ++k) series.points.push_back({run.times[k], run.values[k]});
  return series;
}

/// The two axes in which a profile is drawn: the first two that the file has.
std::pair<std::size_t, std::size_t> drawn_axes(const MeasuredData& data) {
  const std::size_t first = data.has_axis[0] ? 0 : 1;
  return {first, data.has_axis[first + 1] ? first + 1 : 2};
}

LinePlot plot_of_value(const SceneValidation& study) {
  LinePlot plot{.title = study.scene.title, .subtitle = study.name};
  plot.x = {.label = "cells across", .scale = AxisScale::logarithmic};
  plot.y = {.label = study.scene.measured->output, .unit = unit_of_output(study.scene.measured->output)};
  PlotSeries found{.name = "found",
                   .detail = words_of_order(study).empty() ? "" : "order " + words_of_order(study)};
  for (const MeasuredRun& run : study.runs)
    if (run.failure.empty()) found.points.push_back({static_cast<double>(run.cells), run.value});
  plot.series = {std::move(found)};
  plot.lines = {{ReferenceLine::Direction::horizontal, study.data.values.front(), "measured"}};
  return plot;
}

void add_rows(const SceneValidation& study, CsvTable& table) {
  for (const MeasuredRun& run : study.runs) {
    const bool is_found = run.failure.empty(), is_last = &run == &study.runs.back();
    table.rows.push_back({study.name, study.scene.measured->output, study.scene.measured->state,
                          std::to_string(run.cells), std::to_string(run.rows), std::to_string(run.columns),
                          study.scene.measured->state == "end" ? study.scene.integrator.method : "",
                          run.time_step > 0 ? csv_number(run.time_step) : "", words_of_value(study),
                          is_found ? csv_number(run.value) : "", is_found ? csv_number(run.error) : "",
                          is_found ? csv_number(run.largest) : "",
                          is_last && std::isfinite(study.order()) ? csv_number(study.order()) : "",
                          csv_number(study.scene.measured->tolerance), run.failure});
  }
}

HtmlTable table_of_scene(const SceneValidation& study) {
  HtmlTable table;
  table.columns = {{"Cells", Align::right},
                   {"How"},
                   {words_of_value(study), Align::right},
                   {"Error", Align::right},
                   {"Largest", Align::right}};
  for (const MeasuredRun& run : study.runs) {
    HtmlRow row{{grid_of(run), words_of_method(study, run)}};
    if (!run.failure.empty())
      row.cells.push_back({run.failure, Verdict::bad});
    else
      for (const std::string& text :
           {fmt::format("{:.6g}", run.value), in_percent(run.error), in_percent(run.largest)})
        row.cells.emplace_back(text);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

LinePlot measured_plot(const SceneValidation& study) {
  if (study.data.kind == MeasuredKind::value) return plot_of_value(study);
  LinePlot plot{.title = study.scene.title, .subtitle = study.name + ": " + study.scene.measured->output};
  const bool is_profile = study.data.kind == MeasuredKind::profile;
  const auto [x, y] = drawn_axes(study.data);
  constexpr const char* axis_words[] = {"x", "y", "z"};
  if (is_profile)
    plot.x = {.label = axis_words[x], .unit = "m"}, plot.y = {.label = axis_words[y], .unit = "m"};
  else
    plot.x = {.label = "time", .unit = "s"},
    plot.y = {.label = study.scene.measured->output, .unit = unit_of_output(study.scene.measured->output)};
  for (const MeasuredRun& run : study.runs)
    if (run.failure.empty()) plot.series.push_back(series_of_run(study, run, x, y));
  PlotSeries measured{.name = "measured", .line = false};
  for (const Vec3& point : study.data.points)
    measured.points.push_back({point[static_cast<Eigen::Index>(x)], point[static_cast<Eigen::Index>(y)]});
  for (std::size_t k = 0; k < study.data.times.size(); ++k)
    measured.points.push_back({study.data.times[k], study.data.values[k]});
  plot.series.push_back(std::move(measured));
  return plot;
}

std::string scenes_text(const std::vector<SceneValidation>& scenes) {
  TextTable table{{{"Scene"},
                   {"Output"},
                   {"Cells", true},
                   {"How"},
                   {"Value", true},
                   {"Of"},
                   {"Error", true},
                   {"Largest", true},
                   {"Order", true},
                   {"Verdict"}},
                  {}};
  std::string notes;
  for (const SceneValidation& study : scenes) {
    for (const MeasuredRun& run : study.runs) {
      const bool is_found = run.failure.empty(), is_last = &run == &study.runs.back();
      table.rows.push_back({study.name, study.scene.measured->output, grid_of(run),
                            words_of_method(study, run), is_found ? fmt::format("{:.7g}", run.value) : "",
                            is_found ? words_of_value(study) : "", is_found ? in_percent(run.error) : "",
                            is_found ? in_percent(run.largest) : "", is_last ? words_of_order(study) : "",
                            !is_found ? run.failure
                            : is_last ? words_of_verdict(study)
                                      : ""});
    }
    if (!study.one_grid.empty())
      notes += fmt::format("\n{}: no other grid: {}\n", study.name, study.one_grid);
  }
  return to_text(table) +
         "\nErrors of a profile are over the line's length, of a history over the largest measured value. "
         "The "
         "scene's own grid and all finer ones are held against the tolerance.\n" +
         notes;
}

std::string scenes_csv(const std::vector<SceneValidation>& scenes) {
  CsvTable table{{"scene", "output", "state", "cells", "rows", "columns", "method", "time_step_s", "quantity",
                  "value", "relative_error", "largest_error", "order", "tolerance", "failure"},
                 {}};
  for (const SceneValidation& study : scenes) add_rows(study, table);
  return csv_text(table, "\r\n");
}

std::string scenes_json(const std::vector<SceneValidation>& scenes, const std::vector<FileDigest>& files) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const SceneValidation& study : scenes) {
    const MeasuredPoints& measured = *study.scene.measured;
    Json entry{
        {"scene", study.name},     {"title", study.scene.title},      {"output", measured.output},
        {"state", measured.state}, {"tolerance", measured.tolerance}, {"quantity", words_of_value(study)}};
    if (study.data.kind == MeasuredKind::value) entry["measured"] = study.data.values.front();
    entry["grids"] = Json::array();
    for (const MeasuredRun& run : study.runs) {
      Json one{{"cells", run.cells}, {"rows", run.rows}, {"columns", run.columns}};
      if (run.time_step > 0)
        one["method"] = study.scene.integrator.method, one["time_step_s"] = run.time_step;
      if (run.failure.empty())
        one.update({{"value", run.value}, {"relative_error", run.error}, {"largest_error", run.largest}});
      else
        one["failure"] = run.failure;
      entry["grids"].push_back(std::move(one));
    }
    entry["order"] = std::isfinite(study.order()) ? Json(study.order()) : Json(nullptr);
    entry["holds"] = study.holds();
    list.push_back(std::move(entry));
  }
  Json root{{"program", "clothlab"}, {"kind", "measured"}, {"scenes", std::move(list)}};
  if (!files.empty()) root["files"] = digests_json(files);
  return root.dump(2) + "\n";
}

std::string scenes_page(const std::vector<SceneValidation>& scenes, const std::string& command, double wall) {
  HtmlPage page(
      "Scenes against measured points",
      "Each scene on its own grid and on others of the same sheet, held against the points of its file.");
  const auto failed =
      std::count_if(scenes.begin(), scenes.end(), [](const auto& one) { return !one.holds(); });
  page.notice(failed == 0 ? fmt::format("All {} within their tolerance.", scenes.size())
                          : fmt::format("{} of {} not within their tolerance.", failed, scenes.size()),
              failed == 0 ? Verdict::good : Verdict::bad);
  for (const SceneValidation& study : scenes) {
    page.heading(study.name);
    page.paragraph(
        fmt::format("{}. {} of {}, {}; {}.", study.scene.title, study.scene.measured->output,
                    study.scene.measured->file, words_of_verdict(study),
                    words_of_order(study).empty() ? "no order" : "order " + words_of_order(study)));
    page.table(table_of_scene(study));
    page.figure(to_svg(measured_plot(study)), "What the grids give, and what was measured.", command);
    if (!study.one_grid.empty()) page.paragraph("No other grid: " + study.one_grid);
  }
  page.heading("How it was made");
  page.facts(
      {{"Error",
        "of a profile the root mean square distance of the measured points from the line of particles, "
        "over its length at rest; of a history the root mean square difference over the largest "
        "measured value"},
       {"Order", "how fast the last three grids approach each other, in the cells"},
       {"Time taken", fmt::format("{:.3g} s", wall)}});
  page.machine_facts();
  return page.to_html();
}

}  // namespace cloth
