#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/registry.h"
#include "io/machine.h"
#include "report/html_page.h"
#include "scene/scene_json.h"
#include "study/stability_report.h"

namespace cloth {
namespace {

HtmlCell ratio_cell(double measured, double predicted) {
  if (!finite_positive(predicted)) return "";
  const double ratio = measured / predicted;
  const double away = std::abs(ratio - 1);
  return HtmlCell(fmt::format("{:.3f}", ratio), away <= 0.03   ? Verdict::good
                                                : away <= 0.15 ? Verdict::none
                                                               : Verdict::warn);
}

HtmlTable agreement_table(const StabilityMap& map, const MethodMap& method) {
  const bool x_is_step = map.options.x.path == time_step_path;
  const StudyAxis& other = x_is_step ? map.options.y : map.options.x;
  HtmlTable table{.caption = method.method, .columns = {}, .rows = {}};
  const Axis axis = plot_axis(other, map.scene);
  const std::string unit = axis.unit.empty() ? "" : " (" + axis.unit + ")";
  for (const HtmlText& header :
       {html_code(other.path) + unit, HtmlText("measured (s)"), HtmlText("predicted (s)"), HtmlText("ratio"),
        HtmlText("spectrum (s)"), HtmlText("ratio"), HtmlText("guaranteed (s)"), HtmlText("Provot (s)")})
    table.columns.push_back({header, Align::right});
  for (const MeasuredLimit& limit : method.measured) {
    HtmlRow row{.cells = {HtmlCell(html_number(limit.other))}};
    if (limit.bracketed())
      row.cells.push_back(HtmlCell(
          html_number(limit.middle(), 4), Verdict::none,
          fmt::format("stable at {:.5g} s, not at {:.5g} s", limit.longest_stable, limit.shortest_unstable)));
    else
      row.cells.emplace_back(limit.longest_stable > 0 ? "beyond the range" : "below the range");
    const auto add = [&](double value, bool ratio) {
      row.cells.push_back(finite_positive(value) ? HtmlCell(html_number(value, 4))
                                                 : HtmlCell(std::isinf(value) ? "any" : "none"));
      if (ratio) row.cells.push_back(limit.bracketed() ? ratio_cell(limit.middle(), value) : HtmlCell(""));
    };
    add(limit.limits.predicted, true);
    add(limit.limits.spectrum, true);
    add(limit.limits.guaranteed, false);
    add(limit.limits.provot, false);
    table.rows.push_back(std::move(row));
  }
  return table;
}

HtmlTable class_table(const StabilityMap& map) {
  HtmlTable table{.caption = "How many cells ended how", .columns = {{"method"}}, .rows = {}};
  for (const ClassStyle& style : run_classes()) table.columns.push_back({style.name, Align::right});
  for (const MethodMap& method : map.methods) {
    HtmlRow row{.cells = {HtmlCell(html_code(method.method))}};
    for (int k = 0; k < static_cast<int>(run_classes().size()); ++k)
      row.cells.emplace_back(std::to_string(count_of(method, static_cast<RunClass>(k))));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_agreement(HtmlPage& page, const StabilityMap& map) {
  page.heading("Measured and predicted limits");
  page.paragraph(
      "The measured limit lies between the last stable cell of a row and the first one after it that is not; "
      "runs between the two have halved the gap five times more. Predicted: the limit of the method's own "
      "stability polynomial, with the scene's damping, at the largest frequency of the flat unbounded grid "
      "at rest. Spectrum: the same at the largest frequency of this very grid with its pins (Lanczos "
      "iteration). "
      "A ratio is measured / the column before it. A finite grid oscillates more slowly than the unbounded "
      "one, a stretched cloth faster.");
  for (const MethodMap& method : map.methods) {
    if (method.measured.empty()) continue;
    page.heading(facts_of(method.method).title, 3);
    if (const double worst = largest_deviation(method); worst > 0)
      page.paragraph(fmt::format("Largest deviation: measured / predicted = {:.3f}.", worst));
    if (std::any_of(method.measured.begin(), method.measured.end(),
                    [](const MeasuredLimit& limit) { return limit.stable_beyond; }))
      page.notice(
          "In some rows a longer step was stable again beyond the first unstable one: the table gives "
          "the first change.",
          Verdict::warn);
    page.table(agreement_table(map, method));
  }
}

}  // namespace

std::string study_page(const StabilityMap& map, const std::string& command, double wall) {
  HtmlPage page(
      "Stability: " + map.scene.title,
      "Which steps each method can take, measured by running the scene and judged by its energy, with "
      "the predicted limits over it.");
  if (!map.complete)
    page.notice("The study was interrupted. Cells that were not run are empty.", Verdict::warn);
  page.figure(to_svg(study_plot(map)),
              "Colours and marks are explained in the legend, thresholds below it. A cell's tooltip has its "
              "energy error, its steps and why it ended.",
              command);
  page.table(class_table(map));
  if (map.options.x.path == time_step_path || map.options.y.path == time_step_path) add_agreement(page, map);
  page.heading("The criterion");
  std::vector<HtmlText> items;
  for (const std::string& paragraph : criterion_text(map)) items.emplace_back(paragraph);
  page.list(items);
  page.paragraph(
      "A run finds no instability that grows more slowly than the run lasts. A method for which every step "
      "is predicted to be stable is so for small motions, no more.");
  page.heading("How it was made");
  std::vector<std::pair<std::string, HtmlText>> facts{{"scene", map.scene.title},
                                                      {"scene hash", html_code(scene_hash(map.scene))},
                                                      {"x axis", html_code(axis_text(map.options.x))},
                                                      {"y axis", html_code(axis_text(map.options.y))},
                                                      {"time taken", fmt::format("{:.3g} s", wall)}};
  for (const auto& row : fact_rows(machine_facts())) facts.emplace_back(row);
  page.facts(facts);
  page.folded("The scene as given", write_scene(map.scene));
  return page.to_html();
}

}  // namespace cloth
