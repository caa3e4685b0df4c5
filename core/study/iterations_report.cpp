#include "study/iterations_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/html_page.h"
#include "report/text_table.h"
#include "scene/method_facts.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

constexpr double milliseconds = 1e3;
constexpr double told_objectives[] = {1e-2, 1e-4, 1e-8};

std::vector<std::string> words_of(const IterationsStudy& study) {
  std::vector<std::string> words;
  words.push_back(fmt::format("One step of {:.4g} s after {:.4g} s of {}, {} particles.", study.step,
                              study.time, study.scene.title, study.particles));
  if (!study.left_out.empty())
    words.push_back(fmt::format("Left out of the scene: {}.", fmt::join(study.left_out, ", ")));
  if (!study.failure.empty()) {
    words.push_back("There is nothing to measure against: " + study.failure + ".");
    return words;
  }
  words.push_back(
      fmt::format("The objective falls by {:.4g} J. Newton's method, to a change of 1e-12 from two guesses, "
                  "leaves {:.2g} N s of the "
                  "step equations; differences below {:.2g} of that fall mean nothing.",
                  study.fall, study.residual, study.floor));
  if (!study.is_minimum)
    words.emplace_back(
        "The solution is no minimum: the second derivative of the objective is not positive definite there.");
  if (study.floor > 1e-6)
    words.emplace_back(
        "From two guesses Newton's method has found two solutions: the step has more than one.");
  for (const MethodIterations& method : study.methods)
    for (const IteratedStep& step : method.steps)
      if (step.objective < -study.floor) {
        words.push_back(fmt::format("{} goes below the solution: to another, lower minimum.",
                                    title_of_iterated(method.method)));
        break;
      }
  return words;
}

TextTable terminal_table(const IterationsStudy& study) {
  TextTable table{{{"Method"}}, {}};
  for (const double objective : told_objectives) {
    table.columns.push_back({fmt::format("To {:.0e}", objective), true});
    table.columns.push_back({"ms", true});
  }
  table.columns.push_back({"Best", true});
  table.columns.push_back({"Iterations", true});
  table.columns.push_back({"Remark"});
  for (const MethodIterations& method : study.methods) {
    std::vector<std::string> row{title_of_iterated(method.method)};
    for (const double objective : told_objectives) {
      const IteratedStep* step = first_below(method, objective);
      row.push_back(step ? std::to_string(step->iterations) : "");
      row.push_back(step ? fmt::format("{:.3g}", milliseconds * step->seconds) : "");
    }
    const auto best = std::min_element(
        method.steps.begin(), method.steps.end(),
        [](const auto& a, const auto& b) { return std::abs(a.objective) < std::abs(b.objective); });
    row.push_back(best == method.steps.end() ? "" : fmt::format("{:.1e}", best->objective));
    row.push_back(best == method.steps.end() ? "" : std::to_string(best->iterations));
    row.push_back(method.remark);
    table.rows.push_back(std::move(row));
  }
  return table;
}

HtmlTable html_table(const IterationsStudy& study) {
  const TextTable text = terminal_table(study);
  HtmlTable table{"Iterations and milliseconds of the whole step to relative objectives", {}, {}};
  for (const TextColumn& column : text.columns)
    table.columns.push_back({column.header, column.is_right ? Align::right : Align::left});
  for (const auto& row : text.rows) {
    table.rows.emplace_back();
    for (const std::string& cell : row) table.rows.back().cells.emplace_back(cell);
  }
  return table;
}

nlohmann::ordered_json json_of(const IterationsStudy& study) {
  nlohmann::ordered_json root{{"scene", study.scene.title},
                              {"scene_hash", scene_hash(study.scene)},
                              {"left_out", study.left_out},
                              {"time_s", study.time},
                              {"time_step_s", study.step},
                              {"particles", study.particles},
                              {"failure", study.failure},
                              {"fall_J", study.fall},
                              {"residual_N_s", study.residual},
                              {"is_minimum", study.is_minimum},
                              {"floor", study.floor},
                              {"stopped", study.stopped},
                              {"methods", nlohmann::ordered_json::array()}};
  for (const MethodIterations& method : study.methods) {
    nlohmann::ordered_json entry{{"method", method.method}, {"remark", method.remark}};
    for (const IteratedStep& step : method.steps)
      entry["steps"].push_back(
          {{"iterations", step.iterations},
           {"seconds", step.seconds},
           {"relative_objective", std::isfinite(step.objective) ? nlohmann::ordered_json(step.objective)
                                                                : nlohmann::ordered_json(nullptr)}});
    root["methods"].push_back(std::move(entry));
  }
  return root;
}

}  // namespace

