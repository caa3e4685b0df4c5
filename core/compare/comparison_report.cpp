#include "compare/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"
#include "io/machine.h"
#include "report/html_page.h"
#include "simulation/run_summary.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t max_marks = 50;  // of a curve

std::string title_of(const ComparisonRun& run) {
  return run.comparison.title.empty() ? run.comparison.scene.title : run.comparison.title;
}

bool has_reference(const ComparisonRun& run) {
  return run.comparison.reference != no_reference;
}

std::string metres_or(const std::optional<double>& value, const char* otherwise) {
  return value ? fmt::format("{:.3g} m", *value) : otherwise;
}

std::string rank_or_dash(int rank) {
  return rank > 0 ? std::to_string(rank) : "-";
}

/// What stands where a pane has no difference.
const char* no_difference(const PaneResult& pane) {
  return pane.is_reference ? "reference" : "-";
}

std::string note_of(const PaneResult& pane) {
  std::string note;
  if (pane.divergence) note = describe(*pane.divergence);
  if (pane.below_floor) note = "its difference is less than the reference's from its check";
  const std::string breach = pane.rate_breach ? describe(*pane.rate_breach) : "";
  for (const std::string& sentence : {pane.notice, breach, describe(pane.energy)})
    if (!sentence.empty()) note += (note.empty() ? "" : "; ") + sentence;
  return note;
}

std::string floor_sentence(const ComparisonRun& run) {
  return fmt::format("it differs from its check ({}) by {:.2g} m RMS at the end, {:.2g} m at most", run.check,
                     *run.floor, run.largest_floor);
}

