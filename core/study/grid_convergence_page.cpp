#include <fmt/format.h>

#include <cmath>

#include "report/html_page.h"
#include "scene/scene_json.h"
#include "study/grid_convergence_report.h"

namespace cloth {
namespace {

Verdict verdict_of(const Richardson& found) {
  switch (found.verdict) {
    case GridVerdict::converging:
      return found.is_asymptotic ? Verdict::good : Verdict::none;
    case GridVerdict::unchanged:
      return Verdict::good;
    case GridVerdict::diverging:
      return Verdict::bad;
    default:
      return Verdict::warn;
  }
}

HtmlTable output_table(const GridConvergence& study, std::size_t output) {
  HtmlTable table{words_of_output(study.outputs[output]), {}, {}};
  for (const char* head : {"Cells", "Cell (m)", "Step (s)", "Value", "Difference", "Order",
                           "Richardson's value", "Grid convergence index"})
    table.columns.push_back({head, Align::right});
  table.columns.push_back({"Status"});
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const GridRun& run = study.runs[k];
    const GridRow row = row_of(study, output, k);
    const bool is_finished = run.status == GridRunStatus::finished;
    table.rows.push_back(
        {{fmt::format("{} x {}", run.columns - 1, run.rows - 1), html_number(run.cell, 5),
          run.time_step > 0 ? html_number(run.time_step, 4) : HtmlText(), row.value, row.difference,
          row.order, row.extrapolate, row.index,
          HtmlCell(name_of(run.status), is_finished ? Verdict::none : Verdict::bad, run.detail)}});
  }
  return table;
}

void add_output(const GridConvergence& study, std::size_t output, const std::string& command,
                HtmlPage& page) {
  const Richardson found = richardson_of(study, output);
  page.heading(words_of_output(study.outputs[output]));
  page.notice(found.words, verdict_of(found));
  page.table(output_table(study, output));
  if (std::isfinite(found.extrapolate) && found.verdict != GridVerdict::unchanged)
    page.paragraph(fmt::format(
        "Extrapolated to cells without size: {:.8g}. Error of the finest value: {:.2g}, with a safety factor "
        "of {:.3g}.",
        found.extrapolate, found.band, found.safety));
  page.figure(to_svg(output_plot(study, output, GridPlot::values)),
              "Values on the grids, and what they extrapolate to.", command);
  if (found.verdict == GridVerdict::converging)
    page.figure(to_svg(output_plot(study, output, GridPlot::errors)),
                "Distance from the extrapolated value: the slope is the order.", command);
}

void add_failures(const GridConvergence& study, HtmlPage& page) {
  std::vector<HtmlText> items;
  for (const GridRun& run : study.runs)
    if (!run.detail.empty())
      items.push_back(html_strong(fmt::format("{} cells, {}", run.cells, name_of(run.status))) + ": " +
                      run.detail);
  if (items.empty()) return;
  page.heading("What is to be said of single grids");
  page.list(items);
}

void add_protocol(const GridConvergence& study, double wall, HtmlPage& page) {
  page.heading("How it was made");
  const Scene& scene = study.scene;
  page.facts(
      {{"Scene", scene.title},
       {"Scene hash", html_code(scene_hash(scene))},
       {"Time", html_number(scene.duration, 6) + " s"},
       {"Method", scene.integrator.method},
       {"Step", scene.integrator.time_step ? html_number(*scene.integrator.time_step, 4) + " s on every grid"
                                           : HtmlText("auto, of each grid its own")},
       {"Grids", "the same sheet with other numbers of cells; pins keep their places"},
       {"Order",
        "of the finest three grids so far, from the differences of their values (Celik et al. 2008)"},
       {"Richardson's value", "the finest value, and what the observed order says is left"},
       {"Grid convergence index",
        fmt::format("what is left with an order of at most 2, times {:.3g}, over the finest value (Roache "
                    "1994; Oberkampf and Roy 2010)",
                    gci_safety)},
       {"Time taken", fmt::format("{:.3g} s", wall)}});
  page.machine_facts();
  page.folded("The scene", write_scene(scene));
}

}  // namespace

std::string study_page(const GridConvergence& study, const std::string& command, double wall) {
  HtmlPage page("Grid convergence: " + study.scene.title,
                "What outputs of the scene are on finer and finer grids of the same sheet, with which order "
                "they approach a limit, and what is left of the error.");
  if (!study.is_complete())
    page.notice("The study was stopped before its end; tables and figures hold what was finished.",
                Verdict::warn);
  for (std::size_t k = 0; k < study.outputs.size(); ++k) add_output(study, k, command, page);
  add_failures(study, page);
  std::vector<HtmlText> items;
  for (const std::string& caution : cautions_of(study)) items.emplace_back(caution);
  if (!items.empty()) {
    page.heading("Read it with care");
    page.list(items);
  }
  add_protocol(study, wall, page);
  return page.to_html();
}

}  // namespace cloth