std::string title_of_iterated(const std::string& method) {
  return method == "implicit-euler" ? "Newton's method" : facts_of(method).title;
}

LinePlot study_plot(const IterationsStudy& study, IterationsAgainst against) {
  const bool by_time = against == IterationsAgainst::time;
  LinePlot plot{.title = by_time ? "Objective against time" : "Objective against iterations",
                .subtitle = study.scene.title};
  plot.x = {.label = by_time ? "time of the step" : "iterations",
            .unit = by_time ? "ms" : "",
            .scale = AxisScale::logarithmic};
  plot.y = {.label = "objective above the minimum, relative to its fall", .scale = AxisScale::logarithmic};
  const std::vector<std::string>& names = integrator_names();
  int tag = 0;
  for (const MethodIterations& method : study.methods) {
    PlotSeries series{.name = title_of_iterated(method.method), .detail = method.remark};
    series.style = static_cast<int>(std::find(names.begin(), names.end(), method.method) - names.begin());
    for (const IteratedStep& step : method.steps) {
      const double x = by_time ? milliseconds * step.seconds : step.iterations;
      const std::string note =
          fmt::format("{} iterations, {:.4g} ms", step.iterations, milliseconds * step.seconds);
      if (std::isfinite(step.objective))
        series.points.push_back({.x = x, .y = step.objective, .note = note, .tag = tag});
      else
        series.failed.push_back({x, method.remark, tag});
      ++tag;
    }
    plot.series.push_back(std::move(series));
  }
  if (study.floor > 0) plot.floor = PlotFloor{study.floor, "floor"};
  plot.caption = words_of(study);
  return plot;
}

std::vector<std::string> line_of(const MethodIterations& method, std::size_t step) {
  const IteratedStep& of = method.steps[step];
  return {method.method, std::to_string(of.iterations), csv_number(of.seconds),
          std::isfinite(of.objective) ? csv_number(of.objective) : "",
          step + 1 == method.steps.size() ? method.remark : ""};
}

CsvTable table_of(const IterationsStudy& study) {
  CsvTable table{{"method", "iterations", "seconds", "relative_objective", "remark"}, {}};
  for (const MethodIterations& method : study.methods)
    for (std::size_t k = 0; k < method.steps.size(); ++k) table.rows.push_back(line_of(method, k));
  return table;
}

std::string study_text(const IterationsStudy& study) {
  std::string text = study.methods.empty() ? "" : to_text(terminal_table(study)) + "\n";
  for (const std::string& words : words_of(study)) text += words + "\n";
  return text;
}

std::string study_json(const IterationsStudy& study) {
  return json_of(study).dump(2) + "\n";
}

std::string study_page(const IterationsStudy& study, const std::string& command, double wall) {
  HtmlPage page("Convergence of iterations: " + study.scene.title,
                "How far the methods that solve an implicit Euler step come with so many iterations, and "
                "with so much time.");
  if (study.stopped)
    page.notice("The study was stopped before its end; tables and figures hold what was finished.",
                Verdict::warn);
  std::vector<HtmlText> items;
  for (const std::string& words : words_of(study)) items.emplace_back(words);
  page.list(items);
  if (!study.methods.empty()) {
    page.table(html_table(study));
    page.figure(to_svg(study_plot(study, IterationsAgainst::iterations)),
                "What is left of the fall of the step's objective, against iterations.", command);
    page.figure(to_svg(study_plot(study, IterationsAgainst::time)), "The same against the time of the step.",
                command);
  }
  page.heading("How it was made");
  page.facts(
      {{"Objective",
        "(G - G*)/(G0 - G*), G* at the solution of Newton's method, G0 where inertia and gravity "
        "take the cloth; differences are added up element by element"},
       {"Time", "the least of several solves of the whole step, its set-up once before them; one thread"},
       {"XPBD", "one substep"},
       {"VBD", "with Chebyshev's semi-iteration"},
       {"Time taken", fmt::format("{:.3g} s", wall)}});
  page.machine_facts();
  page.folded("The scene", write_scene(study.scene));
  return page.to_html();
}

}  // namespace cloth