json finite(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json optional_number(const std::optional<double>& value) {
  return value ? finite(*value) : json(nullptr);
}

json rank_json(int rank) {
  return rank > 0 ? json(rank) : json(nullptr);
}

json pane_json(const PaneResult& pane) {
  json entry{{"name", pane.name},
             {"title", pane.title},
             {"method", pane.method},
             {"time_step_s", pane.time_step},
             {"status", name_of(pane.status)},
             {"simulated_s", pane.simulated},
             {"wall_s", pane.wall},
             {"wall_s_per_simulated_s", pane.cost()},
             {"steps", pane.count.steps},
             {"force_evaluations", pane.count.force_evaluations},
             {"max_strain", finite(pane.max_strain)},
             {"energy_error_J", finite(pane.energy.error())},
             {"energy_exchanged_J", finite(pane.energy.exchanged())},
             {"energy_error_share", finite(pane.energy.share())},
             {"is_reference", pane.is_reference},
             {"rms_difference_m", optional_number(pane.rms)},
             {"largest_difference_m", optional_number(pane.largest)},
             {"largest_difference_particle", pane.largest ? json(pane.particle) : json(nullptr)},
             {"below_floor", pane.below_floor},
             {"rms_difference_over_time_m", optional_number(pane.rms_over_time)},
             {"rank_by_error", rank_json(pane.error_rank)},
             {"rank_by_cost", rank_json(pane.cost_rank)}};
  if (pane.divergence)
    entry["diverged"] = {{"step", pane.divergence->step},
                         {"time_s", pane.divergence->time},
                         {"particle", pane.divergence->particle},
                         {"message", describe(*pane.divergence)}};
  if (pane.rate_breach) entry["rate_not_kept"] = breach_json(*pane.rate_breach);
  if (!pane.notice.empty()) entry["notice"] = pane.notice;
  return entry;
}

/// At most max_marks points, every nth of them and the last one.
PlotSeries series_of(const PaneResult& pane, const std::vector<double>& time,
                     const std::vector<double>& value) {
  PlotSeries series{.name = fmt::format("{}: {}", pane.name, pane.title),
                    .detail = fmt::format("step {:.4g} s", pane.time_step),
                    .style = pane.style};
  const std::size_t stride = std::max<std::size_t>(1, (time.size() + max_marks - 1) / max_marks);
  for (std::size_t k = 0; k < time.size(); ++k)
    if ((time.size() - 1 - k) % stride == 0) series.points.push_back({.x = time[k], .y = value[k]});
  if (pane.divergence) series.failed.push_back({pane.divergence->time, describe(*pane.divergence)});
  return series;
}

LinePlot plot_over_time(const ComparisonRun& run, const std::string& title) {
  LinePlot plot;
  plot.title = title;
  plot.subtitle = title_of(run);
  plot.x = {.label = "simulated time", .unit = "s"};
  std::size_t longest = 0;
  for (const PaneSeries& series : run.series) longest = std::max(longest, series.time.size());
  if (longest > max_marks)
    plot.caption.push_back("Marks at some of the common times; compare.csv has them all.");
  return plot;
}

LinePlot pane_plot(const ComparisonRun& run, const std::string& title, const Axis& y,
                   std::vector<double> PaneSeries::*value) {
  LinePlot plot = plot_over_time(run, title);
  plot.y = y;
  for (std::size_t i = 0; i < run.panes.size(); ++i)
    plot.series.push_back(series_of(run.panes[i], run.series[i].time, run.series[i].*value));
  return plot;
}

void add_table(const ComparisonRun& run, HtmlPage& page) {
  HtmlTable table{"Panes by error, then by cost",
                  {{"Pane"},
                   {"Method"},
                   {"Step", Align::right},
                   {"RMS at the end", Align::right},
                   {"Largest", Align::right},
                   {"RMS over time", Align::right},
                   {"By error", Align::right},
                   {"Cost", Align::right},
                   {"By cost", Align::right},
                   {"Evaluations", Align::right},
                   {"Largest strain", Align::right}},
                  {}};
  const auto metres = [](const PaneResult& pane, const std::optional<double>& value) {
    return value ? HtmlCell(html_number(*value) + " m") : HtmlCell(no_difference(pane));
  };
  std::vector<HtmlText> notes;
  for (const std::size_t i : ranked(run.panes)) {
    const PaneResult& pane = run.panes[i];
    if (const std::string note = note_of(pane); !note.empty())
      notes.push_back(html_strong(pane.name) + ": " + note);
    table.rows.push_back(
        {{html_strong(pane.name), pane.title, html_number(pane.time_step) + " s", metres(pane, pane.rms),
          metres(pane, pane.largest), metres(pane, pane.rms_over_time), rank_or_dash(pane.error_rank),
          fmt::format("{:.3g}", pane.cost()), rank_or_dash(pane.cost_rank),
          fmt::format("{:.0f}", pane.evaluations_each_second()),
          fmt::format("{:.4g} %", 100 * pane.max_strain)},
         pane.divergence ? Verdict::bad : Verdict::none});
  }
  page.table(table);
  if (!notes.empty()) page.list(notes);
  page.paragraph(
      "Cost: seconds of stepping for each simulated second. Evaluations: of the force, for each simulated "
      "second. Differences are distances of the same particles at the same time; RMS over all particles.");
}

void add_protocol(const ComparisonRun& run, HtmlPage& page) {
  page.heading("How it was run");
  page.facts({{"Reference", run.reference + (run.floor ? "; " + floor_sentence(run) : "")},
              {"Particles", fmt::format("{}", run.particles)},
              {"Simulated", fmt::format("{:.6g} s", run.simulated)},
              {"Common times", fmt::format("every {:.6g} s", run.comparison.scene.record.interval)},
              {"Threads", fmt::format("{}", run.threads)}});
  page.machine_facts();
  page.folded("The comparison as it was run", write_comparison(run.comparison));
}

}  // namespace

std::string comparison_text(const ComparisonRun& run) {
  std::string text =
      fmt::format("{}\n{} particles, {:.6g} s simulated", title_of(run), run.particles, run.simulated);
  text += has_reference(run) ? fmt::format("; reference: {}\n", run.reference) : "\n";
  if (run.floor) text += floor_sentence(run) + "\n";
  if (!run.notice.empty()) text += run.notice + "\n";
  text += "\n";
  text +=
      fmt::format("{:<5} {:<24} {:>12} {:>12} {:>12} {:>13} {:>5} {:>10} {:>5} {:>12}\n", "pane", "title",
                  "step", "RMS at end", "largest", "RMS over time", "rank", "cost", "rank", "evaluations");
  std::string notes;
  for (const std::size_t i : ranked(run.panes)) {
    const PaneResult& pane = run.panes[i];
    const char* none = no_difference(pane);
    text += fmt::format("{:<5} {:<24} {:>10.4g} s {:>12} {:>12} {:>13} {:>5} {:>10.3g} {:>5} {:>12.0f}\n",
                        pane.name, pane.title, pane.time_step, metres_or(pane.rms, none),
                        metres_or(pane.largest, none), metres_or(pane.rms_over_time, none),
                        rank_or_dash(pane.error_rank), pane.cost(), rank_or_dash(pane.cost_rank),
                        pane.evaluations_each_second());
    if (const std::string note = note_of(pane); !note.empty())
      notes += fmt::format("{}: {}\n", pane.name, note);
  }
  text += "cost: seconds of stepping for each simulated second; evaluations: of the force, likewise\n";
  return notes.empty() ? text : text + "\n" + notes;
}

std::string comparison_summary(const ComparisonRun& run) {
  json root{{"program", "clothlab"},
            {"version", version()},
            {"kind", "comparison"},
            {"title", title_of(run)},
            {"scene_hash", scene_hash(run.comparison.scene)},
            {"status", run.stopped        ? "stopped"
                       : run.has_result() ? "finished"
                                          : "diverged"},
            {"particles", run.particles},
            {"simulated_s", run.simulated},
            {"interval_s", run.comparison.scene.record.interval},
            {"reference", run.comparison.reference},
            {"reference_text", run.reference}};
  if (run.comparison.reference == controlled_reference) {
    root["reference_wall_s"] = run.reference_wall;
    root["reference_check"] = run.check;
    root["reference_floor_m"] = optional_number(run.floor);
    root["reference_largest_floor_m"] = finite(run.largest_floor);
  }
  if (!run.reference_failure.empty()) root["reference_failure"] = run.reference_failure;
  if (!run.notice.empty()) root["notice"] = run.notice;
  root["ranking"] = json::array();
  for (const std::size_t i : ranked(run.panes)) root["ranking"].push_back(run.panes[i].name);
  root["panes"] = json::array();
  for (const PaneResult& pane : run.panes) root["panes"].push_back(pane_json(pane));
  if (!run.files.empty()) root["files"] = digests_json(run.files);
  root["threads"] = run.threads;
  root["machine"] = json::object();
  for (const auto& [name, value] : fact_rows(machine_facts())) root["machine"][name] = value;
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

LinePlot difference_plot(const ComparisonRun& run) {
  LinePlot plot = plot_over_time(run, "RMS difference from the reference");
  plot.caption.insert(plot.caption.begin(), "Reference: " + run.reference + ".");
  plot.y = {.label = "RMS difference", .unit = "m", .scale = AxisScale::logarithmic};
  for (std::size_t i = 0; i < run.panes.size(); ++i) {
    if (run.panes[i].is_reference) continue;
    PaneSeries series = run.series[i];
    if (!series.rms.empty()) {  // at the start all are the same, which a logarithm cannot show
      series.rms.erase(series.rms.begin());
      series.difference_time.erase(series.difference_time.begin());
    }
    plot.series.push_back(series_of(run.panes[i], series.difference_time, series.rms));
  }
  if (run.floor_series.rms.size() > 1) {
    PlotSeries floor{.name = "Reference from its check",
                     .detail = "differences below are not told apart",
                     .style = static_cast<int>(max_panes),
                     .markers = false};
    for (std::size_t k = 1; k < run.floor_series.rms.size(); ++k)
      floor.points.push_back({.x = run.floor_series.difference_time[k], .y = run.floor_series.rms[k]});
    plot.series.push_back(std::move(floor));
  }
  return plot;
}

LinePlot energy_error_plot(const ComparisonRun& run) {
  return pane_plot(run, "Energy error", {.label = "energy error", .unit = "J"}, &PaneSeries::energy_error);
}

LinePlot strain_plot(const ComparisonRun& run) {
  return pane_plot(run, "Largest strain", {.label = "largest strain"}, &PaneSeries::max_strain);
}

LinePlot main_plot(const ComparisonRun& run) {
  return has_reference(run) ? difference_plot(run) : strain_plot(run);
}

std::string comparison_page(const ComparisonRun& run, const std::string& command) {
  HtmlPage page(
      "Comparison: " + title_of(run),
      "The same scene run side by side, each pane with its own method, step or values, and compared "
      "particle by particle at common times.");
  if (run.stopped)
    page.notice("The comparison was stopped before its end; the results are those up to there.",
                Verdict::warn);
  if (!run.reference_failure.empty())
    page.notice("The reference stopped, and with it the differences: " + run.reference_failure, Verdict::bad);
  if (!run.notice.empty()) page.notice(run.notice, Verdict::warn);
  page.heading("Ranking");
  add_table(run, page);
  page.heading("Over time");
  if (has_reference(run))
    page.figure(to_svg(difference_plot(run)),
                "RMS distance of all particles from the reference. A curve that ends early is a pane that "
                "stopped.",
                command);
  page.figure(to_svg(energy_error_plot(run)),
              "What works and losses cannot explain of the change in energy: the method's own doing.",
              command);
  page.figure(to_svg(strain_plot(run)), "The largest strain of structural and shear springs.", command);
  add_protocol(run, page);
  return page.to_html();
}

}  // namespace cloth
